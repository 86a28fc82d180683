/* Collimated beams: the pixels inside the field have the bits of the open beam, those outside are dark; the penumbra of extended
 * sources against closed forms. */
#include "suite.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The detector of run_view: pixels of 1 mm, 1200 mm from the source. The jaws stand at a third of this, so that their shadow is 3 times
 * as large. */
enum { SIDE = 48 };
static const double PITCH = 1, DETECTOR = 1200, JAWS = 400;

static skg_scene *scene;
static skg_spectrum *beam;
static skg_plan_options options;
static skg_collimation jaws;
static skg_view view;

/* A box in one corner, so that pixels of the field differ. */
static void open_scene(void) {
    const double pose[16] = {1, 0, 0, 8, 0, 1, 0, -5, 0, 0, 1, 0, 0, 0, 0, 1};
    skg_mesh *box = NULL;
    run_open();
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(30, 22, 6, &box));
    run_part(scene, "box", box, 1.3, pose, -1);
    skg_mesh_release(&box);
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    skg_plan_options_init(&options);
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_RECTANGLE;
    jaws.distance_mm = JAWS;
    jaws.low[0] = -4.1, jaws.high[0] = 2.3, jaws.low[1] = -6.2, jaws.high[1] = 5.1;
    view = run_view(SIDE, PITCH);
}

static void close_scene(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    run_close();
}

/* The image in doubles; to be freed. */
static double *image_of(const skg_collimation *collimation) {
    skg_plan *plan = NULL;
    options.collimation = collimation;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    double *pixels = run_image(plan, &view);
    skg_plan_release(&plan);
    return pixels;
}

/* mm on the detector from its centre to the middle of a pixel, whatever the detector's side. */
static double place_of(int64_t index) {
    return ((double)index - 0.5 * (SIDE - 1)) * PITCH;
}

/* Whether pixel p lies in a rectangle on the detector, mm. */
static int is_inside(int p, const double low[2], const double high[2]) {
    const double x = place_of(p % SIDE), y = place_of(p / SIDE);
    return x > low[0] && x < high[0] && y > low[1] && y < high[1];
}

/* Compares with the open beam: the same bits inside the rectangle, `dark` outside. */
static void check_field(const skg_collimation *collimation, const double low[2], const double high[2],
                        double dark) {
    double *open = image_of(NULL), *limited = image_of(collimation);
    int inside = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        const int in = is_inside(p, low, high);
        if (in)
            ck_assert_msg(memcmp(&limited[p], &open[p], sizeof *open) == 0, "pixel %d: %.9g instead of %.9g",
                          p, limited[p], open[p]);
        else /* two roundings of a float */
            ck_assert_msg(fabs(limited[p] - dark) <= 2e-7 * dark, "pixel %d outside: %.9g instead of %.9g", p,
                          limited[p], dark);
        inside += in;
    }
    ck_assert_int_gt(inside, 0);
    ck_assert_int_lt(inside, SIDE * SIDE);
    free(open);
    free(limited);
}

static const double shadow_low[2] = {-12.3, -18.6}, shadow_high[2] = {6.9, 15.3};

/* Every strategy and precision leaves the same pixels. */
START_TEST(the_edge_is_at_its_pixel) {
    static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    static const int32_t precisions[] = {SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE, SKG_PRECISION_HALF};
    options.strategy = strategies[_i % 3];
    options.precision = precisions[_i / 3];
    if (options.precision == SKG_PRECISION_DOUBLE && !run_has_double()) return;
    check_field(&jaws, shadow_low, shadow_high, 0);
}
END_TEST

