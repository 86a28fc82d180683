#include "stage/gradient.h"

#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <math.h>
#include <string.h>

enum { GROUP = 64, SLICES = 32, CLAIM = 1024 }; /* CLAIM: triangles of a work-item of a processor */

void skg_gradient_memory_release(skg_gradient_memory *memory) {
    skg_buffer *const buffers[] = {&memory->adjoint, &memory->weights, &memory->most,
                                   &memory->scales,  &memory->moments, &memory->slopes,
                                   &memory->lengths, &memory->faces,   &memory->node};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
    skg_free(&memory->gathered);
    skg_free(&memory->corners);
}

int64_t skg_gradient_memory_bytes(const skg_gradient_memory *memory) {
    return memory->adjoint.bytes + memory->weights.bytes + memory->most.bytes + memory->scales.bytes +
           memory->moments.bytes + memory->slopes.bytes + memory->lengths.bytes + memory->faces.bytes +
           memory->node.bytes;
}

/* One gather. */
typedef struct {
    const skg_pass *pass;
    const skg_geometry *geometry;
    const skg_hits_memory *hits;
    skg_gradient_memory *memory;
    skg_staging *staging;
    const skg_raster *raster;
    skg_context *context;
    cl_program program;
    skg_gradient_args args;
    int32_t is_double;
    int32_t forward; /* 1: derivatives of pixels */
} gather_run;

static gather_run run_of(const skg_pass *pass, const skg_geometry *geometry, const skg_hits_memory *hits,
                         skg_gradient_memory *memory, skg_staging *staging, int32_t forward) {
    return (gather_run){.pass = pass,
                        .geometry = geometry,
                        .hits = hits,
                        .memory = memory,
                        .staging = staging,
                        .raster = pass->main.raster,
                        .context = pass->main.raster->context,
                        .is_double = geometry->precision == SKG_PRECISION_DOUBLE,
                        .forward = forward};
}

static size_t real_size(const skg_raster *raster) {
    return raster->options.kernels.precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
}

static skg_weight_layout layout_of(const skg_pass *pass) {
    return skg_attenuate_weight_layout(pass->main.raster, pass->fine);
}

skg_status skg_gradient_reserve(const skg_pass *pass, int64_t planes, skg_gradient_memory *memory) {
    const skg_weight_layout layout = layout_of(pass);
    const int64_t most = planes > layout.planes + 2 ? planes : layout.planes + 2;
    /* Lanes without a hit read behind their rows. */
    const int64_t behind = SKG_SPARE_ROWS * layout.stride + SKG_SPARE_COLUMNS;
    SKG_TRY(skg_buffer_reserve(pass->main.raster->context, &memory->most,
                               layout.planes * layout.items * (int64_t)real_size(pass->main.raster),
                               CL_MEM_READ_WRITE, "weights of a gradient"));
    return skg_buffer_reserve(pass->main.raster->context, &memory->weights,
                              (most * layout.plane + behind) * (int64_t)real_size(pass->main.raster),
                              CL_MEM_READ_WRITE, "weights of a gradient");
}

static skg_status reserve(const gather_run *run, skg_buffer *buffer, int64_t bytes) {
    return skg_buffer_reserve(run->context, buffer, bytes, CL_MEM_READ_WRITE, "gradient");
}

/* Whether faces are gathered in batches; what priorities add is then added by itself. */
static int in_batches(const gather_run *run) {
    return !run->forward && !run->context->device->info.gpu;
}

static skg_status get_batches(const gather_run *run, cl_program *program) {
    static const char *const files[] = {"batch.clh", "gather.clh", "draw.clh", "collect.clh",
                                        "gradient_batches.cl"};
    static const skg_define defines[] = {{"SKG_GATHER", 1}};
    return skg_kernels_get(run->context, &run->pass->kernels, 5, files, SKG_DEFINES(defines), program);
}

