/* Verifies a model against the whole spectrum, and bounds its error. */
#include "spectral/verification.h"

#include "core/maths.h"
#include "core/threads.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The worst points, from which the search goes uphill. */
enum { STARTS = 10 };

void skg_nodes_release(skg_nodes *nodes) {
    skg_free(&nodes->bin);
    skg_free(&nodes->shares);
    nodes->count = 0;
}

void skg_lengths_release(skg_lengths *points) {
    skg_free(&points->lengths);
    skg_free(&points->exact);
    points->count = points->capacity = 0;
}

static double exponent_at(const skg_polychromatic *beam, const double *mu, const double *lengths,
                          int32_t bin) {
    double sum = 0;
    for (int32_t m = 0; m < beam->materials; m++) sum += lengths[m] * mu[(int64_t)m * beam->bins + bin];
    return sum;
}

/* The exponents of all bins. Some bins at a time stay in registers; each sum has the order of exponent_at and so its
 * bits. */
enum { SOME = 8 };
static void find_exponents(const skg_polychromatic *beam, const double *mu, const double *lengths,
                           double *exponents) {
    int32_t first = 0;
    for (; first + SOME <= beam->bins; first += SOME) {
        double sums[SOME] = {0};
        for (int32_t m = 0; m < beam->materials; m++) {
            const double length = lengths[m], *row = mu + (int64_t)m * beam->bins + first;
            for (int32_t b = 0; b < SOME; b++) sums[b] += length * row[b];
        }
        memcpy(exponents + first, sums, sizeof sums);
    }
    for (; first < beam->bins; first++) exponents[first] = exponent_at(beam, mu, lengths, first);
}

void skg_transmit(const skg_polychromatic *beam, const double *mu, const double *lengths, double *passed) {
    find_exponents(beam, mu, lengths, passed);
    for (int32_t b = 0; b < beam->bins; b++) passed[b] = exp(-passed[b]);
}

void skg_transmit_exact(const skg_polychromatic *beam, double *lengths, double *exact, double *exponents) {
    double least = HUGE_VAL;
    find_exponents(beam, beam->mu, lengths, exponents);
    for (int32_t b = 0; b < beam->bins; b++) least = exponents[b] < least ? exponents[b] : least;
    if (least > SKG_EXPONENT_MAX) {
        for (int32_t m = 0; m < beam->materials; m++) lengths[m] *= SKG_EXPONENT_MAX / least;
        find_exponents(beam, beam->mu, lengths, exponents);
    }
    memset(exact, 0, (size_t)beam->sets * sizeof *exact);
    for (int32_t b = 0; b < beam->bins; b++) {
        const double passed = exp(-exponents[b]), *shares = beam->shares + (int64_t)b * beam->sets;
        for (int32_t s = 0; s < beam->sets; s++) exact[s] += passed * shares[s];
    }
}

/* --- points --- */

/* Points of a piece of work of skg_parallel. */
enum { PIECE = 64 };
static int64_t pieces_of(int64_t points) {
    return (points + PIECE - 1) / PIECE;
}

typedef struct {
    const skg_polychromatic *beam;
    skg_lengths *points;
    int64_t first; /* the points before have their transmission */
} filling;

static skg_status fill_piece(void *user, int64_t piece) {
    const filling *f = user;
    const int64_t first = f->first + piece * PIECE;
    double *exponents = NULL;
    SKG_TRY(skg_alloc(f->beam->bins, sizeof *exponents, "lengths", &exponents));
    for (int64_t p = first; p < first + PIECE && p < f->points->count; p++)
        skg_transmit_exact(f->beam, f->points->lengths + p * f->beam->materials,
                           f->points->exact + p * f->beam->sets, exponents);
    skg_free(&exponents);
    return SKG_OK;
}

static skg_status reserve(const skg_polychromatic *beam, int64_t more, skg_lengths *points) {
    if (points->count + more <= points->capacity) return SKG_OK;
    const int64_t capacity = points->count + more;
    SKG_TRY(skg_realloc(capacity * beam->materials, sizeof *points->lengths, "lengths", &points->lengths));
    SKG_TRY(skg_realloc(capacity * beam->sets, sizeof *points->exact, "lengths", &points->exact));
    points->capacity = capacity;
    return SKG_OK;
}

