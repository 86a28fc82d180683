/* The derivative of a pass along a direction, added to the image of derivatives. */
#include "gradient/direction_pass.h"

#include "core/maths.h"
#include "gradient/direction_density.h"
#include "gradient/direction_slopes.h"
#include "gradient/faces.h"
#include "gradient/pass.h"
#include "plan/decisions.h"
#include "spectral/model.h"

#include <math.h>
#include <string.h>

/* The velocity of a sample of the source: by differences, as in pass.c. */
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

/* One pass, with its weights on the device. */
typedef struct {
    skg_job *job;
    const skg_frame_work *work;
    const skg_pass *pass;
    skg_moving_parts moving;
    skg_pass_direction *directions; /* of moving */
    skg_geometry_part *drawn;       /* [parts] as the kernels gather them */
    uint8_t *weighed;               /* [parts] whose weights are needed */
    double *rays;         /* [rows][columns] if pixels have several rays, or scales of their own; else NULL */
    skg_seen_lines lines; /* faces that are seen as lines along a direction */
    double *exponents;    /* [rows][stride] of the powers of two that rays are over; NULL: none are */
    double *values; /* the same along one direction, which is added to: rays, or a channel of the image */
} pass_run;

/* Adds the faces that are seen as lines, with the weights that stand on the device. */
static skg_status add_edges(pass_run *r, int64_t direction) {
    skg_moving_parts *moving = &r->moving;
    for (int64_t p = 0; r->lines.any && p < r->pass->scene->count; p++) {
        const skg_face_moments *faces = &moving->faces[p];
        if (!moving->moves_now[p] || r->drawn[p].contributions == 0) continue;
        const skg_velocities v = skg_moving_velocities(moving, direction, p);
        for (int64_t f = 0; f < faces->mesh->triangles; f++) {
            if (!r->lines.faces[moving->first[p] + f]) continue;
            SKG_TRY(skg_edge_weights_read(r->job, p, &moving->of_edges));
            SKG_TRY(skg_slopes_spread(faces, &v, f, r->values));
        }
    }
    return SKG_OK;
}

/* Whether the rays themselves change their lengths. */
static int changes_rays(const pass_run *r, int64_t direction) {
    const skg_direction *d = r->directions[direction].direction;
    return (d->source || d->detector) && !r->pass->camera.parallel;
}

/* Adds the changes besides those of lengths: those of whole rays, the falloff, and the photons of an absolute beam. */
static skg_status add_rays(pass_run *r, int64_t direction) {
    const skg_job *job = r->job;
    const skg_recipe *recipe = job->recipe;
    const skg_pass *pass = r->pass;
    const skg_camera *camera = &pass->camera;
    const skg_view *view = r->work->view;
    const skg_velocities *v = &r->directions[direction].of_view;
    const double *source = r->directions[direction].direction->source;
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int falls = job->machine->images.falloff;
    static const double none[3] = {0};
    double *rays = NULL, all = 0, way[3];
    skg_add_scaled(view->centre, -1, view->source, way);
    if (falls) all += 3 * skg_slope_of_distance(camera, v, camera->origin, camera->first, v->source);
    if (recipe->absolute && !skg_quantity_is_ratio(&recipe->options))
        all -= 2 * skg_slope_of_distance(camera, v, view->source, way, source ? source : none);
    SKG_TRY(skg_alloc(2 * layout.plane, sizeof *rays, "derivative", &rays));
    const skg_status status = skg_gradient_read(pass, skg_gradient_of(r->job)->memory->weights.memory,
                                                layout.planes * layout.plane, 2 * layout.plane, rays);
    for (int64_t row = 0; row < camera->rows && status == SKG_OK; row++)
        for (int64_t c = 0; c < camera->columns; c++) {
            const double *at = rays + row * layout.stride + c;
            double ray[3];
            for (int k = 0; k < 3; k++)
                ray[k] = camera->first[k] + (double)c * camera->column[k] + (double)row * camera->row[k];
            r->values[row * camera->columns + c] +=
                (at[0] - (falls ? 3 : 0) * at[layout.plane]) * skg_slope_of_ray(camera, v, ray) +
                all * at[layout.plane];
        }
    skg_free(&rays);
    return status;
}

/* Adds up the slopes of hits with the parts as they are drawn. The tables of the pass are put back. */
static skg_status scatter(pass_run *r, double largest) {
    const skg_pass *pass = r->pass;
    skg_machine *machine = r->job->machine;
    skg_geometry *geometry = &machine->geometry;
    const int64_t state = geometry->state;
    const double scale = pass->scale.scale;
    skg_pass other = *pass;
    other.parts = r->drawn;
    if (r->drawn != pass->parts)
        SKG_TRY(skg_geometry_weigh(machine->context, geometry, &pass->camera, r->drawn, scale));
    SKG_TRY(skg_gradient_scatter(&other, geometry, &machine->hits, skg_gradient_of(r->job)->memory,
                                 &r->job->staging, r->moving.moves_now, largest, &r->lines, r->values));
    if (r->drawn != pass->parts)
        SKG_TRY(skg_geometry_weigh(machine->context, geometry, &pass->camera, pass->parts, scale));
    geometry->state = state; /* the sums of the pass stand as before */
    return SKG_OK;
}

/* Reads by which power of two the weights of each ray are divided. */
static skg_status read_exponents(pass_run *r) {
    const skg_weight_layout layout = skg_attenuate_weight_layout(r->pass->main.raster, r->pass->fine);
    if (!r->exponents) SKG_TRY(skg_alloc(layout.plane, sizeof *r->exponents, "derivative", &r->exponents));
    return skg_gradient_read(r->pass, skg_gradient_of(r->job)->memory->weights.memory,
                             (layout.planes + 2) * layout.plane, layout.plane, r->exponents);
}

