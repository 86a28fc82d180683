/* Response of detectors to scattered photons, whose energy and slope are known behind a small sphere: oblique scintillators, bands of
 * energy, blur by depths, a DQE. */
#include "subject.h"
#include "suite.h"
#include "sums.h"
#include "support/named.h"

#include <float.h>
#include <math.h>

enum { SIDE = 8, PIXELS = SIDE * SIDE };
static const double RADIUS = 0.2, KEV = 60, PITCH = 1, ELECTRON_KEV = 510.99895;

/* A small sphere in a beam as wide as it, and a detector of 8 x 8 mm at z = 100 mm, around x = aside. */
static subject open_sphere(double aside) {
    subject s;
    subject_open(&s);
    solid ball = solid_sphere(RADIUS, 24, 12);
    subject_add(&s, run_mesh(&ball), "Water, Liquid", 0, 0, 0, -1);
    solid_free(&ball);
    s.kev = KEV;
    s.view.centre[0] = aside, s.view.centre[2] = 100;
    s.view.columns = s.view.rows = SIDE;
    s.view.column_step[0] = s.view.row_step[1] = PITCH;
    s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 500;
    for (int k = 0; k < 2; k++) {
        const double middle = k ? 0 : aside * 500 / 600;
        s.jaws.low[k] = -middle - RADIUS, s.jaws.high[k] = -middle + RADIUS;
    }
    s.scatter.histories = 1 << 14;
    return s;
}

/* The cosine of the way to a pixel against the beam, which is that against the detector's normal. */
static double cosine_of(double aside, int64_t pixel) {
    const double x = aside + ((double)(pixel % SIDE) - (SIDE - 1) / 2.0) * PITCH;
    const double y = ((double)(pixel / SIDE) - (SIDE - 1) / 2.0) * PITCH;
    return 100 / sqrt(x * x + y * y + 1e4);
}

/* keV of a photon that is scattered once, by Compton's formula or unchanged. */
static double kev_after(double cosine, int changed) {
    return changed ? KEV / (1 + KEV / ELECTRON_KEV * (1 - cosine)) : KEV;
}

/* A component of all channels. */
static void take_component(subject *s, int32_t component, float *image) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.kind = SKG_OUTPUT_SCATTER_COMPONENT, output.component = component;
    output.data = image;
    ck_skg(skg_plan_submit(s->plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

static double sum_of(const float *image) {
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) sum += (double)image[i];
    return sum;
}

static skg_response *scintillator(int escapes) {
    skg_material *iodide = named("CsI");
    skg_response *plain = NULL, *response = NULL;
    skg_material *dense = NULL;
    ck_skg(skg_material_create_at_density(iodide, 4.51, &dense));
    ck_skg(skg_response_create_scintillator(dense, 0.2, 0.8, &plain));
    if (escapes)
        ck_skg(skg_response_create_escaping(plain, &response));
    else
        response = plain;
    if (escapes) skg_response_release(&plain);
    skg_material_release(&iodide);
    skg_material_release(&dense);
    return response;
}

/* Recorded signal of photons that cross the layer obliquely over that of straight ones, on average over the detector. */
static double oblique_gain(const skg_response *response, double aside, int changed) {
    double gain = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double cosine = cosine_of(aside, i), kev = kev_after(cosine, changed);
        double straight = 0, oblique = 0;
        ck_skg(skg_response_get(response, kev, 1, &straight, NULL));
        ck_skg(skg_response_get(response, kev, 1 / cosine, &oblique, NULL));
        gain += oblique / straight / PIXELS;
    }
    return gain;
}

START_TEST(oblique_photons_cross_more_of_the_layer) {
    static const double places[] = {0, 60, 140};
    static const int32_t kinds[2] = {SKG_SCATTER_COMPONENT_RAYLEIGH_FIRST,
                                     SKG_SCATTER_COMPONENT_COMPTON_FIRST};
    for (int escapes = 0; escapes < 2; escapes++)
        for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
            skg_response *response = scintillator(escapes);
            double sums[2][2];
            for (int oblique = 0; oblique < 2; oblique++) {
                subject s = open_sphere(places[p]);
                float image[PIXELS];
                s.options.response = response, s.options.oblique = oblique;
                subject_plan(&s);
                for (int k = 0; k < 2; k++) {
                    take_component(&s, kinds[k], image);
                    sums[oblique][k] = sum_of(image);
                }
                subject_close(&s);
            }
            for (int k = 0; k < 2; k++) {
                const double gain = sums[1][k] / sums[0][k], expected = oblique_gain(response, places[p], k);
                printf("at %g mm, escape %d, %s: %.5f, closed form %.5f\n", places[p], escapes,
                       k ? "Compton" : "Rayleigh", gain, expected);
                fflush(stdout); /* before an assertion ends the process */
                /* Pixels count by what reaches them, which differs by 10 % over gains that differ by up to 5 %. */
                ck_assert_double_eq_tol(gain / expected, 1, 3e-3);
            }
            skg_response_release(&response);
        }
}
END_TEST

