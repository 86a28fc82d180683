/* The gradient of a pass: weights of its pixels, and what faces and edges gather of them. */
#include "gradient/pass.h"

#include "core/maths.h"
#include "gradient/adjoint.h"
#include "gradient/density.h"
#include "gradient/faces.h"
#include "gradient/nodes.h"
#include "spectral/model.h"

#include <string.h>

/* Adds the sums of every part to its twist, and to those of all parts. */
static void add_sums(int64_t parts, const skg_force_sums *sums, double *poses, skg_force_sums *all) {
    for (int64_t p = 0; p < parts; p++)
        for (int k = 0; k < 3; k++) {
            poses[6 * p + k] += sums[p].force[k];
            poses[6 * p + 3 + k] += sums[p].torque[k];
            all->force[k] += sums[p].force[k];
            all->along[k] += sums[p].along[k];
            all->pixel_torque[k] += sums[p].pixel_torque[k];
        }
}

/* --- source and detector */

/* Derivatives by where the rays of a pass come from and go to: the sample of the source, and the twist of the pixels. */
typedef struct {
    double source[3], detector[6];
} ends;

/* With a parallel beam, what turns the beam: dd = P (d centre - d source) with the projector P across the beam d. */
static void add_parallel(const skg_view *view, const skg_camera *camera, const skg_force_sums *all, ends *e) {
    const double *d = camera->first;
    const double share = skg_dot(all->along, d) / skg_dot(d, d);
    double push[3], turn[3], ratio = 1;
    skg_add_scaled(all->along, -share, d, push);
    skg_cross(view->centre, push, turn);
    const int infinite = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    if (infinite) ratio = -skg_length(d) / skg_length(view->source);
    for (int k = 0; k < 3; k++) {
        e->source[k] += ratio * push[k];
        e->detector[k] -= all->force[k] + (infinite ? 0 : push[k]);
        e->detector[3 + k] -= all->pixel_torque[k] + (infinite ? 0 : turn[k]);
    }
}

/* The lengths of the rays change, too: those of all paths as |D|, and with the falloff the intensities as 1 / |D|^3. sums: over rays
 * (kernels/gradient/weights.cl) */
static void add_ray_lengths(const skg_camera *camera, const double sums[SKG_RAY_SUMS], ends *e) {
    double all[3], turn[3];
    for (int k = 0; k < 3; k++)
        all[k] = sums[0] * camera->first[k] + sums[1] * camera->column[k] + sums[2] * camera->row[k];
    /* The pixel is source + ray, so that its lever is that of the source. */
    skg_cross(camera->origin, all, turn);
    for (int k = 0; k < 3; k++) {
        e->source[k] -= all[k];
        e->detector[k] += all[k];
        e->detector[3 + k] += turn[k];
    }
}

/* Adds the derivative of a factor distance^power, with the distance of the detector's plane from a point. way: from there to a point
 * of the plane. */
static void add_distance(const skg_camera *camera, const double *from, const double way[3], double power,
                         ends *e) {
    double normal[3], turn[3];
    skg_cross(camera->column, camera->row, normal);
    const double share = power / skg_dot(way, normal);
    skg_cross(from, normal, turn);
    for (int k = 0; k < 3; k++) {
        e->source[k] -= share * normal[k];
        e->detector[k] += share * normal[k];
        e->detector[3 + k] += share * turn[k];
    }
}

/* The view with its source moved along axis `way` 0 to 2, or its detector by entry way - 3 of a twist. */
static void move_view(const skg_view *view, int way, double step, skg_view *moved) {
    double axis[3] = {0};
    *moved = *view;
    axis[way % 3] = step;
    for (int k = 0; k < 3; k++) {
        if (way < 3) moved->source[k] += axis[k];
        if (way >= 3 && way < 6) moved->centre[k] += axis[k];
    }
    if (way < 6) return;
    double turned[3];
    const double *const from[3] = {view->centre, view->column_step, view->row_step};
    double *const to[3] = {moved->centre, moved->column_step, moved->row_step};
    for (int v = 0; v < 3; v++) {
        skg_cross(axis, from[v], turned);
        skg_add_scaled(from[v], 1, turned, to[v]);
    }
}

