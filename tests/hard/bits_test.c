/* Equal bits by all ways: strategies, tiles, order of triangles, welded or not, alone or in a batch. */
#include "hard/scenes.h"
#include "suite.h"

#include <string.h>

enum { WAYS = 9 };
static const run_choice ways[WAYS] = {{.strategy = SKG_STRATEGY_COPIES},
                                      {.strategy = SKG_STRATEGY_ATOMICS},
                                      {.strategy = SKG_STRATEGY_TILES},
                                      {.strategy = SKG_STRATEGY_TILES, .tile = 1},
                                      {.strategy = SKG_STRATEGY_TILES, .tile = 8},
                                      {.strategy = SKG_STRATEGY_TILES, .tile = 13},
                                      {.strategy = SKG_STRATEGY_TILES, .tile = 32},
                                      {.strategy = SKG_STRATEGY_TILES, .tile = 1000},
                                      {.strategy = SKG_STRATEGY_AUTO}};

static uint64_t hash_of(const double *image, const skg_view *view) {
    return run_hash(image, view->rows * view->columns * (int64_t)sizeof *image);
}

static uint64_t lengths_hash(const solid *s, const hard_scene *h, run_choice choice) {
    double *image = run_solid(s, h->pose, &h->view, choice);
    const uint64_t hash = hash_of(image, &h->view);
    free(image);
    return hash;
}

static void check_strategies(int which) {
    hard_scene h = hard_make(which);
    for (int32_t precision = 0; precision < (run_has_double() ? 2 : 1); precision++) {
        uint64_t first = 0;
        for (int n = 0; n < WAYS; n++) {
            run_choice choice = ways[n];
            choice.precision = precision;
            const uint64_t hash = lengths_hash(&h.body, &h, choice);
            if (n == 0) first = hash;
            ck_assert_msg(hash == first, "%s: strategy %d, tile %d, precision %d differs", h.name,
                          (int)choice.strategy, (int)choice.tile, (int)precision);
        }
    }
    hard_free(&h);
}

START_TEST(strategies_and_tiles) {
    for (int which = 0; which < HARD_SCENES; which++) check_strategies(which);
}
END_TEST

static void check_order(int which) {
    hard_scene h = hard_make(which);
    solid shuffled = solid_shuffled(&h.body, 77), apart = solid_unwelded(&h.body);
    for (int32_t precision = 0; precision < (run_has_double() ? 2 : 1); precision++) {
        const run_choice choice = {.precision = precision};
        const uint64_t first = lengths_hash(&h.body, &h, choice);
        ck_assert_msg(lengths_hash(&shuffled, &h, choice) == first, "%s: shuffled, precision %d", h.name,
                      (int)precision);
        ck_assert_msg(lengths_hash(&apart, &h, choice) == first, "%s: unwelded, precision %d", h.name,
                      (int)precision);
    }
    solid_free(&shuffled);
    solid_free(&apart);
    hard_free(&h);
}

START_TEST(order_of_triangles) {
    for (int which = 0; which < HARD_SCENES; which++) check_order(which);
}
END_TEST

/* --- images of several parts ----------------------------------------------------------------------------- */

/* An envelope with a bone, a cavity and an open sheet inside. */
static skg_scene *several(void) {
    skg_scene *scene = NULL;
    solid skin = solid_blob(90, 60, 30, 1), bone = solid_torus(40, 12, 50, 24),
          hole = solid_sphere(20, 30, 15), sheet = solid_box(30, 30, 4);
    sheet.triangles -= 2;
    const double beside[16] = {0.8, 0.6, 0, 30, -0.6, 0.8, 0, 9, 0, 0, -1, 20, 0, 0, 0, 1}; /* mirrored */
    skg_mesh *meshes[4] = {run_mesh(&skin), run_mesh(&bone), run_mesh(&hole), run_mesh(&sheet)};
    ck_skg(skg_scene_create(run_context, &scene));
    const int64_t envelope = run_part(scene, "skin", meshes[0], 0.2, NULL, -1);
    run_part(scene, "bone", meshes[1], 0.55, beside, envelope);
    run_part(scene, "hole", meshes[2], 0, NULL, envelope);
    run_part(scene, "sheet", meshes[3], 0.4, NULL, envelope);
    for (int n = 0; n < 4; n++) skg_mesh_release(&meshes[n]);
    solid_free(&skin);
    solid_free(&bone);
    solid_free(&hole);
    solid_free(&sheet);
    return scene;
}

