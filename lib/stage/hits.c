/* Priority resolution on the device: hits listed, sorted, swept (hits.cl). */
#include "frame/frame.h"
#include "stage/raster_private.h"

#include <inttypes.h>
#include <stdio.h>

enum { GROUP = 64, ROWS_AT_ONCE = 32 };

void skg_priority_memory_release(skg_priority_memory *memory) {
    skg_buffer *const buffers[] = {&memory->slots,  &memory->table, &memory->shifts, &memory->counts,
                                   &memory->starts, &memory->total, &memory->hits};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
}

int64_t skg_priority_memory_bytes(const skg_priority_memory *memory) {
    return memory->slots.bytes + memory->table.bytes + memory->shifts.bytes + memory->counts.bytes +
           memory->starts.bytes + memory->total.bytes + memory->hits.bytes;
}

/* The priority resolution of one frame. */
typedef struct {
    skg_plan *plan;
    skg_job *job;
    const skg_frame_parts *frame;
    const skg_raster *raster;
    cl_program program;
    skg_priority_memory *memory;
} priority_run;

static skg_status compile(priority_run *run) {
    static const char *const files[] = {"pixel.clh", "hits.cl", "source_plane.cl"};
    char slots[32];
    snprintf(slots, sizeof slots, "-D SKG_SLOTS=%" PRId64, skg_priority_slots(&run->frame->priority));
    return skg_kernels_get(run->plan->context, &run->raster->options.kernels, 3, files, slots, &run->program);
}

static skg_status reserve(priority_run *run, skg_buffer *buffer, int64_t bytes, const char *what) {
    return skg_buffer_reserve(run->plan->context, buffer, bytes, CL_MEM_READ_WRITE, what);
}

static skg_status upload(priority_run *run, skg_buffer *buffer, int64_t bytes, const void *staged) {
    SKG_TRY(reserve(run, buffer, bytes, "priorities"));
    return skg_stage_write(run->plan->context, "priority", buffer->memory, 0, bytes, staged, &run->job->log);
}

/* Depths are listed relative to the first competitor's reference, so that they keep their digits. */
static skg_status upload_shifts(priority_run *run) {
    const skg_priority *priority = &run->frame->priority;
    const int is_double = run->plan->options.precision == SKG_PRECISION_DOUBLE;
    const int64_t size = is_double ? (int64_t)sizeof(double) : (int64_t)sizeof(float);
    double common = 0;
    void *shifts = NULL;
    SKG_TRY(skg_job_stage(run->job, priority->count, (size_t)size, "priorities", &shifts));
    for (int64_t s = 0; s < priority->count; s++) {
        const skg_geometry_part *part = &run->frame->parts[priority->parts[s]];
        skg_part_double seen;
        skg_camera_part(&run->frame->camera, part->pose, part->origin, part->reference, part->flipped, &seen);
        if (s == 0) common = seen.reference;
        if (is_double)
            ((double *)shifts)[s] = seen.reference - common;
        else
            ((float *)shifts)[s] = (float)(seen.reference - common);
    }
    return upload(run, &run->memory->shifts, priority->count * size, shifts);
}

static skg_status upload_tables(priority_run *run) {
    const skg_scene *scene = run->plan->scene;
    const skg_priority *priority = &run->frame->priority;
    const int64_t entries = priority->count * skg_priority_entry(priority);
    int32_t *slots = NULL, *table = NULL;
    SKG_TRY(skg_job_stage(run->job, scene->count, sizeof *slots, "priorities", &slots));
    SKG_TRY(skg_job_stage(run->job, entries, sizeof *table, "priorities", &table));
    skg_priority_tables(scene, run->plan->options.clip, priority, slots, table);
    SKG_TRY(upload(run, &run->memory->slots, scene->count * (int64_t)sizeof *slots, slots));
    SKG_TRY(upload(run, &run->memory->table, entries * (int64_t)sizeof *table, table));
    return upload_shifts(run);
}