/* Adds the derivatives by the view's source and detector. A sample of the source moves with the source, and turns with the line to
 * the detector's centre: by differences, since the spot is small against the distance. */
static void add_ends(const skg_recipe *recipe, const skg_view *view, int64_t number, const ends *e,
                     double total[9]) {
    const skg_samples *samples = &recipe->samples;
    const int is_point =
        number < 0 || samples->spot.shape == SKG_SPOT_POINT || view->projection != SKG_PROJECTION_POINT;
    const int64_t sample = number * samples->fine * samples->fine;
    for (int way = 0; way < 9; way++) {
        const double step = way < 6 ? 1e-2 : 1e-5;
        double ahead[3], behind[3], shift[2];
        skg_view moved;
        if (way >= 3) total[way] += e->detector[way - 3];
        if (is_point && way < 3) total[way] += e->source[way];
        if (is_point) continue;
        move_view(view, way, step, &moved);
        skg_samples_at(samples, &moved, sample, ahead, shift);
        move_view(view, way, -step, &moved);
        skg_samples_at(samples, &moved, sample, behind, shift);
        for (int k = 0; k < 3; k++) total[way] += e->source[k] * (ahead[k] - behind[k]) / (2 * step);
    }
}

/* intensity: result: the sum over rays of the derivatives by the logarithm of the intensity */
static skg_status add_point(skg_job *job, const skg_pass *pass, const skg_force_sums *all, ends *e,
                            double *intensity) {
    const skg_camera *camera = &pass->camera;
    double sums[SKG_RAY_SUMS];
    for (int k = 0; k < 3; k++) {
        e->source[k] -= all->force[k] - all->along[k];
        e->detector[k] -= all->along[k];
        e->detector[3 + k] -= all->pixel_torque[k];
    }
    SKG_TRY(skg_gradient_read_ray_sums(pass, skg_gradient_of(job)->memory, &job->staging, sums));
    add_ray_lengths(camera, sums, e);
    *intensity = sums[3];
    if (job->machine->images.falloff) add_distance(camera, camera->origin, camera->first, 3 * *intensity, e);
    return SKG_OK;
}

static skg_status add_view(skg_job *job, const skg_frame_work *work, int64_t number, const skg_pass *pass,
                           const skg_force_sums *all) {
    const skg_recipe *recipe = job->recipe;
    double *total = skg_gradient_of(job)->view, intensity = 0, way[3];
    ends e = {0}, photons = {0};
    if (pass->camera.parallel) {
        add_parallel(work->view, &pass->camera, all, &e);
        add_ends(recipe, work->view, number, &e, total);
        return SKG_OK;
    }
    SKG_TRY(add_point(job, pass, all, &e, &intensity));
    add_ends(recipe, work->view, number, &e, total);
    if (!recipe->absolute || skg_quantity_is_ratio(&recipe->options)) return SKG_OK;
    /* The photons of a pixel go with the inverse square of the distance. */
    skg_add_scaled(work->view->centre, -1, work->view->source, way);
    add_distance(&pass->camera, work->view->source, way, -2 * intensity, &photons);
    add_ends(recipe, work->view, -1, &photons, total);
    return SKG_OK;
}

/* --- a pass */

static skg_status check_places(const skg_pass *pass) {
    for (int64_t p = 0; pass->kernels.source_plane && p < pass->scene->count; p++)
        if (pass->extents[p].near_source)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "gradient: part %s reaches the plane of the source, where gradients are not "
                            "computed; move the part or the source",
                            pass->scene->parts[p].label);
    return SKG_OK;
}

skg_status skg_gradient_weigh(skg_job *job, const skg_pass *pass, const skg_sums *sums,
                              const skg_weights_wanted *wanted) {
    skg_machine *machine = job->machine;
    skg_attenuation attenuation = machine->images;
    SKG_TRY(check_places(pass));
    memcpy(attenuation.window, pass->window, sizeof attenuation.window);
    if (wanted->channel < 0) SKG_TRY(skg_adjoint_send(job, skg_gradient_of(job)->adjoint));
    SKG_TRY(skg_gradient_reserve(pass, job->recipe->model.planes, skg_gradient_of(job)->memory));
    return skg_gradient_transpose(machine->attenuator, pass, sums, &attenuation, wanted,
                                  skg_gradient_of(job)->memory, &job->staging);
}

