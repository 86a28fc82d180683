/* What a detector that counts makes of photons, against photons that are followed one by one through the pixels of the sensor: all
 * scattering, and fluorescence until it ends. */
#include "material/material.h"
#include "material/scattering.h"
#include "material/shells.h"
#include "suite.h"
#include "support/named.h"
#include "support/random.h"

#include <skiagraph/counting.h>

#include <math.h>
#include <string.h>

enum { REACH = 20, SIDE = 2 * REACH + 1, PIXELS = SIDE * SIDE, MIDDLE = PIXELS / 2 };
/* In the tables of the counter. */
enum { ACROSS = SKG_COUNTING_SIDE, BESIDE = ACROSS * ACROSS / 2 + 1, BELOW = BESIDE - 1 + ACROSS };
enum { PHOTONS = 100000, WINDOWS = 3 };
static const double PI = 3.14159265358979323846;

/* A sensor and its beam. */
typedef struct {
    const char *name;
    double mm, pixel_mm, bias_v, cloud_mm, noise_kev, kev, thresholds[WINDOWS];
    int anti_coincidence;
} sensor;

static const sensor sensors[] = {
    {"CdTe", 1, 0.1, 400, 0.005, 1.5, 60, {12, 30, 50}, 0},
    {"CdTe", 2, 0.25, 900, 0, 2, 100, {20, 45, 80}, 0},
    {"CdTe", 1, 0.055, 300, 0.005, 1.2, 40, {10, 20, 33}, 0},
    {"CdTe", 1, 0.11, 400, 0.005, 1.5, 60, {13, 30, 50}, 1},
    {"Si", 0.5, 0.055, 150, 0.003, 0.8, 20, {5, 10, 15}, 0},
    {"Si", 1, 0.17, 200, 0, 1, 60, {5, 9, 40}, 0},
};

/* A photon on its way, and the charge of its history by pixel. */
typedef struct {
    const sensor *s;
    const skg_material *material;
    double at[3], way[3], kev;
    double charge[PIXELS];
    uint64_t seed;
} history;

static double number(history *h) {
    return draw(&h->seed, 0, 1);
}

/* Turns the photon by an angle. */
static void turn(history *h, double cosine) {
    const double around = 2 * PI * number(h), sine = sqrt(fmax(1 - cosine * cosine, 0));
    const double *w = h->way, across = hypot(w[0], w[1]);
    double u[3] = {1, 0, 0}, v[3];
    if (across > 1e-9) u[0] = -w[1] / across, u[1] = w[0] / across, u[2] = 0;
    v[0] = w[1] * u[2] - w[2] * u[1], v[1] = w[2] * u[0] - w[0] * u[2], v[2] = w[0] * u[1] - w[1] * u[0];
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = cosine * w[k] + sine * (cos(around) * u[k] + sin(around) * v[k]);
    memcpy(h->way, to, sizeof to);
}

/* The share of a cloud along one direction that lies in pixel i. */
static double share(double x, double width, double pitch, int i) {
    if (width == 0) return x >= i * pitch && x < (i + 1) * pitch;
    return 0.5 * (erf(((i + 1) * pitch - x) / (sqrt(2) * width)) - erf((i * pitch - x) / (sqrt(2) * width)));
}

static void leave(history *h, double kev) {
    const sensor *s = h->s;
    const double drift = s->mm - h->at[2];
    const double width =
        sqrt(s->cloud_mm * s->cloud_mm + (s->bias_v > 0 ? 2 * 0.02585199 * drift * s->mm / s->bias_v : 0));
    const int column = (int)floor(h->at[0] / s->pixel_mm), row = (int)floor(h->at[1] / s->pixel_mm);
    for (int j = row - 2 > -REACH ? row - 2 : -REACH; j <= row + 2 && j <= REACH; j++)
        for (int i = column - 2 > -REACH ? column - 2 : -REACH; i <= column + 2 && i <= REACH; i++)
            h->charge[(j + REACH) * SIDE + i + REACH] +=
                kev * share(h->at[0], width, s->pixel_mm, i) * share(h->at[1], width, s->pixel_mm, j);
}

