/* Noise against what physics says of it: means and variances of the photons detected, their distribution
 * where they are few, the noise power behind a blur, and that keys decide alone. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>
#include <string.h>

enum { SIDE = 128, PIXELS = SIDE * SIDE };

static skg_context *context;
static skg_scene *scene;
static skg_material *tissue, *iodide;
static skg_response *scintillator;
static skg_view view;

/* A slab of 50 mm that covers the detector, in a parallel beam: all pixels alike. */
enum { THICKNESS = 50 };

static void open_scene(void) {
    skg_mesh *slab = NULL;
    skg_part part;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_material_create_named("Tissue, Soft (ICRU-44)", &tissue));
    ck_skg(skg_material_create_named("CsI", &iodide));
    ck_skg(skg_response_create_scintillator(iodide, 0.6, 0.8, &scintillator));
    ck_skg(skg_mesh_create_cuboid(1000, 1000, THICKNESS, &slab));
    skg_part_init(&part);
    part.mesh = slab, part.material = tissue, part.label = "slab";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&slab);
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.columns = view.rows = SIDE;
    view.source[2] = 1; /* direction */
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 0.2;
}

static void close_scene(void) {
    skg_response_release(&scintillator);
    skg_material_release(&tissue);
    skg_material_release(&iodide);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

static skg_spectrum *energies(int64_t count, const double *kev, const double *photons) {
    skg_spectrum *spectrum = NULL;
    ck_skg(skg_spectrum_create_bins(count, kev, photons, &spectrum));
    return spectrum;
}

static skg_plan_options noisy(void) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.noise = 1;
    return options;
}

/* `count` frames of an own index and this seed: [count][PIXELS]. */
static void take(const skg_spectrum *spectrum, const skg_plan_options *options, int64_t seed, int64_t count,
                 double *images) {
    skg_plan *plan = NULL;
    skg_frame frames[8];
    skg_output output;
    skg_job *job = NULL;
    ck_assert(count <= 8);
    for (int64_t i = 0; i < count; i++) {
        skg_frame_init(&frames[i]);
        frames[i].noise_seed = seed, frames[i].index = i;
    }
    ck_skg(skg_plan_create(context, scene, &view, (skg_spectrum *)spectrum, options, &plan));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = images;
    ck_skg(skg_plan_submit(plan, count, frames, &output, &job));
    ck_skg(skg_job_wait(&job));
    skg_plan_release(&plan);
}

typedef struct {
    double mean, variance;
} moments;

static moments moments_of(int64_t count, const double *values) {
    moments m = {0, 0};
    for (int64_t i = 0; i < count; i++) m.mean += values[i];
    m.mean /= (double)count;
    for (int64_t i = 0; i < count; i++) m.variance += (values[i] - m.mean) * (values[i] - m.mean);
    m.variance /= (double)(count - 1);
    return m;
}

/* Sums over the energies: photons that arrive, are detected, what they add, and its square. */
typedef struct {
    double detected, mean, variance, fourth; /* fourth: cumulant, sum of detected times added^4 */
} truth;

static truth sum_energies(int64_t count, const double *kev, const double *photons,
                          const skg_plan_options *options) {
    truth t = {0};
    for (int64_t i = 0; i < count; i++) {
        double per_cm = 0, recorded = kev[i], efficiency = 1;
        ck_skg(skg_material_attenuation_get(tissue, kev[i], &per_cm));
        if (options->response) ck_skg(skg_response_get(options->response, kev[i], 1, &recorded, &efficiency));
        double swank = 1;
        ck_skg(skg_response_swank_get(options->response, kev[i], 1, &swank));
        swank *= options->swank;
        const double detected = photons[i] * exp(-0.1 * per_cm * THICKNESS) * efficiency * swank;
        const double each = recorded / efficiency / swank;
        t.detected += detected;
        t.mean += detected * each;
        t.variance += detected * each * each;
        t.fourth += detected * pow(each, 4);
    }
    return t;
}

/* Mean and variance within four standard errors. */
static void check_moments(int64_t count, const double *values, const truth *t) {
    const moments m = moments_of(count, values);
    const double n = (double)count;
    const double error = sqrt((2 * t->variance * t->variance + t->fourth) / n);
    /* Floats of single precision add 16 roundings, 16 * FLT_EPSILON / 2 = 1e-6. */
    ck_assert_double_eq_tol(m.mean, t->mean, 4 * sqrt(t->variance / n) + 1e-6 * t->mean);
    ck_assert_double_eq_tol(m.variance, t->variance, 4 * error + 1e-6 * t->variance);
}

static const double two_kev[2] = {40, 80};

