/* The interface of a strategy of rasters, and what all share. Private. */
#ifndef SKG_RASTER_PRIVATE_H
#define SKG_RASTER_PRIVATE_H

#include "stage/raster.h"

/* --- The inside of a raster, for its own files and for the stages that read or add to its sums. */

enum {
    SKG_RASTER_GROUP = 64, /* local size where a work-item takes a triangle */
    SKG_STRATEGY_FILES = 6,
    SKG_STRATEGY_KERNELS = 4
};

/* How triangles are added up, in one file: raster_*.c, and kernels/raster_*.cl. raster_create.c lists the strategies. A member
 * that is NULL is not needed. */
typedef struct {
    /* Whether it draws rasters with these options. */
    int (*takes)(const skg_context *context, const skg_raster_options *options);
    const char *files[SKG_STRATEGY_FILES];     /* of its program, behind those of the projection */
    const char *kernels[SKG_STRATEGY_KERNELS]; /* functions that become skg_raster.kernels */
    /* Sets what the layout has beside the sizes of detector and planes: copies, shape of tiles, entries of a queue. */
    skg_status (*lay_out)(skg_raster *raster);
    skg_status (*allocate)(skg_raster *raster); /* buffers beside sums and used */
    /* Gets the program of the strategy, instead of skg_raster_get_program. program: NULL: it is only prefetched. */
    skg_status (*get_program)(const skg_raster *raster, cl_program *program);
    /* Enqueues one frame. */
    skg_status (*run)(skg_raster *raster, const skg_geometry *geometry, skg_stage_log *log);
    /* The buffer that holds the two ints of skg_raster_read_listed, and the first of them. */
    const skg_buffer *(*find_listed)(const skg_raster *raster, int64_t *first);
} skg_raster_strategy;
extern const skg_raster_strategy skg_raster_half, skg_raster_passes_together, skg_raster_copies,
    skg_raster_atomics, skg_raster_squares, skg_raster_bands;

struct skg_raster {
    skg_context *context;
    skg_raster_options options;
    const skg_raster_strategy *strategy;
    skg_raster_layout layout;
    skg_ray_float rays; /* half */
    int32_t workers;    /* persistent work-groups, if the strategy has such */
    skg_buffer sums;
    skg_buffer used; /* sets of the planes of copies, counters of claims, extents of the planes */
    cl_int *whole;   /* [planes][4] extents of the whole detector */
    /* [planes][4] extents as the device has them; of passes that are drawn together: not used */
    cl_int *sent;
    skg_buffer scratch; /* bands: an image for each worker; passes: projected vertices for each worker */
    skg_buffer counts, starts, list,
        for_all;         /* tiles; for bands: counters, pieces, pool, list for all bands */
    skg_buffer queue;    /* atomics: strips of large triangles */
    skg_buffer rows_bad; /* [count planes][rows][3] of the last verdicts, as counts.cl leaves it */
    cl_kernel kernels[SKG_STRATEGY_KERNELS]; /* of the strategy */
    cl_kernel project;                       /* of the same program */
    cl_kernel source;                        /* for the source's plane; NULL: no triangle reaches it */
    cl_kernel bad_rows, bad;                 /* made on demand */
    int32_t only_prefetch;                   /* 1: its programs are only prefetched */
    int32_t reserved;
    int64_t state; /* of the geometry whose sums it holds, all of them; 0: not known */
};

/* How many passes a worker draws side by side: SKG_SIDE of the kernels. */
int32_t skg_raster_side(const skg_raster *raster);

/* Bytes of an accumulator, and of all planes of one copy. */
int64_t skg_raster_sum_bytes(const skg_raster *raster);
int64_t skg_raster_plane_bytes(const skg_raster *raster);

/* Reserves a buffer of a raster; the lists of the tiles, and the list for all tiles. */
skg_status skg_raster_reserve(skg_raster *raster, skg_buffer *buffer, int64_t bytes, const char *what);
skg_status skg_raster_reserve_lists(skg_raster *raster);

/* The program of the strategy's files. program: NULL: it is only prefetched. */
skg_status skg_raster_get_program(const skg_raster *raster, cl_program *program);

/* The sizes of launches: a work-group of one work-item for each worker; a work-item for each triangle; whole work-groups. */
static inline skg_work_size skg_raster_by_worker(const skg_raster *raster) {
    return (skg_work_size){1, {raster->workers}, {1}};
}
static inline skg_work_size skg_raster_by_triangle(const skg_raster *raster) {
    return (skg_work_size){1, {raster->layout.triangles}, {SKG_RASTER_GROUP}};
}
static inline skg_work_size skg_raster_in_groups(int64_t groups) {
    return (skg_work_size){1, {groups * SKG_RASTER_GROUP}, {SKG_RASTER_GROUP}};
}

/* Launches a kernel of the strategy, by its number in the list of kernels. */
#define SKG_RASTER_LAUNCH(raster, number, stage, work, arguments, log)                                       \
    SKG_LAUNCH((raster)->context, (raster)->kernels[number], stage, (const skg_work_size[]){work},           \
               arguments, log)

/* Enqueues a fill of `bytes` bytes of a buffer from byte `from` on. */
skg_status skg_raster_fill(const skg_raster *raster, const skg_buffer *buffer, cl_int value, int64_t from,
                           int64_t bytes);

/* Into how many work-items the kernel of the source plane divides a triangle: on a CPU few, because most triangles are far from
 * the source and each work-item has to find that out. */
size_t skg_raster_source_bands(const skg_raster *raster);

/* --- Rasters made so far, by what they can do: sums of 32 or 64 bits, point or parallel beam, how many planes... *
 * A raster is got pinned. It stays until its pin is released; only rasters without a pin are replaced. */

enum { SKG_RASTER_CACHE_CAPACITY = 16 };

typedef struct {
    skg_raster *raster;
    skg_raster_options options;
    int32_t pins, reserved;
} skg_raster_entry;

/* All zero but for the context: empty. */
typedef struct {
    skg_context *context;
    int32_t count, next; /* entries in use; the entry to replace next, if it has no pin */
    skg_raster_entry entries[SKG_RASTER_CACHE_CAPACITY];
} skg_raster_cache;

/* A raster in use. All zero: none. The cache must not move while pins exist. */
typedef struct {
    skg_raster *raster;
    skg_raster_entry *entry;
} skg_raster_pin;

/* The raster with these options, made on demand, pinned. Whatever pin held before is released, after the new raster is
 * pinned. A cache full of pinned rasters is SKG_ERR_INTERNAL, and pin keeps what it holds. */
skg_status skg_raster_cache_pin(skg_raster_cache *cache, const skg_raster_options *options,
                                skg_raster_pin *pin);

/* Another pin of the same raster, which may hold one before. */
void skg_raster_pin_copy(const skg_raster_pin *from, skg_raster_pin *to);

/* Releases a pin; one that holds nothing is fine. What is enqueued for the raster may still be under way: OpenCL keeps
 * the memory of a raster that is replaced until it is done. */
void skg_raster_pin_release(skg_raster_pin *pin);

/* Releases all rasters, pinned or not. */
void skg_raster_cache_release(skg_raster_cache *cache);

/* Bytes on the device. */
int64_t skg_raster_cache_bytes(const skg_raster_cache *cache);

#endif
