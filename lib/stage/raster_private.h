/* The inside of a raster, for its own files and for the stages that read or add to its sums. Private. */
#ifndef SKG_RASTER_PRIVATE_H
#define SKG_RASTER_PRIVATE_H

#include "stage/raster.h"

enum {
    SKG_RASTER_PROJECT,
    SKG_RASTER_COUNT,
    SKG_RASTER_SCAN,
    SKG_RASTER_FILL,
    SKG_RASTER_DRAW,
    SKG_RASTER_LARGE,
    SKG_RASTER_SOURCE,
    SKG_RASTER_KERNELS
};

struct skg_raster {
    skg_context *context;
    skg_raster_options options;
    skg_frame_args frame;
    skg_ray_float rays; /* half */
    int32_t workers;    /* persistent work-groups, if the strategy has such */
    skg_buffer sums;
    skg_buffer used;    /* which copies count, the counter of claims, the extents of the planes */
    cl_int *whole;      /* [planes][4] extents of the whole detector */
    cl_int *sent;       /* [passes][planes][4] extents as the device has them */
    skg_buffer scratch; /* bands: an image for each worker; passes: projected vertices for each worker */
    skg_buffer counts, starts, list,
        for_all;         /* tiles; for bands: counters, pieces, pool, list for all bands */
    skg_buffer queue;    /* atomics: strips of large triangles */
    skg_buffer rows_bad; /* [count planes][rows][3] of the last verdicts, as counts.cl leaves it */
    cl_kernel kernels[SKG_RASTER_KERNELS]; /* NULL: not used by the strategy */
    cl_kernel bad_rows, bad;               /* made on demand */
    int32_t expected;                      /* 1: its programs are only expected */
};

/* Whether tiles are squares. */
int skg_raster_has_squares(const skg_raster *raster);

/* How many passes a worker draws side by side: SKG_SIDE of the kernels. */
int32_t skg_raster_side(const skg_raster *raster);

/* Bytes of an accumulator. */
int64_t skg_raster_sum_bytes(const skg_raster *raster);

/* Enqueues a fill of `bytes` bytes of a buffer from byte `from` on. */
skg_status skg_raster_fill(const skg_raster *raster, const skg_buffer *buffer, cl_int value, int64_t from,
                           int64_t bytes);

/* Into how many work-items the kernel of the source plane divides a triangle: on a CPU few, because most triangles are far from
 * the source and each work-item has to find that out. */
size_t skg_raster_source_bands(const skg_raster *raster);

#endif
