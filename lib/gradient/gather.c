/* Sums of weights over the pixels of faces and edges, for gradients. */
#include "gradient/gather.h"

#include "core/maths.h"
#include "gradient/forces.h"
#include "gradient/scales.h"
#include "gradient/volumes.h"

#include <skiagraph/plan.h>

#include <float.h>
#include <string.h>

enum { GROUP = 64, SLICES = 32 };

static skg_weight_layout layout_of(const skg_pass *pass) {
    return skg_attenuate_weight_layout(pass->main.raster, pass->fine);
}

skg_status skg_gather_reserve(const skg_gather_run *run, skg_buffer *buffer, int64_t bytes) {
    return skg_buffer_reserve(run->context, buffer, bytes, CL_MEM_READ_WRITE, "gradient");
}

static skg_status get_batches(const skg_gather_run *run, cl_program *program) {
    const char *const files[] = {"batch.clh",
                                 "worth.clh",
                                 run->forward ? "spread.clh" : "gather.clh",
                                 "draw.clh",
                                 "collect.clh",
                                 "tiny.clh",
                                 run->forward ? "spread_tiny.clh" : "gather_tiny.clh",
                                 "gradient_batches.cl"};
    const skg_define defines[] = {
        {"SKG_GATHER", 1}, {"SKG_AROUND", run->around != NULL}, {"SKG_FORWARD", run->forward}};
    return skg_kernels_get(run->context, &run->pass->kernels, sizeof files / sizeof *files, files,
                           SKG_DEFINES(defines), program);
}

/* Whether the kernels of gradient.cl are needed: for all faces, or for what priorities add. */
static int needs_faces(const skg_gather_run *run) {
    return run->workers == 0 || run->pass->priority.count > 0;
}

skg_status skg_gather_begin(skg_gather_run *run) {
    static const char *const files[] = {"pixel.clh", "intervals.clh", "hits.cl", "slopes.cl", "gradient.cl"};
    const skg_priority *priority = &run->pass->priority;
    const skg_weight_layout layout = layout_of(run->pass);
    const skg_define defines[] = {{"SKG_SLOTS", priority->count ? skg_priority_slots(priority) : 32},
                                  {"SKG_PRIORITY", priority->count > 0},
                                  {"SKG_SLOPES_ALONE", run->workers > 0},
                                  {"SKG_AROUND", run->around && run->workers == 0},
                                  {"SKG_FORWARD", run->forward}};
    run->args = (skg_gradient_args){
        .layout = run->raster->layout,
        .window = {priority->window[2], priority->window[0], priority->window[3], priority->window[1]},
        .stride = (SKG_INT)layout.stride,
        .plane = (SKG_INT)layout.plane,
        .planes = (SKG_INT)layout.planes};
    if (!needs_faces(run)) return SKG_OK;
    return skg_kernels_get(run->context, &run->pass->kernels, 5, files, SKG_DEFINES(defines), &run->program);
}

