/* Falloff and absolute beams: every pixel receives the photons per steradian at the source times the solid angle that
 * it fills, in closed form, wherever on the plane of the detector the foot of the perpendicular lies. */
#include "core/maths.h"
#include "setup/setup_files.h"

#include <skiagraph/plan.h>

#include <math.h>

enum { COLUMNS = 64, ROWS = 48, PIXELS = COLUMNS * ROWS };

static const char right[] = "Detector.RightVector=[1, 0, 0]", up[] = "Detector.UpVector=[0, 0, -1]";

/* Where source and detector are, the source's distance from the detector's plane, and whether the foot of the
 * perpendicular is on a pixel. Pixels are of 0.5 mm x 0.5 mm. */
static const struct {
    const char *source, *right, *up;
    double distance;
    int on_a_pixel;
} cases[] = {
    {"Source.Position=[0, -40, 0, \"cm\"]", right, up, 500, 1},
    {"Source.Position=[5.25, -400, -4.75, \"mm\"]", right, up, 500, 1},
    /* A tube angled by 45 degrees. */
    {"Source.Position=[-50, -40, 0, \"cm\"]", right, up, 500, 0},
    /* Detectors tilted by 60 degrees, and about the other axis by what 3, 4 and 5 make. */
    {"Source.Position=[0, -40, 0, \"cm\"]", "Detector.RightVector=[1, 1.7320508075688772, 0]", up, 250, 0},
    {"Source.Position=[0, -40, 0, \"cm\"]", right, "Detector.UpVector=[0, 0.6, -0.8]", 400, 0},
};
enum { CASES = sizeof cases / sizeof *cases };

static skg_context *context;
static double image[PIXELS];
static skg_view view;

static void open_device(void) {
    set_up();
    ck_skg(skg_context_create(NULL, &context));
}

static void close_device(void) {
    tear_down();
    skg_context_release(&context);
}

/* The open beam: the parts lie outside the picture. */
static void take(int index, const char *beam, const char *noise) {
    const char *settings[] = {cases[index].source,
                              cases[index].right,
                              cases[index].up,
                              "Detector.Size=[3.2, 2.4, \"cm\"]",
                              "Samples.skin.Transform=[[\"Translation\", 0, 0, 9, \"m\"]]",
                              "Samples.bone.Transform=[[\"Translation\", 0, 0, 9, \"m\"]]",
                              beam,
                              noise};
    skg_plan_options options;
    skg_output output;
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    write_file("scene.json", good);
    skg_setup_release(&setup);
    ck_skg(skg_setup_load(context, path, 8, settings, &setup));
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    skg_view_init(&view);
    ck_skg(skg_setup_view_get(setup, &view));
    skg_plan_options_init(&options);
    ck_skg(skg_setup_options_get(setup, &options));
    options.quantity = SKG_QUANTITY_PHOTONS;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
}

/* The photons of 1 mAs in a steradian, made without a scene: photons per mm2 at 1 m, times 1e6 mm2. */
static double photons_per_steradian(void) {
    skg_material *aluminium = NULL;
    skg_spectrum *spectrum = NULL;
    skg_quality quality;
    skg_tube tube;
    ck_skg(skg_material_create_element(13, &aluminium));
    const skg_filter filter = {.size = (int32_t)sizeof filter, .material = aluminium, .thickness_mm = 3};
    skg_tube_init(&tube);
    tube.kvp = 80, tube.filter_count = 1, tube.filters = &filter;
    ck_skg(skg_spectrum_create_tube(&tube, &spectrum));
    skg_quality_init(&quality);
    ck_skg(skg_spectrum_quality_get(spectrum, &quality));
    skg_spectrum_release(&spectrum);
    skg_material_release(&aluminium);
    return 1e6 * quality.photons;
}

