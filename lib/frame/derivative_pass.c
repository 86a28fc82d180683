#include "frame/derivative_pass.h"

#include "core/maths.h"
#include "core/threads.h"
#include "frame/derivative_density.h"
#include "frame/gradient_edges.h"
#include "frame/gradient_faces.h"
#include "frame/gradient_pass.h"
#include "geometry/slopes.h"
#include "spectral/model.h"

#include <float.h>
#include <string.h>

/* The velocity of a sample of the source: by differences, as in gradient_pass.c. */
static void find_source(const skg_recipe *recipe, const skg_view *view, int64_t number,
                        const skg_direction *direction, double velocity[3]) {
    static const double none[3] = {0};
    const skg_samples *samples = &recipe->samples;
    const double *source = direction->source ? direction->source : none;
    const int is_point = number < 0 || samples->spot.shape == SKG_SPOT_POINT;
    double size = 0, ends[2][3], shift[2];
    memcpy(velocity, source, 3 * sizeof *source);
    if (is_point) return;
    for (int k = 0; k < 3; k++) {
        size += fabs(source[k]);
        if (direction->detector)
            size += fabs(direction->detector[k]) + 1000 * fabs(direction->detector[3 + k]);
    }
    if (!(size > 0)) return;
    const double step = 1e-2 / size;
    for (int side = 0; side < 2; side++) {
        skg_view moved = *view;
        double turned[3];
        skg_add_scaled(view->source, side ? -step : step, source, moved.source);
        if (direction->detector) {
            const double *from[3] = {view->centre, view->column_step, view->row_step};
            double *to[3] = {moved.centre, moved.column_step, moved.row_step};
            for (int v = 0; v < 3; v++) {
                skg_cross(direction->detector + 3, from[v], turned);
                for (int k = 0; k < 3; k++)
                    to[v][k] += (side ? -step : step) * (turned[k] + (v == 0 ? direction->detector[k] : 0));
            }
        }
        skg_samples_at(samples, &moved, number * samples->fine * samples->fine, ends[side], shift);
    }
    for (int k = 0; k < 3; k++) velocity[k] = (ends[0][k] - ends[1][k]) / (2 * step);
}

/* The velocity of the direction of a parallel beam. */
static void find_beam(const skg_view *view, const skg_camera *camera, const skg_direction *direction,
                      skg_velocities *v) {
    const double *d = camera->first;
    const int infinite = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    const double ratio = infinite ? skg_length(d) / skg_length(view->source) : -1;
    double moves[3] = {0}, turned[3];
    for (int k = 0; k < 3 && direction->source; k++) moves[k] = ratio * direction->source[k];
    if (!infinite && direction->detector) {
        skg_cross(direction->detector + 3, view->centre, turned);
        for (int k = 0; k < 3; k++) moves[k] += direction->detector[k] + turned[k];
    }
    skg_add_scaled(moves, -skg_dot(moves, d) / skg_dot(d, d), d, v->beam);
}

/* Consecutive faces of a part. */
typedef struct {
    int64_t part, first, end;
} face_range;

/* The slopes of the faces of the parts that move, and what faces that are seen as lines add to each channel. */
typedef struct {
    const skg_pass *pass;
    const skg_velocities *of_view;
    const skg_direction *direction;
    skg_face_moments *faces; /* [parts] */
    skg_part_edges *edges;   /* [parts] */
    skg_edge_weights of_edges;
    double *slopes;     /* [triangles][3] of the parts that move */
    uint8_t *edge_on;   /* [triangles] of them */
    int64_t *first;     /* [parts] the first triangle */
    uint8_t *moves;     /* [parts] */
    face_range *ranges; /* of the parts that move */
    int64_t range_count;
    skg_geometry_part *drawn; /* [parts] as the kernels gather them */
} slopes_work;

enum { FACES = 2048 }; /* of a range */

static skg_velocities velocities_of(const slopes_work *w, int64_t part) {
    const skg_direction *direction = w->direction;
    skg_velocities v = *w->of_view;
    if (direction->poses) memcpy(v.pose, direction->poses + 6 * part, sizeof v.pose);
    if (direction->vertices) v.vertices = direction->vertices[part];
    return v;
}

static skg_status find_range(void *user, int64_t number) {
    const slopes_work *w = user;
    const face_range *range = &w->ranges[number];
    const int64_t part = range->part;
    const double reference = w->pass->parts[part].reference;
    const double rounding =
        w->pass->kernels.precision == SKG_PRECISION_DOUBLE ? DBL_EPSILON : (double)FLT_EPSILON;
    const skg_velocities v = velocities_of(w, part);
    skg_slopes_find(&w->faces[part], &v, w->pass->camera.parallel || !(reference > 0) ? 1 : reference,
                    rounding, range->first, range->end, w->slopes + 3 * w->first[part],
                    w->edge_on + w->first[part]);
    return SKG_OK;
}

