/* Stage `hits`: what priorities and clipping take off the sums of closed parts. */
#include "stage/hits.h"

#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <string.h>

enum { GROUP = 64, ROWS_AT_ONCE = 32 };

static void release_count(skg_hits_memory *memory) {
    if (memory->counted) clReleaseEvent(memory->counted);
    memory->counted = NULL;
}

void skg_hits_memory_release(skg_hits_memory *memory) {
    release_count(memory);
    skg_free(&memory->sent);
    skg_buffer *const buffers[] = {&memory->slots,  &memory->runs,  &memory->table,
                                   &memory->shifts, &memory->spans, &memory->counts,
                                   &memory->starts, &memory->total, &memory->hits};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
}

int64_t skg_hits_memory_bytes(const skg_hits_memory *memory) {
    return memory->slots.bytes + memory->runs.bytes + memory->table.bytes + memory->shifts.bytes +
           memory->spans.bytes + memory->counts.bytes + memory->starts.bytes + memory->total.bytes +
           memory->hits.bytes;
}

skg_status skg_hits_bytes(const skg_hit_count *count, int32_t is_double, int64_t *bytes) {
    const int64_t hits = (int64_t)count->high << 32 | (int64_t)count->low;
    const int64_t hit = is_double ? 16 : 8; /* a depth and an int, as skg_listed */
    if (hits > (int64_t)SKG_HITS_MAX)
        return skg_fail(
            SKG_ERR_DEVICE_MEMORY,
            "priorities: the rays of this frame hit the surfaces of the parts that compete %" PRId64
            " times, and at most %" PRId64
            " hits are listed; take fewer pixels, coarser meshes or fewer parts with priorities",
            hits, (int64_t)SKG_HITS_MAX);
    *bytes = (hits > 0 ? hits : 1) * hit;
    return SKG_OK;
}

/* The stage for one pass. */
typedef struct {
    const skg_pass *pass;
    const skg_geometry *geometry;
    const skg_raster *raster;
    skg_hits_memory *memory;
    skg_staging *staging;
    skg_context *context;
    cl_program program;
    int32_t is_double;
    int32_t reserved;
} hits_run;

static skg_status compile(const hits_run *run, cl_program *program) {
    static const char *const files[] = {"pixel.clh", "intervals.clh", "hits.cl", "source_plane.cl"};
    const skg_define slots[] = {{"SKG_SLOTS", skg_priority_slots(&run->pass->priority)}};
    return skg_kernels_get(run->context, &run->raster->options.kernels, 4, files, SKG_DEFINES(slots),
                           program);
}

static skg_status reserve(const hits_run *run, skg_buffer *buffer, int64_t bytes, const char *what) {
    return skg_buffer_reserve(run->context, buffer, bytes, CL_MEM_READ_WRITE, what);
}

static skg_status upload(const hits_run *run, skg_buffer *buffer, int64_t bytes, const void *staged) {
    SKG_TRY(reserve(run, buffer, bytes, "priorities"));
    return skg_stage_write(run->context, "priority", buffer->memory, 0, bytes, staged, &run->staging->log);
}

static double reference_of(const skg_pass *pass, int64_t slot) {
    skg_part_double seen;
    const skg_camera_place place = skg_geometry_place(&pass->parts[pass->priority.parts[slot]], 0);
    skg_camera_part(&pass->camera, &place, &seen);
    return seen.reference;
}

/* Depths are listed relative to the first competitor's reference, so that they keep their digits. */
double skg_hits_common(const skg_pass *pass) {
    return reference_of(pass, 0);
}

static skg_status upload_shifts(const hits_run *run) {
    const skg_priority *priority = &run->pass->priority;
    const int64_t size = run->is_double ? (int64_t)sizeof(double) : (int64_t)sizeof(float);
    const double common = skg_hits_common(run->pass);
    void *shifts = NULL;
    SKG_TRY(skg_staging_take(run->staging, priority->count, (size_t)size, "priorities", &shifts));
    for (int64_t s = 0; s < priority->count; s++) {
        const double shift = reference_of(run->pass, s) - common;
        if (run->is_double)
            ((double *)shifts)[s] = shift;
        else
            ((float *)shifts)[s] = (float)shift;
    }
    return upload(run, &run->memory->shifts, priority->count * size, shifts);
}

