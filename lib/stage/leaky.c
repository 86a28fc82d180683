/* Stage `leaky`: the sums of parts whose meshes are not closed. */
#include "stage/leaks.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

/* Bytes of the planes of a batch, unless one part needs more. */
enum { BATCH_BYTES = 32 << 20 };

/* A frame's batches, one after another. */
typedef struct {
    const skg_leaky_parts *leaky;
    const skg_pass *pass;
    skg_geometry *geometry;
    skg_leaky_memory *memory;
    skg_leaky_verdicts *verdicts;
    skg_staging *staging;
    skg_raster_pin pin;          /* the raster of all batches, made for the one with the most planes */
    int64_t planes;              /* of that raster */
    skg_geometry_part *parts;    /* [parts] only the batch's are drawn */
    skg_contribution *to_planes; /* [planes] */
} batching;

skg_status skg_leaky_verdicts_create(int64_t count, skg_staging *staging, skg_leaky_verdicts *verdicts) {
    *verdicts = (skg_leaky_verdicts){0};
    SKG_TRY(skg_staging_take(staging, count, sizeof *verdicts->indices, "bad pixels", &verdicts->indices));
    return skg_staging_take(staging, count * (1 + SKG_FIRST_BAD), sizeof *verdicts->pixels, "bad pixels",
                            &verdicts->pixels);
}

/* One plane for each contribution of a leaky part, and its count plane. */
static int64_t planes_of(const batching *b, int64_t index) {
    const int64_t part = b->leaky->parts[index];
    return b->pass->first[part + 1] - b->pass->first[part] + 1;
}

/* Lists the parts that contribute: a frame of one part's lengths leaves out the others. */
static void list_parts(const batching *b) {
    b->verdicts->count = 0;
    for (int64_t k = 0; k < b->leaky->count; k++)
        if (planes_of(b, k) > 1) b->verdicts->indices[b->verdicts->count++] = k;
}

static skg_status get_raster(batching *b, skg_raster_cache *rasters) {
    const skg_raster *shared = b->pass->main.raster;
    skg_raster_options options = shared->options;
    int64_t most = 0, total = 0;
    for (int64_t k = 0; k < b->verdicts->count; k++) {
        const int64_t planes = planes_of(b, b->verdicts->indices[k]);
        most = planes > most ? planes : most;
        total += planes;
    }
    const int64_t capacity = BATCH_BYTES / (shared->layout.plane * skg_raster_sum_bytes(shared));
    b->planes = total < capacity ? total : capacity;
    b->planes = b->planes > most ? b->planes : most;
    options.kernels = b->pass->kernels;
    options.kernels.listed = 1;
    options.strategy = b->leaky->strategy;
    options.tile = options.strategy == SKG_STRATEGY_TILES ? b->leaky->tile : 0;
    options.planes = b->planes;
    options.more_sums = 0;
    return skg_raster_cache_pin(rasters, &options, &b->pin);
}

/* Fills the tables of a batch. table: [parts + planes] as the kernels of leaky.cl take it. */
static void fill_batch(const batching *b, const skg_leaky_batch *batch, cl_int *table, cl_int *extents) {
    const skg_pass *pass = b->pass;
    cl_int *counts = table, *joined = table + batch->parts, plane = 0;
    for (int64_t p = 0; p < b->geometry->parts; p++) {
        b->parts[p] = pass->parts[p];
        b->parts[p].contributions = 0;
    }
    for (int64_t k = 0; k < batch->parts; k++) {
        const int64_t part = skg_leaky_part(batch, k);
        const int64_t contributions = planes_of(b, batch->indices[k]) - 1;
        b->parts[part].contributions = (int32_t)contributions + 1;
        b->parts[part].contribution = b->to_planes + plane;
        for (int64_t c = 0; c <= contributions; c++, plane++) {
            skg_extent_pixels(&pass->camera, &pass->extents[part], extents + 4 * plane);
            if (c == contributions) {
                b->to_planes[plane] = (skg_contribution){.plane = plane, .bias = 1};
                counts[k] = plane;
                continue;
            }
            const skg_contribution *shared = &pass->contributions[pass->first[part] + c];
            b->to_planes[plane] = (skg_contribution){.plane = plane, .weight = shared->weight};
            joined[plane] = (cl_int)shared->plane;
        }
    }
}

