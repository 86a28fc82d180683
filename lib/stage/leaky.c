/* Open parts: each is rastered into planes and a count of its own; where its signed hits cancel, its sums
 * join those of the closed parts, elsewhere repaired ones (repair.c). One count for several would let +1 and
 * -1 of two meshes cancel (contracts 3). */
#include "frame/frame.h"
#include "stage/raster_private.h"

#include <string.h>

/* Bytes of the planes of a batch, where one part does not need more. */
enum { BATCH_BYTES = 32 << 20 };

/* A frame's batches, one after another. */
typedef struct {
    skg_plan *plan;
    skg_job *job;
    const skg_frame_parts *frame;
    skg_raster *raster; /* of the batch that needs most planes, for all */
    int64_t planes;     /* that it has */
    const skg_raster *shared;
    skg_geometry_part *parts;  /* [parts] only the batch's are drawn */
    skg_contribution *weights; /* [planes] */
} batching;

static int64_t planes_of(const batching *b, int64_t open) {
    const int64_t part = b->plan->open[open];
    return b->frame->firsts[part + 1] - b->frame->firsts[part] + 1;
}

/* Who adds anything: lengths of one part know nothing of the others. */
static void list_parts(const batching *b) {
    b->job->bad_count = 0;
    for (int64_t k = 0; k < b->plan->open_count; k++)
        if (planes_of(b, k) > 1) b->job->bad_open[b->job->bad_count++] = k;
}

static skg_status get_raster(batching *b) {
    const skg_frame_args *layout = &b->shared->frame;
    skg_kernel_options kernels = b->frame->kernels;
    int64_t most = 0, total = 0;
    for (int64_t k = 0; k < b->job->bad_count; k++) {
        const int64_t its = planes_of(b, b->job->bad_open[k]);
        most = its > most ? its : most;
        total += its;
    }
    const int64_t room = BATCH_BYTES / (layout->plane * (int64_t)(kernels.bits / 8));
    b->planes = total < room ? total : room;
    b->planes = b->planes > most ? b->planes : most;
    kernels.listed_writes = 1;
    /* Bands write the few rows that a part meets; copies clear whole rectangles, and are added up twice. */
    const skg_plan *plan = b->plan;
    const int bands = plan->options.strategy == SKG_STRATEGY_AUTO && plan->strategy == SKG_STRATEGY_COPIES;
    return skg_plan_raster(b->plan, &kernels, bands ? SKG_STRATEGY_TILES : plan->strategy, b->planes, 0,
                           &b->raster);
}

/* Fills the tables of a batch. table: [parts + planes] as skg_open_add takes it. */
static void fill_batch(const batching *b, const skg_open_batch *batch, cl_int *table, cl_int *fields) {
    cl_int *counts = table, *joined = table + batch->parts, plane = 0;
    for (int64_t p = 0; p < b->plan->scene->count; p++) {
        b->parts[p] = b->frame->parts[p];
        b->parts[p].weights = 0;
    }
    for (int64_t k = 0; k < batch->parts; k++) {
        const int64_t part = b->plan->open[batch->open[k]];
        const int64_t writes = planes_of(b, batch->open[k]) - 1;
        b->parts[part].weights = (int32_t)writes + 1;
        b->parts[part].weight = b->weights + plane;
        for (int64_t w = 0; w <= writes; w++, plane++) {
            const skg_contribution *shared = &b->frame->all_writes[b->frame->firsts[part] + w];
            skg_extent_pixels(&b->frame->camera, &b->frame->extents[part], fields + 4 * plane);
            if (w == writes) {
                b->weights[plane] = (skg_contribution){.plane = plane, .bias = 1};
                counts[k] = plane;
            } else {
                b->weights[plane] = (skg_contribution){.plane = plane, .weight = shared->weight};
                joined[plane] = (cl_int)shared->plane;
            }
        }
    }
}

