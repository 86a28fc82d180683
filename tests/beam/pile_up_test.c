/* Pulses that overlap: what each window records, against closed forms and against single pulses of single photons, one after the other. */
#include "beam/counter.h"
#include "counter_photons.h"
#include "suite.h"
#include "support/named.h"

#include <math.h>

enum { PHOTONS = 100000, PULSES_MAX = 20 * PHOTONS, ARRIVALS = 400000 };
static const double EXPOSURE_S = 1, DEAD_NS = 100;

static const sensor sensors[] = {
    {"CdTe", 1, 0.1, 400, 0.005, 1.5, 60, {12, 30, 50}, 0},
    {"CdTe", 2, 0.25, 900, 0, 2, 100, {20, 45, 120}, 0},
    {"Si", 0.5, 0.055, 150, 0.003, 0.8, 20, {5, 10, 15}, 0},
};
static const double rates[] = {0.05, 0.3, 1};

/* Counts in a dead time, of so many photons for each pixel and dead time. */
static void record(const sensor *s, int32_t kind, int64_t windows, double photons, double *recorded) {
    skg_material *material = named(s->name);
    const double in_exposure = photons * EXPOSURE_S / (DEAD_NS * 1e-9);
    skg_counting c;
    skg_counter *counter = NULL;
    skg_counting_init(&c);
    c.material = material, c.thickness_mm = s->mm, c.pixel_mm[0] = c.pixel_mm[1] = s->pixel_mm;
    c.count = windows, c.threshold_kev = s->thresholds, c.electronic_kev = s->noise_kev;
    c.cloud_mm = s->cloud_mm, c.bias_v = s->bias_v, c.fluorescence = s->bias_v > 0;
    c.pile_up = kind;
    if (kind) c.dead_time_ns = DEAD_NS, c.exposure_s = EXPOSURE_S;
    ck_skg(skg_counter_create(&c, &counter));
    ck_skg(skg_counter_record(counter, 1, &s->kev, &in_exposure, 1, recorded));
    for (int64_t w = 0; w < windows; w++) recorded[w] *= DEAD_NS * 1e-9 / EXPOSURE_S;
    skg_counter_release(&counter);
    skg_material_release(&material);
}

/* Pulses of 27 to 30 keV, of which two make more than 50 keV: n pulses in a dead time leave n / (1 + n) counts, of which a share of exp(-n)
 * is alone, and n exp(-n), of which n^2 exp(-n) rise past 50 keV. */
START_TEST(pulses_of_one_height_follow_closed_forms) {
    static const sensor even = {"CdTe", 1, 0.5, 0, 0, 0, 30, {20, 50}, 0};
    double plain[2], recorded[2];
    record(&even, SKG_PILE_UP_NONE, 2, 1, plain);
    ck_assert_double_eq_tol(plain[1], 0, 1e-12); /* no photon has 50 keV */
    for (double n = 0.001; n < 2; n *= 3) {
        const double photons = n / plain[0];
        record(&even, SKG_PILE_UP_NONPARALYSABLE, 2, photons, recorded);
        ck_assert_double_eq_tol(recorded[0], n / (1 + n) * exp(-n), 1e-12);       /* rounding */
        ck_assert_double_eq_tol(recorded[1], n / (1 + n) * (1 - exp(-n)), 1e-12); /* rounding */
        record(&even, SKG_PILE_UP_PARALYSABLE, 2, photons, recorded);
        ck_assert_double_eq_tol(recorded[0], n * exp(-n) - n * n * exp(-n), 1e-12); /* rounding */
        ck_assert_double_eq_tol(recorded[1], n * n * exp(-n), 1e-12);               /* rounding */
    }
}
END_TEST

/* The windows of any detector together lose what dead time takes, and at low rates what moves is of the second order. */
START_TEST(all_windows_lose_what_one_loses) {
    double plain[WINDOWS], recorded[WINDOWS], counted = 0;
    const sensor *s = &sensors[_i];
    for (int32_t kind = SKG_PILE_UP_NONPARALYSABLE; kind <= SKG_PILE_UP_PARALYSABLE; kind++)
        for (int r = 0; r < 5; r++) {
            const double photons = (double[]){1e-6, 0.01, 0.3, 1, 30}[r];
            double all = 0, sum = 0;
            record(s, SKG_PILE_UP_NONE, WINDOWS, photons, plain);
            record(s, kind, WINDOWS, photons, recorded);
            for (int w = 0; w < WINDOWS; w++) all += plain[w], sum += recorded[w];
            ck_skg(skg_pile_up_get(kind, all, &counted, NULL));
            ck_assert_double_eq_tol(sum / counted, 1, 1e-9); /* rounding of a sum whose terms cancel */
            for (int w = 0; w < WINDOWS && r == 0;
                 w++) /* n = 1e-6 in a dead time: 3 n of the counts at most */
                ck_assert_double_eq_tol(recorded[w] / photons, plain[w] / photons, 4e-6);
        }
}
END_TEST

/* Charges of pixels, of photons that are followed one by one. Returns how many; photons make `each` of them. */
static int collect(history *h, double *charges, double *each) {
    int count = 0;
    for (int n = 0; n < PHOTONS; n++) {
        follow_photon(h);
        for (int k = 0; k < PIXELS; k++)
            if (h->charge[k] > 0 && count < PULSES_MAX) charges[count++] = h->charge[k];
    }
    *each = (double)count / PHOTONS;
    return count;
}