/* Whether the device has these tables, of which the host keeps a copy; if not, the copy is made. */
static skg_status note_tables(skg_hits_memory *memory, int64_t count, const int32_t *tables, int *known) {
    const size_t bytes = (size_t)count * sizeof *tables;
    *known = memory->sent && memory->sent_count == count && memcmp(memory->sent, tables, bytes) == 0;
    if (*known) return SKG_OK;
    memory->sent_count = 0; /* until the device has the new ones */
    SKG_TRY(skg_realloc(count, sizeof *memory->sent, "priorities", &memory->sent));
    memcpy(memory->sent, tables, bytes);
    return SKG_OK;
}

static skg_status upload_tables(const hits_run *run) {
    const skg_pass *pass = run->pass;
    skg_hits_memory *m = run->memory;
    const int64_t of_slots = pass->scene->count, of_runs = 3 * pass->priority.count;
    const int64_t of_table = pass->priority.count * skg_priority_entry(&pass->priority);
    const int64_t count = of_slots + of_runs + of_table, size = sizeof(int32_t);
    int32_t *slots = NULL;
    int known = 0;
    SKG_TRY(skg_staging_take(run->staging, count, sizeof *slots, "priorities", &slots));
    int32_t *const runs = slots + of_slots, *const table = runs + of_runs;
    skg_priority_tables(pass->scene, pass->rules, &pass->priority, slots, table);
    skg_priority_runs(pass->scene, pass->rules, &pass->priority, runs, m->triangles);
    SKG_TRY(note_tables(m, count, slots, &known));
    if (!known) {
        SKG_TRY(upload(run, &m->runs, of_runs * size, runs));
        SKG_TRY(upload(run, &m->slots, of_slots * size, slots));
        SKG_TRY(upload(run, &m->table, of_table * size, table));
        m->sent_count = count;
    }
    return upload_shifts(run);
}

/* Columns from, rows from, columns to, rows to, as skg_window takes them. */
static cl_int4 window_of(const hits_run *run) {
    const int32_t *pixels = run->pass->priority.window;
    return (cl_int4){.s = {pixels[2], pixels[0], pixels[3], pixels[1]}};
}

/* The scalar arguments of all kernels. task: SKG_HITS_... */
static skg_hits_args scalars_of(const hits_run *run, SKG_INT task) {
    const cl_int4 window = window_of(run);
    return (skg_hits_args){.layout = run->raster->layout,
                           .window = {window.s[0], window.s[1], window.s[2], window.s[3]},
                           .task = task,
                           .winners = (SKG_INT)(run->pass->priority.count - run->pass->priority.background)};
}

/* The arguments by which both kernels take the lists. */
#define LIST_ARGUMENTS(kernel, lists)                                                                        \
    SKG_ARGUMENT(kernel, slots, (lists)->slots.memory),                                                      \
        SKG_ARGUMENT(kernel, shifts, (lists)->shifts.memory),                                                \
        SKG_ARGUMENT(kernel, counts, (lists)->counts.memory),                                                \
        SKG_ARGUMENT(kernel, starts, (lists)->starts.memory),                                                \
        SKG_ARGUMENT(kernel, hits, (lists)->hits.memory)

/* Lists the hits of triangles in front of the source. */
static skg_status list_hits(const hits_run *run, SKG_INT task) {
    const int64_t *triangles = run->memory->triangles;
    const int64_t count = task == SKG_HITS_COUNT              ? triangles[0]
                          : task == SKG_HITS_COUNT_BACKGROUND ? triangles[1]
                                                              : triangles[0] + triangles[1];
    const skg_work_size gpu = {2, {count, ROWS_AT_ONCE}, {GROUP, 1}},
                        cpu = {1, {(count + SKG_HITS_TRIANGLES - 1) / SKG_HITS_TRIANGLES}, {1}};
    const skg_work_size *work = run->context->device->info.gpu ? &gpu : &cpu;
    skg_hits_args args = scalars_of(run, task);
    args.chosen[0] = task == SKG_HITS_COUNT_BACKGROUND ? args.winners : 0;
    args.chosen[1] = task == SKG_HITS_COUNT ? args.winners : (SKG_INT)run->pass->priority.count;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_LIST, args, args),
        SKG_ARGUMENT(HITS_LIST, corners, run->geometry->corners.memory),
        SKG_ARGUMENT(HITS_LIST, projected, run->geometry->projected.memory),
        SKG_ARGUMENT(HITS_LIST, parts, run->geometry->part_table.memory),
        SKG_ARGUMENT(HITS_LIST, runs, run->memory->runs.memory),
        SKG_ARGUMENT(HITS_LIST, spans, run->memory->spans.memory),
        LIST_ARGUMENTS(HITS_LIST, run->memory),
    };
    if (count == 0) return SKG_OK;
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_list", "priority", work, arguments,
                           &run->staging->log);
}