/* Behind the jaws a ratio to the open beam is 0, and its logarithm that of the smallest normal float, 126 ln 2. */
START_TEST(ratios_are_to_the_open_beam) {
    const double kev[2] = {40, 90}, photons[2] = {1000, 300}, opaque = 126 * log(2);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    check_field(&jaws, shadow_low, shadow_high, 0);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    check_field(&jaws, shadow_low, shadow_high, opaque); /* the exponent itself */
    options.supersampling = 2;
    double *averaged = image_of(&jaws);
    ck_assert_double_eq_tol(averaged[0], opaque, 1e-5); /* the logarithm of floats: 2e-7 of 87 */
    free(averaged);
    options.supersampling = 1;
    skg_spectrum_release(&beam);
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &beam));
    check_field(&jaws, shadow_low, shadow_high, opaque); /* the logarithm of a sum */
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    options.falloff = 1, options.electronic_kev = 1e-9; /* so that the flat field is an image */
    double *ratio = image_of(&jaws);
    ck_assert_double_eq_tol(ratio[0], 0, 1e-12); /* the electronic noise */
    ck_assert_double_eq_tol(ratio[SIDE / 2 * SIDE + 14], 1, 1e-6);
    free(ratio);
}
END_TEST

/* No photons, no noise; the draws of the other pixels stay. */
START_TEST(jaws_stop_noise) {
    options.noise = 1;
    options.noise_seed = 5;
    check_field(&jaws, shadow_low, shadow_high, 0);
    options.supersampling = 2;
    double *open = image_of(NULL), *limited = image_of(&jaws);
    ck_assert(open[0] > 0 && limited[0] == 0);
    ck_assert_double_eq(limited[SIDE / 2 * SIDE + SIDE / 2], open[SIDE / 2 * SIDE + SIDE / 2]);
    free(open);
    free(limited);
}
END_TEST

/* An edge on the centres of pixels: the low one belongs to the field, the high one does not. */
START_TEST(an_edge_through_centres_belongs_to_one_side) {
    jaws.low[0] = -10.5 / 3, jaws.high[0] = 4.5 / 3, jaws.low[1] = -0.5 / 3, jaws.high[1] = 7.5 / 3;
    const double low[2] = {-10.6, -0.6}, high[2] = {4.4, 7.4};
    check_field(&jaws, low, high, 0);
}
END_TEST

START_TEST(the_detectors_field_has_a_margin) {
    jaws.kind = SKG_COLLIMATION_DETECTOR;
    jaws.distance_mm = 0;
    jaws.margin_mm = -5.2;
    const double edge = SIDE / 2 * PITCH - 5.2, low[2] = {-edge, -edge}, high[2] = {edge, edge};
    check_field(&jaws, low, high, 0);
    for (int k = 0; k < 3; k++) {
        jaws.margin_mm = 3 * k;
        if (k == 2) jaws.kind = SKG_COLLIMATION_OPEN;
        double *open = image_of(NULL), *limited = image_of(&jaws);
        ck_assert_int_eq(memcmp(open, limited, SIDE * SIDE * sizeof *open), 0);
        free(open);
        free(limited);
    }
}
END_TEST

/* A parallel beam carries the rectangle along, at any angle, whatever the distance. */
START_TEST(parallel_beams_carry_the_rectangle) {
    view.projection = SKG_PROJECTION_PARALLEL;
    view.source[0] = 150;
    jaws.distance_mm = 5000;
    check_field(&jaws, jaws.low, jaws.high, 0);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.source[0] = 0.2, view.source[1] = 0, view.source[2] = 1;
    check_field(&jaws, jaws.low, jaws.high, 0);
}
END_TEST

/* The field goes with source and detector: a view that is turned and moved as a whole has the same pixels, and another distance of the
 * detector other ones. */
