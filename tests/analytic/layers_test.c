/* Blur by depths of a scintillator and noise power by a DQE, against closed forms: Gaussian transfer functions, shares of a layer by
 * depth, and the noise power of flat fields from simulated frames. */
#include "suite.h"

#include "support/named.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 96, ROWS = 64, PIXELS = COLUMNS * ROWS, FRAMES = 64 };

static const double PI = 3.14159265358979323846;
static const double PIXEL = 0.2;                /* mm */
static const double PHOTONS = 1e4, ENERGY = 60; /* a pixel; keV */
static skg_scene *scene;
static skg_material *csi, *lead;
static skg_response *scintillator;
static skg_spectrum *mono;
static skg_view view;
static skg_plan_options options;

static void open_all(void) {
    skg_mesh *plate = NULL;
    skg_part part;
    run_open();
    csi = named("CsI"), lead = named("Pb");
    ck_skg(skg_response_create_scintillator(csi, 0.6, 0.8, &scintillator));
    ck_skg(skg_spectrum_create_mono(ENERGY, PHOTONS, &mono));
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_cuboid(4.01, 3.03, 2, &plate)); /* an edge across the image */
    skg_part_init(&part);
    part.mesh = plate, part.material = lead, part.label = "plate";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&plate);
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.columns = COLUMNS, view.rows = ROWS;
    view.source[2] = 1, view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = PIXEL;
    skg_plan_options_init(&options);
}

static void close_all(void) {
    skg_spectrum_release(&mono);
    skg_response_release(&scintillator);
    skg_material_release(&csi);
    skg_material_release(&lead);
    skg_scene_release(&scene);
    run_close();
}