static skg_status begin(gather_run *run) {
    static const char *const files[] = {"pixel.clh", "hits.cl", "slopes.cl", "gradient.cl"};
    const skg_priority *priority = &run->pass->priority;
    const skg_weight_layout layout = layout_of(run->pass);
    const skg_define defines[] = {{"SKG_SLOTS", priority->count ? skg_priority_slots(priority) : 32},
                                  {"SKG_PRIORITY", priority->count > 0},
                                  {"SKG_SLOPES_ALONE", in_batches(run)},
                                  {"SKG_FORWARD", run->forward}};
    run->args = (skg_gradient_args){
        .layout = run->raster->layout,
        .window = {priority->window[2], priority->window[0], priority->window[3], priority->window[1]},
        .stride = (SKG_INT)layout.stride,
        .plane = (SKG_INT)layout.plane,
        .planes = (SKG_INT)layout.planes};
    return skg_kernels_get(run->context, &run->pass->kernels, 4, files, SKG_DEFINES(defines), &run->program);
}

/* Reads reals of the device as doubles, and waits. Floats are read into the end of the doubles' memory. */
static skg_status read_reals(const skg_raster *raster, cl_mem memory, int64_t first, int64_t count,
                             double *numbers) {
    const size_t size = real_size(raster), behind = (size_t)count * (sizeof *numbers - size);
    char *raw = (char *)numbers + behind;
    SKG_CL_TRY(clEnqueueReadBuffer(raster->context->device->queue, memory, CL_TRUE, (size_t)first * size,
                                   (size_t)count * size, raw, 0, NULL, NULL));
    for (int64_t i = 0; size == sizeof(float) && i < count; i++) {
        float value;
        memcpy(&value, raw + (size_t)i * size, size);
        numbers[i] = (double)value;
    }
    return SKG_OK;
}

/* The largest weight of each plane. */
static skg_status find_most(const gather_run *run, double *most) {
    const int64_t planes = run->args.planes, items = layout_of(run->pass).items;
    double *of_items = NULL;
    SKG_TRY(skg_staging_take(run->staging, planes * items, sizeof *of_items, "gradient", &of_items));
    SKG_TRY(read_reals(run->raster, run->memory->most.memory, 0, planes * items, of_items));
    for (int64_t i = 0; i < planes * items; i++) {
        if (!isfinite(of_items[i]))
            return skg_fail(SKG_RANGE, "gradient: the derivative of the loss by a path length is not finite; "
                                       "give a smaller derivative by the image, or take precision double");
        most[i / items] = fmax(most[i / items], of_items[i]);
    }
    return SKG_OK;
}

/* What a unit of the contributions is on the device: they weigh q = r / reference, with a parallel beam r. */
static double depth_unit(const gather_run *run, int64_t part) {
    const skg_geometry_part *p = &run->pass->parts[part];
    if (!(p->depth > 0)) return 0;
    const double reference = p->reference > 0 ? p->reference : 1;
    return run->pass->camera.parallel ? run->pass->scale.scale : run->pass->scale.scale * reference;
}

/* No |d loss / d q| of a part's hits is larger, but for priorities. */
static double bound_of(const gather_run *run, int64_t part, const double *most) {
    const skg_geometry_part *p = &run->pass->parts[part];
    double bound = 0;
    for (int32_t c = 0; c < p->contributions; c++)
        bound += fabs(p->contribution[c].weight) * most[p->contribution[c].plane];
    return bound * depth_unit(run, part);
}

static double reference_of(const gather_run *run, int64_t part) {
    const double reference = run->pass->parts[part].reference;
    return run->pass->camera.parallel || !(reference > 0) ? 1 : reference;
}

/* The pixels that a part can cover. */
static double pixels_of(const gather_run *run, int64_t part) {
    const skg_geometry_part *p = &run->pass->parts[part];
    const double columns = fmin(p->columns[1] - p->columns[0] + 4, (double)run->raster->layout.columns);
    const double rows = fmin(p->rows[1] - p->rows[0] + 4, (double)run->raster->layout.rows);
    return columns > 1 && rows > 1 ? columns * rows : 1;
}

/* No weight of a hit, times t^2 over the square of the reference, is larger. */
static double hit_bound(const gather_run *run, int64_t part, const double *most, double competing) {
    const double reference = reference_of(run, part);
    const double deep =
        run->pass->camera.parallel ? 1 : (reference + run->pass->parts[part].depth) / reference;
    return (bound_of(run, part, most) + competing * reference) * deep * deep;
}