/* Gathers with the parts as `drawn` has them. The tables of the pass are put back. */
static skg_status gather(skg_job *job, const skg_pass *pass, const skg_surroundings *around,
                         skg_geometry_part *drawn, skg_gathered *gathered) {
    skg_machine *machine = job->machine;
    skg_geometry *geometry = &machine->geometry;
    const int64_t state = geometry->state;
    skg_pass other = *pass;
    other.parts = drawn;
    if (drawn != pass->parts)
        SKG_TRY(skg_geometry_weigh(machine->context, geometry, &pass->camera, drawn, pass->scale.scale));
    SKG_TRY(skg_gradient_gather(&other, geometry, &machine->hits, around, skg_gradient_of(job)->memory,
                                &job->staging, gathered));
    const skg_status status =
        drawn == pass->parts
            ? SKG_OK
            : skg_geometry_weigh(machine->context, geometry, &pass->camera, pass->parts, pass->scale.scale);
    if (status != SKG_OK) skg_gradient_close(pass, skg_gradient_of(job)->memory);
    geometry->state = state; /* the sums of the pass stand as before */
    return status;
}

/* Everything but the densities that need path lengths. */
static skg_status add_gathered(skg_job *job, const skg_frame_work *work, int64_t number, const skg_pass *pass,
                               const skg_surroundings *around, skg_geometry_part *drawn,
                               skg_force_sums *of_parts) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    skg_gathered gathered;
    skg_force_sums all = {0};
    SKG_TRY(gather(job, pass, around, drawn, &gathered));
    skg_status status = skg_gradient_add_faces(job, pass, &gathered, gradient->wanted.vertices, of_parts);
    if (status == SKG_OK && around) skg_gradient_add_densities(job, work, pass, around, &gathered, of_parts);
    skg_gradient_close(pass, skg_gradient_of(job)->memory);
    SKG_TRY(status);
    add_sums(pass->scene->count, of_parts, gradient->poses, &all);
    return gradient->wanted.source || gradient->wanted.detector ? add_view(job, work, number, pass, &all)
                                                                : SKG_OK;
}

skg_status skg_gradient_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                 const skg_pass *pass, const skg_sums *sums, double factor) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    skg_force_sums *of_parts = NULL;
    skg_geometry_part *drawn = pass->parts;
    skg_surroundings around;
    const int by_view = (gradient->wanted.source || gradient->wanted.detector) && !pass->camera.parallel;
    const skg_weights_wanted of_parts_and_rays = {
        .factor = factor, .channel = -1, .rays = by_view ? SKG_RAYS_SUMS : SKG_RAYS_NONE};
    SKG_TRY(skg_gradient_weigh(job, pass, sums, &of_parts_and_rays));
    if (gradient->wanted.densities) SKG_TRY(skg_gradient_find_surroundings(job, pass, &around, &drawn));
    SKG_TRY(skg_gradient_draw_competitors(job, pass, &drawn));
    SKG_TRY(skg_alloc(pass->scene->count, sizeof *of_parts, "gradient", &of_parts));
    const skg_status status =
        add_gathered(job, work, number, pass, gradient->wanted.densities ? &around : NULL, drawn, of_parts);
    skg_free(&of_parts);
    SKG_TRY(status);
    if (gradient->wanted.densities && skg_gradient_needs_lengths(gradient, pass->scene->count)) {
        const skg_weights_wanted of_planes = {.factor = factor, .channel = -1, .of = SKG_WEIGHTS_OF_PLANES};
        SKG_TRY(skg_gradient_weigh(job, pass, sums, &of_planes));
        SKG_TRY(skg_gradient_keep_planes(job, pass));
    }
    if (!gradient->wanted.attenuations) return SKG_OK;
    memset(gradient->needs_lengths, 1, (size_t)pass->scene->count);
    return skg_gradient_keep_nodes(job, pass, sums, factor);
}
