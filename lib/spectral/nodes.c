/* The energies of a model, chosen by least squares. */
#include "spectral/compression.h"

#include <math.h>
#include <string.h>

/* The numbers below were set by trial, with thorax tissues, iodine and steel: they trade the time of the search against
 * the number of nodes (bench/results/energies.md). They never decide whether the stated bound holds, because the bound
 * is verified on points of its own. */

/* Points that the weights are fitted to, and others on which they are checked: all rays. Different seeds, so that no
 * point is both fitted to and checked. */
static const skg_sampling FIT = {.corners = 64, .draws = 320, .rays = 96, .seed = 1};
static const skg_sampling CHECK = {.corners = 1024, .draws = 2000, .rays = INT64_MAX, .seed = 2};

/* Lawson's reweightings of one fit; fits repeated with the points that a check has found; searches with a lower
 * aim; and the largest product of sets and nodes for which nodes are shifted, which takes long. */
enum { REWEIGHTINGS = 30, REFITS = 3, SEARCHES = 5, SHIFTED = 64 };

/* The aim at the fitted points is AIM of the target, because other points have larger errors; after each search that
 * fails the check, it is lowered by LOWER. */
static const double AIM = 0.9, LOWER = 0.7;

/* The first set of bins is searched until the mean squared error is this share of the square of the aim. */
static const double FIRST_LEFT = 0.01;

/* A shift is kept if it lowers the squared errors to this share; another round follows if a round lowered them so. */
static const double SHIFT_HELPS = 0.999, ROUND_HELPS = 0.9;

/* Reweighting ends below GOOD times the aim, and above HOPELESS times it. */
static const double GOOD = 0.5, HOPELESS = 20;

/* Added to each relative error when weights are raised, so that no point loses its weight at once. */
static const double MIN_FACTOR = 0.05;

typedef struct {
    const skg_polychromatic *beam;
    const double *mu;
    double aim; /* the greatest error that is wanted at the fitted points */
    skg_lengths fit, check;
    double *passed, *unit;   /* of each fitted point: [bins] transmissions, [sets] 1 / the unit of errors */
    int64_t known, capacity; /* points that have them, and for which there is room */
    skg_least_squares *systems;   /* [sets] over all bins, reduced */
    int32_t *bins, *best, *trial; /* [bins] each */
    int32_t count, best_count;
    double *x, *spread;        /* [bins] each */
    double *score;             /* [bins] */
    skg_nodes nodes;           /* of the last weights */
    double *row_weight, *rest; /* [fit points] */
} search;

/* --- systems over the bins --- */

/* Finds the transmissions of the points that have joined the fit. */
static skg_status pass_points(search *s) {
    const int32_t bins = s->beam->bins, sets = s->beam->sets;
    const int64_t points = s->fit.count;
    if (s->capacity < points) {
        s->capacity = 2 * points;
        SKG_TRY(skg_realloc(s->capacity * bins, sizeof *s->passed, "nodes", &s->passed));
        SKG_TRY(skg_realloc(s->capacity * sets, sizeof *s->unit, "nodes", &s->unit));
        SKG_TRY(skg_realloc(s->capacity, sizeof *s->row_weight, "nodes", &s->row_weight));
        SKG_TRY(skg_realloc(s->capacity, sizeof *s->rest, "nodes", &s->rest));
    }
    for (; s->known < points; s->known++) {
        skg_transmit(s->beam, s->mu, s->fit.lengths + s->known * s->beam->materials,
                     s->passed + s->known * bins);
        for (int32_t set = 0; set < sets; set++)
            s->unit[s->known * sets + set] = 1 / fmax(s->fit.exact[s->known * sets + set], s->beam->floor);
    }
    return SKG_OK;
}

static skg_status make_system(search *s, int32_t set) {
    const int64_t points = s->fit.count;
    const int32_t bins = s->beam->bins;
    skg_least_squares whole = {0};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_least_squares_create(points, bins, &whole));
    for (int64_t p = 0; p < points; p++) {
        const double unit = s->unit[p * s->beam->sets + set];
        for (int32_t b = 0; b < bins; b++) whole.a[b * points + p] = s->passed[p * bins + b] * unit;
        whole.b[p] = s->fit.exact[p * s->beam->sets + set] * unit;
    }
    SKG_TRY_CLEANUP(skg_least_squares_reduce(&whole, &s->systems[set]));
