/* Images of a registration's scenes, and their derivatives. */
#include "registration/types.h"

#include <stdlib.h>
#include <string.h>

skg_status reg_plan_create(const skg_registration *r, skg_scene *scene, skg_spectrum *spectrum,
                           const skg_view *view, int64_t supersampling, skg_plan **plan) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.precision = r->plan.precision == SKG_PRECISION_HALF ? SKG_PRECISION_SINGLE : r->plan.precision;
    options.strategy = r->plan.strategy;
    options.repair = r->plan.repair;
    options.clip = r->plan.clip;
    options.unite = r->plan.unite;
    options.world = r->plan.world;
    options.response = r->plan.response;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.overlaps = 0;
    options.falloff = SKG_FALLOFF_OFF;
    options.tolerance = 1e-3; /* of many energies: only to choose one */
    options.supersampling = (int32_t)supersampling;
    return skg_plan_create(r->context, scene, view, spectrum, &options, plan);
}

/* Poses of the parts that move, behind a motion: [count][16]. */
static skg_status place(const reg_scene *scene, const double *motion, double *poses) {
    skg_part part;
    skg_part_init(&part);
    for (int64_t p = 0; p < scene->count; p++) {
        SKG_TRY(skg_scene_part_get(scene->scene, scene->parts[p], &part));
        skg_pose_multiply(motion, part.pose, poses + 16 * p);
    }
    return SKG_OK;
}

/* Waits for a job. A path length outside of the verified range is none of one energy; pixels that are not finite are. */
static skg_status finish(skg_job **job) {
    const skg_status status = skg_job_wait(job);
    return status == SKG_RANGE ? SKG_OK : status;
}

/* Frames of one plan: view f and motion f. Either may be NULL: the plan's, the start's. */
static skg_status draw(skg_registration *r, skg_plan *plan, const reg_scene *scene, int64_t count,
                       const skg_view *views, const double *const *motions, float *images) {
    skg_frame *frames = NULL;
    double *poses = NULL;
    skg_job *job = NULL;
    skg_output output;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *frames, "frames of a registration", &frames));
    SKG_TRY_CLEANUP(skg_alloc(count * scene->count * 16, sizeof *poses, "poses of a registration", &poses));
    for (int64_t f = 0; f < count; f++) {
        skg_frame_init(&frames[f]);
        if (views) frames[f].view = &views[f];
        if (!motions || scene->count == 0) continue;
        SKG_TRY_CLEANUP(place(scene, motions[f], poses + 16 * scene->count * f));
        frames[f].pose_count = scene->count;
        frames[f].pose_parts = scene->parts;
        frames[f].poses = poses + 16 * scene->count * f;
    }
    skg_output_init(&output);
    output.data = images;
    SKG_TRY_CLEANUP(skg_plan_submit(plan, count, frames, 1, &output, &job));
    SKG_TRY_CLEANUP(finish(&job));
    r->result.images += count;
cleanup:
    skg_free(&frames);
    skg_free(&poses);
    return status;
}

skg_status reg_render_once(skg_registration *r, const reg_scene *scene, skg_spectrum *spectrum,
                           const skg_view *view, int64_t supersampling, const double *motion, double *image) {
    const int64_t count = view->rows * view->columns;
    skg_plan *plan = NULL;
    float *values = NULL;
    int64_t parts = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_scene_part_count(scene->scene, &parts));
    if (parts == 0) { /* nothing but what moves */
        memset(image, 0, (size_t)count * sizeof *image);
        return SKG_OK;
    }
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *values, "image of a registration", &values));
    SKG_TRY_CLEANUP(
        reg_plan_create(r, scene->scene, spectrum ? spectrum : r->model, view, supersampling, &plan));
    SKG_TRY_CLEANUP(draw(r, plan, scene, 1, NULL, motion ? &motion : NULL, values));
    for (int64_t p = 0; p < count; p++) image[p] = (double)values[p];
cleanup:
    skg_plan_release(&plan);
    skg_free(&values);
    return status;
}