/* Reads reals of the device as doubles, and waits. Floats are read into the end of the doubles' memory. */
static skg_status read_reals(const skg_raster *raster, cl_mem memory, int64_t first, int64_t count,
                             double *numbers) {
    const size_t size = (size_t)skg_gradient_real_size(raster->options.kernels.precision),
                 behind = (size_t)count * (sizeof *numbers - size);
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
skg_status skg_gather_find_max(const skg_gather_run *run, double *most) {
    const int64_t planes = run->args.planes, items = layout_of(run->pass).items;
    double *of_items = NULL;
    SKG_TRY(skg_staging_take(run->staging, planes * items, sizeof *of_items, "gradient", &of_items));
    SKG_TRY(read_reals(run->raster, run->memory->most.memory, 0, planes * items, of_items));
    int finite = 1;
    for (int64_t p = 0; p < planes; p++)
        for (int64_t i = 0; i < items; i++) {
            const double here = of_items[p * items + i];
            finite &= here <= DBL_MAX; /* NaN is not */
            most[p] = here > most[p] ? here : most[p];
        }
    if (finite) return SKG_OK;
    skg_buffer_release(&run->memory->weights); /* later ones begin with 0 again */
    return skg_fail(SKG_RANGE, "gradient: the derivative of the loss by a path length is not finite; "
                               "give a smaller derivative by the image, or take precision double");
}

void skg_gather_round(const skg_gather_run *run, int64_t first, int64_t count, const double *numbers,
                      void *reals) {
    if (run->is_double) memcpy((double *)reals + first, numbers, (size_t)count * sizeof *numbers);
    for (int64_t i = 0; i < count && !run->is_double; i++) ((float *)reals)[first + i] = (float)numbers[i];
}

skg_status skg_gather_upload_scales(const skg_gather_run *run, int64_t count, const double *scales) {
    const size_t size = (size_t)skg_gradient_real_size(run->geometry->precision);
    void *reals = NULL;
    SKG_TRY(skg_staging_take(run->staging, count, size, "gradient", &reals));
    skg_gather_round(run, 0, count, scales, reals);
    return skg_staging_write(run->staging, &run->memory->scales, count * (int64_t)size, reals, "gradient");
}

/* Below what differences of depths hits are at one place: what rounding makes of the faces of parts that touch, even where they lean, as a
 * share of the greatest depth of a part. */
static double touch_of(const skg_gather_run *run) {
    double depth = 0;
    for (int64_t s = 0; s < run->pass->priority.count; s++) {
        const double own = run->pass->parts[run->pass->priority.parts[s]].depth;
        depth = own > depth ? own : depth;
    }
    return depth * (run->is_double ? 1e-8 : 2e-5);
}

/* The hits of competing parts are listed still, by skg_hits_settle of this pass. */
skg_status skg_gather_slopes(const skg_gather_run *run) {
    const skg_hits_memory *h = run->hits;
    const skg_gradient_args *args = &run->args;
    const skg_work_size work = {
        2, {args->window[2] - args->window[0], args->window[3] - args->window[1]}, {16, 16}};
    if (run->pass->priority.count == 0 || work.items[0] < 1 || work.items[1] < 1) return SKG_OK;
    SKG_TRY(skg_gather_reserve(run, &run->memory->slopes, h->hits.bytes));
    const cl_double touch = touch_of(run);
    const cl_float rounded = (cl_float)touch;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_SLOPES, args, *args),
        SKG_ARGUMENT_WITH(HITS_SLOPES, touch, run->is_double, touch, rounded),
        SKG_ARGUMENT(HITS_SLOPES, parts, run->geometry->part_table.memory),
        SKG_ARGUMENT(HITS_SLOPES, contributions, run->geometry->contribution_table.memory),
        SKG_ARGUMENT(HITS_SLOPES, counts, h->counts.memory),
        SKG_ARGUMENT(HITS_SLOPES, starts, h->starts.memory),
        SKG_ARGUMENT(HITS_SLOPES, hits, h->hits.memory),
        SKG_ARGUMENT(HITS_SLOPES, table, h->table.memory),
        SKG_ARGUMENT(HITS_SLOPES, weights, run->memory->weights.memory),
        SKG_ARGUMENT(HITS_SLOPES, slopes, run->memory->slopes.memory),
    };
    SKG_TRY(SKG_LAUNCH_ONCE(run->context, run->program, "skg_hits_slopes", "gradient", &work, arguments,
                            &run->staging->log));
    return skg_gather_volumes(run);
}

skg_status skg_gather_batches(const skg_gather_run *run) {
    const skg_geometry *geometry = run->geometry;
    const skg_gradient_memory *m = run->memory;
    const skg_work_size work = {1, {run->workers}, {1}};
    skg_gradient_args args = run->args;
    cl_program program = NULL;
    args.layout.claim = SKG_GATHER_CLAIM;
    if (run->workers == 0) return SKG_OK;
    SKG_TRY(get_batches(run, &program));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(GRADIENT_BATCHES, args, args),
        SKG_TRIANGLE_BUFFERS(GRADIENT_BATCHES, geometry),
        SKG_ARGUMENT(GRADIENT_BATCHES, contributions, geometry->contribution_table.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, weights, m->weights.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, scales, m->scales.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, first_around, m->first_around.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, around, m->around.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, face_slopes, m->faces.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, lines, m->lines.memory),
        SKG_ARGUMENT(GRADIENT_BATCHES, moments, m->moments.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, program, "skg_gradient_batches", "gradient", &work, arguments,
                           &run->staging->log);
}

