/* A program of another version with this library. Compiled against headers whose structs lack their last field
 * (SKG_OLDER), as they are, and against headers whose structs have a field more, `later` (SKG_NEWER). */
#include "suite.h"

#include <float.h>
#include <skiagraph/breathing.h>
#include <skiagraph/live.h>
#include <skiagraph/registration.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 16, GUARD = 64, PATTERN = 0xA5 };

static skg_context *context;
static skg_scene *scene;
static skg_mesh *cube;
static skg_material *water;
static skg_spectrum *beam;
static skg_plan *plan;
static skg_view view;
static skg_part part;

static void check_guard(const char *name, const unsigned char *guard) {
    for (int i = 0; i < GUARD; i++) ck_assert_msg(guard[i] == PATTERN, "%s was overrun", name);
}

static void open_plan(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_mesh_create_cube(20, &cube));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
    ck_skg(skg_spectrum_create_mono(80, 1000, &beam));
    ck_skg(skg_scene_create(context, &scene));
    skg_part_init(&part);
    part.mesh = cube, part.material = water, part.label = "cube";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL;
    view.columns = view.rows = SIDE;
    view.source[2] = -100, view.centre[2] = 50;
    view.column_step[0] = view.row_step[1] = 1;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
}

static void close_plan(void) {
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_material_release(&water);
    skg_mesh_release(&cube);
    skg_context_release(&context);
}

