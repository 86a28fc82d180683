/* Stage `raster`: exact integer sums of signed path parameters, per plane and pixel, by one of three
 * strategies that give the same bits. The plan decides, this obeys. Private. */
#ifndef SKG_RASTER_H
#define SKG_RASTER_H

#include "stage/project.h"

/* What a tile is; AUTO: squares on a GPU, bands elsewhere. */
enum { SKG_TILE_AUTO = 0, SKG_TILE_BANDS = 1, SKG_TILE_SQUARES = 2 };

typedef struct {
    skg_kernel_options kernels;
    int32_t strategy;      /* SKG_STRATEGY_COPIES, _TILES or _ATOMICS */
    int32_t shape;         /* tiles: SKG_TILE_... */
    int32_t tile;          /* tiles: rows of a band or side of a square, in pixels; 0: chosen here */
    int64_t columns, rows; /* of the detector */
    int64_t planes;        /* accumulator planes, >= 1 */
    int64_t triangles;     /* most triangles of a frame */
    int32_t more_sums;     /* 1: other kernels add to the sums of the first copy after a frame */
    int32_t reserved;
} skg_raster_options;

typedef struct skg_raster skg_raster;

/* Compiles and allocates. The options are kept. */
skg_status skg_raster_create(skg_context *context, const skg_raster_options *options, skg_raster **raster);
void skg_raster_release(skg_raster **raster);

/* Rays of the frames to come: only sums in half precision need them. */
void skg_raster_set_rays(skg_raster *raster, const skg_camera *camera);

/* Enqueues a frame: what skg_geometry_project has projected is added up. Nothing is waited for. fields:
 * [planes][4] rows from, to, columns from, to outside which nothing is added to a plane (skg_shared.h); they
 * must stay until the frame is done. NULL: not known. */
skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, const cl_int *fields,
                          skg_stage_log *log);

/* Enqueues the verdicts on `count` count planes (int planes[], on the device) into int verdicts[first...][1 +
 * SKG_FIRST_BAD]: how many pixels do not cancel, then the first ones, row * columns + column, ascending. */
skg_status skg_raster_bad_pixels(skg_raster *raster, int64_t count, cl_mem planes, int64_t first,
                                 cl_mem verdicts, skg_stage_log *log);

/* Enqueues a read of how often triangles are listed in tiles, into listed[2]: in lists of one tile, in the
 * list for all tiles. It must stay. Nothing is written by strategies without tiles. */
skg_status skg_raster_read_listed(const skg_raster *raster, int32_t *listed);

/* Shape of the tiles (the whole detector where there are none) and their number; bytes allocated. */
void skg_raster_tiles(const skg_raster *raster, int64_t *columns, int64_t *rows, int64_t *tiles);
int64_t skg_raster_bytes(const skg_raster *raster);

/* What a strategy is chosen by. */
typedef struct {
    int32_t is_gpu;
    int32_t workers;        /* compute units */
    int64_t image_bytes;    /* of all accumulator planes */
    int64_t triangles;      /* of a frame */
    double triangle_pixels; /* mean pixels of a triangle's box */
} skg_raster_facts;

/* The strategy for these facts, and why in a few words (static storage). */
int32_t skg_raster_choose(const skg_raster_facts *facts, const char **why);

#endif