skg_status skg_gather_clear(const skg_gather_run *run, int64_t first, int64_t end) {
    const size_t size = sizeof(int64_t);
    const cl_int none = 0;
    SKG_ASSERT(0 <= first && first <= end);
    SKG_TRY(skg_gather_reserve(run, &run->memory->moments, end * (int64_t)size));
    if (first < end)
        SKG_CL_TRY(clEnqueueFillBuffer(run->context->device->queue, run->memory->moments.memory, &none,
                                       sizeof none, (size_t)first * size, (size_t)(end - first) * size, 0,
                                       NULL, NULL));
    return SKG_OK;
}

skg_status skg_gather_faces(const skg_gather_run *run) {
    const skg_geometry *geometry = run->geometry;
    const skg_hits_memory *h = run->hits;
    const skg_gradient_memory *m = run->memory;
    if (!needs_faces(run)) return SKG_OK;
    const skg_work_size work = {
        2, {geometry->triangles, run->context->device->info.gpu ? SLICES : 1}, {GROUP, 1}};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(GRADIENT_FACES, args, run->args),
        SKG_TRIANGLE_BUFFERS(GRADIENT_FACES, geometry),
        SKG_ARGUMENT(GRADIENT_FACES, contributions, geometry->contribution_table.memory),
        SKG_ARGUMENT(GRADIENT_FACES, weights, m->weights.memory),
        SKG_ARGUMENT(GRADIENT_FACES, scales, m->scales.memory),
        SKG_ARGUMENT(GRADIENT_FACES, first_around, m->first_around.memory),
        SKG_ARGUMENT(GRADIENT_FACES, around, m->around.memory),
        SKG_ARGUMENT(GRADIENT_FACES, moments, m->moments.memory),
        SKG_ARGUMENT(GRADIENT_FACES, slots, h->slots.memory),
        SKG_ARGUMENT(GRADIENT_FACES, shifts, h->shifts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, counts, h->counts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, starts, h->starts.memory),
        SKG_ARGUMENT(GRADIENT_FACES, hits, h->hits.memory),
        SKG_ARGUMENT(GRADIENT_FACES, slopes, m->slopes.memory),
        SKG_ARGUMENT(GRADIENT_FACES, face_slopes, m->faces.memory),
        SKG_ARGUMENT(GRADIENT_FACES, lines, m->lines.memory),
    };
    return SKG_LAUNCH_ONCE(run->context, run->program, "skg_gradient_faces", "gradient", &work, arguments,
                           &run->staging->log);
}

/* Uploads what stands around the parts, as kernels weigh it. */
static skg_status send_around(const skg_gather_run *run) {
    const int64_t parts = run->pass->scene->count, count = run->around->first[parts];
    skg_gradient_memory *m = run->memory;
    skg_contribution_double *list = NULL;
    skg_contribution_float *rounded = NULL;
    SKG_TRY(skg_staging_take(run->staging, count + 1, sizeof *list, "gradient", &list));
    SKG_TRY(skg_staging_take(run->staging, count + 1, sizeof *rounded, "gradient", &rounded));
    for (int64_t p = 0; p < parts; p++) {
        const skg_geometry_part *part = &run->pass->parts[p];
        const double unit = run->pass->kernels.listed ? skg_gradient_depth_unit(run, p)
                            : part->contributions     ? 1 / part->contribution->weight
                                                      : 0;
        for (int32_t c = run->around->first[p]; c < run->around->first[p + 1]; c++) {
            list[c] = (skg_contribution_double){.weight = run->around->list[c].weight * unit,
                                                .plane = (SKG_INT)run->around->list[c].plane};
            rounded[c] = (skg_contribution_float){.weight = (float)list[c].weight, .plane = list[c].plane};
        }
    }
    SKG_TRY(skg_staging_write(run->staging, &m->first_around, (parts + 1) * (int64_t)sizeof(int32_t),
                              run->around->first, "gradient"));
    return run->is_double ? skg_staging_write(run->staging, &m->around, (count + 1) * (int64_t)sizeof *list,
                                              list, "gradient")
                          : skg_staging_write(run->staging, &m->around,
                                              (count + 1) * (int64_t)sizeof *rounded, rounded, "gradient");
}