/* What priorities add to the bound of every part that competes. */
static double competing_of(const gather_run *run, const double *most) {
    double competing = 0;
    for (int64_t s = 0; s < run->pass->priority.count; s++) {
        const int64_t p = run->pass->priority.parts[s];
        const int32_t layers = run->pass->scene->parts[p].mesh->layers;
        competing += 2 * bound_of(run, p, most) / reference_of(run, p) * (layers > 1 ? layers : 1);
    }
    return competing;
}

/* A power of two that brings numbers of this size to 2^62. */
static double scale_for(double bound) {
    int exponent = 0;
    frexp(bound, &exponent);
    return ldexp(1, exponent > 62 + 120 ? -120 : exponent < 62 - 120 ? 120 : 62 - exponent);
}

/* Powers of two by which weights become integers: the sum over a face, times columns or rows, stays below 2^62. */
static void find_scales(const gather_run *run, const double *most, double *scales, double *units) {
    const double competing = competing_of(run, most);
    const skg_raster_layout *layout = &run->raster->layout;
    const double far = layout->columns > layout->rows ? layout->columns : layout->rows;
    for (int64_t p = 0; p < run->pass->scene->count; p++) {
        const double bound = hit_bound(run, p, most, competing) * pixels_of(run, p) * far;
        if (run->pass->parts[p].contributions == 0 || !(bound > 0)) continue;
        scales[p] = scale_for(bound);
        units[p] = reference_of(run, p) / scales[p];
    }
}

/* Uploads doubles in the precision of the pass. */
static skg_status upload_reals(const gather_run *run, int64_t count, const double *numbers,
                               skg_buffer *buffer) {
    float *rounded = NULL;
    if (run->is_double)
        return skg_buffer_write(run->context, buffer, count * (int64_t)sizeof *numbers, numbers, "gradient");
    SKG_TRY(skg_staging_take(run->staging, count, sizeof *rounded, "gradient", &rounded));
    for (int64_t i = 0; i < count; i++) rounded[i] = (float)numbers[i];
    return skg_buffer_write(run->context, buffer, count * (int64_t)sizeof *rounded, rounded, "gradient");
}

/* The hits of competing parts are listed still, by skg_hits_settle of this pass. */
static skg_status run_slopes(const gather_run *run) {
    const skg_hits_memory *h = run->hits;
    const skg_gradient_args *args = &run->args;
    const skg_work_size work = {
        2, {args->window[2] - args->window[0], args->window[3] - args->window[1]}, {16, 16}};
    if (run->pass->priority.count == 0 || work.items[0] < 1 || work.items[1] < 1) return SKG_OK;
    SKG_TRY(reserve(run, &run->memory->slopes, h->hits.bytes));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_SLOPES, args, *args),
        SKG_ARGUMENT(HITS_SLOPES, parts, run->geometry->part_table.memory),
        SKG_ARGUMENT(HITS_SLOPES, contributions, run->geometry->contribution_table.memory),
        SKG_ARGUMENT(HITS_SLOPES, counts, h->counts.memory),
        SKG_ARGUMENT(HITS_SLOPES, starts, h->starts.memory),
        SKG_ARGUMENT(HITS_SLOPES, hits, h->hits.memory),
        SKG_ARGUMENT(HITS_SLOPES, table, h->table.memory),
        SKG_ARGUMENT(HITS_SLOPES, weights, run->memory->weights.memory),
        SKG_ARGUMENT(HITS_SLOPES, slopes, run->memory->slopes.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_slopes", "gradient", &work, arguments,
                           &run->staging->log);
}

/* On a processor: the moments but for what priorities add. */
static skg_status run_batches(const gather_run *run) {
    const skg_geometry *geometry = run->geometry;
    const skg_gradient_memory *m = run->memory;
    const skg_work_size work = {1, {(geometry->triangles + CLAIM - 1) / CLAIM}, {1}};
    skg_gradient_args args = run->args;
    cl_program program = NULL;
    args.layout.claim = CLAIM;
    SKG_TRY(get_batches(run, &program));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(GRADIENT_BATCHES, args, args),
        SKG_TRIANGLE_BUFFERS(GRADIENT_BATCHES, geometry),
        SKG_ARGUMENT(GRADIENT_BATCHES, contributions, geometry->contribution_table.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, weights, m->weights.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, scales, m->scales.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, moments, m->moments.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, program, "skg_gradient_batches", "gradient", &work, arguments,
                           &run->staging->log);
}