START_TEST(the_field_moves_with_the_view) {
    skg_plan *plan = NULL;
    skg_view moved = view;
    const double to_detector[3] = {0, DETECTOR, 0}, source[3] = {7, -900, 11};
    const double column[3] = {0, 0, 1}, row[3] = {1, 0, 0}; /* the beam along y, tilted columns */
    for (int k = 0; k < 3; k++) {
        moved.source[k] = source[k];
        moved.centre[k] = source[k] + to_detector[k];
        moved.column_step[k] = PITCH * column[k];
        moved.row_step[k] = PITCH * row[k];
    }
    options.collimation = &jaws;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    for (int far = 0; far < 2; far++) {
        ck_skg(skg_plan_view_set(plan, &moved));
        double *pixels = run_image(plan, &moved);
        const double scale = far ? 2 : 1;
        for (int p = 0; p < SIDE * SIDE; p++) {
            const double low[2] = {scale * shadow_low[0], scale * shadow_low[1]},
                         high[2] = {scale * shadow_high[0], scale * shadow_high[1]};
            ck_assert_msg((pixels[p] > 0) == is_inside(p, low, high), "pixel %d of view %d", p, far);
        }
        free(pixels);
        moved.centre[1] += DETECTOR;
    }
    skg_plan_release(&plan);
}
END_TEST

/* A detector that is not across the central ray, with steps that are not perpendicular: the rectangle is measured along both steps from
 * the central ray, in the plane at the distance along the normal. */
START_TEST(oblique_views_have_a_field_along_their_steps) {
    view.source[0] = 300;
    view.row_step[0] = 0.6 * PITCH, view.row_step[1] = 0.8 * PITCH;
    check_field(&jaws, shadow_low, shadow_high, 0);
}
END_TEST

/* --- penumbrae --- */

/* A share of pieces [0, 1] of the source, in its middle, below x: the n middles of equal pieces. */
static double share_below(double x, int n) {
    int below = 0;
    for (int k = 0; k < n; k++) below += (k + 0.5) / n < x;
    return (double)below / n;
}

/* A line of the width f along the columns. The ray from s to a pixel at x crosses the jaws at s + (x - s) d / D, so that the edge e
 * is passed by s > (e - x d / D) / (1 - d / D). The exact share of the samples, and the width of the penumbra f (D - d) / d. */
START_TEST(a_line_has_its_penumbra) {
    enum { N = 16 };
    const double width = 6, ratio = JAWS / DETECTOR;
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_LINE, spot.extent[0] = width, spot.grid = N;
    options.spot = &spot;
    double *open = image_of(NULL), *limited = image_of(&jaws);
    int partial = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        const double x = place_of(p % SIDE), y = place_of(p / SIDE);
        const double first = (jaws.low[0] - x * ratio) / (1 - ratio) / width + 0.5,
                     last = (jaws.high[0] - x * ratio) / (1 - ratio) / width + 0.5;
        const double rows = y > shadow_low[1] && y < shadow_high[1];
        const double share = rows * (share_below(last, N) - share_below(first, N));
        if (fabs(open[p] - 60000) < 1) /* beside the box, where all samples give the same */
            ck_assert_msg(fabs(limited[p] / open[p] - share) < 1e-6, "pixel %d: %.7g instead of %.7g", p,
                          limited[p] / open[p], share); /* a mean of 16 floats */
        else if (share == 0 || share == 1)              /* behind it */
            ck_assert_double_eq(limited[p], share * open[p]);
        if (p / SIDE == SIDE / 2) partial += share > 0 && share < 1;
    }
    /* Two edges of 12 mm, in pixels of 1 mm; the samples end half a piece inside the line. */
    const double penumbra = width * (DETECTOR - JAWS) / JAWS;
    ck_assert_int_ge(partial, (int)(2 * penumbra * (1 - 1.0 / N)) - 2);
    ck_assert_int_le(partial, (int)(2 * penumbra) + 2);
    free(open);
    free(limited);
}
END_TEST

/* A rectangle: in both directions, against the continuous source. 1,024 Sobol points of which a box is cut off leave some parts in
 * 1,024 at each of the two edges. */