cleanup:
    skg_least_squares_release(&whole);
    return status;
}

static void start_even(double *x, int32_t count) {
    for (int32_t j = 0; j < count; j++) x[j] = 1.0 / count;
}

/* The sum over the sets of the squared errors with these bins. */
static double squares_left(search *s, int32_t count, const int32_t *bins) {
    double sum = 0;
    for (int32_t set = 0; set < s->beam->sets; set++) {
        start_even(s->x, count);
        sum += skg_nnls(&s->systems[set], count, bins, 0, s->x);
    }
    return sum;
}

/* Finds the bins that non-negative least squares takes for any of the sets. */
static void find_first(search *s) {
    const int32_t bins = s->beam->bins;
    const double least = (double)s->fit.count * FIRST_LEFT * s->aim * s->aim;
    for (int32_t b = 0; b < bins; b++) s->trial[b] = b, s->score[b] = 0;
    for (int32_t set = 0; set < s->beam->sets; set++) {
        memset(s->x, 0, (size_t)bins * sizeof *s->x);
        skg_nnls(&s->systems[set], bins, s->trial, least, s->x);
        for (int32_t b = 0; b < bins; b++) s->score[b] += s->x[b];
    }
    s->count = 0;
    for (int32_t b = 0; b < bins; b++)
        if (s->score[b] > 0) s->bins[s->count++] = b;
}

/* Removes the bin without which the squared errors grow least. */
static void take_one_away(search *s) {
    int32_t worst = 0;
    for (int32_t j = 0; j < s->count; j++) s->score[j] = 0;
    for (int32_t set = 0; set < s->beam->sets; set++) {
        int32_t used = 0;
        start_even(s->x, s->count);
        skg_nnls(&s->systems[set], s->count, s->bins, 0, s->x);
        for (int32_t j = 0; j < s->count; j++)
            if (s->x[j] > 0) s->trial[used++] = s->bins[j];
        double *again = s->x + s->beam->bins; /* the second half of the array */
        skg_least_squares_solve(&s->systems[set], used, s->trial, again, s->spread);
        for (int32_t j = 0, k = 0; j < s->count; j++)
            if (s->x[j] > 0) {
                s->score[j] += again[k] * again[k] / s->spread[k];
                k++;
            }
    }
    for (int32_t j = 1; j < s->count; j++)
        if (s->score[j] < s->score[worst]) worst = j;
    s->count--;
    for (int32_t j = worst; j < s->count; j++) s->bins[j] = s->bins[j + 1];
}

/* Shifts bins to neighbours while that lowers the squared errors. */
static void shift(search *s) {
    static const int32_t ways[] = {-1, 1, -2, 2, -4, 4};
    double left = squares_left(s, s->count, s->bins);
    for (int round = 0; round < 3; round++) {
        const double before = left;
        for (int32_t j = 0; j < s->count; j++)
            for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
                const int32_t old = s->bins[j], to = old + ways[w];
                const int32_t above = j + 1 < s->count ? s->bins[j + 1] : s->beam->bins;
                if (to <= (j > 0 ? s->bins[j - 1] : -1) || to >= above) continue;
                s->bins[j] = to;
                const double now = squares_left(s, s->count, s->bins);
                if (now < SHIFT_HELPS * left)
                    left = now;
                else
                    s->bins[j] = old;
            }
        if (!(left < ROUND_HELPS * before)) break;
    }
}

/* --- weights --- */

/* The errors of one set at the fitted points, with weights s->x of the nodes in s->trial. Returns the greatest. */
static double find_rest(search *s, const double *columns, int32_t set, int32_t used) {
    const int64_t points = s->fit.count;
    double worst = 0;
    for (int64_t p = 0; p < points; p++) {
        double sum = -s->fit.exact[p * s->beam->sets + set] * s->unit[p * s->beam->sets + set];
        for (int32_t j = 0; j < used; j++) sum += s->x[j] * columns[s->trial[j] * points + p];
        s->rest[p] = fabs(sum);
        worst = fmax(worst, s->rest[p]);
    }
    return worst;
}

static void keep_weights(search *s, int32_t set, int32_t used) {
    const int32_t sets = s->beam->sets;
    for (int32_t j = 0; j < s->count; j++) s->nodes.shares[j * sets + set] = 0;
    for (int32_t j = 0; j < used; j++) s->nodes.shares[s->trial[j] * sets + set] = s->x[j];
}