skg_status skg_open_kernel(skg_plan *plan, const skg_open_batch *batch, const char *name, cl_kernel *kernel) {
    static const char *const files[] = {"leaky.cl"};
    const skg_raster *raster = batch->raster;
    const skg_kernel_options options = {.precision = raster->options.kernels.precision,
                                        .bits = raster->options.kernels.bits};
    const cl_int parts = (cl_int)batch->parts;
    cl_program program = NULL;
    skg_status status = SKG_OK;
    *kernel = NULL;
    SKG_TRY(skg_kernels_get(plan->context, &options, 1, files, NULL, &program));
    SKG_TRY(skg_kernel_create(program, name, kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(*kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY_CLEANUP(
        skg_kernel_set_memory(*kernel, 1, 2, (cl_mem[]){raster->sums.memory, raster->used.memory}));
    SKG_TRY_CLEANUP(skg_kernel_set(*kernel, 3, sizeof parts, &parts));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(*kernel, 4, 1, &plan->open_table.memory));
    return SKG_OK;
cleanup:
    clReleaseKernel(*kernel);
    *kernel = NULL;
    return status;
}

static skg_status add_sums(skg_plan *plan, skg_job *job, const skg_open_batch *batch) {
    const skg_frame_args *layout = &batch->raster->frame;
    const int on_gpu = plan->context->device->info.is_gpu;
    const int64_t lanes = skg_kernel_lanes(plan->context, batch->raster->options.kernels.precision);
    /* A CPU takes each row in one go. */
    const size_t across = on_gpu ? (size_t)((layout->columns + 8 * lanes - 1) / (8 * lanes)) * 8 : 1;
    const size_t local[2] = {on_gpu ? 8 : 1, 8};
    const size_t global[2] = {across, (size_t)((layout->rows + 7) / 8 * 8)};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_open_kernel(plan, batch, "skg_open_add", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 5, 1, &batch->shared->sums.memory));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "open meshes", 2, global, local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

/* From `first` in job->bad_open on: as many parts as the planes suffice for. Returns them in batch->parts. */
static skg_status run_batch(const batching *b, int64_t first, skg_open_batch *batch) {
    skg_plan *plan = b->plan;
    skg_job *job = b->job;
    cl_int *table = NULL, *fields = NULL;
    int64_t planes = 0;
    *batch = (skg_open_batch){.open = job->bad_open + first, .raster = b->raster, .shared = b->shared};
    while (first + batch->parts < job->bad_count) {
        const int64_t its = planes_of(b, batch->open[batch->parts]);
        if (planes + its > b->planes) break;
        planes += its;
        batch->parts++;
    }
    SKG_TRY(skg_job_stage(job, batch->parts + planes, sizeof *table, "open parts", &table));
    SKG_TRY(skg_job_stage(job, 4 * b->planes, sizeof *fields, "fields", &fields));
    fill_batch(b, batch, table, fields);
    const int64_t bytes = (batch->parts + planes) * (int64_t)sizeof *table;
    SKG_TRY(skg_buffer_reserve(plan->context, &plan->open_table, bytes, CL_MEM_READ_ONLY,
                               "planes of open parts"));
    SKG_TRY(skg_stage_write(plan->context, "upload", plan->open_table.memory, 0, bytes, table, &job->log));
    SKG_TRY(skg_geometry_weigh(plan->context, &plan->geometry, &b->frame->camera, b->parts,
                               b->frame->scale.scale));
    SKG_TRY(skg_raster_run(b->raster, &plan->geometry, fields, &job->log));
    SKG_TRY(skg_raster_bad_pixels(b->raster, batch->parts, plan->open_table.memory, first, plan->bad.memory,
                                  &job->log));
    SKG_TRY(add_sums(plan, job, batch));
    return skg_open_repair(plan, job, b->frame, batch);
}

skg_status skg_open_parts_add(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                              skg_raster *shared) {
    batching b = {.plan = plan, .job = job, .frame = frame, .shared = shared};
    skg_open_batch batch;
    skg_status status = SKG_OK;
    list_parts(&b);
    if (job->bad_count == 0) return SKG_OK;
    SKG_TRY(get_raster(&b));
    SKG_TRY_CLEANUP(skg_alloc(plan->scene->count, sizeof *b.parts, "open parts", &b.parts));
    SKG_TRY_CLEANUP(skg_alloc(b.planes, sizeof *b.weights, "open parts", &b.weights));
    for (int64_t first = 0; first < job->bad_count; first += batch.parts)
        SKG_TRY_CLEANUP(run_batch(&b, first, &batch));
    SKG_TRY_CLEANUP(skg_job_read(job, plan->bad.memory,
                                 job->bad_count * (1 + SKG_FIRST_BAD) * (int64_t)sizeof *job->bad, job->bad));
cleanup:
    skg_free(&b.parts);
    skg_free(&b.weights);
    return status;
}