/* [count][PIXELS] frames of the scene, or beside it. */
static double *frames_of(const skg_spectrum *beam, int beside, int64_t count) {
    skg_view seen = view;
    skg_plan *plan = NULL;
    skg_job *job = NULL;
    skg_output output;
    skg_frame *frames = calloc((size_t)count, sizeof *frames);
    double *images = malloc((size_t)(count * PIXELS) * sizeof *images);
    if (beside) seen.centre[0] = 1000;
    ck_skg(skg_plan_create(run_context, scene, &seen, (skg_spectrum *)beam, &options, &plan));
    for (int64_t i = 0; i < count; i++) skg_frame_init(&frames[i]), frames[i].index = i;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = images;
    ck_skg(skg_plan_submit(plan, count, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    skg_plan_release(&plan);
    free(frames);
    return images;
}

/* --- line spread functions --- */

enum { TABLE = 26 };
static double frequencies[TABLE], gaussian[TABLE], dqe_values[TABLE];
static const double SIGMA = 1.2; /* pixels */

static double gaussian_at(double cycles) {
    return exp(-2 * PI * PI * SIGMA * SIGMA * cycles * cycles);
}

static void fill_tables(void) {
    for (int i = 0; i < TABLE; i++) {
        frequencies[i] = i * 0.5 / PIXEL / (TABLE - 1);
        gaussian[i] = gaussian_at(frequencies[i] * PIXEL);
        dqe_values[i] = 0.7 - 0.45 * i / (TABLE - 1);
    }
}

START_TEST(gaussian_transfer_function) {
    double line[SKG_LINE_SAMPLES_MAX];
    int64_t samples = 0;
    fill_tables();
    ck_skg(skg_line_spread_get(TABLE, frequencies, gaussian, PIXEL, line, &samples));
    ck_assert_int_eq(samples % 2, 1);
    ck_assert_int_lt(samples, 12); /* 4 standard deviations on either side are 10.6 pixels */
    for (int64_t n = 0; n < samples; n++) {
        const double x = (double)(n - samples / 2);
        /* Each of the errors of 0.005 of the transfer function is the most that a sample may have. */
        ck_assert_double_eq_tol(line[n], exp(-x * x / (2 * SIGMA * SIGMA)) / (sqrt(2 * PI) * SIGMA), 5e-3);
    }
    for (double cycles = 0; cycles <= 0.5; cycles += 1.0 / 64) {
        double sum = 0;
        for (int64_t n = 0; n < samples; n++)
            sum += line[n] * cos(2 * PI * cycles * (double)(n - samples / 2));
        /* The error that the header states, and that of the curve between 26 rows: its fourth derivative, 12 (2 pi sigma)^4 / 16, times the
         * fourth
         * power of the step over 384 is 2e-6; a slope of two secants is 1e-3 off. */
        ck_assert_double_eq_tol(sum, gaussian_at(cycles), 5e-3 + 1e-3);
    }
}
END_TEST

START_TEST(wrong_tables) {
    double line[SKG_LINE_SAMPLES_MAX], values[TABLE], rows[TABLE];
    int64_t samples = 0;
    fill_tables();
    ck_skg_fails(skg_line_spread_get(TABLE, frequencies, gaussian, PIXEL / 2, line, &samples),
                 SKG_ERR_ARGUMENT,
                 "ends at 2.5 per mm, but pixels of 0.1 mm show frequencies up to 5 per mm");
    ck_skg_fails(skg_line_spread_get(1, frequencies, gaussian, PIXEL, line, &samples), SKG_ERR_ARGUMENT,
                 "two frequencies");
    ck_skg_fails(skg_line_spread_get(TABLE, frequencies, gaussian, 0, line, &samples), SKG_ERR_ARGUMENT,
                 "a pixel of 0 mm");
    memcpy(values, gaussian, sizeof values), values[0] = 0.9;
    ck_skg_fails(skg_line_spread_get(TABLE, frequencies, values, PIXEL, line, &samples), SKG_ERR_ARGUMENT,
                 "row 1: 0.9");
    memcpy(rows, frequencies, sizeof rows), rows[4] = rows[3];
    ck_skg_fails(skg_line_spread_get(TABLE, rows, gaussian, PIXEL, line, &samples), SKG_ERR_ARGUMENT,
                 "row 5");
    const double steep[4] = {0, 1.249, 1.25, 2.5}, step[4] = {1, 1, 0, 0};
    ck_skg_fails(skg_line_spread_get(4, steep, step, PIXEL, line, &samples), SKG_ERR_ARGUMENT,
                 "changes too fast");
}
END_TEST

/* --- depths --- */

static const double wide[7] = {0.05, 0.1, 0.2, 0.3, 0.2, 0.1, 0.05}, narrow[3] = {0.15, 0.7, 0.15};
static const double ends[2] = {0.35, 1};
static skg_detector_blur blurs[2];
static skg_depth_blur depths;

static void make_depths(void) {
    skg_detector_blur_init(&blurs[0]);
    blurs[1] = blurs[0];
    blurs[0].columns = blurs[0].rows = 7, blurs[0].along_row = blurs[0].along_column = wide;
    blurs[1].columns = blurs[1].rows = 3, blurs[1].along_row = blurs[1].along_column = narrow;
    skg_depth_blur_init(&depths);
    depths.count = 2, depths.to = ends, depths.blur = blurs;
    options.response = scintillator;
    options.depth_blur = &depths;
}

/* Of the photons of an energy that interact in 0.6 mm with a packing of 0.8, the share in the first depth. */
static double share_of(double energy) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(csi, energy, &per_cm));
    const double thick = 0.06 * 0.8 * per_cm;
    return (1 - exp(-thick * ends[0])) / (1 - exp(-thick));
}

