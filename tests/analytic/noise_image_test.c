/* Noise of images: shares of sources, keys that decide alone, the power behind a blur, electronics, quantities. */
#include "analytic/noise_scene.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Samples of a source draw shares that add up to a draw of all photons: a slab is as thick for each of them,
 * to the obliquity of a spot that is small beside the distance. */
START_TEST(shares_of_an_extended_source) {
    const double many[2] = {9000, 4000}, few[2] = {30, 10};
    const skg_view parallel = view;
    skg_plan_options options = noisy();
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = 1, spot.samples = 8;
    options.spot = &spot;
    options.supersampling = 2;
    view.projection = SKG_PROJECTION_POINT;
    view.source[2] = -1e5;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
    spot.samples = 0; /* found without noise: doublings that differ by noise alone would never end */
    spot.samples_max = 64;
    check_two_energies(few, &options);
    view = parallel;
}
END_TEST

static double correlation(const double *a, const double *b) {
    const moments of_a = moments_of(PIXELS, a), of_b = moments_of(PIXELS, b);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) sum += (a[i] - of_a.mean) * (b[i] - of_b.mean);
    return sum / (PIXELS - 1) / sqrt(of_a.variance * of_b.variance);
}

/* Frames, seeds and neighbours are uncorrelated; the same key has the same bits, whatever the strategy. */
START_TEST(keys) {
    static double images[3][PIXELS], again[3][PIXELS], other[PIXELS];
    const double photons[2] = {3000, 2000}, few[2] = {20, 10};
    skg_plan_options options = noisy();
    skg_spectrum *spectrum = energies(2, two_kev, photons), *faint = energies(2, two_kev, few);
    const double chance = 4 / sqrt((double)PIXELS);
    take(spectrum, &options, 5, 3, images[0]);
    take(spectrum, &options, 5 + ((int64_t)1 << 32), 1, other);
    ck_assert_double_le(fabs(correlation(images[0], images[1])), chance);
    ck_assert_double_le(fabs(correlation(images[1], images[2])), chance);
    ck_assert_double_le(fabs(correlation(images[0], other)), chance);
    memcpy(other, images[0] + 1, sizeof other - sizeof *other);
    ck_assert_double_le(fabs(correlation(images[0], other)), chance);
    memcpy(other, images[0] + SIDE, sizeof other - SIDE * sizeof *other);
    ck_assert_double_le(fabs(correlation(images[0], other)), chance);
    for (int strategy = SKG_STRATEGY_AUTO; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
        options.strategy = strategy;
        take(spectrum, &options, 5, 3, again[0]);
        ck_assert_mem_eq(images, again, sizeof images);
    }
    options.strategy = SKG_STRATEGY_AUTO;
    take(faint, &options, 5, 3, images[0]);
    options.strategy = SKG_STRATEGY_TILES;
    take(faint, &options, 5, 3, again[0]);
    ck_assert_mem_eq(images, again, sizeof images);
    skg_spectrum_release(&spectrum);
    skg_spectrum_release(&faint);
}
END_TEST

/* Blurred noise of a flat field has the power of white noise times the square of the modulation transfer
 * function, that is of the line spread function's Fourier transform. */
