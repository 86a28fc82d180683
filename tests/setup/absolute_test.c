/* Absolute beams made without a scene file: the same images and photon numbers as those of the file, and photons that follow
 * the view when it moves. That these numbers are right is shown by falloff_test, in closed form. */
#include "core/maths.h"
#include "setup/setup_files.h"

#include <skiagraph/plan.h>

#include <float.h>
#include <math.h>

enum { COLUMNS = 64, ROWS = 48, PIXELS = COLUMNS * ROWS };

/* Distances of 250 mm to 2 m, pixels of 0.25 mm2 to 2 mm2, detectors tilted and beside the foot of the perpendicular. */
static const char *const cases[][2] = {
    {"Source.Position=[0, -40, 0, \"cm\"]", "Detector.Size=[6.4, 9.6, \"cm\"]"},
    {"Source.Position=[0, -190, 0, \"cm\"]", "Detector.Size=[6.4, 4.8, \"cm\"]"},
    {"Source.Position=[0, -15, 0, \"cm\"]", "Detector.Size=[3.2, 2.4, \"cm\"]"},
    {"Source.Position=[-50, -40, 0, \"cm\"]", "Detector.Size=[6.4, 9.6, \"cm\"]"},
    {"Source.Position=[0, -40, 0, \"cm\"]", "Detector.UpVector=[0, 0.6, -0.8]"},
};
enum { CASES = sizeof cases / sizeof *cases };

static const double MAS = 5e-4;
static const char tube_of_file[] = "Source.Beam={\"kVp\": 80, \"Filter\": [[\"Al\", 3]], \"mAs\": 5e-4}";

static skg_context *context;
static skg_plan *plan, *other;
static skg_scene *scene;
static skg_spectrum *own;
static skg_view view;
static skg_plan_options options;
static double image[PIXELS], expected[PIXELS];
static char log_text[2048];

static void keep_log(int32_t level, const char *message, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING)
        snprintf(log_text + strlen(log_text), sizeof log_text - strlen(log_text), "%s\n", message);
}

/* The tube of the file, made by hand. */
static skg_spectrum *make_tube(double mas) {
    skg_material *aluminium = NULL;
    skg_spectrum *spectrum = NULL;
    skg_tube tube;
    ck_skg(skg_material_create_element(13, &aluminium));
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 3};
    skg_tube_init(&tube);
    tube.kvp = 80, tube.mas = mas, tube.filter_count = 1, tube.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&tube, &spectrum));
    skg_material_release(&aluminium);
    return spectrum;
}

static void open_device(void) {
    set_up();
    *log_text = '\0';
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_context_log_set(context, keep_log, NULL));
    own = make_tube(MAS);
}

static void close_device(void) {
    tear_down();
    skg_plan_release(&plan);
    skg_plan_release(&other);
    skg_spectrum_release(&own);
    skg_context_release(&context);
}

/* Reads the file of a case, and returns its own beam. */
static skg_spectrum *read_case(int index, const char *more) {
    const char *settings[] = {cases[index][0], cases[index][1], tube_of_file, more};
    skg_spectrum *spectrum = NULL;
    skg_setup_release(&setup);
    write_file("scene.json", good);
    ck_skg(skg_setup_load(context, path, 4, settings, &setup));
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    skg_view_init(&view);
    ck_skg(skg_setup_view_get(setup, &view));
    skg_plan_options_init(&options);
    ck_skg(skg_setup_options_get(setup, &options));
    return spectrum;
}

