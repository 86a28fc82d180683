#include "spectral/verify.h"

#include "core/parallel.h"
#include "core/random.h"

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

/* The exponents of several bins at a time, whose sums have the order of exponent_at and so its bits. */
enum { SOME = 64 };
static int32_t find_exponents(const skg_polychromatic *beam, const double *mu, const double *lengths,
                              int32_t first, double *sums) {
    const int32_t count = beam->bins - first < SOME ? beam->bins - first : SOME;
    for (int32_t b = 0; b < count; b++) sums[b] = 0;
    for (int32_t m = 0; m < beam->materials; m++) {
        const double length = lengths[m], *row = mu + (int64_t)m * beam->bins + first;
        for (int32_t b = 0; b < count; b++) sums[b] += length * row[b];
    }
    return count;
}

void skg_transmit(const skg_polychromatic *beam, const double *mu, const double *lengths, double *passed) {
    double sums[SOME];
    for (int32_t first = 0; first < beam->bins; first += SOME) {
        const int32_t count = find_exponents(beam, mu, lengths, first, sums);
        for (int32_t b = 0; b < count; b++) passed[first + b] = exp(-sums[b]);
    }
}

void skg_transmit_exact(const skg_polychromatic *beam, const double *lengths, double *exact) {
    double sums[SOME];
    memset(exact, 0, (size_t)beam->sets * sizeof *exact);
    for (int32_t first = 0; first < beam->bins; first += SOME) {
        const int32_t count = find_exponents(beam, beam->mu, lengths, first, sums);
        for (int32_t b = 0; b < count; b++) {
            const double passed = exp(-sums[b]), *shares = beam->shares + (int64_t)(first + b) * beam->sets;
            for (int32_t s = 0; s < beam->sets; s++) exact[s] += passed * shares[s];
        }
    }
}

/* --- points --- */

/* Scales lengths down until the energy that passes best has at most the largest exponent. */
static void cap(const skg_polychromatic *beam, double *lengths) {
    double sums[SOME], least = HUGE_VAL;
    for (int32_t first = 0; first < beam->bins; first += SOME) {
        const int32_t count = find_exponents(beam, beam->mu, lengths, first, sums);
        for (int32_t b = 0; b < count; b++) least = sums[b] < least ? sums[b] : least;
    }
    if (least <= SKG_MOST_EXPONENT) return;
    for (int32_t m = 0; m < beam->materials; m++) lengths[m] *= SKG_MOST_EXPONENT / least;
}

skg_status skg_lengths_add(const skg_polychromatic *beam, const double *lengths, skg_lengths *points) {
    if (points->count == points->capacity) {
        const int64_t capacity = 2 * points->capacity + 64;
        SKG_TRY(skg_realloc(capacity * beam->materials, sizeof *lengths, "lengths", &points->lengths));
        SKG_TRY(skg_realloc(capacity * beam->sets, sizeof *lengths, "lengths", &points->exact));
        points->capacity = capacity;
    }
    double *at = points->lengths + points->count * beam->materials;
    memmove(at, lengths, (size_t)beam->materials * sizeof *at);
    cap(beam, at);
    skg_transmit_exact(beam, at, points->exact + points->count * beam->sets);
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

skg_status skg_lengths_fill(const skg_polychromatic *beam, int64_t most, int64_t draws, uint64_t seed,
                            int64_t count, const double *given, skg_lengths *points) {
    uint64_t state = seed;
    double *lengths = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(beam->materials, sizeof *lengths, "lengths", &lengths));
    const int all = beam->materials < 30 && (int64_t)1 << beam->materials <= most;
    const int64_t corners = all ? (int64_t)1 << beam->materials : most;
    SKG_TRY_CLEANUP(skg_lengths_add(beam, lengths, points)); /* no matter at all */
    for (int64_t c = 0; c < corners; c++) {
        draw_corner(beam, all || c == 0 ? (uint64_t)c : (uint64_t)(skg_draw(&state) * 0x1p53), lengths);
        SKG_TRY_CLEANUP(skg_lengths_add(beam, lengths, points));
    }
    for (int64_t d = 0; d < draws; d++) {
        draw_point(beam, d % 2 == 1, &state, lengths);
        SKG_TRY_CLEANUP(skg_lengths_add(beam, lengths, points));
    }
    for (int64_t g = 0; g < count; g++)
        SKG_TRY_CLEANUP(skg_lengths_add(beam, given + g * beam->materials, points));
cleanup:
    skg_free(&lengths);
    return status;
}

/* --- errors --- */

double skg_nodes_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                       const double *lengths, const double *exact) {
    double worst = 0, found[64] = {0}; /* up to 64 sets at a time share the exponentials */
    for (int32_t first = 0; first < beam->sets; first += 64) {
        const int32_t sets = beam->sets - first < 64 ? beam->sets - first : 64;
        for (int32_t s = 0; s < sets; s++) found[s] = 0;
        for (int32_t n = 0; n < nodes->count; n++) {
            const double passed = exp(-exponent_at(beam, mu, lengths, nodes->bin[n]));
            for (int32_t s = 0; s < sets; s++) found[s] += passed * nodes->shares[n * beam->sets + first + s];
        }
        for (int32_t s = 0; s < sets; s++) {
            const double truth = exact[first + s];
            worst = fmax(worst, fabs(found[s] - truth) / fmax(truth, beam->floor));
        }
    }
    return worst;
}

typedef struct {
    const skg_polychromatic *beam;
    const double *mu;
    const skg_nodes *nodes;
    double *lengths, *trial, *exact; /* of one point */
    double error;                    /* at `lengths` */
    int64_t looks;
} climb;

static double look(climb *c, const double *lengths) {
    c->looks++;
    skg_transmit_exact(c->beam, lengths, c->exact);
    return skg_nodes_error(c->beam, c->mu, c->nodes, lengths, c->exact);
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
                cap(beam, c->trial);
                const double found = look(c, c->trial);
                if (!(found > error)) continue;
                error = found, rose = 1;
                memcpy(c->lengths, c->trial, (size_t)beam->materials * sizeof *c->trial);
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

/* What threads share: the points in pieces, then the climbs. */
enum { PIECE = 64 };
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
        memcpy(c->lengths, v->points->lengths + start[s] * materials, (size_t)materials * sizeof *c->lengths);
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
    SKG_TRY_CLEANUP(skg_parallel((points->count + PIECE - 1) / PIECE, find_errors, &v));
    SKG_TRY_CLEANUP(prepare_climbs(&v, &starts));
    *error = starts ? v.climbs[0].error : 0;
    SKG_TRY_CLEANUP(skg_parallel(starts, climb_one, &v));
    *checked = points->count;
    for (int32_t s = 0; s < starts; s++) {
        *error = fmax(*error, v.climbs[s].error);
        *checked += v.climbs[s].looks;
        if (worst) SKG_TRY_CLEANUP(skg_lengths_add(beam, v.climbs[s].lengths, worst));
    }
cleanup:
    for (int32_t s = 0; s < STARTS; s++) {
        skg_free(&v.climbs[s].lengths);
        skg_free(&v.climbs[s].trial);
        skg_free(&v.climbs[s].exact);
    }
    skg_free(&v.errors);
    return status;
}