/* Images of bands of the same beam: [bands][PIXELS]. */
static void take_bands(subject *s, int64_t bands, const double *edges, float *image) {
    skg_output output;
    skg_job *job = NULL;
    s->options.bands = bands, s->options.band_kev = edges;
    subject_plan(s);
    skg_output_init(&output);
    output.kind = SKG_OUTPUT_SCATTER, output.data = image;
    ck_skg(skg_plan_submit(s->plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

/* Where Compton's formula puts photons that are scattered once, and with their energy those that are not changed. */
START_TEST(bands_have_the_photons_of_their_energies) {
    static const double aside = 140;
    double low = HUGE_VAL, high = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double kev = kev_after(cosine_of(aside, i), 1);
        low = fmin(low, kev), high = fmax(high, kev);
    }
    /* Pixels reach half a mm beyond their middles, and the sphere .2 mm: .1 keV. */
    const double edges[] = {1, low - 0.1, high + 0.1, 59.9, 60.1};
    static float image[4 * PIXELS];
    subject s = open_sphere(aside);
    s.options.bands = 4, s.options.band_kev = edges;
    subject_plan(&s);
    for (int changed = 0; changed < 2; changed++) {
        take_component(
            &s, changed ? SKG_SCATTER_COMPONENT_COMPTON_FIRST : SKG_SCATTER_COMPONENT_RAYLEIGH_FIRST, image);
        for (int b = 0; b < 4; b++) {
            const double sum = sum_of(image + b * PIXELS);
            printf("%s, %.2f to %.2f keV: %g\n", changed ? "Compton" : "Rayleigh", edges[b], edges[b + 1],
                   sum);
            fflush(stdout); /* before an assertion ends the process */
            if (b == (changed ? 1 : 3))
                ck_assert_double_gt(sum, 0);
            else
                ck_assert_double_eq(sum, 0);
        }
    }
    subject_close(&s);
}
END_TEST

/* Bands add up to the image without them, over the detector: each keeps cosines of its own. */
START_TEST(bands_add_up) {
    static const double edges[] = {0, 45, 52, 58, 61};
    for (int noise = 0; noise < 2; noise++)
        for (int32_t weight = SKG_BAND_WEIGHT_PHOTONS; weight <= SKG_BAND_WEIGHT_ENERGY; weight++) {
            subject s;
            double sums[2] = {0};
            subject_open(&s);
            subject_fill(&s);
            s.options.band_weight = weight;
            s.options.noise = noise;
            s.options.quantity =
                weight == SKG_BAND_WEIGHT_ENERGY ? SKG_QUANTITY_ENERGY : SKG_QUANTITY_PHOTONS;
            const int64_t count = s.view.rows * s.view.columns;
            float *image = calloc((size_t)(4 * count), sizeof *image);
            take_bands(&s, 0, NULL, image);
            for (int64_t i = 0; i < count; i++) sums[0] += (double)image[i];
            const skg_scatter_report whole = subject_report(&s);
            take_bands(&s, 4, edges, image);
            for (int64_t i = 0; i < 4 * count; i++) sums[1] += (double)image[i];
            const skg_scatter_report report = subject_report(&s);
            /* Equal histories; a cosine may swing below 0 where little arrives, and is cut there: 1e-4. */
            ck_assert_double_eq_tol(sums[1] / sums[0], 1, 1e-4);
            ck_assert_double_eq_tol(4 * report.mean / whole.mean, 1, 1e-4);
            ck_assert_double_eq_tol(report.orders[0], whole.orders[0],
                                    1e-6); /* sums of the same whole numbers */
            free(image);
            subject_close(&s);
        }
}
END_TEST

/* Shares of depths with blurs of one sample. */
static void give_depths(skg_depth_blur *depths, skg_detector_blur *blurs, const double *to) {
    static const double one = 1;
    skg_depth_blur_init(depths);
    depths->count = 2, depths->to = to, depths->blur = blurs;
    for (int d = 0; d < 2; d++) {
        skg_detector_blur_init(&blurs[d]);
        blurs[d].columns = blurs[d].rows = 1;
        blurs[d].along_row = blurs[d].along_column = &one;
    }
}

/* exp(-a) - exp(-b) of the photons that interact between two depths. */
static double depth_share(double depth, double cosine, double from, double to) {
    return (exp(-depth / cosine * from) - exp(-depth / cosine * to)) / -expm1(-depth / cosine);
}

START_TEST(depths_have_the_photons_that_interact_there) {
    static const double aside = 140, to[] = {0.3, 1};
    for (int oblique = 0; oblique < 2; oblique++) {
        skg_response *response = scintillator(0);
        skg_detector_blur blurs[2];
        skg_depth_blur depths;
        float layers[2 * PIXELS];
        double first[2] = {0}, efficiency = 0;
        subject s = open_sphere(aside);
        s.options.response = response, s.options.oblique = oblique;
        subject_plan(&s);
        pictures whole = subject_pictures(&s, NULL);
        give_depths(&depths, blurs, to);
        s.options.depth_blur = &depths;
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        ck_skg(staged_read(run_context, s.plan, 2 * PIXELS, layers));
        for (int i = 0; i < PIXELS; i++) {
            /* Rounding of the sum of two floats. */
            ck_assert_double_eq_tol((double)p.image[i], (double)whole.image[i],
                                    64 * (double)FLT_EPSILON * (double)whole.image[i]);
            for (int l = 0; l < 2; l++) first[l] += (double)layers[l * PIXELS + i];
        }
        /* Nearly all is scattered once, between the energies of Compton's formula and 60 keV. */
        double bounds[2];
        for (int changed = 0; changed < 2; changed++) {
            const double cosine = cosine_of(aside, PIXELS / 2 + SIDE / 2);
            ck_skg(skg_response_get(response, kev_after(cosine, changed), 1, NULL, &efficiency));
            bounds[changed] = depth_share(-log1p(-efficiency), oblique ? cosine : 1, 0, to[0]);
        }
        const double share = first[0] / (first[0] + first[1]);
        printf("oblique %d: the first depth has %.4f, closed form %.4f to %.4f\n", oblique, share, bounds[0],
               bounds[1]);
        fflush(stdout); /* before an assertion ends the process */
        ck_assert_double_ge(share, fmin(bounds[0], bounds[1]) - 2e-3);
        ck_assert_double_le(share, fmax(bounds[0], bounds[1]) + 2e-3);
        pictures_free(&whole);
        pictures_free(&p);
        skg_response_release(&response);
        subject_close(&s);
    }
}
END_TEST

/* Scatter alone beside the beam: the variance of its pixels over their mean times 60 keV, and the mean over the still one. */
static void measure_noise(const skg_dqe *dqe, double *variance, double *mean) {
    enum { FRAMES = 8 };
    subject s;
    subject_open(&s);
    skg_mesh *block = NULL;
    ck_skg(skg_mesh_create_cuboid(40, 60, 60, &block));
    subject_add(&s, block, "Water, Liquid", 100, 0, 50, -1);
    s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 550;
    s.jaws.low[0] = 82, s.jaws.high[0] = 120, s.jaws.low[1] = -30, s.jaws.high[1] = 30;
    s.photons = 1e6;
    subject_plan(&s);
    pictures still = subject_pictures(&s, NULL);
    s.options.noise = 1, s.options.dqe = dqe;
    subject_plan(&s);
    *variance = *mean = 0;
    for (int f = 0; f < FRAMES; f++) {
        skg_frame frame;
        skg_frame_init(&frame);
        frame.index = f;
        pictures noisy = subject_pictures(&s, &frame);
        for (int64_t i = 0; i < still.count; i++) {
            const double level = (double)still.image[i], off = (double)noisy.image[i] - level;
            *variance += off * off / (level * s.kev) / (double)(FRAMES * still.count);
        }
        *mean += subject_sum(&s, noisy.image) / subject_sum(&s, still.image) / FRAMES;
        pictures_free(&noisy);
    }
    pictures_free(&still);
    subject_close(&s);
}

/* A DQE of a half at all frequencies doubles the power of the noise, and changes no mean. */
START_TEST(a_dqe_scales_the_noise) {
    static const double per_mm[] = {0, 1}, values[] = {0.5, 0.5};
    skg_dqe dqe;
    double variance[2], mean[2];
    skg_dqe_init(&dqe);
    dqe.count = 2, dqe.per_mm = per_mm, dqe.dqe = values;
    measure_noise(NULL, &variance[0], &mean[0]);
    measure_noise(&dqe, &variance[1], &mean[1]);
    printf("variance %.4f of that of 60 keV, with the DQE %.4f; mean off by %.2g and %.2g\n", variance[0],
           variance[1], mean[0] - 1, mean[1] - 1);
    fflush(stdout); /* before an assertion ends the process */
    /* The variance of 9,600 draws has a spread of sqrt(2 / 9600) = .0144; four of two of them. */
    ck_assert_double_eq_tol(variance[1] / variance[0], 2, 2 * 0.082);
    for (int k = 0; k < 2; k++) ck_assert_double_eq_tol(mean[k], 1, 5e-3);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, oblique_photons_cross_more_of_the_layer);
    tcase_add_test(tests, bands_have_the_photons_of_their_energies);
    tcase_add_test(tests, bands_add_up);
    tcase_add_test(tests, depths_have_the_photons_that_interact_there);
    tcase_add_test(tests, a_dqe_scales_the_noise);
}

SKG_SUITE_MAIN("scatter/detector", add_tests)