/* Lists the hits of triangles that reach the source's plane. */
static skg_status list_hits_at_source(const hits_run *run, SKG_INT task) {
    const skg_hits_args args = scalars_of(run, task);
    const skg_work_size work = {
        2, {run->raster->layout.triangles, (int64_t)skg_raster_source_bands(run->raster)}, {GROUP, 1}};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_SOURCE_PLANE, args, args),
        SKG_TRIANGLE_BUFFERS(HITS_SOURCE_PLANE, run->geometry),
        SKG_ARGUMENT(HITS_SOURCE_PLANE, vertices, run->geometry->offsets.memory),
        LIST_ARGUMENTS(HITS_SOURCE_PLANE, run->memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_source_plane", "priority", &work, arguments,
                           &run->staging->log);
}

static skg_status list_all(const hits_run *run, SKG_INT task) {
    const skg_kernel_options *kernels = &run->raster->options.kernels;
    SKG_TRY(list_hits(run, task));
    return kernels->source_plane && !kernels->parallel ? list_hits_at_source(run, task) : SKG_OK;
}

/* The pixels of the window, in groups of a GPU's work-items; on a CPU each work-item takes SKG_CPU_RUN pixels of a row. */
static skg_work_size work_of(const hits_run *run, int64_t across, int64_t down) {
    const cl_int4 window = window_of(run);
    const int64_t columns = window.s[2] - window.s[0], rows = window.s[3] - window.s[1];
    if (run->context->device->info.gpu) return (skg_work_size){2, {columns, rows}, {across, down}};
    return (skg_work_size){2, {(columns + SKG_CPU_RUN - 1) / SKG_CPU_RUN, rows}, {1, 1}};
}

/* Gives each pixel its stretch of the list, and counts all hits. */
static skg_status place_hits(const hits_run *run) {
    const skg_hits_args args = scalars_of(run, SKG_HITS_LIST);
    const skg_work_size work = work_of(run, GROUP, 1);
    const skg_hits_memory *m = run->memory;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_PLACE, args, args),
        SKG_ARGUMENT(HITS_PLACE, counts, m->counts.memory),
        SKG_ARGUMENT(HITS_PLACE, starts, m->starts.memory),
        SKG_ARGUMENT(HITS_PLACE, total, m->total.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_place", "priority", &work, arguments,
                           &run->staging->log);
}

/* Enqueues the read of the count of hits. */
static skg_status read_count(const hits_run *run) {
    skg_hits_memory *m = run->memory;
    SKG_CL_TRY(clEnqueueReadBuffer(run->context->device->queue, m->total.memory, CL_FALSE, 0, sizeof m->count,
                                   &m->count, 0, NULL, &m->counted));
    return skg_queue_flush(run->context);
}

/* Waits for the count of hits and reserves their list. */
static skg_status reserve_hits(const hits_run *run) {
    int64_t bytes = 0;
    SKG_CL_TRY(skg_event_wait(run->memory->counted));
    release_count(run->memory);
    SKG_TRY(skg_hits_bytes(&run->memory->count, run->is_double, &bytes));
    return reserve(run, &run->memory->hits, bytes, "hits of parts with priorities");
}

