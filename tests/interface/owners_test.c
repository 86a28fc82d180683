/* A handle with two owners is there as long as one of them. */
#include "suite.h"
#include "support/run.h"

#include <skiagraph/counting.h>
#include <skiagraph/dose.h>
#include <skiagraph/volume.h>

enum { SIDE = 16 };

static skg_material *water;
static skg_scene *scene;
static skg_plan *plan;

/* A sphere of water in 60 keV. */
static void open_plan(void) {
    const skg_view view = run_view(SIDE, 10);
    skg_mesh *ball = NULL;
    skg_spectrum *beam = NULL;
    skg_part part;
    run_open();
    skg_part_init(&part);
    ck_skg(skg_mesh_create_sphere(30, 40, &ball));
    ck_skg(skg_material_create_named("water", &water));
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_scene_create(run_context, &scene));
    part.mesh = ball, part.material = water, part.label = "ball";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    ck_skg(skg_plan_create(run_context, scene, &view, beam, NULL, &plan));
    skg_spectrum_release(&beam);
    skg_mesh_release(&ball);
}

static void close_plan(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_material_release(&water);
    run_close();
}

START_TEST(of_a_counter) {
    static const double threshold = 20;
    skg_counter *counter = NULL, *other = NULL;
    skg_counting counting;
    int64_t count = 0;
    skg_counting_init(&counting);
    counting.material = water, counting.thickness_mm = 1, counting.pixel_mm[0] = counting.pixel_mm[1] = 0.1;
    counting.threshold_kev = &threshold, counting.count = 1;
    ck_skg(skg_counter_create(&counting, &counter));
    other = counter;
    ck_skg(skg_counter_retain(other));
    skg_counter_release(&counter);
    ck_assert_ptr_null(counter);
    ck_skg(skg_counter_thresholds_get(other, &count));
    ck_assert_int_eq(count, 1);
    skg_counter_release(&other);
    ck_skg_fails(skg_counter_retain(NULL), SKG_ERR_ARGUMENT, "counter");
}
END_TEST

START_TEST(of_a_volume) {
    static const double cells[8] = {0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2};
    skg_volume *volume = NULL, *other = NULL;
    skg_volume_source source;
    skg_volume_contents contents;
    skg_volume_source_init(&source);
    source.values = SKG_VOLUME_MU, source.type = SKG_VOLUME_FLOAT64;
    source.columns = source.rows = source.slices = 2;
    source.cells = cells;
    ck_skg(skg_volume_create(&source, &volume));
    other = volume;
    ck_skg(skg_volume_retain(other));
    skg_volume_release(&volume);
    skg_volume_contents_init(&contents);
    ck_skg(skg_volume_contents_get(other, &contents));
    ck_assert_int_eq(contents.slices, 2);
    skg_volume_release(&other);
    ck_skg_fails(skg_volume_retain(NULL), SKG_ERR_ARGUMENT, "volume");
}
END_TEST

START_TEST(of_a_dose) {
    skg_dose *dose = NULL, *other = NULL;
    skg_dose_options options;
    skg_dose_part part;
    skg_dose_options_init(&options);
    options.histories = 1000;
    ck_skg(skg_dose_create(plan, &options, &dose));
    other = dose;
    ck_skg(skg_dose_retain(other));
    skg_dose_release(&dose);
    skg_dose_part_init(&part);
    ck_skg(skg_dose_part_get(other, 0, &part));
    ck_assert_double_gt(part.dose_ugy, 0);
    skg_dose_release(&other);
    ck_skg_fails(skg_dose_retain(NULL), SKG_ERR_ARGUMENT, "dose");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, of_a_counter);
    tcase_add_test(tests, of_a_volume);
    tcase_add_test(tests, of_a_dose);
}

SKG_SUITE_MAIN("owners", add_tests)