/* A pulse on its way through the dead time, in units of which its time is. */
typedef struct {
    double at, kev;
} pulse;

/* Counts of each window in a dead time. */
typedef struct {
    double counts[WINDOWS], time;
} tally;

enum { OPEN_MAX = 256 };

/* The level of a sum: noise is added once. */
static int level(history *h, double kev) {
    return kev > 0 ? window_of(h->s, kev + h->s->noise_kev * normal(h)) : -1;
}

static int higher(int a, int b) {
    return a > b ? a : b;
}

/* The next pulse. with_low: those below the lowest threshold, too. alone: result: its window by itself */
static pulse next(history *h, const double *charges, int count, double rate, int with_low, double *now,
                  int *alone) {
    for (;;) {
        *now -= log1p(-number(h)) / rate;
        const double kev = charges[(int)(number(h) * count)];
        *alone = level(h, kev);
        if (*alone >= 0 || with_low) return (pulse){*now, kev};
    }
}

/* Each threshold counts where the sum of the pulses of the last dead time rises past it. */
static void count_rises(history *h, const double *charges, int count, double rate, int with_low, tally *t) {
    pulse open[OPEN_MAX];
    int held = 0, alone = 0;
    double now = 0;
    for (int k = 0; k < ARRIVALS; k++) {
        const pulse p = next(h, charges, count, rate, with_low, &now, &alone);
        double sum = 0;
        int left = 0;
        for (int i = 0; i < held; i++)
            if (p.at - open[i].at < 1) sum += open[i].kev, open[left++] = open[i];
        held = left;
        /* Pulses that passed the lowest threshold stay above it. */
        const int least = sum > 0 && !with_low ? 0 : -1, before = higher(level(h, sum), least);
        const int after = sum > 0 ? higher(level(h, sum + p.kev), least) : alone;
        for (int w = before + 1; w <= after; w++) {
            t->counts[w] += 1;
            if (w > 0) t->counts[w - 1] -= 1;
        }
        if (held < OPEN_MAX) open[held++] = p;
    }
    t->time = now;
}

/* A pulse above the lowest threshold begins a dead time, which is recorded with all that follow in it. */
static void count_dead_times(history *h, const double *charges, int count, double rate, int with_low,
                             tally *t) {
    double now = 0, begun = -2, sum = 0;
    int single = 0, first = 0, alone = 0;
    for (int k = 0; k < ARRIVALS; k++) {
        const pulse p = next(h, charges, count, rate, with_low, &now, &alone);
        if (p.at - begun < 1) {
            sum += p.kev, single = 0;
            continue;
        }
        if (sum > 0) {
            const int window = single ? first : level(h, sum);
            if (window >= 0) t->counts[window] += 1;
            sum = 0;
        }
        if (alone < 0) continue;
        begun = p.at, sum = p.kev, single = 1, first = alone;
    }
    t->time = now;
}

START_TEST(windows_record_what_single_pulses_record) {
    static double charges[PULSES_MAX];
    const sensor *s = &sensors[_i];
    skg_material *material = named(s->name);
    history h = {.s = s, .material = material, .seed = 17};
    double each = 0;
    const int count = collect(&h, charges, &each);
    for (int32_t kind = SKG_PILE_UP_NONPARALYSABLE; kind <= SKG_PILE_UP_PARALYSABLE; kind++)
        for (int r = 0; r < 3; r++) {
            double plain[WINDOWS], recorded[WINDOWS], all = 0;
            record(s, SKG_PILE_UP_NONE, WINDOWS, 1, plain);
            for (int w = 0; w < WINDOWS; w++) all += plain[w];
            const double photons = rates[r] / all;
            record(s, kind, WINDOWS, photons, recorded);
            for (int low = 0; low < 2; low++) {
                tally t = {.time = 0};
                (kind == SKG_PILE_UP_PARALYSABLE ? count_rises : count_dead_times)(&h, charges, count,
                                                                                   photons * each, low, &t);
                printf("%s %g keV, kind %d, %g pulses in a dead time%s:", s->name, s->kev, (int)kind,
                       rates[r], low ? ", and those below the lowest threshold" : "");
                for (int w = 0; w < WINDOWS; w++) {
                    const double truth = t.counts[w] / t.time;
                    printf("  %.4f (%.4f without moves), pulses %.4f", recorded[w] / rates[r],
                           plain[w] / all * exp(-rates[r]), truth / rates[r]);
                    /* Four standard errors of shares, sqrt(p (1 - p) / n) <= 1/2 sqrt(1 / n), of the arrivals and of the photons' charges;
                     * 0.004: the histories of the table (counter_oracle_test), and sums that are known by steps. */
                    const double error = 2 * sqrt(1.0 / ARRIVALS + 1 / (PHOTONS * all)) + 0.004;
                    if (!low) ck_assert_double_eq_tol(recorded[w] / rates[r], truth / rates[r], error);
                }
                printf("\n");
                fflush(stdout);
            }
        }
    skg_material_release(&material);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, pulses_of_one_height_follow_closed_forms);
    tcase_add_loop_test(tests, all_windows_lose_what_one_loses, 0, (int)(sizeof sensors / sizeof *sensors));
    tcase_add_loop_test(tests, windows_record_what_single_pulses_record, 0,
                        (int)(sizeof sensors / sizeof *sensors));
}

SKG_SUITE_MAIN("pile_up", add_tests)
