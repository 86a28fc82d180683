/* CMA-ES with active update, cumulative step size, and restarts with a doubled population: N. Hansen, The CMA Evolution
 * Strategy: A Tutorial, arXiv 1604.00772 (2016), whose names and default constants these are; A. Auger and N. Hansen, A
 * restart CMA evolution strategy with increasing population size, CEC 2005. */
#include "evolution/methods.h"

#include "core/eigen.h"
#include "evolution/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PURPOSE_STEP = 1, PURPOSE_RESTART };

/* The first standard deviation, as a share of the box; Hansen advises 0.3. */
static const double FIRST_SIGMA = 0.3;

/* The standard deviation after a restart near the best point, likewise: a few degrees of a plane (a choice). */
static const double NEAR_SIGMA = 0.05;

/* Values of the last generations that tell whether the search still gains. */
enum { HISTORY = 64 };

/* Layout of the numbers of skg_search.own. memory: of the model. */
typedef struct {
    double *mean, *path_c, *path_sigma, *covariance, *axes, *lengths, *history, *record, *sigma, *memory;
} state;

int64_t skg_cma_numbers(int64_t n) {
    return 4 * n + 2 * n * n + HISTORY + 3 + skg_model_numbers(n);
}

static state state_of(const skg_search *s) {
    const int64_t n = s->dimensions;
    state c;
    c.mean = s->own;
    c.path_c = c.mean + n;
    c.path_sigma = c.path_c + n;
    c.lengths = c.path_sigma + n;
    c.covariance = c.lengths + n;
    c.axes = c.covariance + n * n;
    c.history = c.axes + n * n;
    c.record = c.history + HISTORY;
    c.sigma = c.record + 2;
    c.memory = c.sigma + 1;
    return c;
}

int64_t skg_cma_population(int64_t n, int64_t restarts) {
    return (4 + (int64_t)floor(3 * log((double)n))) << restarts;
}

/* The distribution at a start: round. */
static void reset(skg_search *s, const double *mean, double sigma) {
    const int64_t n = s->dimensions;
    const state c = state_of(s);
    memset(s->own, 0, (size_t)skg_cma_numbers(n) * sizeof *s->own);
    memcpy(c.mean, mean, (size_t)n * sizeof *mean);
    for (int64_t k = 0; k < n; k++) c.covariance[(n + 1) * k] = c.axes[(n + 1) * k] = c.lengths[k] = 1;
    *c.sigma = sigma;
    s->counters[SEARCH_SINCE] = s->counters[SEARCH_KEPT] = 0;
}

void skg_cma_begin(skg_search *s) {
    s->counters[SEARCH_POPULATION] = skg_cma_population(s->dimensions, 0);
    reset(s, s->start, FIRST_SIGMA);
}

/* Alternately near the best point, because a function with steps holds a search beside its minimum, and from a random point,
 * with a population that doubles as long as there is room. */
static void restart(skg_search *s) {
    double mean[SKG_SEARCH_MAX];
    const skg_draw_key key = {s->seed, s->counters[SEARCH_GENERATION], 0, PURPOSE_RESTART};
    const int64_t doublings = s->counters[SEARCH_RESTARTS]++ / 2 + 1;
    const int is_near = s->counters[SEARCH_RESTARTS] % 2 == 1;
    for (int64_t k = 0; k < s->dimensions; k++) mean[k] = is_near ? s->best[k] : skg_draw_uniform(&key, k);
    s->counters[SEARCH_POPULATION] = skg_cma_population(s->dimensions, 0);
    for (int64_t d = 0; d < doublings && !is_near && 2 * s->counters[SEARCH_POPULATION] <= s->max_points; d++)
        s->counters[SEARCH_POPULATION] *= 2;
    reset(s, mean, is_near ? NEAR_SIGMA : FIRST_SIGMA);
}

/* A normal deviate for each axis. The first point of a search is its start. */
static void draw_step(const skg_search *s, int64_t i, double *z) {
    const skg_draw_key key = {s->seed, s->counters[SEARCH_GENERATION], (int32_t)i, PURPOSE_STEP};
    const int is_start = s->counters[SEARCH_GENERATION] == 0 && i == 0;
    for (int64_t k = 0; k < s->dimensions; k++) z[k] = is_start ? 0 : skg_draw_normal(&key, k);
}