/* Divides the faces of the parts that move. */
static skg_status find_ranges(slopes_work *w) {
    const int64_t parts = w->pass->scene->count;
    int64_t most = 0;
    for (int64_t p = 0; p < parts; p++) most += w->faces[p].mesh->triangles / FACES + 1;
    SKG_TRY(skg_alloc(most, sizeof *w->ranges, "derivative", &w->ranges));
    for (int64_t p = 0; p < parts; p++) {
        const skg_velocities v = velocities_of(w, p);
        const int64_t count = w->faces[p].mesh->triangles;
        w->moves[p] = (uint8_t)skg_slopes_move(&v);
        for (int64_t f = 0; w->moves[p] && f < count; f += FACES)
            w->ranges[w->range_count++] =
                (face_range){.part = p, .first = f, .end = f + FACES < count ? f + FACES : count};
    }
    return SKG_OK;
}

static skg_status find_slopes(skg_job *job, slopes_work *w) {
    const skg_geometry *geometry = &job->machine->geometry;
    const int64_t parts = w->pass->scene->count;
    SKG_TRY(skg_alloc(parts, sizeof *w->faces, "derivative", &w->faces));
    SKG_TRY(skg_alloc(parts, sizeof *w->edges, "derivative", &w->edges));
    SKG_TRY(skg_alloc(parts, sizeof *w->first, "derivative", &w->first));
    SKG_TRY(skg_alloc(parts, sizeof *w->moves, "derivative", &w->moves));
    SKG_TRY(skg_alloc(3 * geometry->triangles, sizeof *w->slopes, "derivative", &w->slopes));
    SKG_TRY(skg_alloc(geometry->triangles, sizeof *w->edge_on, "derivative", &w->edge_on));
    SKG_TRY(skg_edge_weights_create(w->pass, &w->of_edges));
    w->drawn = w->pass->parts;
    SKG_TRY(skg_gradient_draw_competitors(job, w->pass, &w->drawn));
    for (int64_t p = 0; p < parts; p++) {
        if (p > 0) w->first[p] = w->first[p - 1] + w->faces[p - 1].mesh->triangles;
        SKG_TRY(skg_gradient_place_faces(job, w->pass, p, &w->faces[p]));
        w->edges[p] = (skg_part_edges){.all = &w->of_edges, .part = p};
        w->faces[p].weigh = skg_edge_weigh;
        w->faces[p].weigh_user = &w->edges[p];
    }
    SKG_TRY(find_ranges(w));
    return skg_parallel(w->range_count, find_range, w);
}

static void release_slopes(slopes_work *w) {
    skg_edge_weights_release(&w->of_edges);
    skg_free(&w->faces);
    skg_free(&w->edges);
    skg_free(&w->first);
    skg_free(&w->moves);
    skg_free(&w->ranges);
    skg_free(&w->slopes);
    skg_free(&w->edge_on);
}

/* Adds the faces that are seen as lines, with the weights that stand on the device. */
static skg_status add_edges(skg_job *job, slopes_work *w, double *values) {
    skg_edge_weights_clear(&w->of_edges);
    for (int64_t p = 0; p < w->pass->scene->count; p++) {
        const skg_velocities v = velocities_of(w, p);
        const skg_face_moments *faces = &w->faces[p];
        if (!w->moves[p] || w->drawn[p].contributions == 0) continue;
        for (int64_t f = 0; f < faces->mesh->triangles; f++) {
            if (!w->edge_on[w->first[p] + f]) continue;
            SKG_TRY(skg_edge_weights_read(job, p, &w->of_edges));
            SKG_TRY(skg_slopes_spread(faces, &v, f, values));
        }
    }
    return SKG_OK;
}

/* What changes besides the lengths: those of whole rays, the falloff, and the photons of an absolute beam. */
static skg_status add_rays(skg_job *job, const skg_frame_work *work, const skg_pass *pass,
                           const skg_velocities *v, double *values) {
    const skg_recipe *recipe = job->recipe;
    const skg_camera *camera = &pass->camera;
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int falls = job->machine->images.falloff;
    static const double none[3] = {0};
    double *rays = NULL, all = 0, way[3];
    if (camera->parallel) return SKG_OK;
    skg_add_scaled(work->view->centre, -1, work->view->source, way);
    if (falls) all += 3 * skg_slope_of_distance(camera, v, camera->origin, camera->first, v->source);
    if (recipe->absolute && !skg_quantity_is_ratio(&recipe->options))
        all -= 2 * skg_slope_of_distance(camera, v, work->view->source, way,
                                         job->gradient->direction.source ? job->gradient->direction.source
                                                                         : none);
    SKG_TRY(skg_alloc(2 * layout.plane, sizeof *rays, "derivative", &rays));
    const skg_status status = skg_gradient_read(pass, job->machine->gradient.weights.memory,
                                                layout.planes * layout.plane, 2 * layout.plane, rays);
    for (int64_t r = 0; r < camera->rows && status == SKG_OK; r++)
        for (int64_t c = 0; c < camera->columns; c++) {
            const double *at = rays + r * layout.stride + c;
            double ray[3];
            for (int k = 0; k < 3; k++)
                ray[k] = camera->first[k] + (double)c * camera->column[k] + (double)r * camera->row[k];
            values[r * camera->columns + c] +=
                (at[0] - (falls ? 3 : 0) * at[layout.plane]) * skg_slope_of_ray(camera, v, ray) +
                all * at[layout.plane];
        }
    skg_free(&rays);
    return status;
}

