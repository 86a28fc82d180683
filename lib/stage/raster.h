/* Stage `raster`: exact integer sums of signed path parameters, per plane and pixel. Private.
 *
 * Three strategies give the same bits; lib/plan chooses one. The accumulators, and which extents of them hold sums, are
 * read by the stages that follow (raster_private.h). */
#ifndef SKG_RASTER_H
#define SKG_RASTER_H

#include "stage/project.h"

/* The shape of a tile; AUTO: squares on a GPU, bands elsewhere. */
enum { SKG_TILE_AUTO = 0, SKG_TILE_BANDS = 1, SKG_TILE_SQUARES = 2 };

typedef struct {
    skg_kernel_options kernels;
    int32_t strategy;  /* SKG_STRATEGY_COPIES, _TILES or _ATOMICS */
    int32_t shape;     /* tiles: SKG_TILE_... */
    int32_t tile;      /* tiles: rows of a band or side of a square, in pixels; 0: chosen here */
    int32_t more_sums; /* 1: other kernels add to the sums of the first copy after a frame */
    int32_t passes;    /* of a frame that are drawn together, SKG_STRATEGY_COPIES; 0 or 1: each by itself */
    int32_t side;      /* of these, how many one worker draws side by side: 1 or 4; passes: a multiple */
    int64_t columns, rows; /* of the detector */
    int64_t planes;        /* of accumulators, >= 1 */
    int64_t triangles;     /* the most of a frame */
} skg_raster_options;
_Static_assert(sizeof(skg_raster_options) ==
                   sizeof(skg_kernel_options) + 6 * sizeof(int32_t) + 4 * sizeof(int64_t),
               "options have no gaps: they are compared as bytes");

typedef struct skg_raster skg_raster;

/* Compiles and allocates. The options are copied. */
skg_status skg_raster_create(skg_context *context, const skg_raster_options *options, skg_raster **raster);
void skg_raster_release(skg_raster **raster);

/* Prefetches the programs and the accumulators of a raster with these options (skg_prefetch_begin). extents: as of skg_raster_run */
skg_status skg_raster_prefetch(skg_context *context, const skg_raster_options *options,
                               const cl_int *extents);

/* The kernel that projects vertices for this raster. It is of the same program, because each program takes time to compile. */
cl_kernel skg_raster_projection(const skg_raster *raster);

/* Gives the rays of the frames to come. Only sums in half precision need them. */
void skg_raster_set_rays(skg_raster *raster, const skg_camera *camera);

/* Notes the numbers of parts, vertices and triangles that launches need; for kernels that run before skg_raster_run. */
skg_status skg_raster_set_scene(skg_raster *raster, const skg_geometry *geometry);

/* Enqueues a frame: adds up what skg_geometry_project has projected. extents: [planes][4] rows from and to, columns
 * from and to, outside which nothing is added to a plane (skg_shared.h); they must stay until the device has read them.
 * NULL: the whole detector. */
skg_status skg_raster_run(skg_raster *raster, const skg_geometry *geometry, const cl_int *extents,
                          skg_stage_log *log);

/* Says that the sums of the geometry as it stands are enqueued, with all that is changed in them; whether they still stand. */
void skg_raster_keep(skg_raster *raster, const skg_geometry *geometry);
int skg_raster_keeps(const skg_raster *raster, const skg_geometry *geometry);

/* How many passes a raster draws together: at least 1. */
int32_t skg_raster_passes(const skg_raster *raster);

/* Enqueues the projection and the sums of the first `passes` of them, whose tables are uploaded (skg_geometry_send_passes). placed: a 0,
 * then the extents of each of them, [passes][planes][4]; read: the event from which on they need not stay; NULL: none. */
skg_status skg_raster_run_passes(skg_raster *raster, const skg_geometry *geometry, int32_t passes,
                                 const cl_int *placed, cl_event *read, skg_stage_log *log);

/* Enqueues the verdicts on `count` count planes (int planes[], on the device) into int verdicts[first...][1 +
 * SKG_FIRST_BAD]: how many pixels have signed hits that do not cancel, then the first of them, row * columns + column,
 * ascending. */
skg_status skg_raster_bad_pixels(skg_raster *raster, int64_t count, cl_mem planes, int64_t first,
                                 cl_mem verdicts, skg_stage_log *log);

/* Enqueues a read of how often triangles are listed in tiles, into listed[2]: in lists of one tile, and in the list for
 * all tiles. listed must stay until the read is done. Strategies without tiles write nothing. */
skg_status skg_raster_read_listed(const skg_raster *raster, int32_t *listed);

/* The shape of the tiles (the whole detector if there are none) and their number. */
void skg_raster_tiles(const skg_raster *raster, int64_t *columns, int64_t *rows, int64_t *tiles);

/* Rows of a band: it fits the cache or has 32 rows, and each work-group has some bands. row_bytes: of a row of all
 * accumulators. */
int64_t skg_raster_band_rows(int64_t rows_of_detector, int64_t row_bytes, int64_t groups);

/* How many triangles a work-group of SKG_STRATEGY_COPIES claims at once: few enough that the last claims even out, and
 * that a thousand triangles still use every worker. */
int64_t skg_raster_claim(int64_t triangles, int64_t workers);

/* Accumulator planes. */
int64_t skg_raster_plane_count(const skg_raster *raster);

/* Bytes on the device. */
int64_t skg_raster_bytes(const skg_raster *raster);

#endif