/* The greatest step of a point that was not drawn, in standard deviations (Hansen 2011). */
static double greatest_step(int64_t n) {
    return sqrt((double)n) + 2 * (double)n / (double)(n + 2);
}

skg_status skg_cma_ask(skg_search *s) {
    const int64_t n = s->dimensions;
    const state c = state_of(s);
    const skg_model_frame frame = {c.mean, c.axes, c.lengths, *c.sigma};
    double best[SKG_SEARCH_MAX];
    int has_model;
    SKG_TRY(skg_model_minimum(s, c.memory, &frame, greatest_step(n), best, &has_model));
    for (int64_t i = 0; i < s->counters[SEARCH_POPULATION]; i++) {
        double *point = s->free_points + n * i, *inside = s->points + n * i, z[SKG_SEARCH_MAX];
        const int is_model = has_model && i == 0;
        draw_step(s, i, z);
        for (int64_t row = 0; row < n; row++) {
            double sum = 0;
            for (int64_t k = 0; k < n; k++)
                sum += c.axes[n * row + k] * c.lengths[k] * (is_model ? best : z)[k];
            point[row] = c.mean[row] + *c.sigma * sum;
            inside[row] = fmin(fmax(point[row], 0), 1);
        }
        if (is_model) memcpy(point, inside, (size_t)n * sizeof *point); /* it was not drawn outside */
    }
    return SKG_OK;
}

typedef struct {
    double value, outside;
    int64_t index;
} ranked;

static int by_value(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->value != y->value) return x->value < y->value ? -1 : 1;
    if (x->outside != y->outside) return x->outside < y->outside ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

/* Ranks the points by their value in the box plus a penalty for how far outside they were drawn, in standard deviations,
 * which is worth as much as the spread of the values. */
static void rank(const skg_search *s, const double *values, ranked *order) {
    const int64_t n = s->dimensions, points = s->counters[SEARCH_POPULATION];
    const state c = state_of(s);
    for (int64_t i = 0; i < points; i++) order[i] = (ranked){values[i], 0, i};
    qsort(order, (size_t)points, sizeof *order, by_value);
    const double low = order[points / 4].value, high = order[3 * points / 4].value;
    const double spread = isfinite(high) ? high - low : 1;
    for (int64_t i = 0; i < points; i++) {
        ranked *one = order + i;
        for (int64_t k = 0; k < n; k++) {
            const double away = s->free_points[n * one->index + k] - s->points[n * one->index + k];
            one->outside += away * away / (*c.sigma * *c.sigma * c.covariance[(n + 1) * k]);
        }
        one->value += spread * one->outside / (double)n;
    }
    qsort(order, (size_t)points, sizeof *order, by_value);
}

/* Hansen's default constants, but for faster learning of the covariance: twice his c_1 and 1.5 times his c_mu. With them the
 * rotated ellipsoid of search_test.c takes about 7200 evaluations instead of 8500, and the sphere as many as before. */
typedef struct {
    int64_t parents;
    double effective, c_sigma, damping, c_c, c_1, c_mu, expected;
} constants;

static constants constants_of(int64_t n, int64_t points, double *weights) {
    constants k = {.parents = points / 2};
    const double size = (double)n;
    double plus = 0, plus_squares = 0, minus = 0, minus_squares = 0;
    for (int64_t i = 0; i < points; i++) {
        weights[i] = log(((double)points + 1) / 2) - log((double)i + 1);
        if (i < k.parents)
            plus += weights[i], plus_squares += weights[i] * weights[i];
        else
            minus -= weights[i], minus_squares += weights[i] * weights[i];
    }
    const double mu = k.effective = plus * plus / plus_squares;
    k.c_sigma = (mu + 2) / (size + mu + 5);
    k.damping = 1 + 2 * fmax(0, sqrt((mu - 1) / (size + 1)) - 1) + k.c_sigma;
    k.c_c = (4 + mu / size) / (size + 4 + 2 * mu / size);
    k.c_1 = 4 / ((size + 1.3) * (size + 1.3) + mu);
    k.c_mu = fmin(1 - k.c_1, 3 * (0.25 + mu + 1 / mu - 2) / ((size + 2) * (size + 2) + mu));
    k.expected = sqrt(size) * (1 - 1 / (4 * size) + 1 / (21 * size * size));
    const double mu_minus = minus * minus / minus_squares;
    const double share =
        fmin(1 + k.c_1 / k.c_mu, fmin(1 + 2 * mu_minus / (mu + 2), (1 - k.c_1 - k.c_mu) / (size * k.c_mu)));
    for (int64_t i = 0; i < points; i++) weights[i] *= i < k.parents ? 1 / plus : share / minus;
    return k;
}