/* Makes sure of the sums, which are 0 if they are added to. */
static skg_status reserve_sums(const gather_run *run) {
    const int64_t pixels = (int64_t)run->raster->layout.rows * run->raster->layout.columns;
    const int64_t bytes = (run->forward ? pixels : 3 * run->geometry->triangles) * (int64_t)sizeof(int64_t);
    const cl_int none = 0;
    SKG_TRY(reserve(run, &run->memory->moments, bytes));
    if (!in_batches(run))
        SKG_CL_TRY(clEnqueueFillBuffer(run->context->device->queue, run->memory->moments.memory, &none,
                                       sizeof none, 0, (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

static skg_status run_faces(const gather_run *run) {
    const skg_geometry *geometry = run->geometry;
    const skg_hits_memory *h = run->hits;
    const skg_gradient_memory *m = run->memory;
    SKG_TRY(reserve_sums(run));
    if (in_batches(run)) SKG_TRY(run_batches(run));
    if (in_batches(run) && run->pass->priority.count == 0) return SKG_OK;
    const skg_work_size work = {
        2, {geometry->triangles, run->context->device->info.gpu ? SLICES : 1}, {GROUP, 1}};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(GRADIENT_FACES, args, run->args),
        SKG_TRIANGLE_BUFFERS(GRADIENT_FACES, geometry),
        SKG_ARGUMENT(GRADIENT_FACES, contributions, geometry->contribution_table.memory),
        SKG_ARGUMENT(GRADIENT_FACES, weights, m->weights.memory),
        SKG_ARGUMENT(GRADIENT_FACES, scales, m->scales.memory),
        SKG_ARGUMENT(GRADIENT_FACES, moments, m->moments.memory),
        SKG_ARGUMENT(GRADIENT_FACES, slots, h->slots.memory),
        SKG_ARGUMENT(GRADIENT_FACES, shifts, h->shifts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, counts, h->counts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, starts, h->starts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, hits, h->hits.memory),
        SKG_ARGUMENT(GRADIENT_FACES, slopes, m->slopes.memory),
        SKG_ARGUMENT(GRADIENT_FACES, face_slopes, m->faces.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_gradient_faces", "gradient", &work, arguments,
                           &run->staging->log);
}

skg_status skg_gradient_gather(const skg_pass *pass, const skg_geometry *geometry,
                               const skg_hits_memory *hits, skg_gradient_memory *memory, skg_staging *staging,
                               skg_gathered *gathered) {
    gather_run run = run_of(pass, geometry, hits, memory, staging, 0);
    double *most = NULL, *scales = NULL, *units = NULL;
    SKG_TRY(begin(&run));
    SKG_TRY(skg_staging_take(staging, run.args.planes, sizeof *most, "gradient", &most));
    SKG_TRY(skg_staging_take(staging, pass->scene->count, sizeof *scales, "gradient", &scales));
    SKG_TRY(skg_staging_take(staging, pass->scene->count, sizeof *units, "gradient", &units));
    if (!memory->gathered)
        SKG_TRY(skg_alloc(3 * geometry->triangles, sizeof *memory->gathered, "gradient", &memory->gathered));
    SKG_TRY(find_most(&run, most));
    find_scales(&run, most, scales, units);
    SKG_TRY(upload_reals(&run, pass->scene->count, scales, &memory->scales));
    SKG_TRY(run_slopes(&run));
    SKG_TRY(run_faces(&run));
    SKG_CL_TRY(clEnqueueReadBuffer(run.context->device->queue, memory->moments.memory, CL_TRUE, 0,
                                   3 * (size_t)geometry->triangles * sizeof *memory->gathered,
                                   memory->gathered, 0, NULL, NULL));
    *gathered = (skg_gathered){.moments = memory->gathered, .units = units, .layout = layout_of(pass)};
    return SKG_OK;
}

/* Cuts slopes off at 2^24 times their mean, and returns the largest that is left. */
static double cut_slopes(int64_t count, double *slopes, int64_t *saturated) {
    double sum = 0, largest = 0;
    int64_t used = 0;
    for (int64_t i = 0; i < count; i++) sum += fabs(slopes[i]), used += slopes[i] != 0;
    const double most = used ? ldexp(sum / (double)used, 24) : 0;
    for (int64_t i = 0; i < count; i++) {
        if (fabs(slopes[i]) > most) slopes[i] = copysign(most, slopes[i]), ++*saturated;
        largest = fmax(largest, fabs(slopes[i]));
    }
    return largest;
}

/* One scale for the hits of all parts. At most 2^10 of the largest hits meet in a pixel. */
static double find_scale(const gather_run *run, const double *most, double slope, double *scales) {
    const double competing = competing_of(run, most);
    double bound = 0;
    for (int64_t p = 0; p < run->pass->scene->count; p++)
        if (run->pass->parts[p].contributions > 0) bound = fmax(bound, hit_bound(run, p, most, competing));
    if (!(bound * slope > 0)) return 0;
    const double scale = scale_for(ldexp(bound * slope, 10));
    for (int64_t p = 0; p < run->pass->scene->count; p++) scales[p] = scale;
    return scale;
}

skg_status skg_gradient_scatter(const skg_pass *pass, const skg_geometry *geometry,
                                const skg_hits_memory *hits, skg_gradient_memory *memory,
                                skg_staging *staging, double *slopes, double *values, int64_t *saturated) {
    gather_run run = run_of(pass, geometry, hits, memory, staging, 1);
    const int64_t pixels = pass->camera.rows * pass->camera.columns, count = 3 * geometry->triangles;
    double *most = NULL, *scales = NULL;
    int64_t *sums = NULL;
    SKG_TRY(begin(&run));
    SKG_TRY(skg_staging_take(staging, run.args.planes, sizeof *most, "derivative", &most));
    SKG_TRY(skg_staging_take(staging, pass->scene->count, sizeof *scales, "derivative", &scales));
    SKG_TRY(skg_staging_take(staging, pixels, sizeof *sums, "derivative", &sums));
    SKG_TRY(find_most(&run, most));
    const double scale = find_scale(&run, most, cut_slopes(count, slopes, saturated), scales);
    for (int64_t p = 0; p < pixels; p++) values[p] = 0;
    if (scale == 0) return SKG_OK;
    SKG_TRY(upload_reals(&run, pass->scene->count, scales, &memory->scales));
    SKG_TRY(upload_reals(&run, count, slopes, &memory->faces));
    SKG_TRY(run_slopes(&run));
    SKG_TRY(run_faces(&run));
    SKG_CL_TRY(clEnqueueReadBuffer(run.context->device->queue, memory->moments.memory, CL_TRUE, 0,
                                   (size_t)pixels * sizeof *sums, sums, 0, NULL, NULL));
    for (int64_t p = 0; p < pixels; p++) values[p] = (double)sums[p] / scale;
    return SKG_OK;
}

skg_status skg_gradient_read(const skg_pass *pass, cl_mem memory, int64_t first, int64_t count,
                             double *numbers) {
    return read_reals(pass->main.raster, memory, first, count, numbers);
}

/* corners: NULL after a failure, so that the next call reads them again */
static skg_status read_corners(skg_context *context, const skg_geometry *geometry, int32_t **corners) {
    const int64_t count = 3 * geometry->mesh_triangle[geometry->meshes];
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof **corners, "gradient", corners));
    SKG_CL_CLEANUP(clEnqueueReadBuffer(context->device->queue, geometry->corners.memory, CL_TRUE, 0,
                                       (size_t)count * sizeof **corners, *corners, 0, NULL, NULL));
cleanup:
    if (status != SKG_OK) skg_free(corners);
    return status;
}

skg_status skg_gradient_find_corners(skg_context *context, const skg_geometry *geometry, int64_t mesh,
                                     skg_gradient_memory *memory, const int32_t **corners) {
    if (!memory->corners) SKG_TRY(read_corners(context, geometry, &memory->corners));
    *corners = memory->corners + 3 * geometry->mesh_triangle[mesh];
    return SKG_OK;
}
