/* The inside of a raster stage, for its own files. */
#ifndef SKG_RASTER_PRIVATE_H
#define SKG_RASTER_PRIVATE_H

#include "stage/raster.h"

enum {
    SKG_RASTER_COUNT,
    SKG_RASTER_SCAN,
    SKG_RASTER_FILL,
    SKG_RASTER_DRAW,
    SKG_RASTER_QUEUE,
    SKG_RASTER_SOURCE,
    SKG_RASTER_KERNELS
};

struct skg_raster {
    skg_context *context;
    skg_raster_options options;
    skg_frame_args frame;
    skg_ray_float rays; /* half */
    int32_t workers;    /* persistent work-groups, where the strategy has such */
    skg_buffer sums;
    skg_buffer used;                          /* copies that count, the counter of claims, fields */
    cl_int *whole, *sent;                     /* [planes][4] fields: of everything; as the device has them */
    skg_buffer scratch;                       /* bands: an image for each worker */
    skg_buffer counts, starts, list, for_all; /* tiles; of bands: counters, pieces, pool and list for all */
    skg_buffer queue;                         /* atomics: strips of large triangles */
    skg_buffer rows_bad; /* [count planes][rows][3] of the last verdicts, as counts.cl leaves it */
    cl_kernel kernels[SKG_RASTER_KERNELS]; /* NULL: not used by the strategy */
    cl_kernel bad_rows, bad;               /* made on demand */
};

#endif
