/* Noise and blur of scattered photons. */
#include "subject.h"
#include "suite.h"

#include <float.h>
#include <math.h>

enum { FRAMES = 40 };

/* Sums of frames with noise: their mean, and their variance. */
static void take_sums(subject *s, double *mean, double *variance) {
    double sums[FRAMES];
    *mean = *variance = 0;
    for (int f = 0; f < FRAMES; f++) {
        skg_frame frame;
        skg_output output;
        skg_job *job = NULL;
        skg_frame_init(&frame);
        skg_output_init(&output);
        frame.index = f;
        output.data = calloc((size_t)(s->view.rows * s->view.columns), sizeof(float));
        ck_skg(skg_plan_submit(s->plan, 1, &frame, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        sums[f] = subject_sum(s, output.data);
        *mean += sums[f] / FRAMES;
        free(output.data);
    }
    for (int f = 0; f < FRAMES; f++) *variance += pow(sums[f] - *mean, 2) / (FRAMES - 1);
}

/* photons: per pixel of the open beam; beside: jaws keep the primary from the detector, so that scatter is all there is. */
static void judge(double photons, int beside) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.photons = photons;
    if (beside) {
        skg_mesh *block = NULL;
        ck_skg(skg_mesh_create_cuboid(40, 60, 60, &block));
        subject_add(&s, block, "Water, Liquid", 100, 0, 50, -1);
        s.jaws.kind = SKG_COLLIMATION_RECTANGLE;
        s.jaws.distance_mm = 550; /* where the detector's cone ends at 78.6 mm */
        s.jaws.low[0] = 82, s.jaws.high[0] = 120, s.jaws.low[1] = -30, s.jaws.high[1] = 30;
    }
    s.scatter.histories = 1 << 15;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const double still = subject_sum(&s, p.image), scattered = subject_sum(&s, p.scatter);
    s.options.noise = 1;
    subject_plan(&s);
    double mean = 0, variance = 0;
    take_sums(&s, &mean, &variance);
    /* Photons of the primary bring 60 keV, scattered ones between 48.6, once back and forth, and 60: N E^2 = (N E) E. */
    const double most = still * s.kev, least = (still - scattered) * s.kev + scattered * 0.6 * s.kev;
    printf(
        "%g photons%s: scatter %.3f of the image; mean off by %.2f standard errors, variance %.3f to %.3f of that of Poisson\n",
        photons, beside ? " beside the beam" : "", scattered / still, (mean - still) / sqrt(most / FRAMES),
        variance / most, variance / least);
    fflush(stdout); /* before an assertion ends the process */
    ck_assert_double_le(fabs(mean - still), 4 * sqrt(most / FRAMES));
    /* The variance of 40 draws has a spread of sqrt(2 / 39); four of them. */
    ck_assert_double_ge(variance, least * (1 - 4 * sqrt(2.0 / (FRAMES - 1))));
    ck_assert_double_le(variance, most * (1 + 4 * sqrt(2.0 / (FRAMES - 1))));
    pictures_free(&p);
    subject_close(&s);
}

START_TEST(noise_is_that_of_photons) {
    judge(1000, 0);
}
END_TEST

START_TEST(noise_beside_the_beam_is_that_of_scattered_photons) {
    judge(1000, 1);
    judge(100, 1); /* a photon in several pixels */
}
END_TEST

/* Pixels' own variance, in one frame of many photons: that of a Poisson number of keV. */
START_TEST(pixels_are_independent) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    s.photons = 400;
    s.scatter.histories = 1 << 15;
    subject_plan(&s);
    pictures still = subject_pictures(&s, NULL);
    s.options.noise = 1;
    subject_plan(&s);
    pictures noisy = subject_pictures(&s, NULL);
    double square = 0;
    for (int64_t i = 0; i < still.count; i++) {
        const double off = (double)noisy.image[i] - (double)still.image[i];
        square += off * off / ((double)still.image[i] * s.kev) / (double)still.count;
    }
    /* The spread of the mean square of 1,200 draws, .041, four times; scattered photons have up to 7 % less than 60 keV here. */
    ck_assert_double_eq_tol(square, 1, 4 * 0.041 + 0.07);
    for (int64_t i = 0; i < still.count; i++) /* outputs of scatter are without noise */
        ck_assert_double_eq((double)noisy.scatter[i], (double)still.scatter[i]);
    pictures_free(&still);
    pictures_free(&noisy);
    subject_close(&s);
}
END_TEST

/* Blur moves scatter and loses nothing of it: pixels at the edge stand for those beyond, where there is almost as much. */
START_TEST(blur_comes_behind_scatter) {
    static const double shape[] = {1, 2, 3, 2, 1};
    skg_detector_blur blur;
    subject s;
    subject_open(&s);
    subject_fill(&s);
    subject_plan(&s);
    pictures sharp = subject_pictures(&s, NULL);
    skg_detector_blur_init(&blur);
    blur.columns = 5, blur.rows = 1;
    blur.along_row = shape, blur.along_column = shape;
    s.options.blur = &blur;
    subject_plan(&s);
    pictures soft = subject_pictures(&s, NULL);
    for (int64_t row = 0; row < s.view.rows; row++)
        for (int64_t column = 0; column < s.view.columns; column++) {
            double sum = 0;
            for (int64_t k = -2; k <= 2; k++) {
                const int64_t from = column + k < 0                ? 0
                                     : column + k < s.view.columns ? column + k
                                                                   : s.view.columns - 1;
                sum += shape[k + 2] / 9 * (double)sharp.image[row * s.view.columns + from];
            }
            /* Sums of five floats, whatever their order. */
            ck_assert_double_eq_tol((double)soft.image[row * s.view.columns + column], sum,
                                    8 * (double)FLT_EPSILON * sum);
        }
    for (int64_t i = 0; i < sharp.count; i++)
        ck_assert_double_eq((double)soft.scatter[i], (double)sharp.scatter[i]);
    pictures_free(&sharp);
    pictures_free(&soft);
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, noise_is_that_of_photons);
    tcase_add_test(tests, noise_beside_the_beam_is_that_of_scattered_photons);
    tcase_add_test(tests, pixels_are_independent);
    tcase_add_test(tests, blur_comes_behind_scatter);
}

SKG_SUITE_MAIN("scatter/noise", add_tests)