/* Adds one point, whose transmission is known. */
static skg_status add_known(const skg_polychromatic *beam, const double *lengths, const double *exact,
                            skg_lengths *points) {
    SKG_TRY(reserve(beam, 1, points));
    memcpy(points->lengths + points->count * beam->materials, lengths,
           (size_t)beam->materials * sizeof *lengths);
    memcpy(points->exact + points->count * beam->sets, exact, (size_t)beam->sets * sizeof *exact);
    points->count++;
    return SKG_OK;
}

static void draw_corner(const skg_polychromatic *beam, uint64_t which, double *lengths) {
    for (int32_t m = 0; m < beam->materials; m++)
        lengths[m] = m < 64 && which >> m & 1 ? beam->high[m] : beam->low[m];
}

/* thin: all lengths together are scaled by 1 to a thousandth, and each is a square, so that thin objects are
 * frequent. */
static void draw_point(const skg_polychromatic *beam, int thin, uint64_t *state, double *lengths) {
    const double all = thin ? pow(10, -3 * skg_draw(state)) : 1;
    for (int32_t m = 0; m < beam->materials; m++) {
        const double part = skg_draw(state), end = beam->high[m];
        const double start = thin ? fmax(0, beam->low[m]) : beam->low[m];
        lengths[m] = start + (end - start) * (thin ? part * part : part) * all;
    }
}

skg_status skg_lengths_fill(const skg_polychromatic *beam, const skg_sampling *sampling, const skg_rays *rays,
                            skg_lengths *points) {
    const int32_t width = beam->materials;
    const int all = width < 30 && (int64_t)1 << width <= sampling->corners;
    const int64_t corners = all ? (int64_t)1 << width : sampling->corners;
    const int64_t given = rays->count < sampling->rays ? rays->count : sampling->rays;
    filling f = {.beam = beam, .points = points, .first = points->count};
    uint64_t state = sampling->seed;
    SKG_TRY(reserve(beam, 1 + corners + sampling->draws + given, points));
    double *at = points->lengths + points->count * width;
    memset(at, 0, (size_t)width * sizeof *at); /* no matter at all */
    for (int64_t c = 0; c < corners; c++)
        draw_corner(beam, all || c == 0 ? (uint64_t)c : (uint64_t)(skg_draw(&state) * 0x1p53), at += width);
    for (int64_t d = 0; d < sampling->draws; d++) draw_point(beam, d % 2 == 1, &state, at += width);
    for (int64_t g = 0; g < given; g++) {
        const int64_t ray = given < rays->count ? g * rays->count / given : g;
        memcpy(at += width, rays->lengths + ray * rays->width, (size_t)width * sizeof *at);
    }
    points->count += 1 + corners + sampling->draws + given;
    return skg_parallel(pieces_of(points->count - f.first), fill_piece, &f);
}

/* --- errors --- */

/* The exponents of SOME nodes, or of those that are left, whose number is returned. */
static int32_t exponents_of_nodes(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                                  const double *lengths, int32_t first, double exponents[SOME]) {
    const int32_t *bin = nodes->bin + first;
    if (nodes->count - first < SOME) {
        for (int32_t k = 0; k < nodes->count - first; k++)
            exponents[k] = exponent_at(beam, mu, lengths, bin[k]);
        return nodes->count - first;
    }
    double sums[SOME] = {0};
    for (int32_t m = 0; m < beam->materials; m++) {
        const double length = lengths[m], *row = mu + (int64_t)m * beam->bins;
        for (int32_t k = 0; k < SOME; k++) sums[k] += length * row[bin[k]];
    }
    memcpy(exponents, sums, sizeof sums);
    return SOME;
}