static skg_status add_sums(const skg_leaky_batch *batch) {
    const skg_raster_layout *layout = &batch->raster->layout;
    const skg_leaky_args args = skg_leaky_scalars(batch);
    skg_context *context = batch->raster->context;
    const int on_gpu = context->device->info.gpu;
    const int64_t lanes = skg_kernel_lanes(context, batch->raster->options.kernels.precision);
    /* On a CPU one work-item takes a whole row. */
    const skg_work_size work = {
        2, {on_gpu ? (layout->columns + lanes - 1) / lanes : 1, layout->rows}, {on_gpu ? 8 : 1, 8}};
    const skg_argument arguments[] = {
        SKG_LEAKY_ARGUMENTS(LEAKY_ADD, args, batch),
        SKG_ARGUMENT(LEAKY_ADD, shared, batch->shared->sums.memory),
    };
    cl_program program = NULL;
    SKG_TRY(skg_leaky_program(batch, &program));
    return SKG_LAUNCH_ONCE(context, program, "skg_leaky_add", "leaky meshes", &work, arguments,
                           &batch->staging->log);
}

/* Takes parts from `first` in the verdicts on, as long as the planes suffice. */
static int64_t choose_parts(const batching *b, int64_t first, skg_leaky_batch *batch) {
    int64_t planes = 0;
    *batch = (skg_leaky_batch){.pass = b->pass,
                               .leaky = b->leaky->parts,
                               .memory = b->memory,
                               .staging = b->staging,
                               .indices = b->verdicts->indices + first,
                               .raster = b->pin.raster,
                               .shared = b->pass->main.raster};
    while (first + batch->parts < b->verdicts->count) {
        const int64_t more = planes_of(b, batch->indices[batch->parts]);
        if (planes + more > b->planes) break;
        planes += more;
        batch->parts++;
    }
    return planes;
}

/* Rasters, judges, adds and repairs one batch, which begins with part `first` of the verdicts. */
static skg_status run_batch(const batching *b, int64_t first, skg_leaky_batch *batch) {
    skg_context *context = b->staging->context;
    skg_buffer *on_device = &b->memory->table;
    skg_stage_log *log = &b->staging->log;
    const int64_t planes = choose_parts(b, first, batch);
    const int64_t bytes = (batch->parts + planes) * (int64_t)sizeof(cl_int);
    cl_int *table = NULL, *extents = NULL;
    SKG_TRY(skg_staging_take(b->staging, batch->parts + planes, sizeof *table, "leaky parts", &table));
    SKG_TRY(skg_staging_take(b->staging, 4 * b->planes, sizeof *extents, "extents", &extents));
    fill_batch(b, batch, table, extents);
    SKG_TRY(skg_buffer_reserve(context, on_device, bytes, CL_MEM_READ_ONLY, "planes of leaky parts"));
    SKG_TRY(skg_stage_write(context, "upload", on_device->memory, 0, bytes, table, log));
    SKG_TRY(skg_geometry_weigh(context, b->geometry, &b->pass->camera, b->parts, b->pass->scale.scale));
    SKG_TRY(skg_raster_run(b->pin.raster, b->geometry, extents, log));
    SKG_TRY(skg_raster_bad_pixels(b->pin.raster, batch->parts, on_device->memory, first,
                                  b->memory->verdicts.memory, log));
    SKG_TRY(add_sums(batch));
    return skg_repair_run(batch, b->leaky->repair);
}

skg_status skg_leaky_run(const skg_leaky_parts *leaky, const skg_pass *pass, skg_geometry *geometry,
                         skg_raster_cache *rasters, skg_leaky_memory *memory, skg_leaky_verdicts *verdicts,
                         skg_staging *staging) {
    batching b = {.leaky = leaky,
                  .pass = pass,
                  .geometry = geometry,
                  .memory = memory,
                  .verdicts = verdicts,
                  .staging = staging};
    skg_leaky_batch batch;
    skg_status status = SKG_OK;
    list_parts(&b);
    if (verdicts->count == 0) return SKG_OK;
    SKG_TRY(get_raster(&b, rasters));
    SKG_TRY_CLEANUP(skg_alloc(geometry->parts, sizeof *b.parts, "leaky parts", &b.parts));
    SKG_TRY_CLEANUP(skg_alloc(b.planes, sizeof *b.to_planes, "leaky parts", &b.to_planes));
    for (int64_t first = 0; first < verdicts->count; first += batch.parts)
        SKG_TRY_CLEANUP(run_batch(&b, first, &batch));
    SKG_TRY_CLEANUP(skg_staging_read(
        staging, memory->verdicts.memory,
        verdicts->count * (1 + SKG_FIRST_BAD) * (int64_t)sizeof *verdicts->pixels, verdicts->pixels));
cleanup:
    skg_raster_pin_release(&b.pin);
    skg_free(&b.parts);
    skg_free(&b.to_planes);
    return status;
}