START_TEST(images_of_several_parts) {
    const skg_view view = run_view(130, 1.6);
    skg_scene *scene = several();
    for (int32_t precision = 0; precision < (run_has_double() ? 2 : 1); precision++) {
        uint64_t first = 0;
        for (int n = 0; n < WAYS; n++) {
            run_choice choice = ways[n];
            choice.precision = precision;
            skg_plan *plan = run_plan(scene, &view, choice);
            for (int again = 0; again < 2; again++) { /* a second frame finds the first one's memory */
                double *image = run_image(plan, &view);
                const uint64_t hash = hash_of(image, &view);
                if (n == 0 && !again) first = hash;
                ck_assert_msg(hash == first, "strategy %d, tile %d, precision %d, frame %d differs",
                              (int)choice.strategy, (int)choice.tile, (int)precision, again);
                free(image);
            }
            skg_plan_release(&plan);
        }
    }
    skg_scene_release(&scene);
}
END_TEST

/* Frames of a batch are those taken alone, for batches of every size up to seven and for every strategy. */
START_TEST(batches) {
    enum { FRAMES = 7, SIDE = 100 };
    skg_view views[FRAMES];
    skg_frame frames[FRAMES];
    static float alone[FRAMES][SIDE * SIDE], batch[FRAMES][SIDE * SIDE];
    skg_scene *scene = several();
    for (int n = 0; n < FRAMES; n++) {
        views[n] = run_view(SIDE, 2);
        views[n].source[0] = 40 * n;
        views[n].projection = n == 4 ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        if (n == 5) views[n].source[2] = 0; /* within: another path through the kernels */
        skg_frame_init(&frames[n]);
        frames[n].view = &views[n];
    }
    for (int n = 0; n < WAYS; n++) {
        skg_plan *plan = run_plan(scene, &views[0], ways[n]);
        skg_output output;
        skg_job *job = NULL;
        skg_output_init(&output);
        for (int f = 0; f < FRAMES; f++) {
            output.data = alone[f];
            ck_skg(skg_plan_submit(plan, 1, &frames[f], 1, &output, &job));
            ck_skg(skg_job_wait(&job));
            for (int other = 0; other < f; other++) ck_assert_mem_ne(alone[f], alone[other], sizeof alone[f]);
        }
        for (int size = 2; size <= FRAMES; size++) {
            memset(batch, 0xff, sizeof batch);
            output.data = batch;
            ck_skg(skg_plan_submit(plan, size, frames, 1, &output, &job));
            ck_skg(skg_job_wait(&job));
            for (int f = 0; f < size; f++)
                ck_assert_msg(memcmp(batch[f], alone[f], sizeof alone[f]) == 0,
                              "strategy %d, tile %d: frame %d of %d differs", (int)ways[n].strategy,
                              (int)ways[n].tile, f, size);
        }
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
}
END_TEST

/* Part of the device's compute units. */
START_TEST(one_compute_unit) {
    hard_scene h = hard_make(HARD_SLIVERS);
    const uint64_t first = lengths_hash(&h.body, &h, (run_choice){0});
    skg_context *whole = run_context;
    run_context = NULL;
    if (skg_context_create("threads=1", &run_context) == SKG_OK) /* not every device can be parted */
        for (int n = 0; n < 3; n++) ck_assert_uint_eq(lengths_hash(&h.body, &h, ways[n]), first);
    skg_context_release(&run_context);
    run_context = whole;
    hard_free(&h);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, strategies_and_tiles);
    tcase_add_test(tests, order_of_triangles);
    tcase_add_test(tests, images_of_several_parts);
    tcase_add_test(tests, batches);
    tcase_add_test(tests, one_compute_unit);
}

SKG_SUITE_MAIN("bits", add_tests)