/* Adds up the slopes of hits with the parts as `drawn` has them. The tables of the pass are put back. */
static skg_status scatter(skg_job *job, slopes_work *w, double *values) {
    const skg_pass *pass = w->pass;
    skg_machine *machine = job->machine;
    skg_geometry *geometry = &machine->geometry;
    const int64_t state = geometry->state;
    const double scale = pass->scale.scale;
    skg_pass other = *pass;
    other.parts = w->drawn;
    if (w->drawn != pass->parts)
        SKG_TRY(skg_geometry_weigh(machine->context, geometry, &pass->camera, w->drawn, scale));
    SKG_TRY(skg_gradient_scatter(&other, geometry, &machine->hits, &machine->gradient, &job->staging,
                                 w->moves, w->slopes, values, &job->gradient->saturated));
    if (w->drawn != pass->parts)
        SKG_TRY(skg_geometry_weigh(machine->context, geometry, &pass->camera, pass->parts, scale));
    geometry->state = state; /* the sums of the pass stand as before */
    return SKG_OK;
}

/* One channel of the intensities: the adjoint is 1 there, so that the weights of a ray are its own slopes. */
static skg_status add_channel(skg_job *job, const skg_frame_work *work, const skg_pass *pass, slopes_work *w,
                              int64_t channel, double *values) {
    struct skg_gradient_work *gradient = job->gradient;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows, fine = pass->fine;
    double *image = gradient->derivative + channel * (rows / fine) * (columns / fine);
    SKG_TRY(scatter(job, w, values));
    SKG_TRY(add_edges(job, w, values));
    if (gradient->direction.source || gradient->direction.detector)
        SKG_TRY(add_rays(job, work, pass, w->of_view, values));
    for (int64_t r = 0; r < rows; r++) {
        double *to = image + r / fine * (columns / fine);
        const double *from = values + r * columns;
        for (int64_t c = 0, pixel = 0; c < columns; pixel++)
            for (const int64_t end = c + fine; c < end; c++) to[pixel] += from[c];
    }
    return SKG_OK;
}

/* Parts whose weights are needed: those that move, and all that compete if one of them does. */
static void find_weighed(const skg_pass *pass, const uint8_t *moves, uint8_t *weighed) {
    const skg_priority *priority = &pass->priority;
    int competes = 0;
    for (int64_t s = 0; s < priority->count; s++) competes |= moves[priority->parts[s]];
    for (int64_t p = 0; p < pass->scene->count; p++) weighed[p] = moves[p];
    for (int64_t s = 0; competes && s < priority->count; s++) weighed[priority->parts[s]] = 1;
}

skg_status skg_derivative_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                   const skg_pass *pass, const skg_sums *sums, double factor) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_direction *direction = &gradient->direction;
    double *values = NULL;
    uint8_t *weighed = NULL;
    skg_velocities v = {.vertices = NULL};
    slopes_work w = {.pass = pass, .of_view = &v, .direction = direction};
    skg_status status = SKG_OK;
    find_source(job->recipe, work->view, number, direction, v.source);
    if (direction->detector) memcpy(v.detector, direction->detector, sizeof v.detector);
    if (pass->camera.parallel) find_beam(work->view, &pass->camera, direction, &v);
    SKG_TRY_CLEANUP(
        skg_alloc(pass->camera.rows * pass->camera.columns, sizeof *values, "derivative", &values));
    SKG_TRY_CLEANUP(skg_alloc(pass->scene->count, 1, "derivative", &weighed));
    SKG_TRY_CLEANUP(find_slopes(job, &w));
    find_weighed(pass, w.moves, weighed);
    for (int64_t c = 0; c < job->recipe->model.channels; c++) {
        const int by_view = (direction->source || direction->detector) && !pass->camera.parallel;
        const skg_weights_wanted wanted = {.factor = factor,
                                           .channel = (int32_t)c,
                                           .rays = by_view ? SKG_RAYS_PLANES : SKG_RAYS_NONE,
                                           .parts = weighed};
        SKG_TRY_CLEANUP(skg_gradient_weigh(job, pass, sums, &wanted));
        SKG_TRY_CLEANUP(add_channel(job, work, pass, &w, c, values));
        SKG_TRY_CLEANUP(skg_derivative_add_changes(job, pass, sums, factor, c));
    }
cleanup:
    release_slopes(&w);
    skg_free(&weighed);
    skg_free(&values);
    return status;
}