START_TEST(noise_power_follows_the_transfer_function) {
    enum { FRAMES = 8, LOW = 8, MARGIN = 8, USED = SIDE - 2 * MARGIN };
    static double images[FRAMES][SIDE][SIDE];
    const double line[5] = {0.1, 0.2, 0.4, 0.2, 0.1}, one = 1, kev = 60, photons = 10000, pi = acos(-1);
    const skg_detector_blur blur = {
        .size = sizeof blur, .columns = 5, .rows = 1, .along_row = line, .along_column = &one};
    skg_plan_options options = noisy();
    options.blur = &blur;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    const truth t = sum_energies(1, &kev, &photons, &options);
    take(spectrum, &options, 1, FRAMES, images[0][0]);
    for (int k = LOW; k <= USED / 2 - LOW; k += LOW) {
        const double f = (double)k / USED;
        double transfer = line[2], power = 0;
        for (int d = 1; d <= 2; d++) transfer += 2 * line[2 + d] * cos(2 * pi * f * d);
        for (int n = 0; n < FRAMES; n++)
            for (int row = 0; row < SIDE; row++) {
                double real = 0, imaginary = 0;
                for (int i = 0; i < USED; i++) {
                    /* Hann's window, so that ends do not leak */
                    const double window = 1 - cos(2 * pi * (i + 0.5) / USED);
                    const double value = window * (images[n][row][MARGIN + i] - t.mean);
                    real += value * cos(2 * pi * f * i), imaginary += value * sin(2 * pi * f * i);
                }
                power += real * real + imaginary * imaginary;
            }
        power /= (double)FRAMES * SIDE * USED * 1.5; /* mean square of the window */
        /* Rows are independent, their power exponentially distributed; the window's width blurs the transfer
         * function by about its second derivative. */
        ck_assert_double_eq_tol(power / t.variance, transfer * transfer,
                                4 * transfer * transfer / sqrt(FRAMES * SIDE) + 2e-3);
    }
    skg_spectrum_release(&spectrum);
}
END_TEST

/* Electronic noise alone, in keV; then steps. */
START_TEST(electronics) {
    static double images[2 * PIXELS], stepped[PIXELS];
    const double kev = 60, photons = 100;
    skg_plan_options options = noisy();
    options.noise = 0;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    truth t = sum_energies(1, &kev, &photons, &options);
    options.electronic_kev = 12.5;
    take(spectrum, &options, 2, 2, images);
    t.variance = 12.5 * 12.5, t.fourth = 0;
    check_moments(2 * PIXELS, images, &t);
    /* Four standard errors of a correlation of that many pairs. */
    ck_assert_double_le(fabs(correlation(images, images + PIXELS)), 4 / sqrt((double)PIXELS));
    options.quantum_step_kev = 4;
    take(spectrum, &options, 2, 1, stepped);
    for (int i = 0; i < PIXELS; i++) {
        ck_assert_double_eq(stepped[i], 4 * round(stepped[i] / 4));
        /* Half a step, and floats of the mean. */
        ck_assert_double_le(fabs(stepped[i] - images[i]), 2 + 1e-4 * t.mean);
    }
    skg_spectrum_release(&spectrum);
}
END_TEST

/* Other quantities are those of the same noise, scaled. */
START_TEST(quantities) {
    static double energy[PIXELS], other[PIXELS];
    const double photons[2] = {3000, 2000}, open = 40 * 3000 + 80 * 2000;
    skg_plan_options options = noisy();
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    options.electronic_kev = 10;
    take(spectrum, &options, 5, 1, energy);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    take(spectrum, &options, 5, 1, other);
    /* Equal draws: the images differ by 16 roundings of single precision, 1e-6, here and below. */
    for (int i = 0; i < PIXELS; i++) ck_assert_double_eq_tol(other[i] * open / energy[i], 1, 1e-6);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    take(spectrum, &options, 5, 1, other);
    /* As above. */
    for (int i = 0; i < PIXELS; i++) ck_assert_double_eq_tol(other[i], -log(energy[i] / open), 1e-6);
    options.quantity = SKG_QUANTITY_FLUENCE;
    take(spectrum, &options, 5, 1, other);
    /* As above. */
    for (int i = 0; i < PIXELS; i++) ck_assert_double_eq_tol(other[i] * 0.04 / energy[i], 1, 1e-6);
    skg_spectrum_release(&spectrum);
}
END_TEST

/* Over an open beam that differs from pixel to pixel: the noisy image of the same key over what the same
 * chain, blur and samples of the source included, makes of a scene whose only part is not in the picture. */