START_TEST(each_energy_by_its_depths) {
    static const double energies[2] = {30, 100}, counts[2] = {1000, 1000};
    double *by_depths[2], *blurred[2][2];
    for (int e = 0; e < 2; e++) {
        skg_spectrum *beam = NULL;
        ck_skg(skg_spectrum_create_mono(energies[e], counts[e], &beam));
        make_depths();
        by_depths[e] = frames_of(beam, 0, 1);
        options.depth_blur = NULL;
        for (int d = 0; d < 2; d++) options.blur = &blurs[d], blurred[e][d] = frames_of(beam, 0, 1);
        options.blur = NULL;
        const double share = share_of(energies[e]), flat = by_depths[e][0];
        for (int p = 0; p < PIXELS; p++) /* Weights and sums of some ten terms are in single precision. */
            ck_assert_double_eq_tol(by_depths[e][p],
                                    share * blurred[e][0][p] + (1 - share) * blurred[e][1][p], 2e-6 * flat);
        skg_spectrum_release(&beam);
    }
    /* Below the K edges most photons stay near the surface: the shares differ. */
    ck_assert_double_gt(share_of(30), share_of(100) + 0.15);
    /* Both together, and fewer energies than all, and ratios to the flat field. */
    skg_spectrum *beam = NULL;
    ck_skg(skg_spectrum_create_bins(2, energies, counts, &beam));
    make_depths();
    double *both = frames_of(beam, 0, 1);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    double *ratio = frames_of(beam, 0, 1);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    double *logarithm = frames_of(beam, 0, 1);
    const double flat = both[0];
    for (int p = 0; p < PIXELS; p++) {
        /* As above, twice: of two energies, and of the ratio's weights. */
        ck_assert_double_eq_tol(both[p], by_depths[0][p] + by_depths[1][p], 4e-6 * flat);
        ck_assert_double_eq_tol(ratio[p], both[p] / flat, 4e-6);
        /* Likewise. */
        ck_assert_double_eq_tol(exp(-logarithm[p]), ratio[p], 4e-6);
    }
    free(both), free(ratio), free(logarithm);
    for (int e = 0; e < 2; e++) free(by_depths[e]), free(blurred[e][0]), free(blurred[e][1]);
    skg_spectrum_release(&beam);
}
END_TEST

/* --- noise power --- */

/* Power of the frames' rows at a frequency, per pixel, over the pixels that the border does not reach: mean over all rows of the
 * squared magnitude behind a window of Hann. */
static double power_of(const double *frames, double mean, double cycles, int border) {
    double power = 0, squares = 0;
    int64_t rows = 0;
    const int count = COLUMNS - 2 * border;
    for (int n = 0; n < count; n++) squares += pow(sin(PI * (n + 0.5) / count), 4);
    for (int64_t row = 0; row < FRAMES * ROWS; row++) {
        const int64_t in_frame = row % ROWS;
        double even = 0, odd = 0;
        if (in_frame < border || in_frame >= ROWS - border) continue;
        for (int n = 0; n < count; n++) {
            const double window = pow(sin(PI * (n + 0.5) / count), 2);
            const double value = window * (frames[row * COLUMNS + border + n] - mean);
            even += value * cos(2 * PI * cycles * n), odd += value * sin(2 * PI * cycles * n);
        }
        power += (even * even + odd * odd) / squares;
        rows++;
    }
    return power / (double)rows;
}

static double mean_of(const double *frames) {
    double sum = 0;
    for (int64_t i = 0; i < (int64_t)FRAMES * PIXELS; i++) sum += frames[i];
    return sum / ((double)FRAMES * PIXELS);
}

/* Of 64 frames with 40 rows or more, of which the blur makes every fourth or so independent, the power of one frequency has a standard
 * error of 1 / sqrt(640), 4 %; four of these. */
static const double POWER_BAR = 0.16;

/* Each frequency alone is that uncertain; their mean less so: neighbours are independent behind the window, 5 frequencies. */
static const double MEAN_BAR = 0.07;

static double transfer_of(int count, const double *line, double cycles) {
    double sum = 0;
    for (int n = 0; n < count; n++) sum += line[n] * cos(2 * PI * cycles * (n - count / 2));
    return sum;
}

static double square_sum(int count, const double *line) {
    double sum = 0;
    for (int n = 0; n < count; n++) sum += line[n] * line[n];
    return sum;
}