/* C^(-1/2) times a vector. */
static void whiten(const state *c, int64_t n, const double *vector, double *result) {
    double along[SKG_SEARCH_MAX];
    for (int64_t k = 0; k < n; k++) {
        along[k] = 0;
        for (int64_t row = 0; row < n; row++) along[k] += c->axes[n * row + k] * vector[row];
        along[k] /= c->lengths[k];
    }
    for (int64_t row = 0; row < n; row++) {
        result[row] = 0;
        for (int64_t k = 0; k < n; k++) result[row] += c->axes[n * row + k] * along[k];
    }
}

static double square_of(int64_t n, const double *vector) {
    double sum = 0;
    for (int64_t k = 0; k < n; k++) sum += vector[k] * vector[k];
    return sum;
}

/* Moves the mean to the weighted best and adapts the step size. Returns the mean's step over sigma in `step`, and whether
 * the path is short enough for the rank-one update (Hansen's h_sigma). */
static int move_mean(skg_search *s, const constants *k, const ranked *order, const double *weights,
                     double *step) {
    const int64_t n = s->dimensions;
    const state c = state_of(s);
    double white[SKG_SEARCH_MAX];
    for (int64_t d = 0; d < n; d++) {
        step[d] = 0;
        for (int64_t i = 0; i < k->parents; i++)
            step[d] += weights[i] * (s->free_points[n * order[i].index + d] - c.mean[d]) / *c.sigma;
    }
    for (int64_t d = 0; d < n; d++) c.mean[d] += *c.sigma * step[d];
    whiten(&c, n, step, white);
    const double keep = 1 - k->c_sigma, gain = sqrt(k->c_sigma * (2 - k->c_sigma) * k->effective);
    for (int64_t d = 0; d < n; d++) c.path_sigma[d] = keep * c.path_sigma[d] + gain * white[d];
    const double length = sqrt(square_of(n, c.path_sigma));
    const double decay = sqrt(1 - pow(keep, 2 * (double)s->counters[SEARCH_SINCE]));
    *c.sigma *= exp(fmin(1, k->c_sigma / k->damping * (length / k->expected - 1)));
    return length / decay < (1.4 + 2 / ((double)n + 1)) * k->expected;
}

/* Adds the rank-one and the rank-mu update to the covariance. sigma: the one that the points were drawn with. */
static void adapt(skg_search *s, const constants *k, const ranked *order, const double *weights, int rank_one,
                  const double *mean, double sigma) {
    const int64_t n = s->dimensions, points = s->counters[SEARCH_POPULATION];
    const state c = state_of(s);
    double sum = 0, y[SKG_SEARCH_MAX], white[SKG_SEARCH_MAX];
    for (int64_t i = 0; i < points; i++) sum += weights[i];
    const double lost = rank_one ? 0 : k->c_1 * k->c_c * (2 - k->c_c);
    const double keep = 1 + lost - k->c_1 - k->c_mu * sum;
    for (int64_t e = 0; e < n * n; e++)
        c.covariance[e] = keep * c.covariance[e] + k->c_1 * c.path_c[e / n] * c.path_c[e % n];
    for (int64_t i = 0; i < points; i++) {
        for (int64_t d = 0; d < n; d++) y[d] = (s->free_points[n * order[i].index + d] - mean[d]) / sigma;
        double weight = k->c_mu * weights[i];
        if (weight < 0) {
            whiten(&c, n, y, white);
            weight *= (double)n / square_of(n, white);
        }
        for (int64_t e = 0; e < n * n; e++) c.covariance[e] += weight * y[e / n] * y[e % n];
    }
}