skg_status skg_gradient_gather(const skg_pass *pass, const skg_geometry *geometry,
                               const skg_hits_memory *hits, const skg_surroundings *around,
                               skg_gradient_memory *memory, skg_staging *staging, skg_gathered *gathered) {
    skg_gather_run run = skg_gather_of(pass, geometry, hits, memory, staging);
    const int64_t parts = pass->scene->count;
    double *most = NULL, *scales = NULL, *units = NULL;
    run.around = around;
    run.workers =
        run.context->device->info.gpu ? 0 : (geometry->triangles + SKG_GATHER_CLAIM - 1) / SKG_GATHER_CLAIM;
    SKG_TRY(skg_gather_begin(&run));
    SKG_TRY(skg_staging_take(staging, run.args.planes, sizeof *most, "gradient", &most));
    SKG_TRY(skg_staging_take(staging, 2 * parts, sizeof *scales, "gradient", &scales));
    SKG_TRY(skg_staging_take(staging, 2 * parts, sizeof *units, "gradient", &units));
    if (around) SKG_TRY(send_around(&run)); /* while the weights are made, which the next call waits for */
    SKG_TRY(skg_gather_find_max(&run, most));
    skg_gradient_find_scales(&run, most, around, scales, units);
    SKG_TRY(skg_gather_upload_scales(&run, 2 * parts, scales));
    SKG_TRY(skg_gather_slopes(&run));
    const int64_t faces = 4 * geometry->triangles; /* batches write all but what stands behind the faces */
    SKG_TRY(skg_gather_clear(&run, run.workers > 0 ? faces : 0, faces + 4));
    SKG_TRY(skg_gather_batches(&run));
    SKG_TRY(skg_gather_faces(&run));
    SKG_TRY(skg_host_view_open(run.context, memory->moments.memory, 0,
                               (faces + 4) * (int64_t)sizeof *gathered->moments, &memory->sums));
    const int64_t *moments = memory->sums.bytes;
    *gathered = (skg_gathered){.moments = moments,
                               .units = units,
                               .around_units = units + parts,
                               .has_edges = moments[faces] != 0,
                               .layout = layout_of(pass)};
    return SKG_OK;
}

skg_status skg_gradient_read(const skg_pass *pass, cl_mem memory, int64_t first, int64_t count,
                             double *numbers) {
    return read_reals(pass->main.raster, memory, first, count, numbers);
}

void skg_gradient_close(const skg_pass *pass, skg_gradient_memory *memory) {
    skg_host_view_close(pass->main.raster->context, &memory->sums);
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

skg_status skg_gradient_find_planes(const skg_geometry *geometry, const skg_mesh *mesh, int64_t number,
                                    skg_gradient_memory *memory, const double **planes) {
    const int64_t first = geometry->mesh_triangle[number];
    if (!memory->planes)
        SKG_TRY(skg_alloc(4 * geometry->mesh_triangle[geometry->meshes], sizeof *memory->planes, "gradient",
                          &memory->planes));
    if (!memory->versions)
        SKG_TRY(skg_alloc(geometry->meshes, sizeof *memory->versions, "gradient", &memory->versions));
    if (memory->versions[number] != mesh->version)
        skg_face_planes_find(mesh, memory->corners + 3 * first, geometry->layouts[number].source,
                             memory->planes + 4 * first);
    memory->versions[number] = mesh->version;
    *planes = memory->planes + 4 * first;
    return SKG_OK;
}