static skg_status settle(const hits_run *run) {
    const skg_hits_args args = scalars_of(run, SKG_HITS_LIST);
    const skg_work_size work = work_of(run, 16, 16);
    const skg_hits_memory *m = run->memory;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_SETTLE, args, args),
        SKG_ARGUMENT(HITS_SETTLE, parts, run->geometry->part_table.memory),
        SKG_ARGUMENT(HITS_SETTLE, contributions, run->geometry->contribution_table.memory),
        SKG_ARGUMENT(HITS_SETTLE, counts, m->counts.memory),
        SKG_ARGUMENT(HITS_SETTLE, starts, m->starts.memory),
        SKG_ARGUMENT(HITS_SETTLE, hits, m->hits.memory),
        SKG_ARGUMENT(HITS_SETTLE, table, m->table.memory),
        SKG_ARGUMENT(HITS_SETTLE, used, run->raster->used.memory),
        SKG_ARGUMENT(HITS_SETTLE, sums, run->raster->sums.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_settle", "priority", &work, arguments,
                           &run->staging->log);
}

/* Reserves and clears what the window's rows need. No other row is read. */
static skg_status clear(const hits_run *run) {
    const skg_raster_layout *layout = &run->raster->layout;
    const skg_hits_args args = scalars_of(run, SKG_HITS_COUNT);
    const skg_work_size work = {
        1, {args.window[3] - args.window[1]}, {run->context->device->info.gpu ? GROUP : 1}};
    skg_hits_memory *m = run->memory;
    const int64_t pixels = (int64_t)layout->rows * layout->columns * (int64_t)sizeof(cl_int);
    SKG_TRY(reserve(run, &m->spans, (int64_t)layout->rows * (int64_t)sizeof(cl_int2), "hits of the rows"));
    SKG_TRY(reserve(run, &m->counts, pixels, "hits of the pixels"));
    SKG_TRY(reserve(run, &m->starts, pixels, "hits of the pixels"));
    SKG_TRY(reserve(run, &m->total, sizeof(skg_hit_count), "hits of the pixels"));
    SKG_TRY(reserve(run, &m->hits, 16, "hits of parts with priorities"));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_CLEAR, args, args),
        SKG_ARGUMENT(HITS_CLEAR, spans, m->spans.memory),
        SKG_ARGUMENT(HITS_CLEAR, counts, m->counts.memory),
        SKG_ARGUMENT(HITS_CLEAR, starts, m->starts.memory),
        SKG_ARGUMENT(HITS_CLEAR, total, m->total.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_clear", "priority", &work, arguments,
                           &run->staging->log);
}

skg_status skg_hits_prefetch(skg_context *context, const skg_pass *pass) {
    const skg_raster raster = {.context = context, .options.kernels = pass->kernels};
    const hits_run run = {.pass = pass, .raster = &raster, .context = context};
    return compile(&run, NULL);
}

static skg_status prepare(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                          skg_staging *staging, hits_run *run) {
    const skg_raster *raster = pass->main.raster;
    *run = (hits_run){.pass = pass,
                      .geometry = geometry,
                      .raster = raster,
                      .memory = memory,
                      .staging = staging,
                      .context = raster->context,
                      .is_double = geometry->precision == SKG_PRECISION_DOUBLE};
    return compile(run, &run->program);
}

skg_status skg_hits_count(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                          skg_staging *staging) {
    const int32_t *window = pass->priority.window;
    hits_run run;
    release_count(memory); /* of a pass that failed */
    if (window[0] >= window[1] || window[2] >= window[3]) return SKG_OK;
    SKG_TRY(prepare(pass, geometry, memory, staging, &run));
    SKG_TRY(skg_raster_set_scene(pass->main.raster, geometry));
    SKG_TRY(upload_tables(&run));
    SKG_TRY(clear(&run));
    SKG_TRY(list_all(&run, SKG_HITS_COUNT));
    if (pass->priority.background > 0) SKG_TRY(list_all(&run, SKG_HITS_COUNT_BACKGROUND));
    SKG_TRY(place_hits(&run));
    return read_count(&run);
}

skg_status skg_hits_settle(const skg_pass *pass, const skg_geometry *geometry, skg_hits_memory *memory,
                           skg_staging *staging) {
    hits_run run;
    if (!memory->counted) return SKG_OK;
    SKG_TRY(prepare(pass, geometry, memory, staging, &run));
    SKG_TRY(reserve_hits(&run));
    SKG_TRY(list_all(&run, SKG_HITS_LIST));
    return settle(&run);
}