static void check_two_energies(const double *photons, const skg_plan_options *options) {
    static double images[4 * PIXELS];
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    const truth t = sum_energies(2, two_kev, photons, options);
    take(spectrum, options, 7, 4, images);
    check_moments(4 * PIXELS, images, &t);
    skg_spectrum_release(&spectrum);
}

/* Not that of one Poisson variable of the summed energy. */
START_TEST(two_energies_in_iodide) {
    const double many[2] = {9000, 4000}, few[2] = {30, 10}, hardly[2] = {0.4, 0.2};
    skg_plan_options options = noisy();
    options.response = scintillator;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
    check_two_energies(hardly, &options);
    options.swank = 0.9;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
    options.precision = SKG_PRECISION_DOUBLE;
    check_two_energies(many, &options);
    check_two_energies(few, &options);
}
END_TEST

/* The mean is the same, whatever a table means; the variance is that of its efficiency and second moment. */
START_TEST(meanings_of_a_table) {
    static const double e[2] = {30, 90}, recorded[2] = {24, 45}, efficiency[2] = {0.9, 0.7},
                        swank[2] = {0.95, 0.6};
    const double many[2] = {9000, 4000}, few[2] = {30, 10};
    skg_plan_options options = noisy();
    double variances[3];
    for (int k = 0; k < 3; k++) {
        skg_response_table table;
        skg_response_table_init(&table);
        table.count = 2, table.energies_kev = e, table.recorded_kev = recorded;
        if (k == 1) table.meaning = SKG_RESPONSE_MEANING_ABSORBED;
        if (k == 2) table.efficiency = efficiency, table.swank = swank;
        ck_skg(skg_response_create_table(&table, &options.response));
        variances[k] = sum_energies(2, two_kev, many, &options).variance;
        check_two_energies(many, &options);
        check_two_energies(few, &options);
        skg_response_release(&options.response);
    }
    /* By hand for 40 and 80 keV: recorded 27.5 and 41.5 keV, efficiency 0.8667 and 0.7333, Swank 0.8917 and 0.6583. */
    ck_assert_double_lt(variances[0], variances[1]);
    double by_hand = 0;
    for (int i = 0; i < 2; i++) {
        double per_cm = 0;
        const double r = i ? 41.5 : 27.5, both = i ? 0.7333333 * 0.6583333 : 0.8666667 * 0.8916667;
        ck_skg(skg_material_attenuation_get(tissue, two_kev[i], &per_cm));
        by_hand += many[i] * exp(-0.1 * per_cm * THICKNESS) * r * r / both;
    }
    ck_assert_double_eq_tol(variances[2] / by_hand, 1, 1e-6); /* the digits of the fractions above */
}
END_TEST

/* Counted photons all add 1: the variance is the mean, sum N T eta, and neither signal nor Swank factor shows. */
START_TEST(counted_photons_have_no_size) {
    static double images[4 * PIXELS];
    static const double e[2] = {30, 90}, recorded[2] = {24, 45}, efficiency[2] = {0.9, 0.7},
                        swank[2] = {0.95, 0.6};
    const double photons[2] = {900, 400}, edges[2] = {20, 200};
    skg_response_table table;
    skg_plan_options options = noisy();
    double expected = 0;
    skg_response_table_init(&table);
    table.count = 2, table.energies_kev = e, table.recorded_kev = recorded;
    table.efficiency = efficiency, table.swank = swank;
    ck_skg(skg_response_create_table(&table, &options.response));
    options.quantity = SKG_QUANTITY_PHOTONS, options.swank = 0.5;
    options.bands = 1, options.band_kev = edges;
    for (int i = 0; i < 2; i++) {
        double per_cm = 0, seen = 0;
        ck_skg(skg_material_attenuation_get(tissue, two_kev[i], &per_cm));
        ck_skg(skg_response_get(options.response, two_kev[i], 1, NULL, &seen));
        expected += photons[i] * exp(-0.1 * per_cm * THICKNESS) * seen;
    }
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    take(spectrum, &options, 9, 4, images);
    const moments m = moments_of(4 * PIXELS, images);
    /* Four standard errors of a mean and of a variance. */
    ck_assert_double_eq_tol(m.mean, expected, 4 * sqrt(expected / (4 * PIXELS)));
    ck_assert_double_eq_tol(m.variance, expected, 4 * expected * sqrt(2.0 / (4 * PIXELS)));
    skg_response_release(&options.response);
    skg_spectrum_release(&spectrum);
}
END_TEST