/* skg_X_init writes the bytes that this program has, and no others. */
START_TEST(structs_are_not_overrun){
#define X(name)                                                                                              \
    {                                                                                                        \
        struct {                                                                                             \
            name whole;                                                                                      \
            unsigned char guard[GUARD];                                                                      \
        } one;                                                                                               \
        memset(&one, PATTERN, sizeof one);                                                                   \
        name##_init(&one.whole);                                                                             \
        ck_assert_int_eq(one.whole.size, (int)sizeof one.whole);                                             \
        check_guard(#name, one.guard);                                                                       \
        name##_init(NULL);                                                                                   \
    }
#include "structs.h"
#undef X
} END_TEST

    /* The library fills the fields that this program has. */
    START_TEST(results_are_not_overrun) {
    struct {
        skg_plan_report whole;
        unsigned char guard[GUARD];
    } report;
    struct {
        skg_mesh_health whole;
        unsigned char guard[GUARD];
    } health;
    memset(&report, PATTERN, sizeof report);
    memset(&health, PATTERN, sizeof health);
    skg_plan_report_init(&report.whole);
    skg_mesh_health_init(&health.whole);
    ck_skg(skg_plan_report_get(plan, &report.whole));
    ck_skg(skg_mesh_health_get(cube, &health.whole));
    check_guard("skg_plan_report", report.guard);
    check_guard("skg_mesh_health", health.guard);
    ck_assert_int_eq(report.whole.size, (int)sizeof report.whole);
    ck_assert_int_eq(report.whole.parts, 1);
    ck_assert_int_eq(health.whole.closed, 1);
    /* twelve tetrahedra are added, each with a few roundings */
    ck_assert_double_eq_tol(health.whole.volume, 8000, 64 * DBL_EPSILON * 8000);
}
END_TEST

/* Arrays step by the program's size; fields that it lacks have the library's defaults: this part has no pose of its own
 * where the struct ends before it, and its frames no fill fractions. */
START_TEST(frames_are_imaged) {
    const int64_t parts[1] = {0};
    const double ratios[2] = {1, 2};
    static float pixels[2][SIDE * SIDE];
    skg_frame frames[2];
    for (int i = 0; i < 2; i++) {
        skg_frame_init(&frames[i]);
        frames[i].override_count = 1;
        frames[i].override_parts = parts;
        frames[i].density_ratios = ratios + i;
    }
    skg_output output;
    skg_output_init(&output);
    output.data = pixels;
    skg_job *job = NULL;
    ck_skg(skg_plan_submit(plan, 2, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    /* 2 cm of 0.2/cm; float with one rounding of the exponential and one of the logarithm */
    const int middle = SIDE / 2 * SIDE + SIDE / 2;
    for (int i = 0; i < 2; i++) ck_assert_double_eq_tol((double)pixels[i][middle], 0.4 * ratios[i], 1e-6);
}
END_TEST

START_TEST(elements_are_alike) {
    static float pixels[2][SIDE * SIDE];
    skg_frame frames[2];
    skg_job *job = NULL;
    skg_output output;
    skg_output_init(&output);
    output.data = pixels;
    memset(frames, 0, sizeof frames);
    skg_frame_init(&frames[0]);
    ck_skg_fails(skg_plan_submit(plan, 2, frames, 1, &output, &job), SKG_ERR_ARGUMENT,
                 "skg_frame: element 1 has size 0");
    frames[0].size = 1 << 30; /* memory that nobody prepared */
    ck_skg_fails(skg_plan_submit(plan, 1, frames, 1, &output, &job), SKG_ERR_ARGUMENT, "skg_frame_init");
    ck_assert_ptr_null(job);
}
END_TEST

START_TEST(breaths_are_held) {
    skg_breath_hold holds[2];
    struct {
        skg_breath whole;
        unsigned char guard[GUARD];
    } breath;
    skg_breath_state state;
    memset(&breath, PATTERN, sizeof breath);
    skg_breath_init(&breath.whole);
    for (int i = 0; i < 2; i++) {
        skg_breath_hold_init(&holds[i]);
        holds[i].start_s = 10 * i, holds[i].end_s = 10 * i + 6;
    }
    ck_skg(skg_breath_pattern_get("quiet", &breath.whole));
    check_guard("skg_breath", breath.guard);
    breath.whole.holds = holds;
    skg_breath_state_init(&state);
#ifdef SKG_OLDER /* hold_count is the field that an older program does not have: nothing is held */
    ck_skg(skg_breath_state_at_time(&breath.whole, 21, &state));
    ck_assert_double_eq_tol(state.phase, 0.25, 1e-12);
#else
    breath.whole.hold_count = 2; /* 12 s of 21 are held, 9 s are two breaths and a quarter */
    ck_skg(skg_breath_state_at_time(&breath.whole, 21, &state));
    ck_assert_double_eq_tol(state.phase, 0.25, 1e-12);
    ck_skg(skg_breath_state_at_time(&breath.whole, 5, &state));
    ck_assert_double_eq(state.phase, 0);
    holds[1].size = 0;
    ck_skg_fails(skg_breath_check(&breath.whole), SKG_ERR_ARGUMENT, "skg_breath_hold: element 1 has size 0");
#endif
}
END_TEST

#ifdef SKG_NEWER
/* Fields that this library does not know may be there, as long as they are 0. */
START_TEST(unknown_fields_are_refused) {
    static float pixels[SIDE * SIDE];
    skg_frame frame;
    skg_frame_init(&frame);
    skg_output output;
    skg_output_init(&output);
    output.data = pixels;
    skg_job *job = NULL;
    ck_assert_int_eq(frame.later, 0);
    frame.later = 1;
    ck_skg_fails(skg_plan_submit(plan, 1, &frame, 1, &output, &job), SKG_ERR_ARGUMENT, "does not know");
    part.later = -1, part.label = "another";
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_ARGUMENT, "does not know");
    view.later = 1;
    ck_skg_fails(skg_plan_view_set(plan, &view), SKG_ERR_ARGUMENT, "does not know");
    skg_filter filters[2];
    skg_spectrum *behind = NULL;
    for (int i = 0; i < 2; i++) {
        skg_filter_init(&filters[i]);
        ck_skg(skg_material_create_named("Al", (skg_material **)&filters[i].material));
        filters[i].thickness_mm = 1;
    }
    ck_skg(skg_spectrum_create_filtered(beam, 2, filters, &behind));
    skg_spectrum_release(&behind);
    filters[1].later = 1;
    ck_skg_fails(skg_spectrum_create_filtered(beam, 2, filters, &behind), SKG_ERR_ARGUMENT, "does not know");
    for (int i = 0; i < 2; i++) skg_material_release((skg_material **)&filters[i].material);
}
END_TEST
#endif

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_plan, close_plan);
    tcase_add_test(tests, structs_are_not_overrun);
    tcase_add_test(tests, results_are_not_overrun);
    tcase_add_test(tests, frames_are_imaged);
    tcase_add_test(tests, elements_are_alike);
    tcase_add_test(tests, breaths_are_held);
#ifdef SKG_NEWER
    tcase_add_test(tests, unknown_fields_are_refused);
#endif
}

SKG_SUITE_MAIN("versions", add_tests)
