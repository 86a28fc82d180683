/* A plan that lives on while poses, vertices, views and materials change gives what a fresh plan gives, bit
 * for bit. */
#include "suite.h"
#include "support/random.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 96, PARTS = 4, FRAMES = 40 };

typedef struct {
    skg_context *context;
    skg_scene *scene;
    skg_mesh *meshes[PARTS];
    skg_spectrum *beam;
    skg_view view;
} world;

static double rest[PARTS][3 * 4096];

static void open_world(world *w, int energies) {
    static const double kev[3] = {40, 60, 90}, photons[3] = {10, 20, 5};
    skg_part part;
    ck_skg(skg_context_create(NULL, &w->context));
    ck_skg(skg_scene_create(w->context, &w->scene));
    ck_skg(skg_spectrum_create_bins(energies, kev, photons, &w->beam));
    for (int i = 0; i < PARTS; i++) {
        skg_material *material = NULL;
        ck_skg(skg_mesh_create_sphere(i == 0 ? 60 : 15, 24, &w->meshes[i]));
        ck_skg(skg_mesh_positions_get(w->meshes[i], rest[i], 0));
        ck_skg(skg_material_create_hounsfield(-100 + 60 * i, &material));
        skg_part_init(&part);
        part.mesh = w->meshes[i], part.material = material, part.inside = i == 0 ? -1 : 0;
        part.label = (const char *[]){"envelope", "a", "b", "c"}[i];
        part.pose[3] = i == 0 ? 0 : -30 + 15 * i;
        ck_skg(skg_scene_part_add(w->scene, &part, NULL));
        skg_material_release(&material);
    }
    skg_view_init(&w->view);
    w->view.columns = w->view.rows = SIDE;
    w->view.source[2] = -500;
    w->view.centre[2] = 200;
    w->view.column_step[0] = w->view.row_step[1] = 2;
}

static void close_world(world *w) {
    for (int i = 0; i < PARTS; i++) skg_mesh_release(&w->meshes[i]);
    skg_scene_release(&w->scene);
    skg_spectrum_release(&w->beam);
    skg_context_release(&w->context);
}

/* Something changes: a pose, the vertices of a mesh, a material, the view. */
static void change(world *w, uint64_t *seed) {
    const int part = 1 + (int)draw_below(seed, 3);
    skg_part now;
    skg_material *material = NULL;
    int64_t vertices = 0, triangles = 0;
    static double positions[3 * 4096];
    skg_part_init(&now);
    ck_skg(skg_scene_part_get(w->scene, part, &now));
    for (int k = 0; k < 3; k++) now.pose[4 * k + 3] = 40 * draw(seed, 0, 1) - 20;
    ck_skg(skg_scene_part_pose_set(w->scene, part, now.pose));
    ck_skg(skg_mesh_count(w->meshes[part], &vertices, &triangles));
    const double stretch = 0.5 + draw(seed, 0, 1);
    for (int64_t k = 0; k < 3 * vertices; k++) positions[k] = rest[part][k] * (k % 3 == 0 ? stretch : 1);
    ck_skg(skg_mesh_positions_set(w->meshes[part], positions, 0));
    ck_skg(skg_material_create_hounsfield(-900 + 2000 * draw(seed, 0, 1), &material));
    ck_skg(skg_scene_part_material_set(w->scene, part, material));
    skg_material_release(&material);
    w->view.source[0] = 100 * draw(seed, 0, 1) - 50;
}

static void take(skg_plan *plan, const world *w, float *image) {
    skg_output output;
    skg_output_init(&output);
    output.data = image;
    ck_skg(skg_plan_view_set(plan, &w->view));
    ck_skg(skg_plan_image(plan, &output));
}

START_TEST(an_old_plan_is_as_good_as_a_new_one) {
    static float old_image[SIDE * SIDE], new_image[SIDE * SIDE];
    world w;
    skg_plan *old = NULL;
    skg_plan_options options;
    uint64_t seed = 7;
    open_world(&w, _i == 0 ? 1 : 3);
    skg_plan_options_init(&options);
    options.overlaps = 0;
    ck_skg(skg_plan_create(w.context, w.scene, &w.view, w.beam, &options, &old));
    for (int frame = 0; frame < FRAMES; frame++) {
        skg_plan *fresh = NULL;
        change(&w, &seed);
        take(old, &w, old_image);
        ck_skg(skg_plan_create(w.context, w.scene, &w.view, w.beam, &options, &fresh));
        take(fresh, &w, new_image);
        skg_plan_release(&fresh);
        ck_assert_mem_eq(old_image, new_image, sizeof old_image);
    }
    skg_plan_release(&old);
    close_world(&w);
}
END_TEST

START_TEST(compressed_energies_are_stale) {
    static float image[SIDE * SIDE];
    world w;
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_output output;
    skg_material *other = NULL;
    skg_tube tube;
    open_world(&w, 3);
    skg_spectrum_release(&w.beam);
    skg_tube_init(&tube);
    tube.kvp = 60;
    ck_skg(skg_spectrum_create_tube(&tube, &w.beam));
    skg_plan_options_init(&options);
    options.tolerance = 1e-3;
    ck_skg(skg_plan_create(w.context, w.scene, &w.view, w.beam, &options, &plan));
    ck_skg(skg_material_create_named("I", &other));
    ck_skg(skg_scene_part_material_set(w.scene, 1, other));
    skg_output_init(&output);
    output.data = image;
    ck_assert_int_eq(skg_plan_image(plan, &output), SKG_STALE);
    skg_material_release(&other);
    skg_plan_release(&plan);
    close_world(&w);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, an_old_plan_is_as_good_as_a_new_one, 0, 2);
    tcase_add_test(tests, compressed_energies_are_stale);
}

SKG_SUITE_MAIN("renew", add_tests)