/* The solid angle of a triangle, seen from the origin (A. Van Oosterom and J. Strackee, 1983). */
static double triangle(const double *a, const double *b, const double *c) {
    const double la = skg_length(a), lb = skg_length(b), lc = skg_length(c);
    double across[3];
    skg_cross(b, c, across);
    return 2 * atan2(fabs(skg_dot(a, across)),
                     la * lb * lc + skg_dot(a, b) * lc + skg_dot(a, c) * lb + skg_dot(b, c) * la);
}

static double solid_angle(int pixel) {
    double corner[4][3];
    for (int n = 0; n < 4; n++) {
        const double i = pixel % COLUMNS - 0.5 * COLUMNS + n % 2;
        const double j = pixel / COLUMNS - 0.5 * ROWS + (n > 1);
        for (int k = 0; k < 3; k++)
            corner[n][k] = view.centre[k] + i * view.column_step[k] + j * view.row_step[k] - view.source[k];
    }
    return triangle(corner[0], corner[1], corner[2]) + triangle(corner[3], corner[1], corner[2]);
}

/* Whether the case is what it says. */
static void check_foot(int index) {
    double normal[3], way[3], foot[3];
    skg_cross(view.column_step, view.row_step, normal);
    skg_add_scaled(view.source, -1, view.centre, way);
    const double height = skg_dot(way, normal) / skg_dot(normal, normal);
    /* a few roundings of 500 mm */
    ck_assert_double_eq_tol(fabs(height) * skg_length(normal), cases[index].distance, 1e-9);
    skg_add_scaled(way, -height, normal, foot);
    const double i = skg_dot(foot, view.column_step) / 0.25, j = skg_dot(foot, view.row_step) / 0.25;
    /* half the detector */
    const int on_a_pixel = fabs(i) < 0.5 * COLUMNS && fabs(j) < 0.5 * ROWS;
    ck_assert_int_eq(on_a_pixel, cases[index].on_a_pixel);
}

static void check(double per_steradian) {
    /* One ray stands for a pixel of 0.5 mm at 250 mm or more: it errs by less than (0.5 / 250)^2 = 4e-6. */
    for (int k = 0; k < PIXELS; k++)
        ck_assert_double_eq_tol(image[k] / (per_steradian * solid_angle(k)), 1, 5e-6);
}

static const char absolute[] = "Source.Beam={\"kVp\": 80, \"Filter\": [[\"Al\", 3]], \"mAs\": 1}";

START_TEST(absolute_beams_are_photons_per_solid_angle) {
    take(_i, absolute, "Noise=false");
    check_foot(_i);
    check(photons_per_steradian());
}
END_TEST

/* 1000 photons in a pixel at the foot, whether or not a pixel lies there. */
START_TEST(counts_are_those_at_the_foot) {
    take(_i, "Falloff=true", "Noise=false");
    check(1000 * cases[_i].distance * cases[_i].distance / 0.25);
}
END_TEST

/* Of photons that are counted, variance and mean are equal. */
START_TEST(noise_follows) {
    static double mean[PIXELS];
    take(_i, "Falloff=true", "Noise=false");
    memcpy(mean, image, sizeof mean);
    take(_i, "Falloff=true", "Noise=true");
    double sum = 0, square = 0;
    for (int k = 0; k < PIXELS; k++) {
        const double deviate = (image[k] - mean[k]) / sqrt(mean[k]);
        sum += deviate / PIXELS, square += deviate * deviate / PIXELS;
    }
    /* four standard errors */
    ck_assert_double_eq_tol(sum, 0, 4 / sqrt(PIXELS));
    /* four standard errors; that of a square is sqrt(2), and 1 / mean more of few photons */
    ck_assert_double_eq_tol(square, 1, 4 * sqrt(2.01 / PIXELS));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_device, close_device);
    tcase_add_loop_test(tests, absolute_beams_are_photons_per_solid_angle, 0, CASES);
    tcase_add_loop_test(tests, counts_are_those_at_the_foot, 0, CASES);
    tcase_add_loop_test(tests, noise_follows, 0, CASES);
}

SKG_SUITE_MAIN("falloff", add_tests)
