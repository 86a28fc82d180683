/* A counting detector against photons that are followed one by one through the pixels of the sensor: all scattering, and fluorescence until
 * it ends. */
#include "counter_photons.h"
#include "suite.h"
#include "support/named.h"

#include <skiagraph/counting.h>

#include <math.h>

/* In the tables of the counter. */
enum { ACROSS = SKG_COUNTING_SIDE, BESIDE = ACROSS * ACROSS / 2 + 1, BELOW = BESIDE - 1 + ACROSS };
enum { PHOTONS = 100000 };

static const sensor sensors[] = {
    {"CdTe", 1, 0.1, 400, 0.005, 1.5, 60, {12, 30, 50}, 0},
    {"CdTe", 2, 0.25, 900, 0, 2, 100, {20, 45, 80}, 0},
    {"CdTe", 1, 0.055, 300, 0.005, 1.2, 40, {10, 20, 33}, 0},
    {"CdTe", 1, 0.11, 400, 0.005, 1.5, 60, {13, 30, 50}, 1},
    {"Si", 0.5, 0.055, 150, 0.003, 0.8, 20, {5, 10, 15}, 0},
    {"Si", 1, 0.17, 200, 0, 1, 60, {5, 9, 40}, 0},
};

/* The windows in which pixels count. */
static void count_pixels(history *h, int *windows) {
    for (int k = 0; k < PIXELS; k++)
        windows[k] = h->charge[k] > 0 ? window_of(h->s, h->charge[k] + h->s->noise_kev * normal(h)) : -1;
}

/* Counts sums: the largest pixel, with the best square about it, before the eight around it are silenced. */
static void count_sums(history *h, int *windows) {
    for (int k = 0; k < PIXELS; k++) windows[k] = -1;
    for (;;) {
        int most = 0;
        for (int k = 0; k < PIXELS; k++)
            if (h->charge[k] > h->charge[most]) most = k;
        if (!(h->charge[most] > 0)) return;
        const int row = most / SIDE, column = most % SIDE;
        double best = 0;
        for (int up = -1; up <= 1; up += 2)
            for (int left = -1; left <= 1; left += 2) {
                const int j = row + up >= 0 && row + up < SIDE ? row + up : row;
                const int i = column + left >= 0 && column + left < SIDE ? column + left : column;
                double sum = h->charge[most];
                if (j != row) sum += h->charge[j * SIDE + column];
                if (i != column) sum += h->charge[row * SIDE + i];
                if (j != row && i != column) sum += h->charge[j * SIDE + i];
                best = fmax(best, sum);
            }
        windows[most] = window_of(h->s, best + 2 * h->s->noise_kev * normal(h));
        for (int j = row - 1; j <= row + 1; j++)
            for (int i = column - 1; i <= column + 1; i++)
                if (j >= 0 && i >= 0 && j < SIDE && i < SIDE) h->charge[j * SIDE + i] = 0;
    }
}

/* Means for each photon: counts, those of the pixel beside, pairs of neighbours with any windows. */
typedef struct {
    double counts[WINDOWS], beside[WINDOWS], pairs;
} tally;

static void count_photons(const sensor *s, const skg_material *material, tally *t) {
    history h = {.s = s, .material = material, .seed = 11};
    int windows[PIXELS];
    *t = (tally){.pairs = 0};
    for (int n = 0; n < PHOTONS; n++) {
        follow_photon(&h);
        if (s->anti_coincidence)
            count_sums(&h, windows);
        else
            count_pixels(&h, windows);
        for (int k = 0; k < PIXELS; k++) {
            if (windows[k] < 0) continue;
            t->counts[windows[k]] += 1.0 / PHOTONS;
            /* The four pixels with a side in common are alike. */
            if (k == MIDDLE - 1 || k == MIDDLE + 1 || k == MIDDLE - SIDE || k == MIDDLE + SIDE)
                t->beside[windows[k]] += 0.25 / PHOTONS;
            if (k % SIDE < SIDE - 1 && windows[k + 1] >= 0) t->pairs += 0.5 / PHOTONS;
            if (k + SIDE < PIXELS && windows[k + SIDE] >= 0) t->pairs += 0.5 / PHOTONS;
        }
    }
}

/* Four standard errors of PHOTONS that count or not, and what is left out: Rayleigh scattering, third interactions, and the error of the
 * histories. */
static double bar(double mean, double least) {
    const double left_out = 0.01;
    return 4 * sqrt(fmax(mean, 1e-5) / PHOTONS) + left_out * mean + least;
}

START_TEST(sensors_count_what_single_photons_count) {
    const sensor *s = &sensors[_i];
    const double least = 2e-3; /* of the lattice's points */
    skg_material *material = named(s->name);
    skg_counting c;
    skg_counter *counter = NULL;
    tally truth;
    double counts[WINDOWS], table[ACROSS * ACROSS], pairs = 0;
    skg_counting_init(&c);
    c.material = material, c.thickness_mm = s->mm, c.pixel_mm[0] = c.pixel_mm[1] = s->pixel_mm;
    c.count = WINDOWS, c.threshold_kev = s->thresholds, c.electronic_kev = s->noise_kev;
    c.cloud_mm = s->cloud_mm, c.bias_v = s->bias_v, c.fluorescence = 1;
    c.anti_coincidence = s->anti_coincidence;
    ck_skg(skg_counter_create(&c, &counter));
    ck_skg(skg_counter_counts_get(counter, s->kev, counts));
    count_photons(s, material, &truth);
    for (int w = 0; w < WINDOWS; w++) {
        ck_skg(skg_counter_spread_get(counter, s->kev, w, table));
        printf(
            "%s %g mm, pixels %g mm, %g keV, above %g keV: %.4f counts, photons make %.4f; beside %.4f, %.4f\n",
            s->name, s->mm, s->pixel_mm, s->kev, s->thresholds[w], counts[w], truth.counts[w], table[BESIDE],
            truth.beside[w]);
        fflush(stdout);
        ck_assert_double_le(fabs(counts[w] - truth.counts[w]), bar(truth.counts[w], least));
        ck_assert_double_le(fabs(table[BESIDE] - truth.beside[w]), bar(truth.beside[w], least));
    }
    for (int w = 0; w < WINDOWS * WINDOWS; w++) {
        ck_skg(skg_counter_pairs_get(counter, s->kev, w / WINDOWS, w % WINDOWS, table));
        pairs += (table[BESIDE] + table[BELOW]) / 2;
    }
    printf("pairs of neighbours: %.4f, %.4f\n", pairs, truth.pairs);
    ck_assert_double_le(fabs(pairs - truth.pairs), bar(truth.pairs, least));
    skg_counter_release(&counter);
    skg_material_release(&material);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, sensors_count_what_single_photons_count, 0,
                        (int)(sizeof sensors / sizeof *sensors));
}

SKG_SUITE_MAIN("counter_oracle", add_tests)