static void take(skg_plan *with, const skg_view *frame_view, double *pixels) {
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = pixels;
    skg_frame_init(&frame);
    frame.view = frame_view;
    ck_skg(skg_plan_submit(with, 1, &frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

static double flat_field_of(const skg_plan *with) {
    skg_channel channel;
    skg_channel_init(&channel);
    ck_skg(skg_plan_channel_get(with, 0, &channel));
    return channel.flat_field;
}

/* A load of 0 is none, and is refused, not left out; times and currents without a unit are taken with a warning. */
START_TEST(a_load_of_nothing_is_refused) {
    static const char *const wrong[] = {"\"mAs\": 0", "\"mAs\": -1",
                                        "\"ExposureTime\": [0, \"ms\"], \"Current\": [100, \"mA\"]",
                                        "\"ExposureTime\": [20, \"ms\"], \"Current\": 0"};
    char beam[200];
    const char *const settings[] = {beam};
    write_file("scene.json", good);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        snprintf(beam, sizeof beam, "Source.Beam={\"kVp\": 80, \"Filter\": [[\"Al\", 3]], %s}", wrong[k]);
        skg_setup_release(&setup);
        ck_skg_fails(skg_setup_load(context, path, 1, settings, &setup), SKG_ERR_BEAM,
                     "which gives no photons");
    }
    snprintf(beam, sizeof beam,
             "Source.Beam={\"kVp\": 80, \"ExposureTime\": 50, \"Current\": [100, \"mA\"]}");
    skg_setup_release(&setup);
    ck_skg(skg_setup_load(context, path, 1, settings, &setup));
    ck_assert_ptr_nonnull(strstr(log_text, "has no unit, and counts in s; write [50, \"s\"]"));
}
END_TEST

/* Image and numbers of a tube and of the file that describes it, with the options of both left alone. */
START_TEST(a_tube_is_the_tube_of_the_file) {
    static const int32_t quantities[] = {SKG_QUANTITY_ENERGY, SKG_QUANTITY_PHOTONS, SKG_QUANTITY_FLUENCE,
                                         SKG_QUANTITY_TRANSMISSION};
    for (int q = 0; q < 8; q++) {
        const char *noise = q < 4 ? "Noise=false" : "Noise=true";
        skg_spectrum *of_file = read_case(_i, noise);
        skg_plan_options plain;
        skg_plan_options_init(&plain);
        options.quantity = plain.quantity = quantities[q % 4];
        plain.noise = q >= 4;
        ck_skg(skg_plan_create(context, scene, &view, of_file, &options, &plan));
        ck_skg(skg_plan_create(context, scene, &view, own, &plain, &other));
        take(plan, NULL, expected);
        take(other, NULL, image);
        ck_assert_mem_eq(image, expected, sizeof image);
        ck_assert_double_eq(flat_field_of(plan), flat_field_of(other));
        skg_plan_release(&plan);
        skg_plan_release(&other);
    }
}
END_TEST

/* The factor of a frame is rounded to float, and so are some products behind it. */
static const double ROUNDED = 8 * (double)FLT_EPSILON;

static void compare(double tolerance) {
    for (int k = 0; k < PIXELS; k++)
        if (fabs(image[k] - expected[k]) > tolerance * fabs(expected[k]))
            ck_abort_msg("pixel %d: %.9g instead of %.9g", k, image[k], expected[k]);
}

/* A plan that was made for one view, and moved to another, by the plan or by the frame. */
static void check_move(int32_t quantity, int32_t noise, int32_t falloff, double tolerance) {
    skg_view first = {0};
    read_case(0, "Noise=false");
    first = view;
    options.quantity = quantity, options.noise = noise, options.falloff = falloff;
    ck_skg(skg_plan_create(context, scene, &first, own, &options, &plan));
    const skg_plan_options same = options;
    for (int c = 1; c < CASES; c++) {
        read_case(c, "Noise=false");
        skg_scene *kept = scene;
        ck_skg(skg_plan_create(context, kept, &view, own, &same, &other));
        take(other, NULL, expected);
        take(plan, &view, image);
        compare(tolerance);
        ck_skg(skg_plan_view_set(plan, &view));
        take(plan, NULL, image);
        compare(tolerance);
        /* a product and a quotient more */
        ck_assert_double_eq_tol(flat_field_of(plan) / flat_field_of(other), 1, 16 * DBL_EPSILON);
        double there = 0, here = 0;
        ck_skg(skg_plan_node_get(plan, 0, NULL, &there, NULL));
        ck_skg(skg_plan_node_get(other, 0, NULL, &here, NULL));
        ck_assert_double_eq_tol(there / here, 1, 16 * DBL_EPSILON);
        skg_plan_release(&other);
    }
    skg_plan_release(&plan);
}

START_TEST(photons_follow_the_view) {
    check_move(SKG_QUANTITY_PHOTONS, 0, SKG_FALLOFF_AUTO, ROUNDED);
    check_move(SKG_QUANTITY_ENERGY, 0, SKG_FALLOFF_OFF, ROUNDED);
    check_move(SKG_QUANTITY_FLUENCE, 0, SKG_FALLOFF_AUTO, ROUNDED);
    check_move(SKG_QUANTITY_TRANSMISSION, 0, SKG_FALLOFF_AUTO, ROUNDED);
}
END_TEST

/* Equal deviates on means and variances that are rounded otherwise. Tens of photons to thousands arrive in a pixel, so that
 * both ways of drawing them are taken; a photon more where a deviate lies on the edge of a count would be 1 in some tens. */
START_TEST(noise_follows_the_view) {
    check_move(SKG_QUANTITY_ENERGY, 1, SKG_FALLOFF_AUTO, 1e-4);
    check_move(SKG_QUANTITY_TRANSMISSION, 1, SKG_FALLOFF_AUTO, 1e-4);
    check_move(SKG_QUANTITY_TRANSMISSION, 1, SKG_FALLOFF_OFF, 1e-4);
}
END_TEST

/* The variance of counted photons is their mean, at every geometry. */
START_TEST(variance_is_that_of_the_photons) {
    read_case(_i, "Noise=false");
    options.quantity = SKG_QUANTITY_PHOTONS;
    ck_skg(skg_plan_create(context, scene, &view, own, &options, &plan));
    options.noise = 1;
    ck_skg(skg_plan_create(context, scene, &view, own, &options, &other));
    take(plan, NULL, expected);
    take(other, NULL, image);
    double square = 0;
    for (int k = 0; k < PIXELS; k++) square += pow(image[k] - expected[k], 2) / expected[k] / PIXELS;
    /* five standard errors; that of a square is sqrt(2), and 1 / mean more of few photons */
    ck_assert_double_eq_tol(square, 1, 5 * sqrt(2.1 / PIXELS));
}
END_TEST

START_TEST(parallel_beams_have_no_distance) {
    skg_spectrum *of_file = read_case(0, "Source.Shape=Parallel");
    skg_quality resolved, given;
    skg_spectrum *counts = NULL;
    skg_quality_init(&resolved);
    skg_quality_init(&given);
    ck_skg(skg_spectrum_create_resolved(own, &view, &counts));
    ck_skg(skg_spectrum_quality_get(own, &given));
    ck_skg(skg_spectrum_quality_get(counts, &resolved));
    ck_assert_double_eq(given.photons, resolved.photons);
    skg_spectrum_release(&counts);
    ck_skg(skg_plan_create(context, scene, &view, own, NULL, &plan));
    ck_assert_ptr_nonnull(strstr(log_text, "mAs does not say how many photons arrive"));
    ck_skg(skg_plan_create(context, scene, &view, of_file, &options, &other));
    take(plan, NULL, image);
    take(other, NULL, expected);
    ck_assert_mem_eq(image, expected, sizeof image);
    skg_view point = view;
    point.projection = SKG_PROJECTION_POINT;
    ck_assert_int_eq(skg_plan_view_set(plan, &point), SKG_STALE);
    ck_assert_ptr_nonnull(strstr(skg_last_error(), "for a parallel beam and an absolute beam"));
    ck_assert_double_eq_tol(flat_field_of(plan), given.energy_kev, 64 * DBL_EPSILON * given.energy_kev);
}
END_TEST

/* A tube without a load counts photons per pixel, whatever the view. */
START_TEST(without_a_load) {
    skg_spectrum *tube = make_tube(0);
    int32_t absolute = 1;
    skg_quality quality;
    skg_quality_init(&quality);
    ck_skg(skg_spectrum_absolute_get(tube, &absolute));
    ck_assert_int_eq(absolute, 0);
    ck_skg(skg_spectrum_quality_get(tube, &quality));
    read_case(_i, "Noise=false");
    skg_plan_options plain;
    skg_plan_options_init(&plain);
    plain.quantity = SKG_QUANTITY_PHOTONS;
    ck_skg(skg_plan_create(context, scene, &view, tube, &plain, &plan));
    ck_assert_double_eq_tol(flat_field_of(plan) / quality.photons, 1, 64 * DBL_EPSILON);
    take(plan, NULL, image);
    ck_assert_double_eq_tol(image[0] / quality.photons, 1, ROUNDED); /* beside the parts, without falloff */
    skg_spectrum_release(&tube);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_device, close_device);
    tcase_add_test(tests, a_load_of_nothing_is_refused);
    tcase_add_loop_test(tests, a_tube_is_the_tube_of_the_file, 0, CASES);
    tcase_add_test(tests, photons_follow_the_view);
    tcase_add_test(tests, noise_follows_the_view);
    tcase_add_loop_test(tests, variance_is_that_of_the_photons, 0, CASES);
    tcase_add_test(tests, parallel_beams_have_no_distance);
    tcase_add_loop_test(tests, without_a_load, 0, 2);
}

SKG_SUITE_MAIN("absolute", add_tests)