START_TEST(a_rectangle_has_its_penumbra_in_both_directions) {
    const double ratio = JAWS / DETECTOR;
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.samples = 1024;
    spot.extent[0] = 3, spot.extent[1] = 5;
    options.spot = &spot;
    options.supersampling = 1;
    double *open = image_of(NULL), *limited = image_of(&jaws);
    for (int p = 0; p < SIDE * SIDE; p++) {
        double share = 1;
        for (int a = 0; a < 2; a++) {
            const double x = place_of(a == 0 ? p % SIDE : p / SIDE), f = spot.extent[a];
            const double low = fmax((jaws.low[a] - x * ratio) / (1 - ratio), -f / 2),
                         high = fmin((jaws.high[a] - x * ratio) / (1 - ratio), f / 2);
            share *= fmax(high - low, 0) / f;
        }
        if (fabs(open[p] - 60000) < 1) /* beside the box */
            ck_assert_msg(fabs(limited[p] / open[p] - share) <= 8.0 / 1024, "pixel %d: %.5g instead of %.5g",
                          p, limited[p] / open[p], share);
    }
    free(open);
    free(limited);
}
END_TEST

/* Of 4 x 4 rays in a pixel on the edge, those inside count; one pass makes them all, or each has a pass. */
START_TEST(rays_of_a_pixel_see_the_edge) {
    options.supersampling = 4;
    jaws.low[0] = -40,
    jaws.high[0] = (place_of(10) + 0.2) / 3; /* behind its third column of rays: -.375, -.125, .125 */
    double *open = image_of(NULL), *limited = image_of(&jaws);
    const int row = SIDE / 2 * SIDE;
    ck_assert_double_eq_tol(limited[row + 10] / open[row + 10], 0.75, 1e-6); /* a mean of 16 floats */
    ck_assert_double_eq(limited[row + 9], open[row + 9]);
    ck_assert_double_eq(limited[row + 11], 0);
    free(open);
    free(limited);
}
END_TEST

/* Path lengths are those of the open beam. */
START_TEST(lengths_are_not_limited) {
    double *lengths[2];
    for (int k = 0; k < 2; k++) {
        skg_plan *plan = NULL;
        options.collimation = k ? &jaws : NULL;
        ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
        lengths[k] = run_lengths(plan, &view);
        skg_plan_release(&plan);
    }
    ck_assert_int_eq(memcmp(lengths[0], lengths[1], SIDE * SIDE * sizeof **lengths), 0);
    free(lengths[0]);
    free(lengths[1]);
}
END_TEST

/* --- the effect, and what is refused --- */

static void check_effect(int on, const char *reason) {
    skg_plan *plan = NULL;
    int64_t count = 0, found = -1;
    skg_effect effect;
    options.collimation = &jaws;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t e = 0; e < count && found < 0; e++) {
        skg_effect_init(&effect);
        ck_skg(skg_plan_effect_get(plan, e, &effect));
        if (strcmp(effect.name, "collimation") == 0) found = e;
    }
    ck_assert_int_ge(found, 0);
    ck_assert_int_eq(effect.on, on);
    ck_assert((effect.cost > 0) == on);
    ck_assert_msg(strstr(effect.reason, reason) != NULL, "\"%s\" has no \"%s\"", effect.reason, reason);
    skg_plan_release(&plan);
}

START_TEST(the_plan_says_what_the_jaws_leave) {
    /* 19 of 48 columns and 34 of 48 rows have their centres in the shadow of 19.2 x 33.9 mm. */
    check_effect(1, "jaws leave 6.4 x 11.3 mm, 400 mm from the source; 28 % of the pixels");
    jaws.low[0] = 100, jaws.high[0] = 101;
    check_effect(1, "0 % of the pixels");
    jaws.kind = SKG_COLLIMATION_DETECTOR;
    jaws.margin_mm = 4;
    check_effect(0, "the field holds the whole detector");
    jaws.margin_mm = -4;
    check_effect(1, "4 mm smaller than the detector");
    jaws.kind = SKG_COLLIMATION_OPEN;
    check_effect(0, "no jaws limit the beam");
}
END_TEST

