/* Open parts: each is rastered into planes and a count of its own; where its signed hits cancel, its sums
 * join those of the closed parts, elsewhere repaired ones (repair.c). One count for several would let +1 and
 * -1 of two meshes cancel (contracts 3). */
#include "plan/frame.h"
#include "plan/raster_private.h"

/* So many at a time. */
enum { BATCH = 8 };

/* A batch in the making: which of its planes go where. */
typedef struct {
    skg_geometry_part *parts;  /* [parts] only the batch's are drawn */
    skg_plane_weight *weights; /* [planes of the batch] */
    cl_int *moves;             /* staged: [count][3] as skg_open_add takes them */
    int64_t planes, count;
} open_batch;

/* The planes of one part: one for each that it adds to, then its count. */
static void add_part(const skg_frame_parts *frame, int64_t part, open_batch *batch) {
    const int64_t writes = frame->firsts[part + 1] - frame->firsts[part],
                  count_plane = batch->planes + writes;
    skg_plane_weight *weights = batch->weights + batch->planes;
    for (int64_t w = 0; w < writes; w++) {
        const skg_plane_weight *shared = &frame->all_writes[frame->firsts[part] + w];
        weights[w] = (skg_plane_weight){.plane = batch->planes + w, .weight = shared->weight};
        cl_int *move = batch->moves + 3 * batch->count++;
        move[0] = (cl_int)(batch->planes + w);
        move[1] = (cl_int)count_plane;
        move[2] = (cl_int)shared->plane;
    }
    weights[writes] = (skg_plane_weight){.plane = count_plane, .bias = 1};
    batch->parts[part].weights = (int32_t)writes + 1;
    batch->parts[part].weight = weights;
    batch->planes = count_plane + 1;
}

static skg_status run_add(skg_plan *plan, skg_job *job, const skg_raster *raster, const skg_raster *shared,
                          const open_batch *batch, cl_mem moves) {
    static const char *const files[] = {"open.cl"};
    cl_program program = NULL;
    cl_kernel kernel = NULL;
    const cl_int count = (cl_int)batch->count;
    const skg_kernel_options options = {.precision = raster->options.kernels.precision,
                                        .bits = raster->options.kernels.bits};
    SKG_TRY(skg_kernels_get(plan->context, &options, 1, files, NULL, &program));
    SKG_TRY(skg_kernel_create(program, "skg_open_add", &kernel));
    skg_status status = SKG_OK;
    const int64_t lanes = skg_kernel_lanes(plan->context, options.precision);
    const size_t local[2] = {8, 16}; /* large groups: PoCL takes some 20 ns for each */
    const size_t global[2] = {(size_t)((raster->frame.columns + 8 * lanes - 1) / (8 * lanes) * 8),
                              (size_t)((raster->frame.rows + 15) / 16 * 16)};
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY_CLEANUP(
        skg_kernel_set_memory(kernel, 1, 2, (cl_mem[]){raster->sums.memory, raster->used.memory}));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 3, sizeof count, &count));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 4, 2, (cl_mem[]){moves, shared->sums.memory}));
    SKG_TRY_CLEANUP(skg_kernel_run(plan->context, kernel, "open meshes", 2, global, local, &job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

/* Rasters a batch and adds it; its verdicts go to job->bad from `first` on. */
static skg_status run_batch(skg_plan *plan, skg_job *job, const skg_frame_parts *frame, skg_raster *shared,
                            int64_t first, int64_t open, const open_batch *batch) {
    skg_kernel_options kernels = frame->kernels;
    skg_raster *raster = NULL;
    skg_buffer moves = {0};
    skg_status status = SKG_OK;
    int64_t plane = 0, move = 0;
    kernels.listed_writes = 1;
    SKG_TRY(skg_plan_raster(plan, &kernels, plan->strategy, batch->planes, 0, &raster));
    SKG_TRY(skg_geometry_project(plan->context, &plan->geometry, &kernels, &frame->camera, batch->parts,
                                 frame->scale.scale, &job->log));
    SKG_TRY(skg_raster_run(raster, &plan->geometry, NULL, &job->log));
    const int64_t bytes = 3 * batch->count * (int64_t)sizeof *batch->moves;
    SKG_TRY_CLEANUP(
        skg_buffer_reserve(plan->context, &moves, bytes, CL_MEM_READ_ONLY, "planes of open parts"));
    SKG_TRY_CLEANUP(
        skg_stage_write(plan->context, "open meshes", moves.memory, 0, bytes, batch->moves, &job->log));
    SKG_TRY_CLEANUP(run_add(plan, job, raster, shared, batch, moves.memory));
    for (int64_t k = first; k < first + open; k++) {
        const int64_t part = plan->open[k];
        const int64_t writes = frame->firsts[part + 1] - frame->firsts[part];
        const skg_open_part own = {.open = k,
                                   .raster = raster,
                                   .shared = shared,
                                   .moves = moves.memory,
                                   .first_move = move,
                                   .move_count = writes,
                                   .count_plane = plane + writes,
                                   .bad = plan->bad.memory};
        plane += writes + 1;
        move += writes;
        SKG_TRY_CLEANUP(skg_raster_bad_pixels(raster, own.count_plane, own.bad, &job->log));
        SKG_TRY_CLEANUP(skg_job_read(job, plan->bad.memory, (1 + SKG_FIRST_BAD) * (int64_t)sizeof *job->bad,
                                     job->bad + k * (1 + SKG_FIRST_BAD)));
        if (writes > 0) SKG_TRY_CLEANUP(skg_open_part_repair(plan, job, frame, &own));
    }
cleanup:
    skg_buffer_release(&moves); /* OpenCL keeps it until what is enqueued is done */
    return status;
}

skg_status skg_open_parts_add(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                              skg_raster *shared) {
    const int64_t parts = plan->scene->count;
    skg_status status = SKG_OK;
    for (int64_t first = 0; first < plan->open_count && status == SKG_OK; first += BATCH) {
        const int64_t left = plan->open_count - first, open = left < BATCH ? left : BATCH;
        open_batch batch = {0};
        int64_t writes = 0;
        for (int64_t k = first; k < first + open; k++)
            writes += frame->firsts[plan->open[k] + 1] - frame->firsts[plan->open[k]];
        if (writes == 0) continue; /* not of interest: lengths of another part */
        SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *batch.parts, "open parts", &batch.parts));
        SKG_TRY_CLEANUP(skg_alloc(writes + open, sizeof *batch.weights, "open parts", &batch.weights));
        SKG_TRY_CLEANUP(skg_job_stage(job, 3 * writes, sizeof *batch.moves, "open parts", &batch.moves));
        for (int64_t p = 0; p < parts; p++) {
            batch.parts[p] = frame->parts[p];
            batch.parts[p].weights = 0;
        }
        for (int64_t k = first; k < first + open; k++) add_part(frame, plan->open[k], &batch);
        status = run_batch(plan, job, frame, shared, first, open, &batch);
    cleanup:
        skg_free(&batch.parts);
        skg_free(&batch.weights);
    }
    return status;
}