/* The arrays of a fit of weights. */
typedef struct {
    skg_least_squares system;
    double *columns; /* [nodes][points], in the unit of the errors of a set */
} fitting;

static void find_columns(const search *s, int32_t set, fitting *f) {
    const int64_t points = s->fit.count;
    for (int32_t j = 0; j < s->count; j++)
        for (int64_t p = 0; p < points; p++)
            f->columns[j * points + p] =
                s->passed[p * s->beam->bins + s->bins[j]] * s->unit[p * s->beam->sets + set];
}

/* Fits the weights of one set for the nodes in s->trial so that the greatest error becomes small, keeps them in
 * s->nodes, and returns that error. */
static double fit_set(search *s, int32_t set, int32_t used, fitting *f) {
    const int64_t points = s->fit.count;
    double best = HUGE_VAL;
    find_columns(s, set, f);
    for (int64_t p = 0; p < points; p++) s->row_weight[p] = 1;
    start_even(s->x, used);
    for (int step = 0; step < REWEIGHTINGS; step++) {
        for (int64_t p = 0; p < points; p++) {
            const double root = sqrt(s->row_weight[p]);
            for (int32_t j = 0; j < s->count; j++)
                f->system.a[j * points + p] = root * f->columns[j * points + p];
            f->system.b[p] = root * s->fit.exact[p * s->beam->sets + set] * s->unit[p * s->beam->sets + set];
        }
        skg_nnls(&f->system, used, s->trial, 0, s->x);
        const double worst = find_rest(s, f->columns, set, used);
        if (worst < best) {
            best = worst;
            keep_weights(s, set, used);
        }
        if (best < GOOD * s->aim || best > HOPELESS * s->aim) break;
        for (int64_t p = 0; p < points; p++) s->row_weight[p] *= s->rest[p] / worst + MIN_FACTOR;
    }
    return best;
}

/* Keeps the nodes in s->trial that both sets of a pair use. Returns their number. */
static int32_t keep_common(search *s, int32_t set, int32_t used) {
    const int32_t sets = s->beam->sets;
    int32_t common = 0;
    for (int32_t j = 0; j < used; j++) {
        const double *shares = s->nodes.shares + s->trial[j] * sets;
        if (shares[set] > 0 && shares[set + sets / 2] > 0) s->trial[common++] = s->trial[j];
    }
    return common;
}

/* Fits a set, or a pair of sets, which is fitted again with the nodes that both use until both use the same. */
static double fit_sets(search *s, int32_t set, fitting *f) {
    for (int32_t j = 0; j < s->count; j++) s->trial[j] = j;
    if (!s->beam->paired) return fit_set(s, set, s->count, f);
    for (int32_t used = s->count;;) {
        const double error = fmax(fit_set(s, set, used, f), fit_set(s, set + s->beam->sets / 2, used, f));
        const int32_t common = keep_common(s, set, used);
        if (common == used) return error;
        used = common;
    }
}

/* Fits the weights of all sets for s->bins. *error is the greatest error at the fitted points. */
static skg_status fit_weights(search *s, double *error) {
    const int64_t points = s->fit.count;
    const int32_t heads = s->beam->paired ? s->beam->sets / 2 : s->beam->sets;
    fitting f = {.columns = NULL};
    skg_status status = SKG_OK;
    SKG_TRY(pass_points(s));
    SKG_TRY_CLEANUP(skg_least_squares_create(points, s->count, &f.system));
    SKG_TRY_CLEANUP(skg_alloc(points * s->count, sizeof *f.columns, "nodes", &f.columns));
    s->nodes.count = s->count;
    memcpy(s->nodes.bin, s->bins, (size_t)s->count * sizeof *s->bins);
    *error = 0;
    for (int32_t set = 0; set < heads; set++) *error = fmax(*error, fit_sets(s, set, &f));
cleanup:
    skg_least_squares_release(&f.system);
    skg_free(&f.columns);
    return status;
}

/* --- the search --- */

/* Removes bins one by one from the first set. s->best becomes the smallest set that reaches the aim; best_count
 * is 0 if there is none. The search ends after two misses in a row, since a smaller set is seldom better. */
