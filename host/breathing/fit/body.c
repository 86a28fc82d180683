/* The body that a fit moves, from a scene file. */
#include "fit/types.h"

#include "body/links.h"
#include "core/maths.h"
#include "scene/scene.h"
#include "setup/types.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Samples of a goal: with more vertices only every step-th one is used. A choice: twice as many change the fitted parameters
 * by less than their sigma. */
enum { SAMPLES = 4000 };

/* The vertices of a scene's part as its file has them. */
static skg_status copy_mesh(const skg_mesh *mesh, skg_mesh **copy) {
    int64_t vertices, triangles;
    double *positions = NULL;
    int32_t *corners = NULL;
    const char *name;
    skg_status status;
    SKG_TRY_CLEANUP(skg_mesh_name_get(mesh, &name));
    SKG_TRY_CLEANUP(skg_mesh_count(mesh, &vertices, &triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * vertices, sizeof *positions, name, &positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * triangles, sizeof *corners, name, &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, corners, 0));
    SKG_TRY_CLEANUP(skg_mesh_create(NULL, name,
                                    &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                       .vertices = vertices,
                                                       .positions = positions,
                                                       .triangles = triangles,
                                                       .corners = corners,
                                                       .unit_mm = 1},
                                    copy));
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

/* The organ of a part, with the mesh of the scene. */
static void describe(const skg_setup *setup, const skg_fit_body *model, int64_t part, skg_organ *organ) {
    const skg_scene_part_data *from = setup->scene->parts + part;
    skg_organ_init(organ);
    organ->mesh = from->mesh;
    organ->label = from->label;
    organ->inside = from->inside < 0 ? -1 : model->organ[from->inside];
    skg_setup_describe_organ(&setup->breathing, part, organ);
}

static int is_simple(skg_role role) {
    return role == ROLE_RIB || role == ROLE_STERNUM || role == ROLE_DIAPHRAGM || role == ROLE_LINKED;
}

static int is_labelled(const skg_organ *organ, const char *word) {
    return skg_label_begins(organ->label, word);
}

/* Whether a part is needed. By the rules of labels, bones, the diaphragm and what is linked to both depend on these and on
 * the lungs alone, diaphragm and liver on bones. If a goal follows other organs, or organs have links of their own, all parts are kept. */
static int is_needed(const skg_setup *setup, const skg_fit_body *model, int64_t part, const skg_goal *goals,
                     int64_t count) {
    int number, side, is_goal = 0, keeps_all = count == 0, with_lungs = 0;
    skg_organ organ;
    for (int64_t p = 0; p < model->parts && !keeps_all; p++) {
        describe(setup, model, p, &organ);
        keeps_all = organ.link_count > 0 || organ.kind != SKG_ORGAN_BY_LABEL;
    }
    for (int64_t g = 0; g < count; g++) {
        describe(setup, model, goals[g].part, &organ);
        keeps_all |= !is_simple(skg_role_of(organ.label, &number, &side));
        is_goal |= goals[g].part == part;
        with_lungs |= !is_labelled(&organ, "diaphragm") && !is_labelled(&organ, "liver");
    }
    describe(setup, model, part, &organ);
    const skg_role role = skg_role_of(organ.label, &number, &side);
    return keeps_all || is_goal || role == ROLE_RIB || role == ROLE_STERNUM || role == ROLE_DIAPHRAGM ||
           skg_label_stays(organ.label) || (with_lungs && is_labelled(&organ, "lung"));
}

static skg_status add_part(const skg_setup *setup, skg_fit_body *model, int64_t part) {
    skg_organ organ;
    SKG_TRY(copy_mesh(setup->scene->parts[part].mesh, &model->meshes[part]));
    describe(setup, model, part, &organ);
    organ.mesh = model->meshes[part];
    return skg_body_add(model->body, &organ, &model->organ[part]);
}

/* Adds what a part lies in before the part. */
static skg_status add_with_parents(const skg_setup *setup, skg_fit_body *model, int64_t part) {
    int64_t chain[64], length = 0;
    for (int64_t p = part; p >= 0 && model->organ[p] < 0 && length < 64; p = setup->scene->parts[p].inside)
        chain[length++] = p;
    while (length-- > 0) SKG_TRY(add_part(setup, model, chain[length]));
    return SKG_OK;
}

static skg_status fill(skg_context *context, const skg_setup *setup, const skg_goal *goals, int64_t count,
                       skg_fit_body *model) {
    skg_body_options options = setup->breathing.body;
    if (options.hysteresis > 0 || options.relaxation > 0)
        options.coupling = SKG_COUPLING_PAPER; /* as posed */
    options.hysteresis = 0;                    /* a fit compares states, not histories */
    SKG_TRY(skg_alloc(model->parts, sizeof *model->organ, "fit", &model->organ));
    SKG_TRY(skg_alloc(model->parts, sizeof(skg_mesh *), "fit", &model->meshes));
    for (int64_t p = 0; p < model->parts; p++) model->organ[p] = -1;
    SKG_TRY(skg_body_create(context, &options, &model->body));
    for (int64_t p = 0; p < model->parts; p++)
        if (is_needed(setup, model, p, goals, count)) SKG_TRY(add_with_parents(setup, model, p));
    return skg_body_link(model->body);
}