static void check_refused(skg_status wanted, const char *place) {
    skg_plan *plan = NULL;
    options.collimation = &jaws;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), wanted, place);
    ck_assert_ptr_null(plan);
}

START_TEST(unusable_jaws_are_refused) {
    const skg_collimation good = jaws;
    skg_spot spot;
    jaws.kind = 7;
    check_refused(SKG_ERR_ARGUMENT, "SKG_COLLIMATION_");
    jaws = good, jaws.distance_mm = 0;
    check_refused(SKG_ERR_SCENE, "0 mm from the source; give a distance above 0");
    jaws = good, jaws.distance_mm = 1200.1;
    check_refused(SKG_ERR_SCENE, "behind the detector at 1200 mm");
    jaws = good, jaws.low[1] = 6;
    check_refused(SKG_ERR_SCENE, "6 to 5.1 mm open along the row step");
    jaws = good, jaws.high[0] = (double)NAN;
    check_refused(SKG_ERR_SCENE, "along the column step");
    jaws = good, jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -24;
    check_refused(SKG_ERR_SCENE, "leaves nothing of the detector, which is 48 mm wide");
    jaws.margin_mm = (double)INFINITY;
    check_refused(SKG_ERR_SCENE, "not finite");
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_CUBE, spot.extent[2] = 20, spot.samples = 64;
    options.spot = &spot;
    jaws = good, jaws.distance_mm = 5;
    check_refused(SKG_ERR_SCENE, "place the jaws farther");
    jaws.distance_mm = DETECTOR; /* on the detector: no penumbra */
    double *pixels = image_of(&jaws);
    ck_assert_double_eq(pixels[0], 0);
    free(pixels);
}
END_TEST

/* A frame whose detector lies before the jaws. */
START_TEST(views_before_the_jaws_are_refused) {
    skg_plan *plan = NULL;
    skg_view near = view;
    skg_output output;
    skg_frame frame;
    float pixels[SIDE * SIDE];
    near.centre[2] = near.source[2] + 300;
    options.collimation = &jaws;
    ck_skg(skg_plan_create(run_context, scene, &view, beam, &options, &plan));
    skg_frame_init(&frame);
    skg_output_init(&output);
    frame.view = &near;
    output.data = pixels;
    skg_job *job = NULL;
    skg_status status = skg_plan_submit(plan, 1, &frame, 1, &output, &job);
    if (status == SKG_OK) status = skg_job_wait(&job);
    ck_skg_fails(status, SKG_ERR_SCENE, "behind the detector at 300 mm");
    skg_plan_release(&plan);
    options.view_count = 1, options.views = &near;
    check_refused(SKG_ERR_SCENE, "behind the detector at 300 mm");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_loop_test(tests, the_edge_is_at_its_pixel, 0, 9);
    tcase_add_test(tests, ratios_are_to_the_open_beam);
    tcase_add_test(tests, jaws_stop_noise);
    tcase_add_test(tests, an_edge_through_centres_belongs_to_one_side);
    tcase_add_test(tests, the_detectors_field_has_a_margin);
    tcase_add_test(tests, parallel_beams_carry_the_rectangle);
    tcase_add_test(tests, the_field_moves_with_the_view);
    tcase_add_test(tests, oblique_views_have_a_field_along_their_steps);
    tcase_add_test(tests, a_line_has_its_penumbra);
    tcase_add_test(tests, a_rectangle_has_its_penumbra_in_both_directions);
    tcase_add_test(tests, rays_of_a_pixel_see_the_edge);
    tcase_add_test(tests, lengths_are_not_limited);
    tcase_add_test(tests, the_plan_says_what_the_jaws_leave);
    tcase_add_test(tests, unusable_jaws_are_refused);
    tcase_add_test(tests, views_before_the_jaws_are_refused);
}

SKG_SUITE_MAIN("collimation", add_tests)