static skg_status find_fewest(search *s) {
    SKG_TRY(pass_points(s));
    for (int32_t set = 0; set < s->beam->sets; set++) {
        skg_least_squares_release(&s->systems[set]);
        SKG_TRY(make_system(s, set));
    }
    find_first(s);
    s->best_count = 0;
    for (int misses = 0; s->count >= 1 && misses < 2;) {
        double error = 0;
        SKG_TRY(fit_weights(s, &error));
        if (error > s->aim && s->beam->sets * s->count <= SHIFTED) {
            shift(s);
            SKG_TRY(fit_weights(s, &error));
        }
        misses += error > s->aim;
        if (error <= s->aim) {
            s->best_count = s->count, misses = 0;
            memcpy(s->best, s->bins, (size_t)s->count * sizeof *s->bins);
        }
        take_one_away(s);
    }
    s->count = s->best_count;
    memcpy(s->bins, s->best, (size_t)s->count * sizeof *s->bins);
    return SKG_OK;
}

/* Fits weights for s->bins and checks them on the other points; the worst of those join the fit. *error is the
 * greatest error of the last check. */
static skg_status check(search *s, double target, double *error, int64_t *checked) {
    for (int refit = 0; refit <= REFITS; refit++) {
        double fitted = 0;
        SKG_TRY(fit_weights(s, &fitted));
        SKG_TRY(skg_nodes_verify(s->beam, s->mu, &s->nodes, &s->check, error, checked, &s->fit));
        if (*error <= target) return SKG_OK;
    }
    return SKG_OK;
}

static skg_status open_search(search *s, int64_t count, const double *given) {
    const skg_polychromatic *beam = s->beam;
    const int32_t bins = beam->bins;
    SKG_TRY(skg_alloc(beam->sets, sizeof *s->systems, "nodes", &s->systems));
    SKG_TRY(skg_alloc(bins, sizeof *s->bins, "nodes", &s->bins));
    SKG_TRY(skg_alloc(bins, sizeof *s->best, "nodes", &s->best));
    SKG_TRY(skg_alloc(bins, sizeof *s->trial, "nodes", &s->trial));
    SKG_TRY(skg_alloc(2 * bins, sizeof *s->x, "nodes", &s->x));
    SKG_TRY(skg_alloc(bins, sizeof *s->spread, "nodes", &s->spread));
    SKG_TRY(skg_alloc(bins, sizeof *s->score, "nodes", &s->score));
    SKG_TRY(skg_alloc(bins, sizeof *s->nodes.bin, "nodes", &s->nodes.bin));
    SKG_TRY(skg_alloc((int64_t)bins * beam->sets, sizeof *s->nodes.shares, "nodes", &s->nodes.shares));
    const skg_rays rays = {count, beam->materials, given};
    SKG_TRY(skg_lengths_fill(beam, &FIT, &rays, &s->fit));
    return skg_lengths_fill(beam, &CHECK, &rays, &s->check);
}

static void close_search(search *s) {
    for (int32_t set = 0; s->systems && set < s->beam->sets; set++)
        skg_least_squares_release(&s->systems[set]);
    skg_free(&s->systems);
    skg_free(&s->bins);
    skg_free(&s->best);
    skg_free(&s->trial);
    skg_free(&s->x);
    skg_free(&s->spread);
    skg_free(&s->score);
    skg_free(&s->passed);
    skg_free(&s->unit);
    skg_free(&s->row_weight);
    skg_free(&s->rest);
    skg_nodes_release(&s->nodes);
    skg_lengths_release(&s->fit);
    skg_lengths_release(&s->check);
}

skg_status skg_nodes_find(const skg_polychromatic *beam, const double *mu, double tolerance, int64_t count,
                          const double *given, skg_compression *compression) {
    const double target = 0.5 * tolerance;
    search s = {.beam = beam, .mu = mu, .aim = AIM * target};
    skg_status status = SKG_OK;
    *compression = (skg_compression){0};
    SKG_TRY_CLEANUP(open_search(&s, count, given));
    for (int k = 0; k < SEARCHES; k++, s.aim *= LOWER) {
        double error = 0;
        int64_t checked = 0;
        SKG_TRY_CLEANUP(find_fewest(&s));
        if (s.count == 0 || s.count >= beam->bins) break;
        SKG_TRY_CLEANUP(check(&s, target, &error, &checked));
        if (error > target) continue;
        *compression = (skg_compression){s.nodes, 2 * error, checked};
        s.nodes = (skg_nodes){0};
        break;
    }
cleanup:
    close_search(&s);
    return status;
}