double skg_nodes_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                       const double *lengths, const double *exact) {
    double worst = 0, found[64] = {0}; /* up to 64 sets at a time share the exponentials */
    for (int32_t first = 0; first < beam->sets; first += 64) {
        const int32_t sets = beam->sets - first < 64 ? beam->sets - first : 64;
        for (int32_t s = 0; s < sets; s++) found[s] = 0;
        for (int32_t n = 0; n < nodes->count; n += SOME) {
            double exponents[SOME];
            const int32_t some = exponents_of_nodes(beam, mu, nodes, lengths, n, exponents);
            for (int32_t k = 0; k < some; k++) {
                const double passed = exp(-exponents[k]);
                const double *shares = nodes->shares + (n + k) * beam->sets + first;
                for (int32_t s = 0; s < sets; s++) found[s] += passed * shares[s];
            }
        }
        for (int32_t s = 0; s < sets; s++) {
            const double truth = exact[first + s];
            worst = fmax(worst, fabs(found[s] - truth) / fmax(truth, beam->floor));
        }
    }
    return worst;
}

/* By how much a logarithm changes with a relative change either way. */
static double log_change(double relative) {
    return relative > 1 ? log1p(relative) : -log1p(-relative);
}

skg_status skg_nodes_log_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                               const skg_rays *rays, double *error, double *least) {
    skg_polychromatic relative = *beam;
    double *lengths = NULL, *exact = NULL, *exponents = NULL;
    skg_status status = SKG_OK;
    relative.floor = DBL_MIN; /* errors are relative everywhere */
    *error = 0, *least = 1;
    SKG_TRY_CLEANUP(skg_alloc(beam->materials, sizeof *lengths, "lengths", &lengths));
    SKG_TRY_CLEANUP(skg_alloc(beam->sets, sizeof *exact, "lengths", &exact));
    SKG_TRY_CLEANUP(skg_alloc(beam->bins, sizeof *exponents, "lengths", &exponents));
    for (int64_t r = 0; r < rays->count; r++) {
        memcpy(lengths, rays->lengths + r * rays->width, (size_t)beam->materials * sizeof *lengths);
        skg_transmit_exact(beam, lengths, exact, exponents);
        for (int32_t s = 0; s < beam->sets; s++)
            if (exact[s] > 0) *least = fmin(*least, exact[s]);
        *error = fmax(*error, log_change(skg_nodes_error(&relative, mu, nodes, lengths, exact)));
    }
cleanup:
    skg_free(&lengths);
    skg_free(&exact);
    skg_free(&exponents);
    return status;
}

typedef struct {
    const skg_polychromatic *beam;
    const double *mu;
    const skg_nodes *nodes;
    double *lengths, *exact;           /* of one point */
    double *trial, *tried, *exponents; /* of another: lengths, transmission; [bins] */
    double error;                      /* at `lengths` */
    int64_t looks;
} climb;

/* The error at the lengths in c->trial. */
static double look(climb *c) {
    c->looks++;
    skg_transmit_exact(c->beam, c->trial, c->tried, c->exponents);
    return skg_nodes_error(c->beam, c->mu, c->nodes, c->trial, c->tried);
}

static void keep_trial(climb *c) {
    memcpy(c->lengths, c->trial, (size_t)c->beam->materials * sizeof *c->trial);
    memcpy(c->exact, c->tried, (size_t)c->beam->sets * sizeof *c->tried);
}

/* Climbs along one coordinate after the other, with steps that are halved if none leads up: from a fifth of the
 * range to a 250th. */
static double ascend(climb *c, double error) {
    const skg_polychromatic *beam = c->beam;
    for (double step = 0.2; step > 0.004; step /= 2) {
        int rose = 1;
        for (int pass = 0; rose && pass < 4; pass++) {
            rose = 0;
            for (int32_t k = 0; k < 2 * beam->materials; k++) {
                const int32_t m = k / 2;
                const double way = (k % 2 ? step : -step) * (beam->high[m] - beam->low[m]);
                memcpy(c->trial, c->lengths, (size_t)beam->materials * sizeof *c->trial);
                c->trial[m] = fmin(fmax(c->trial[m] + way, beam->low[m]), beam->high[m]);
                if (c->trial[m] == c->lengths[m]) continue;
                const double found = look(c);
                if (!(found > error)) continue;
                error = found, rose = 1;
                keep_trial(c);
            }
        }
    }
    return error;
}