static void check_power(const double *frames, int border, double (*wanted)(double cycles)) {
    const double mean = mean_of(frames);
    double ratio = 0;
    for (int k = 0; k < 5; k++) {
        const double cycles = 0.06 + 0.1 * k; /* 0.46: near half a cycle, behind the window's width */
        const double found = power_of(frames, mean, cycles, border) / wanted(cycles);
        ck_assert_double_eq_tol(found, 1, POWER_BAR);
        ratio += found / 5;
    }
    ck_assert_double_eq_tol(ratio, 1, MEAN_BAR);
}

/* Photons of both depths are independent: the powers add up, (G. Lubberts 1968). Down the columns, rows are summed over all
 * frequencies: the sum of squares. */
static double power_by_depths(double cycles) {
    double efficiency = 0;
    ck_skg(skg_response_get(scintillator, ENERGY, 1, NULL, &efficiency));
    const double share = share_of(ENERGY), all = PHOTONS * efficiency * ENERGY * ENERGY;
    const double first = transfer_of(7, wide, cycles), second = transfer_of(3, narrow, cycles);
    return all * (share * first * first * square_sum(7, wide) +
                  (1 - share) * second * second * square_sum(3, narrow));
}

START_TEST(noise_of_depths) {
    make_depths();
    options.noise = 1;
    double *frames = frames_of(mono, 1, FRAMES);
    check_power(frames, 4, power_by_depths);
    free(frames);
}
END_TEST

static skg_dqe dqe;

static double dqe_at(double cycles) {
    return 0.7 - 0.45 * cycles / 0.5;
}

/* mean^2 MTF^2 / (q DQE), times the mean over all frequencies of MTF^2 DQE(0) / DQE of the other direction. */
static double power_by_dqe(double cycles) {
    const double mean = PHOTONS * ENERGY;
    double other = 0;
    for (int k = 0; k < 200; k++) {
        const double f = (k + 0.5) / 400;
        other += pow(gaussian_at(f), 2) * dqe_at(0) / dqe_at(f) / 200;
    }
    return mean * mean * pow(gaussian_at(cycles), 2) / (PHOTONS * dqe_at(cycles)) * other;
}

static void make_dqe(double *line, skg_detector_blur *blur) {
    int64_t samples = 0;
    fill_tables();
    ck_skg(skg_line_spread_get(TABLE, frequencies, gaussian, PIXEL, line, &samples));
    skg_detector_blur_init(blur);
    blur->columns = blur->rows = samples, blur->along_row = blur->along_column = line;
    skg_dqe_init(&dqe);
    dqe.count = TABLE, dqe.per_mm = frequencies, dqe.dqe = dqe_values;
    options.noise = 1, options.blur = blur, options.dqe = &dqe;
}

/* Where the Gaussian has fallen to some hundredths, its tables' errors of 0.005 are larger than the power. */
static double power_of_white(double cycles) {
    const double mean = PHOTONS * ENERGY;
    double other = 0;
    for (int k = 0; k < 200; k++) other += dqe_at(0) / dqe_at((k + 0.5) / 400) / 200;
    return mean * mean / (PHOTONS * dqe_at(cycles)) * other;
}

START_TEST(noise_by_a_table) {
    double line[SKG_LINE_SAMPLES_MAX];
    skg_detector_blur blur;
    make_dqe(line, &blur);
    double *frames = frames_of(mono, 1, FRAMES);
    const double mean = mean_of(frames);
    for (int k = 0; k < 2; k++) { /* MTF 0.75 and 0.31 */
        const double cycles = 0.1 + 0.1 * k;
        ck_assert_double_eq_tol(power_of(frames, mean, cycles, 8) / power_by_dqe(cycles), 1, POWER_BAR);
    }
    free(frames);
    options.blur = NULL; /* white noise becomes what the DQE says, and the signal stays sharp */
    frames = frames_of(mono, 1, FRAMES);
    check_power(frames, 8, power_of_white);
    free(frames);
    options.noise = 0;
    double *plain = frames_of(mono, 0, 1);
    options.dqe = NULL;
    double *without = frames_of(mono, 0, 1);
    ck_assert_mem_eq(plain, without, PIXELS * sizeof *plain);
    free(plain), free(without);
}
END_TEST