/* Photo absorption: the vacancy's element is drawn by its share, then its line. Returns 0 if the photon ends. */
static int absorb(history *h) {
    double sections[SKG_PROCESSES], own[SKG_PROCESSES];
    skg_mixed_sections(h->material->count, h->material->parts, h->kev, sections);
    double drawn = number(h) * sections[SKG_PHOTO];
    int64_t e = -1;
    do {
        e++;
        skg_element_sections(h->material->parts[e].z, h->kev, own);
        drawn -= own[SKG_PHOTO] * h->material->parts[e].fraction;
    } while (drawn > 0 && e < h->material->count - 1);
    skg_shell shell;
    const int known = skg_shell_find(h->material->parts[e].z, SKG_SHELL_K, &shell);
    if (known && h->kev >= shell.edge_kev[0] && number(h) < skg_shell_vacancies(&shell, h->kev) &&
        number(h) < shell.row->yield) {
        double which = number(h);
        int l = 0;
        for (; l < SKG_K_LINES - 1 && which >= shell.row->share[l]; l++) which -= shell.row->share[l];
        leave(h, h->kev - shell.row->line_kev[l]);
        h->kev = shell.row->line_kev[l];
        h->way[0] = h->way[1] = 0, h->way[2] = 1;
        turn(h, draw(&h->seed, -1, 1));
        return 1;
    }
    leave(h, h->kev);
    return 0;
}

/* Compton or Rayleigh scattering, by drawing angles and refusing them. */
static void scatter(history *h, int compton) {
    double most = 0, none = 0, unused = 0;
    skg_scattering_factors(h->material, 1e3, &none, &most);
    if (!compton) skg_scattering_factors(h->material, 0, &most, &unused);
    for (;;) {
        const double cosine = draw(&h->seed, -1, 1), x = sqrt((1 - cosine) / 2);
        const double r = compton ? 1 / (1 + h->kev / SKG_ELECTRON_KEV * (1 - cosine)) : 1;
        double coherent = 0, incoherent = 0;
        skg_scattering_factors(h->material, h->kev / SKG_HC_KEV_ANGSTROM * x, &coherent, &incoherent);
        const double chance =
            0.5 * r * r * (r + 1 / r - 1 + cosine * cosine) * (compton ? incoherent : coherent) / most;
        if (number(h) >= chance) continue;
        if (compton) leave(h, h->kev * (1 - r));
        h->kev *= r;
        turn(h, cosine);
        return;
    }
}

static void follow(history *h) {
    for (;;) {
        double sections[SKG_PROCESSES];
        skg_mixed_sections(h->material->count, h->material->parts, h->kev, sections);
        const double all = skg_total_section(sections),
                     path = -log1p(-number(h)) * 10 / (all * h->material->density);
        for (int k = 0; k < 3; k++) h->at[k] += path * h->way[k];
        if (h->at[2] < 0 || h->at[2] > h->s->mm) return;
        const double kind = number(h) * all;
        if (kind < sections[SKG_PHOTO]) {
            if (!absorb(h)) return;
        } else {
            scatter(h, kind < sections[SKG_PHOTO] + sections[SKG_COMPTON]);
            if (h->kev < 1.5) return leave(h, h->kev);
        }
    }
}

static double normal(history *h) {
    return sqrt(-2 * log(1 - number(h))) * cos(2 * PI * number(h));
}

/* The window of a pulse, or -1. */
static int window_of(const sensor *s, double kev) {
    int w = -1;
    while (w < WINDOWS - 1 && kev >= s->thresholds[w + 1]) w++;
    return w;
}

/* The windows in which pixels count. */
static void count_pixels(history *h, int *windows) {
    for (int k = 0; k < PIXELS; k++)
        windows[k] = h->charge[k] > 0 ? window_of(h->s, h->charge[k] + h->s->noise_kev * normal(h)) : -1;
}

/* The same of sums: the largest pixel, with the best square about it, before the eight around it are silenced. */
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
        memset(h.charge, 0, sizeof h.charge);
        h.at[0] = number(&h) * s->pixel_mm, h.at[1] = number(&h) * s->pixel_mm, h.at[2] = 0;
        h.way[0] = h.way[1] = 0, h.way[2] = 1, h.kev = s->kev;
        follow(&h);
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