static void check_over_the_open_field(skg_plan_options options, const skg_spectrum *spectrum) {
    static double energy[2 * PIXELS], field[2 * PIXELS], ratio[2 * PIXELS];
    const int64_t channels = options.bands ? options.bands : 1;
    const double pose[16] = {1, 0, 0, 9000, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double home[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    skg_plan_options quiet = options;
    options.quantity = SKG_QUANTITY_ENERGY;
    take(spectrum, &options, 5, channels > 1 ? 1 : 2, energy);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    take(spectrum, &options, 5, channels > 1 ? 1 : 2, ratio);
    quiet.noise = 0, quiet.electronic_kev = 0;
    ck_skg(skg_scene_part_pose_set(scene, 0, pose));
    take(spectrum, &quiet, 5, 1, field);
    ck_skg(skg_scene_part_pose_set(scene, 0, home));
    ck_assert_double_gt(field[PIXELS / 2 + SIDE / 2], 1.001 * field[0]);
    /* a few roundings, of single precision where images are */
    const double bar = options.precision == SKG_PRECISION_DOUBLE ? 1e-12 : 16 * 0x1p-24;
    for (int i = 0; i < 2 * PIXELS; i++) { /* two frames, or two channels */
        const double expected = energy[i] / field[channels > 1 ? i : i % PIXELS];
        ck_assert_double_eq_tol(ratio[i], expected, bar * fabs(expected));
    }
}

START_TEST(over_the_open_field) {
    const double photons[2] = {3000, 2000}, line[3] = {0.2, 0.5, 0.3}, one = 1, edges[3] = {10, 60, 100};
    const skg_detector_blur blur = {
        .size = sizeof blur, .columns = 3, .rows = 1, .along_row = line, .along_column = &one};
    skg_plan_options options = noisy();
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    skg_material *water = NULL;
    skg_spot spot;
    ck_skg(skg_material_create_named("water", &water));
    view.projection = SKG_PROJECTION_POINT;
    view.source[2] = -60;
    view.column_step[0] = view.row_step[1] = 1;
    options.electronic_kev = 10;
    options.falloff = 1;
    check_over_the_open_field(options, spectrum);
    options.world = water;
    check_over_the_open_field(options, spectrum);
    options.blur = &blur;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = 1, spot.samples = 4;
    options.spot = &spot;
    options.bands = 2, options.band_kev = edges, options.band_weight = SKG_BAND_WEIGHT_ENERGY;
    options.precision = SKG_PRECISION_DOUBLE;
    check_over_the_open_field(options, spectrum);
    skg_material_release(&water);
    skg_spectrum_release(&spectrum);
}
END_TEST

START_TEST(refused) {
    skg_plan *plan = NULL;
    const double kev = 60, photons = 100;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    skg_plan_options options = noisy();
    options.swank = 1.2;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &plan), SKG_ERR_ARGUMENT,
                 "Swank factor is 1.2");
    options = noisy();
    options.electronic_kev = -1;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &plan), SKG_ERR_ARGUMENT,
                 "electronic noise is -1 keV");
    options.electronic_kev = 1, options.quantity = SKG_QUANTITY_PHOTONS;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &plan), SKG_ERR_ARGUMENT,
                 "photons are counted");
    /* Ratios of bands count photons, unless they are weighted by energy. */
    const double edges[2] = {10, 100};
    options.bands = 1, options.band_kev = edges, options.quantity = SKG_QUANTITY_TRANSMISSION;
    ck_skg_fails(skg_plan_create(context, scene, &view, spectrum, &options, &plan), SKG_ERR_ARGUMENT,
                 "BandWeight");
    options.band_weight = SKG_BAND_WEIGHT_ENERGY;
    ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
    skg_plan_release(&plan);
    skg_spectrum_release(&spectrum);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, shares_of_an_extended_source);
    tcase_add_test(tests, keys);
    tcase_add_test(tests, noise_power_follows_the_transfer_function);
    tcase_add_test(tests, electronics);
    tcase_add_test(tests, quantities);
    tcase_add_test(tests, over_the_open_field);
    tcase_add_test(tests, refused);
}

SKG_SUITE_MAIN("noise of images", add_tests)