/* Sets axes and their lengths. Returns 0 if the covariance has degenerated. */
static skg_status decompose(skg_search *s, int *is_sound) {
    const int64_t n = s->dimensions;
    const state c = state_of(s);
    memcpy(c.axes, c.covariance, (size_t)(n * n) * sizeof *c.axes);
    *is_sound = 1;
    for (int64_t e = 0; e < n * n; e++) *is_sound &= isfinite(c.axes[e]) != 0;
    if (*is_sound) skg_eigen_rising((int)n, c.axes, c.lengths);
    *is_sound = *is_sound && c.lengths[0] > 1e-14 * c.lengths[n - 1];
    for (int64_t k = 0; k < n && *is_sound; k++) c.lengths[k] = sqrt(c.lengths[k]);
    return SKG_OK;
}

/* The search stagnates when its best value has not fallen by this share for so many generations for each dimension: choices.
 * In the bends of Rosenbrock's valley the values of 15 dimensions do not fall for 30 generations. */
static const double GAIN = 0.01;
enum { PATIENCE = 5 };

/* Keeps the best value since the start, and its generation. The start itself may lie far below the first points. */
static int stagnates(const skg_search *s, double best) {
    double *record = state_of(s).record;
    const int64_t since = s->counters[SEARCH_SINCE];
    if (since <= 2 || best < record[0] - GAIN * fabs(record[0])) record[0] = best, record[1] = (double)since;
    return (double)since - record[1] > (double)(PATIENCE * s->dimensions);
}

/* Criteria for a restart, of which the second and third are Hansen's: the best value stagnates, the values of the last
 * generations, or the points, have become equal. */
static int has_converged(const skg_search *s, const ranked *order) {
    const int64_t n = s->dimensions, points = s->counters[SEARCH_POPULATION];
    const state c = state_of(s);
    const int64_t since = s->counters[SEARCH_SINCE];
    int64_t window = 10 + (30 * n + points - 1) / points;
    if (window > HISTORY) window = HISTORY;
    double low = order[0].value, high = order[points / 2].value, widest = 0;
    for (int64_t h = 0; h < window; h++) {
        low = fmin(low, c.history[(since - h + HISTORY) % HISTORY]);
        high = fmax(high, c.history[(since - h + HISTORY) % HISTORY]);
    }
    for (int64_t k = 0; k < n; k++) widest = fmax(widest, *c.sigma * sqrt(c.covariance[(n + 1) * k]));
    const int is_flat = since >= window && high - low <= 1e-12 * fabs(low);
    return stagnates(s, order[0].value) || is_flat || widest < 1e-12 || *c.sigma > 1e6;
}

skg_status skg_cma_tell(skg_search *s, const double *values) {
    const int64_t n = s->dimensions, points = s->counters[SEARCH_POPULATION];
    const state c = state_of(s);
    ranked *order = NULL;
    double *weights = NULL, mean[SKG_SEARCH_MAX], step[SKG_SEARCH_MAX];
    int is_sound = 0;
    skg_model_add(s, c.memory, values);
    skg_status status = skg_alloc(points, sizeof *order, "search", &order);
    if (status == SKG_OK) status = skg_alloc(points, sizeof *weights, "search", &weights);
    if (status == SKG_OK) {
        const double sigma = *c.sigma;
        const constants k = constants_of(n, points, weights);
        memcpy(mean, c.mean, (size_t)n * sizeof *mean);
        rank(s, values, order);
        const int rank_one = move_mean(s, &k, order, weights, step);
        const double gain = rank_one ? sqrt(k.c_c * (2 - k.c_c) * k.effective) : 0;
        for (int64_t d = 0; d < n; d++) c.path_c[d] = (1 - k.c_c) * c.path_c[d] + gain * step[d];
        adapt(s, &k, order, weights, rank_one, mean, sigma);
        c.history[s->counters[SEARCH_SINCE] % HISTORY] = order[0].value;
        status = decompose(s, &is_sound);
        if (status == SKG_OK && (!is_sound || has_converged(s, order))) restart(s);
    }
    skg_free(&order);
    skg_free(&weights);
    return status;
}