/* Gives the rays their own scales back. */
static void scale_rays(pass_run *r) {
    const int64_t columns = r->pass->camera.columns, rows = r->pass->camera.rows;
    const skg_weight_layout layout = skg_attenuate_weight_layout(r->pass->main.raster, r->pass->fine);
    for (int64_t row = 0; row < rows; row++)
        for (int64_t c = 0; c < columns; c++) {
            double *ray = r->rays + row * columns + c;
            if (*ray != 0) *ray = ldexp(*ray, (int)r->exponents[row * layout.stride + c]);
        }
}

/* Adds the rays to the pixels of an image. */
static void add_pixels(const pass_run *r, double *image) {
    const int64_t columns = r->pass->camera.columns, rows = r->pass->camera.rows, fine = r->pass->fine;
    for (int64_t row = 0; row < rows; row++) {
        double *to = image + row / fine * (columns / fine);
        const double *from = r->rays + row * columns;
        for (int64_t c = 0, pixel = 0; c < columns; pixel++)
            for (const int64_t end = c + fine; c < end; c++) to[pixel] += from[c];
    }
}

/* One channel of the intensities along one direction. The loss is the channel itself, so that the weights of a ray are its own slopes. */
static skg_status add_direction(pass_run *r, int64_t direction, int64_t channel) {
    skg_derivative_work *of = &skg_gradient_of(r->job)->directions[direction];
    const skg_camera *camera = &r->pass->camera;
    double *image = of->image + channel * r->job->recipe->view.rows * r->job->recipe->view.columns;
    double largest = 0;
    int64_t saturated = 0;
    SKG_TRY(skg_slopes_make(r->job, &r->moving, direction, &largest, &saturated));
    if (channel == 0) of->saturated += saturated;
    r->values = r->rays ? r->rays : image;
    if (r->rays) memset(r->rays, 0, (size_t)(camera->rows * camera->columns) * sizeof *r->rays);
    SKG_TRY(scatter(r, largest));
    SKG_TRY(add_edges(r, direction));
    if (changes_rays(r, direction)) SKG_TRY(add_rays(r, direction));
    if (r->exponents) scale_rays(r);
    if (r->rays) add_pixels(r, image);
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

static skg_status find_directions(pass_run *r, int64_t number) {
    const skg_job *job = r->job;
    const skg_camera *camera = &r->pass->camera;
    const int64_t count = skg_gradient_of(r->job)->direction_count;
    SKG_TRY(skg_alloc(count, sizeof *r->directions, "derivative", &r->directions));
    for (int64_t d = 0; d < count; d++) {
        const skg_direction *direction = &skg_gradient_of(r->job)->directions[d].direction;
        skg_velocities *v = &r->directions[d].of_view;
        r->directions[d].direction = direction;
        find_source(job->recipe, r->work->view, number, direction, v->source);
        if (direction->detector) memcpy(v->detector, direction->detector, sizeof v->detector);
        if (camera->parallel) find_beam(r->work->view, camera, direction, v);
    }
    return skg_moving_parts_create(r->job, r->pass, count, r->directions, &r->moving);
}

/* The weights of a channel, then all directions. */
static skg_status add_channel(pass_run *r, const skg_sums *sums, double factor, int64_t channel) {
    const int64_t count = skg_gradient_of(r->job)->direction_count;
    skg_weights_wanted wanted = {.factor = factor,
                                 .channel = (int32_t)channel,
                                 .relative = skg_decide_late_logarithm(r->job->recipe),
                                 .parts = r->weighed};
    for (int64_t d = 0; d < count; d++)
        if (changes_rays(r, d)) wanted.rays = SKG_RAYS_PLANES;
    SKG_TRY(skg_gradient_weigh(r->job, r->pass, sums, &wanted));
    if (wanted.relative) SKG_TRY(read_exponents(r));
    for (int64_t d = 0; d < count; d++) SKG_TRY(add_direction(r, d, channel));
    skg_edge_weights_clear(&r->moving.of_edges);
    return skg_derivative_add_changes(r->job, r->pass, sums, factor, channel);
}

skg_status skg_derivative_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                   const skg_pass *pass, const skg_sums *sums, double factor) {
    pass_run r = {.job = job, .work = work, .pass = pass, .drawn = pass->parts};
    skg_status status = SKG_OK;
    if (pass->fine > 1 || skg_decide_late_logarithm(job->recipe))
        SKG_TRY_CLEANUP(
            skg_alloc(pass->camera.rows * pass->camera.columns, sizeof *r.rays, "derivative", &r.rays));
    SKG_TRY_CLEANUP(skg_alloc(pass->scene->count, 1, "derivative", &r.weighed));
    SKG_TRY_CLEANUP(skg_alloc(job->machine->geometry.triangles, 1, "derivative", &r.lines.faces));
    SKG_TRY_CLEANUP(find_directions(&r, number));
    SKG_TRY_CLEANUP(skg_gradient_draw_competitors(job, pass, &r.drawn));
    find_weighed(pass, r.moving.moves, r.weighed);
    for (int64_t c = 0; c < job->recipe->model.channels; c++)
        SKG_TRY_CLEANUP(add_channel(&r, sums, factor, c));
cleanup:
    skg_moving_parts_release(&r.moving);
    skg_free(&r.directions);
    skg_free(&r.weighed);
    skg_free(&r.rays);
    skg_free(&r.exponents);
    skg_free(&r.lines.faces);
    return status;
}