/* Keeps the worst points in falling order; of equal ones the first. */
static void rank_point(int64_t index, double error, int64_t *worst, double *errors, int32_t *count) {
    int32_t at = *count;
    while (at > 0 && errors[at - 1] < error) at--;
    if (at == STARTS) return;
    if (*count < STARTS) (*count)++;
    for (int32_t k = *count - 1; k > at; k--) worst[k] = worst[k - 1], errors[k] = errors[k - 1];
    worst[at] = index, errors[at] = error;
}

/* Work of the threads of a verification: first the points in pieces, then the climbs. */
typedef struct {
    const skg_lengths *points;
    double *errors; /* [points] */
    climb climbs[STARTS];
} verifying;

static skg_status find_errors(void *user, int64_t piece) {
    verifying *v = user;
    const climb *c = v->climbs;
    const skg_lengths *points = v->points;
    for (int64_t p = piece * PIECE; p < (piece + 1) * PIECE && p < points->count; p++)
        v->errors[p] = skg_nodes_error(c->beam, c->mu, c->nodes, points->lengths + p * c->beam->materials,
                                       points->exact + p * c->beam->sets);
    return SKG_OK;
}

static skg_status climb_one(void *user, int64_t item) {
    climb *c = &((verifying *)user)->climbs[item];
    c->error = ascend(c, c->error);
    return SKG_OK;
}

/* Makes the climbs from the worst points. Returns their number by *starts. */
static skg_status prepare_climbs(verifying *v, int32_t *starts) {
    int64_t start[STARTS];
    double errors[STARTS];
    *starts = 0;
    for (int64_t p = 0; p < v->points->count; p++) rank_point(p, v->errors[p], start, errors, starts);
    for (int32_t s = 0; s < *starts; s++) {
        climb *c = &v->climbs[s];
        const int32_t materials = c->beam->materials;
        SKG_TRY(skg_alloc(materials, sizeof *c->lengths, "lengths", &c->lengths));
        SKG_TRY(skg_alloc(materials, sizeof *c->trial, "lengths", &c->trial));
        SKG_TRY(skg_alloc(c->beam->sets, sizeof *c->exact, "lengths", &c->exact));
        SKG_TRY(skg_alloc(c->beam->sets, sizeof *c->tried, "lengths", &c->tried));
        SKG_TRY(skg_alloc(c->beam->bins, sizeof *c->exponents, "lengths", &c->exponents));
        memcpy(c->lengths, v->points->lengths + start[s] * materials, (size_t)materials * sizeof *c->lengths);
        memcpy(c->exact, v->points->exact + start[s] * c->beam->sets,
               (size_t)c->beam->sets * sizeof *c->exact);
        c->error = errors[s];
    }
    return SKG_OK;
}

skg_status skg_nodes_verify(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                            const skg_lengths *points, double *error, int64_t *checked, skg_lengths *worst) {
    verifying v = {.points = points};
    int32_t starts = 0;
    skg_status status = SKG_OK;
    for (int32_t s = 0; s < STARTS; s++) v.climbs[s] = (climb){.beam = beam, .mu = mu, .nodes = nodes};
    SKG_TRY_CLEANUP(skg_alloc(points->count, sizeof *v.errors, "lengths", &v.errors));
    SKG_TRY_CLEANUP(skg_parallel(pieces_of(points->count), find_errors, &v));
    SKG_TRY_CLEANUP(prepare_climbs(&v, &starts));
    *error = starts ? v.climbs[0].error : 0;
    SKG_TRY_CLEANUP(skg_parallel(starts, climb_one, &v));
    *checked = points->count;
    for (int32_t s = 0; s < starts; s++) {
        *error = fmax(*error, v.climbs[s].error);
        *checked += v.climbs[s].looks;
        if (worst) SKG_TRY_CLEANUP(add_known(beam, v.climbs[s].lengths, v.climbs[s].exact, worst));
    }
cleanup:
    for (int32_t s = 0; s < STARTS; s++) {
        skg_free(&v.climbs[s].lengths);
        skg_free(&v.climbs[s].exact);
        skg_free(&v.climbs[s].trial);
        skg_free(&v.climbs[s].tried);
        skg_free(&v.climbs[s].exponents);
    }
    skg_free(&v.errors);
    return status;
}