/* Lists the hits of triangles in front of the source with one kernel, those at its plane with the other. */
static skg_status list_hits(priority_run *run, const char *name, int32_t fill) {
    const skg_geometry *g = &run->plan->geometry;
    const skg_frame_args *frame = &run->raster->frame;
    const skg_priority_memory *m = run->memory;
    const int at_source = name[4] == 's'; /* skg_source_plane: other arguments before the lists */
    const cl_mem memory[] = {g->corners.memory, g->projected.memory, g->part_table.memory,
                             g->triangle_blocks.memory, g->offsets.memory};
    const cl_mem lists[] = {m->slots.memory, m->shifts.memory, m->counts.memory, m->starts.memory,
                            m->hits.memory};
    const cl_uint first = at_source ? 6 : 5;
    const size_t rows = at_source ? (size_t)((frame->rows + SKG_SOURCE_ROWS - 1) / SKG_SOURCE_ROWS)
                        : run->plan->context->device->info.is_gpu ? ROWS_AT_ONCE
                                                                  : 1;
    const size_t local[2] = {GROUP, 1},
                 global[2] = {((size_t)frame->triangles + GROUP - 1) / GROUP * GROUP, rows};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_kernel_create(run->program, name, &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof *frame, frame));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 1, (int32_t)first - 1, memory));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, first, 5, lists));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, first + 5, sizeof fill, &fill));
    SKG_TRY_CLEANUP(skg_kernel_run(run->plan->context, kernel, "priority", 2, global, local, &run->job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

static skg_status list_all(priority_run *run, int32_t fill) {
    const skg_kernel_options *kernels = &run->raster->options.kernels;
    SKG_TRY(list_hits(run, "skg_hits_list", fill));
    if (!kernels->source_plane || kernels->parallel) return SKG_OK;
    return list_hits(run, "skg_source_plane", fill);
}

/* Room for every pixel's hits. The host waits for their number here. */
static skg_status place_hits(priority_run *run) {
    const cl_int pixels = run->raster->frame.rows * run->raster->frame.columns, none = 0;
    const size_t local = GROUP, global = ((size_t)pixels + GROUP - 1) / GROUP * GROUP;
    skg_priority_memory *m = run->memory;
    cl_command_queue queue = run->plan->context->device->queue;
    cl_kernel kernel = NULL;
    cl_int total = 0;
    skg_status status = SKG_OK;
    SKG_CL_TRY(
        clEnqueueFillBuffer(queue, m->total.memory, &none, sizeof none, 0, sizeof none, 0, NULL, NULL));
    SKG_TRY(skg_kernel_create(run->program, "skg_hits_place", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof pixels, &pixels));
    SKG_TRY_CLEANUP(
        skg_kernel_set_memory(kernel, 1, 3, (cl_mem[]){m->counts.memory, m->starts.memory, m->total.memory}));
    SKG_TRY_CLEANUP(
        skg_kernel_run(run->plan->context, kernel, "priority", 1, &global, &local, &run->job->log));
    const cl_int code =
        clEnqueueReadBuffer(queue, m->total.memory, CL_TRUE, 0, sizeof total, &total, 0, NULL, NULL);
    if (code != CL_SUCCESS) status = skg_cl_fail(code, "clEnqueueReadBuffer", __FILE__, __LINE__);
    /* A depth and an int, as skg_listed. */
    const int64_t hit = run->plan->options.precision == SKG_PRECISION_DOUBLE ? 16 : 8;
    if (status == SKG_OK)
        status = reserve(run, &m->hits, (total > 0 ? total : 1) * hit, "hits of parts that compete");
cleanup:
    clReleaseKernel(kernel);
    return status;
}

static skg_status settle(priority_run *run) {
    const skg_geometry *g = &run->plan->geometry;
    const skg_frame_args *frame = &run->raster->frame;
    const skg_priority_memory *m = run->memory;
    const cl_mem memory[] = {g->part_table.memory,    g->write_table.memory, m->counts.memory,
                             m->starts.memory,        m->hits.memory,        m->table.memory,
                             run->raster->sums.memory};
    const size_t local[2] = {16, 16};
    const size_t global[2] = {((size_t)frame->columns + 15) / 16 * 16, ((size_t)frame->rows + 15) / 16 * 16};
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_kernel_create(run->program, "skg_hits_settle", &kernel));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 0, sizeof *frame, frame));
    SKG_TRY_CLEANUP(skg_kernel_set_memory(kernel, 1, 7, memory));
    SKG_TRY_CLEANUP(skg_kernel_run(run->plan->context, kernel, "priority", 2, global, local, &run->job->log));
cleanup:
    clReleaseKernel(kernel);
    return status;
}

skg_status skg_priority_run(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                            const skg_raster *raster) {
    priority_run run = {plan, job, frame, raster, NULL, &plan->priority_memory};
    const int64_t pixels = (int64_t)raster->frame.rows * raster->frame.columns * (int64_t)sizeof(cl_int);
    const cl_int none = 0;
    SKG_TRY(compile(&run));
    SKG_TRY(upload_tables(&run));
    SKG_TRY(reserve(&run, &run.memory->counts, pixels, "hits of the pixels"));
    SKG_TRY(reserve(&run, &run.memory->starts, pixels, "hits of the pixels"));
    SKG_TRY(reserve(&run, &run.memory->total, sizeof(cl_int), "hits of the pixels"));
    SKG_TRY(reserve(&run, &run.memory->hits, 16, "hits of parts that compete"));
    SKG_CL_TRY(clEnqueueFillBuffer(plan->context->device->queue, run.memory->counts.memory, &none,
                                   sizeof none, 0, (size_t)pixels, 0, NULL, NULL));
    SKG_TRY(list_all(&run, 0));
    SKG_TRY(place_hits(&run));
    SKG_TRY(list_all(&run, 1));
    return settle(&run);
}