/* --- absent, or refused --- */

static int effect_is_on(const char *name, const char *reason) {
    skg_plan *plan = NULL;
    int64_t count = 0;
    int on = -1;
    ck_skg(skg_plan_create(run_context, scene, &view, mono, &options, &plan));
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t e = 0; e < count && on < 0; e++) {
        skg_effect effect;
        skg_effect_init(&effect);
        ck_skg(skg_plan_effect_get(plan, e, &effect));
        if (strcmp(effect.name, name) != 0) continue;
        on = effect.on;
        ck_assert_msg(strstr(effect.reason, reason) != NULL, "%s: \"%s\" has no \"%s\"", name, effect.reason,
                      reason);
    }
    skg_plan_release(&plan);
    ck_assert_int_ge(on, 0);
    return on;
}

static void check_refused(skg_status status, const char *text) {
    skg_plan *plan = NULL;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, mono, &options, &plan), status, text);
}

START_TEST(absent_or_refused) {
    double line[SKG_LINE_SAMPLES_MAX];
    const double falling[2] = {0.5, 0.4}, short_of[2] = {0.5, 0.9};
    static const double bands[12] = {10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120};
    skg_detector_blur blur;
    options.response = scintillator;
    ck_assert(!effect_is_on("blur by depths", "same for all energies"));
    ck_assert(!effect_is_on("noise power", "as the signal is"));
    make_depths();
    ck_assert(effect_is_on("blur by depths", "2 depths"));
    ck_assert(!effect_is_on("blur", "no line"));
    options.blur = &blurs[0];
    check_refused(SKG_ERR_ARGUMENT, "leave out the one for all");
    options.blur = NULL, options.response = NULL;
    check_refused(SKG_ERR_ARGUMENT, "is ideal");
    options.response = scintillator, depths.to = falling;
    check_refused(SKG_ERR_ARGUMENT, "depth 2 of the scintillator ends at 0.4");
    depths.to = short_of;
    check_refused(SKG_ERR_ARGUMENT, "the last is 1");
    depths.to = ends, depths.count = 9;
    check_refused(SKG_ERR_ARGUMENT, "9 depths");
    depths.count = 2, blurs[1].columns = 2;
    check_refused(SKG_ERR_ARGUMENT, "depth 2: the line spread function along the rows has 2 samples");
    blurs[1].columns = 3, options.bands = 11, options.band_kev = bands;
    check_refused(SKG_ERR_ARGUMENT, "2 depths of 11 bands");
    options.bands = 0;
    make_dqe(line, &blur);
    options.blur = NULL;
    check_refused(SKG_ERR_ARGUMENT, "give one of them");
    options.depth_blur = NULL;
    ck_assert(effect_is_on("noise power", "DQE of 0.7 at 0 to 0.25 at 2.5 per mm"));
    dqe_values[0] = 0.99;
    check_refused(SKG_ERR_BEAM, "more than the detector's response allows for this beam");
    dqe_values[3] = 0;
    check_refused(SKG_ERR_ARGUMENT, "row 4: 0");
    fill_tables();
    dqe.count = TABLE - 2;
    check_refused(SKG_ERR_ARGUMENT, "add rows up to there");
    dqe.count = TABLE, options.bands = 2, options.band_kev = bands;
    check_refused(SKG_ERR_ARGUMENT, "without bands");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_all, close_all);
    tcase_add_test(tests, gaussian_transfer_function);
    tcase_add_test(tests, wrong_tables);
    tcase_add_test(tests, each_energy_by_its_depths);
    tcase_add_test(tests, noise_of_depths);
    tcase_add_test(tests, noise_by_a_table);
    tcase_add_test(tests, absent_or_refused);
}

SKG_SUITE_MAIN("layers", add_tests)