skg_status skg_fit_body_create(skg_context *context, const skg_setup *setup, const skg_goal *goals,
                               int64_t count, skg_fit_body *model) {
    *model = (skg_fit_body){.parts = setup->scene->count};
    const skg_status status = fill(context, setup, goals, count, model);
    if (status != SKG_OK) skg_fit_body_free(model);
    return status;
}

void skg_fit_body_free(skg_fit_body *model) {
    skg_body_release(&model->body);
    for (int64_t p = 0; model->meshes && p < model->parts; p++) skg_mesh_release(&model->meshes[p]);
    skg_free(&model->meshes);
    skg_free(&model->organ);
}

/* A third of the area of each triangle for each of its corners; of the vertices that are used, shares of their sum. */
static void weigh(const double *positions, int64_t triangles, const int32_t *corners, double *areas) {
    for (int64_t t = 0; t < triangles; t++) {
        const double *p[3];
        double e[3], f[3], n[3];
        for (int c = 0; c < 3; c++) p[c] = positions + 3 * (int64_t)corners[3 * t + c];
        skg_add_scaled(p[1], -1, p[0], e);
        skg_add_scaled(p[2], -1, p[0], f);
        skg_cross(e, f, n);
        for (int c = 0; c < 3; c++) areas[corners[3 * t + c]] += skg_length(n) / 6;
    }
}

static skg_status find_weights(const skg_mesh *mesh, skg_goal *goal) {
    int64_t vertices, triangles;
    double *positions = NULL, *areas = NULL, sum = 0;
    int32_t *corners = NULL;
    skg_status status;
    SKG_TRY_CLEANUP(skg_mesh_count(mesh, &vertices, &triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * vertices, sizeof *positions, "fit", &positions));
    SKG_TRY_CLEANUP(skg_alloc(vertices, sizeof *areas, "fit", &areas));
    SKG_TRY_CLEANUP(skg_alloc(3 * triangles, sizeof *corners, "fit", &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, corners, 0));
    weigh(positions, triangles, corners, areas);
    goal->step = (vertices + SAMPLES - 1) / SAMPLES;
    goal->count = (vertices + goal->step - 1) / goal->step;
    SKG_TRY_CLEANUP(skg_alloc(goal->count, sizeof *goal->weights, "fit", &goal->weights));
    for (int64_t i = 0; i < goal->count; i++) sum += goal->weights[i] = areas[i * goal->step];
    if (!(sum > 0)) status = skg_fail(SKG_ERR_MESH, "fit: a part has no area");
    for (int64_t i = 0; i < goal->count && status == SKG_OK; i++) goal->weights[i] /= sum;
cleanup:
    skg_free(&positions);
    skg_free(&areas);
    skg_free(&corners);
    return status;
}

static skg_status make_tree(skg_goal *goal) {
    int64_t vertices, triangles;
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_status status;
    SKG_TRY_CLEANUP(skg_mesh_count(goal->mesh, &vertices, &triangles));
    SKG_TRY_CLEANUP(skg_alloc(3 * vertices, sizeof *positions, "fit", &positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * triangles, sizeof *corners, "fit", &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(goal->mesh, positions, 0));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(goal->mesh, corners, 0));
    SKG_TRY_CLEANUP(skg_tree_create("fit", positions, triangles, corners, &goal->tree));
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

skg_status skg_goal_prepare(const skg_setup *setup, skg_goal *goal) {
    SKG_TRY(find_weights(setup->scene->parts[goal->part].mesh, goal));
    return make_tree(goal);
}

void skg_goal_free(skg_goal *goal) {
    skg_mesh_release(&goal->mesh);
    skg_tree_free(&goal->tree);
    skg_free(&goal->weights);
}

skg_status skg_fit_body_pose(skg_fit_body *model, const skg_goal *goal) {
    return skg_body_pose(model->body, &goal->state);
}

void skg_fit_body_distances(const skg_fit_body *model, const skg_goal *goal, double *distances) {
    const skg_body_organ *organ = model->body->organ + model->organ[goal->part];
    for (int64_t i = 0; i < goal->count; i++) {
        double p[3];
        const int64_t vertex = i * goal->step;
        skg_add_scaled(organ->rest + 3 * vertex, 1, organ->moved + 3 * vertex, p);
        distances[i] = sqrt(skg_tree_nearest(&goal->tree, p, HUGE_VAL, NULL));
    }
}

skg_status skg_fit_body_error(skg_fit_body *model, const skg_goal *goals, int64_t count, double *square) {
    *square = 0;
    for (int64_t g = 0; g < count; g++) {
        const skg_goal *goal = goals + g;
        double *distances;
        if (g == 0 || goal->state.phase != goals[g - 1].state.phase) SKG_TRY(skg_fit_body_pose(model, goal));
        SKG_TRY(skg_alloc(goal->count, sizeof *distances, "fit", &distances));
        skg_fit_body_distances(model, goal, distances);
        for (int64_t i = 0; i < goal->count; i++)
            *square += goal->weights[i] * distances[i] * distances[i] / (double)count;
        skg_free(&distances);
    }
    return SKG_OK;
}