/* Radiographs that share a plan follow each other in one submission. */
static skg_status render_group(skg_registration *r, const reg_level *level, const reg_state *state,
                               int64_t first, float **images) {
    const reg_shrunk *shrunk = &level->images[first];
    const int64_t size = shrunk->rows * shrunk->columns;
    skg_view *views = NULL;
    const double **motions = NULL;
    int64_t *members = NULL, count = 0;
    float *values = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(r->image_count, sizeof *views, "views", &views));
    SKG_TRY_CLEANUP(skg_alloc(r->image_count, sizeof *motions, "motions", &motions));
    SKG_TRY_CLEANUP(skg_alloc(r->image_count, sizeof *members, "radiographs", &members));
    for (int64_t i = first; i < r->image_count; i++) {
        if (level->images[i].plan != shrunk->plan) continue;
        views[count] = reg_view_shrunk(&state->views[i], level->factor);
        motions[count] = state->motion;
        members[count++] = i;
    }
    SKG_TRY_CLEANUP(skg_alloc(count * size, sizeof *values, "images of a registration", &values));
    SKG_TRY_CLEANUP(draw(r, shrunk->plan, &r->body, count, views, motions, values));
    for (int64_t m = 0; m < count; m++)
        memcpy(images[members[m]], values + m * size, (size_t)size * sizeof *values);
cleanup:
    skg_free(&views);
    skg_free(&motions);
    skg_free(&members);
    skg_free(&values);
    return status;
}

skg_status reg_render(skg_registration *r, const reg_level *level, const reg_state *state, float **images) {
    for (int64_t i = 0; i < r->image_count; i++) {
        int is_first = 1;
        for (int64_t j = 0; j < i; j++) is_first = is_first && level->images[j].plan != level->images[i].plan;
        if (is_first) SKG_TRY(render_group(r, level, state, i, images));
    }
    return SKG_OK;
}

skg_status reg_render_poses(skg_registration *r, const reg_shrunk *shrunk, const skg_view *view,
                            int64_t count, const double *motions, float *images) {
    skg_view *views = NULL;
    const double **each = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *views, "views", &views));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *each, "motions", &each));
    for (int64_t f = 0; f < count; f++) {
        views[f] = *view;
        each[f] = motions + 16 * f;
    }
    SKG_TRY_CLEANUP(draw(r, shrunk->plan, &r->body, count, views, each, images));
cleanup:
    skg_free(&views);
    skg_free(&each);
    return status;
}

skg_status reg_differentiate(skg_registration *r, const reg_level *level, const reg_state *state,
                             int64_t image, double *derivatives) {
    const int64_t count = reg_local_count(r);
    const skg_view view = reg_view_shrunk(&state->views[image], level->factor);
    skg_direction directions[REG_LOCAL];
    double *poses = NULL, *placed = NULL, source[REG_LOCAL][3], detector[REG_LOCAL][6];
    int64_t parts = 0;
    skg_frame frame;
    skg_output output;
    skg_status status = SKG_OK;
    SKG_TRY(skg_scene_part_count(r->body.scene, &parts));
    SKG_TRY_CLEANUP(skg_alloc(count * 6 * parts, sizeof *poses, "directions", &poses));
    SKG_TRY_CLEANUP(skg_alloc(16 * r->body.count, sizeof *placed, "poses", &placed));
    for (int64_t k = 0; k < count; k++)
        reg_direction(r, state, image, k, &directions[k], poses + k * 6 * parts, source[k], detector[k]);
    skg_frame_init(&frame);
    frame.view = &view;
    if (r->body.count > 0) {
        SKG_TRY_CLEANUP(place(&r->body, state->motion, placed));
        frame.pose_count = r->body.count;
        frame.pose_parts = r->body.parts;
        frame.poses = placed;
    }
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64;
    output.data = derivatives;
    SKG_TRY_CLEANUP(
        skg_plan_derivatives(level->images[image].plan, &frame, count, directions, &output, NULL));
    r->result.jacobians++;
cleanup:
    skg_free(&poses);
    skg_free(&placed);
    return status;
}