/* Fewer energies stand for the same means and variances, where photons are many and where they are few. */
START_TEST(compressed_spectra) {
    static double images[4 * PIXELS];
    enum { ENERGIES = 60 };
    double kev[ENERGIES], photons[ENERGIES];
    skg_plan_options options = noisy();
    options.response = scintillator;
    for (int few = 0; few < 2; few++) {
        skg_plan *plan = NULL;
        skg_plan_report report;
        for (int i = 0; i < ENERGIES; i++) {
            kev[i] = 20.5 + i;
            photons[i] = (few ? 1e-3 : 1) * (i + 1) * (ENERGIES - i);
        }
        skg_spectrum *spectrum = energies(ENERGIES, kev, photons);
        const truth t = sum_energies(ENERGIES, kev, photons, &options);
        ck_assert(few ? t.detected > 1 && t.detected < 10 : t.detected > 1000);
        options.tolerance = 1e-3;
        skg_plan_report_init(&report);
        ck_skg(skg_plan_create(context, scene, &view, spectrum, &options, &plan));
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_lt(report.nodes, 16);
        ck_assert(report.bound > 0 && report.bound <= 1e-3);
        skg_plan_release(&plan);
        take(spectrum, &options, 7, 4, images);
        check_moments(4 * PIXELS, images, &t);
        skg_spectrum_release(&spectrum);
    }
}
END_TEST

/* One energy, photons counted: whole numbers with Poisson's distribution; DQE(0) = eta A_S follows from mean
 * and variance. */
START_TEST(few_photons_are_exact) {
    static double images[4 * PIXELS];
    enum { LIMIT = 40 };
    const double kev = 60, photons = 20;
    double counts[LIMIT] = {0}, chi = 0, expected;
    int bins = 0;
    skg_plan_options options = noisy();
    options.quantity = SKG_QUANTITY_PHOTONS;
    options.response = scintillator;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    const truth t = sum_energies(1, &kev, &photons, &options);
    take(spectrum, &options, 3, 4, images);
    for (int i = 0; i < 4 * PIXELS; i++) {
        const double count = images[i];
        /* a photon counts as v / w, a ratio of rounded numbers */
        ck_assert_double_eq_tol(count, round(count), 1e-5);
        ck_assert_msg(round(count) < LIMIT, "%g photons where %g are expected", count, t.detected);
        counts[(int)round(count)]++;
    }
    expected = exp(-t.detected) * 4 * PIXELS;
    for (int k = 0; k < LIMIT; k++) {
        if (expected > 10) chi += (counts[k] - expected) * (counts[k] - expected) / expected, bins++;
        expected *= t.detected / (k + 1);
    }
    ck_assert_int_gt(bins, 10);
    ck_assert_double_le(chi, bins + 4 * sqrt(2.0 * bins));
    skg_spectrum_release(&spectrum);
}
END_TEST

START_TEST(detective_quantum_efficiency) {
    static double images[4 * PIXELS];
    const double kev = 60, photons = 20000;
    double per_cm = 0, efficiency = 0;
    skg_plan_options options = noisy();
    options.response = scintillator;
    options.swank = 0.92;
    skg_spectrum *spectrum = energies(1, &kev, &photons);
    take(spectrum, &options, 11, 4, images);
    const moments m = moments_of(4 * PIXELS, images);
    ck_skg(skg_material_attenuation_get(tissue, kev, &per_cm));
    ck_skg(skg_response_get(scintillator, kev, 1, NULL, &efficiency));
    const double arriving = photons * exp(-0.1 * per_cm * THICKNESS);
    /* of a variance from n values: sqrt(2 / n) */
    ck_assert_double_eq_tol(m.mean * m.mean / m.variance / arriving / (efficiency * 0.92), 1,
                            4 * sqrt(2.0 / (4 * PIXELS)));
    skg_spectrum_release(&spectrum);
}
END_TEST

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
    /* The same draws: what differs are 16 roundings of single precision, 1e-6, here and below. */
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
    tcase_add_test(tests, two_energies_in_iodide);
    tcase_add_test(tests, meanings_of_a_table);
    tcase_add_test(tests, counted_photons_have_no_size);
    tcase_add_test(tests, compressed_spectra);
    tcase_add_test(tests, few_photons_are_exact);
    tcase_add_test(tests, detective_quantum_efficiency);
    tcase_add_test(tests, shares_of_an_extended_source);
    tcase_add_test(tests, keys);
    tcase_add_test(tests, noise_power_follows_the_transfer_function);
    tcase_add_test(tests, electronics);
    tcase_add_test(tests, quantities);
    tcase_add_test(tests, over_the_open_field);
    tcase_add_test(tests, refused);
}

SKG_SUITE_MAIN("noise", add_tests)
