/* Transport of scattered photons in a layer: a table by energy, depth and direction of what a photon leaves behind. */
#include "beam/deposition.h"
#include "core/maths.h"
#include "material/material.h"
#include "material/scattering.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells of depth, directions, angles of scattering and places around them; tried in deposition_test.c. */
enum { CELLS = 24, HALF = 8, WAYS = 2 * HALF, ANGLES = 32, TURNS = 16, SWEEPS = 12 };
/* Of the table of energies: each is so many times the one before, from FIRST_KEV on; edges have a row below and a row above. Of less, all but
 * nothing is scattered. */
static const double FIRST_KEV = 5, STEP = 1.2, EDGE = 1e-9;

/* Over the energy and over its square. */
typedef struct {
    double first[WAYS][CELLS], second[WAYS][CELLS];
} row;

struct skg_deposition {
    const skg_material *material; /* borrowed */
    const skg_escape *escape;     /* borrowed; NULL: none */
    double mm, bounds[CELLS + 1], middles[CELLS];
    double way[WAYS], share[WAYS]; /* direction cosines from -1 to 1, and their weights, which add up to 1 */
    /* Of Compton and Rayleigh scattering: the sine of half the angle, and weights over its cosine. */
    double x[2][ANGLES], step[2][ANGLES];
    int64_t count;
    double *kev; /* [count] rising */
    row *rows;   /* [count] */
};

/* Interactions of a photon of one energy: their shares, and the angles of two of them. */
typedef struct {
    double kev, photo, compton, rayleigh, pair;
    double weight[2][ANGLES]; /* add up to 1 for each kind */
    double after[ANGLES];     /* keV of the photon after Compton scattering */
    /* Moments of what absorption and pair production leave in each cell. */
    double first[CELLS], second[CELLS];
} collision;

/* Probabilities of the directions [kind][angle][new direction] for one direction. */
typedef double turning[2][ANGLES][WAYS];

/* Points and weights of Gauss and Legendre on 0 to 1, by the method of Newton. */
static void find_gauss(int count, double *points, double *weights) {
    for (int i = 0; i < count; i++) {
        double x = cos(SKG_PI * (i + 0.75) / (count + 0.5)), slope = 0;
        for (int round = 0; round < 50; round++) {
            double p = 1, before = 0;
            for (int k = 1; k <= count; k++) {
                const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p, p = next;
            }
            slope = count * (x * p - before) / (x * x - 1);
            x -= p / slope;
            if (fabs(p / slope) < 1e-15) break;
        }
        points[i] = 0.5 * (1 - x);
        weights[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

static void find_grids(skg_deposition *d) {
    double points[ANGLES], weights[ANGLES];
    for (int b = 0; b <= CELLS; b++) d->bounds[b] = 0.5 * d->mm * (1 - cos(SKG_PI * b / CELLS));
    for (int c = 0; c < CELLS; c++) d->middles[c] = 0.5 * (d->bounds[c] + d->bounds[c + 1]);
    find_gauss(HALF, points, weights);
    /* Paths along the layer are long, so that directions near 0 differ most. */
    for (int i = 0; i < HALF; i++) {
        const double y = points[i];
        d->way[HALF + i] = y, d->way[HALF - 1 - i] = -y;
        d->share[HALF + i] = d->share[HALF - 1 - i] = weights[i] / 2;
    }
    find_gauss(ANGLES, points, weights);
    /* The cosine is 1 - 2 x^2; form factors are sharp at small angles, where x = y^3 is fine. */
    for (int q = 0; q < ANGLES; q++) {
        const double y = points[q];
        d->x[0][q] = y, d->step[0][q] = 4 * y * weights[q];
        d->x[1][q] = y * y * y, d->step[1][q] = 4 * y * y * y * 3 * y * y * weights[q];
    }
}

/* Adds a share of a direction to the two of the grid beside it. */
static void add_way(const skg_deposition *d, double way, double share, double to[WAYS]) {
    int high = 1;
    while (high < WAYS - 1 && d->way[high] < way) high++;
    const double below = d->way[high - 1], above = d->way[high];
    const double part =
        below * above > 0 ? (1 / below - 1 / way) / (1 / below - 1 / above) : (way - below) / (above - below);
    const double inside = fmin(fmax(part, 0), 1);
    to[high - 1] += share * (1 - inside);
    to[high] += share * inside;
}

/* Where scattering leads from a direction, on the average around it. */
static void find_turning(const skg_deposition *d, double way, turning to) {
    const double across = sqrt(fmax(1 - way * way, 0));
    const int turns = across > 0 ? TURNS : 1; /* along the normal all are alike */
    memset(to, 0, sizeof(turning));
    for (int kind = 0; kind < 2; kind++)
        for (int q = 0; q < ANGLES; q++) {
            const double x = d->x[kind][q], cosine = 1 - 2 * x * x, sine = 2 * x * sqrt(1 - x * x);
            for (int t = 0; t < turns; t++)
                add_way(d, way * cosine + across * sine * cos(SKG_PI * (t + 0.5) / turns), 1.0 / turns,
                        to[kind][q]);
        }
}

static void find_collision(const skg_deposition *d, double kev, collision *c) {
    const skg_material *m = d->material;
    double sections[SKG_PROCESSES], sums[2] = {0};
    skg_mixed_sections(m->count, m->parts, kev, sections);
    const double all = skg_total_section(sections);
    *c = (collision){.kev = kev,
                     .photo = sections[SKG_PHOTO] / all,
                     .compton = sections[SKG_COMPTON] / all,
                     .rayleigh = sections[SKG_RAYLEIGH] / all};
    c->pair = fmax(1 - c->photo - c->compton - c->rayleigh, 0);
    for (int kind = 0; kind < 2; kind++)
        for (int q = 0; q < ANGLES; q++) {
            const double x = d->x[kind][q], cosine = 1 - 2 * x * x;
            const double r = 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
            double coherent = 0, incoherent = 0;
            skg_scattering_factors(m, kev / SKG_HC_KEV_ANGSTROM * x, &coherent,
                                   &incoherent); /* checked before */
            const double chance = kind ? (1 + cosine * cosine) * coherent
                                       : r * r * (r + 1 / r - 1 + cosine * cosine) * incoherent;
            c->weight[kind][q] = chance * d->step[kind][q];
            sums[kind] += c->weight[kind][q];
            if (!kind) c->after[q] = r * kev;
        }
    for (int kind = 0; kind < 2; kind++)
        for (int q = 0; q < ANGLES; q++) c->weight[kind][q] /= sums[kind];
}

/* The row below an energy among the first `count`, and how far it is to the next one. */
static int64_t find_row(const skg_deposition *d, int64_t count, double kev, double *part) {
    int64_t low = 0, high = count - 1;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (d->kev[middle] <= kev)
            low = middle;
        else
            high = middle;
    }
    *part = fmin(fmax(log(kev / d->kev[low]) / log(d->kev[high] / d->kev[low]), 0), 1);
    return low;
}

/* Absorption and pair production. */
static void absorb(const skg_deposition *d, collision *c) {
    const double kev = c->kev, rest = kev - 2 * SKG_ELECTRON_KEV;
    double part = 0;
    double left[CELLS] = {0}, squares[CELLS] = {0};
    const int64_t low = find_row(d, d->count, SKG_ELECTRON_KEV, &part);
    if (d->escape) skg_escape_left(d->escape, kev, CELLS, d->middles, left, squares);
    for (int cell = 0; cell < CELLS; cell++) {
        double own = 0, own_square = 0;
        c->first[cell] = c->photo * kev - left[cell];
        c->second[cell] = c->photo * kev * kev - 2 * kev * left[cell] + squares[cell];
        if (!(c->pair > 0) || !(rest > 0)) continue;
        for (int m = 0; m < WAYS; m++) {
            own += d->share[m] *
                   ((1 - part) * d->rows[low].first[m][cell] + part * d->rows[low + 1].first[m][cell]);
            own_square += d->share[m] * ((1 - part) * d->rows[low].second[m][cell] +
                                         part * d->rows[low + 1].second[m][cell]);
        }
        own *= SKG_ELECTRON_KEV, own_square *= SKG_ELECTRON_KEV * SKG_ELECTRON_KEV;
        c->first[cell] += c->pair * (rest + 2 * own);
        c->second[cell] += c->pair * (rest * rest + 4 * rest * own + 2 * own_square + 2 * own * own);
    }
}

/* Moments of what an interaction leaves in each cell, of a photon in one direction: what does not depend on row `self`. The rest are
 * factors of that row's values by direction, and of its means in the mean square. */
typedef struct {
    double first[CELLS], second[CELLS], own_first[WAYS], own_second[WAYS], cross[WAYS];
} balance;

/* Energy that a scattered photon leaves in each cell by its direction, and energy that the scattering itself leaves. */
typedef struct {
    double lost, kev;                               /* keV of the electron and of the photon */
    double own;                                     /* the photon's share of the row `self` */
    double other;                                   /* of rows before it */
    double first[WAYS][CELLS], second[WAYS][CELLS]; /* by those; 0 where it has no share of them */
} scattered;

/* Memory of a solution; too much for the stack. */
typedef struct {
    turning to[WAYS];
    balance balances[WAYS];
    double reaches[WAYS][CELLS][CELLS];
} workspace;

/* rows: those that are known */
static void find_scattered(const skg_deposition *d, double lost, double kev, int64_t rows, int64_t self,
                           scattered *to) {
    double part = 0;
    const int64_t low = find_row(d, rows, kev, &part);
    const double shares[2] = {low < self ? 1 - part : 0, low + 1 < self ? part : 0};
    const double one[2] = {shares[0] * kev, shares[1] * kev};
    const row *r = &d->rows[low];
    to->lost = lost, to->kev = kev;
    to->own = (low == self ? 1 - part : 0) + (low + 1 == self ? part : 0);
    to->other = shares[0] + shares[1];
    for (int m = 0; m < WAYS && to->other > 0; m++)
        for (int c = 0; c < CELLS; c++) {
            const double mean = one[0] * r[0].first[m][c] + one[1] * r[1].first[m][c];
            const double square = one[0] * r[0].second[m][c] + one[1] * r[1].second[m][c];
            to->first[m][c] = mean;
            to->second[m][c] = kev * square + 2 * lost * mean;
        }
}

static void add_cells(double share, const double *restrict from, double *restrict to) {
    for (int c = 0; c < CELLS; c++) to[c] += share * from[c];
}

/* ways: where the scattering leads */
static void add_scattered(const scattered *s, double chance, const double ways[WAYS], balance *b) {
    const double lost = chance * s->lost, squares = lost * s->lost, own = chance * s->own * s->kev;
    for (int c = 0; c < CELLS; c++) b->first[c] += lost, b->second[c] += squares;
    for (int m = 0; m < WAYS; m++) {
        if (!(ways[m] > 0)) continue;
        b->own_first[m] += ways[m] * own;
        b->own_second[m] += ways[m] * own * s->kev;
        b->cross[m] += 2 * s->lost * ways[m] * own;
        if (!(s->other > 0)) continue;
        add_cells(chance * ways[m], s->first[m], b->first);
        add_cells(chance * ways[m], s->second[m], b->second);
    }
}

/* to, balances: of `count` directions. rows: those that are known; self: the one to be solved, or d->count */
static void find_balances(const skg_deposition *d, const collision *c, int64_t rows, int64_t self, int count,
                          turning *to, balance *balances) {
    scattered s;
    for (int m = 0; m < count; m++) {
        memset(&balances[m], 0, sizeof *balances);
        memcpy(balances[m].first, c->first, sizeof c->first);
        memcpy(balances[m].second, c->second, sizeof c->second);
    }
    for (int q = 0; q < ANGLES; q++) {
        find_scattered(d, c->kev - c->after[q], c->after[q], rows, self, &s);
        for (int m = 0; m < count; m++)
            add_scattered(&s, c->compton * c->weight[0][q], to[m][0][q], &balances[m]);
    }
    find_scattered(d, 0, c->kev, rows, self, &s);
    for (int q = 0; q < ANGLES; q++)
        for (int m = 0; m < count; m++)
            add_scattered(&s, c->rayleigh * c->weight[1][q], to[m][1][q], &balances[m]);
}

/* The cells that a photon flies through from cell c on: the first, and one past the last, in steps of `side`. */
#define EACH_AHEAD(to, c, side) for (int to = (c); to >= 0 && to < CELLS; to += (side))

/* The share of photons from the middle of a cell that interact in each of the cells ahead. */
static void find_flight(const skg_deposition *d, double per_mm, double way, double reaches[CELLS][CELLS]) {
    const double along = per_mm / fabs(way);
    const int side = way > 0 ? 1 : -1;
    double stays[CELLS], half[CELLS]; /* of those that enter, and of those that start in the middle */
    for (int c = 0; c < CELLS; c++) {
        const double width = d->bounds[c + 1] - d->bounds[c];
        stays[c] = -expm1(-along * width);
        half[c] = -expm1(-along * width / 2);
    }
    for (int c = 0; c < CELLS; c++) {
        double passes = 1;
        EACH_AHEAD(to, c, side) {
            const double here = to == c ? half[to] : stays[to];
            reaches[c][to] = passes * here;
            passes *= 1 - here;
        }
    }
}

/* Of one direction of a row, after the balances of all directions are known: what it leaves from each cell on. */
static void sweep(row *r, double kev, int m, int side, double reaches[CELLS][CELLS], const balance *b) {
    double first[CELLS], second[CELLS];
    memcpy(first, b->first, sizeof first);
    memcpy(second, b->second, sizeof second);
    for (int w = 0; w < WAYS; w++) {
        if (!(b->own_first[w] > 0)) continue;
        add_cells(b->own_first[w], r->first[w], first);
        add_cells(b->own_second[w], r->second[w], second);
        add_cells(b->cross[w], r->first[w], second);
    }
    for (int c = 0; c < CELLS; c++) {
        double one = 0, two = 0;
        EACH_AHEAD(to, c, side) one += reaches[c][to] * first[to], two += reaches[c][to] * second[to];
        r->first[m][c] = one / kev, r->second[m][c] = two / (kev * kev);
    }
}

static void solve_row(skg_deposition *d, int64_t k, workspace *w) {
    collision c;
    double sections[SKG_PROCESSES];
    find_collision(d, d->kev[k], &c);
    absorb(d, &c);
    skg_mixed_sections(d->material->count, d->material->parts, d->kev[k], sections);
    const double per_mm = skg_total_section(sections) * d->material->density / 10;
    if (k > 0) d->rows[k] = d->rows[k - 1];
    find_balances(d, &c, k + 1, k, WAYS, w->to, w->balances);
    for (int m = 0; m < WAYS; m++) find_flight(d, per_mm, d->way[m], w->reaches[m]);
    for (int s = 0; s < SWEEPS; s++)
        for (int m = 0; m < WAYS; m++)
            sweep(&d->rows[k], d->kev[k], m, d->way[m] > 0 ? 1 : -1, w->reaches[m], &w->balances[m]);
}

static int by_energy(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Energies of the table: even in the logarithm, and both sides of every edge. kev NULL: only counts. */
static int64_t list_energies(const skg_material *m, double *kev) {
    int64_t count = 0;
    for (double e = FIRST_KEV; e < SKG_HIGHEST_KEV * STEP; e *= STEP, count++)
        if (kev) kev[count] = fmin(e, SKG_HIGHEST_KEV);
    for (int64_t p = 0; p < m->count; p++) {
        const skg_element_row *element = &skg_elements[m->parts[p].z];
        for (int32_t k = element->first + 1; k < element->last; k++) {
            const double edge = skg_knots[k].energy_kev;
            if (edge > skg_knots[k - 1].energy_kev || !(edge > FIRST_KEV * (1 + 2 * EDGE))) continue;
            if (kev) kev[count] = edge * (1 - EDGE), kev[count + 1] = edge * (1 + EDGE);
            count += 2;
        }
    }
    if (kev) qsort(kev, (size_t)count, sizeof *kev, by_energy);
    return count;
}

skg_status skg_deposition_create(const skg_material *material, double mm, const skg_escape *escape,
                                 skg_deposition **deposition) {
    skg_deposition *made = NULL;
    workspace *work = NULL;
    skg_status status = SKG_OK;
    *deposition = NULL;
    SKG_TRY(skg_scattering_check(material));
    SKG_TRY(skg_alloc(1, sizeof *made, "deposition", &made));
    made->material = material, made->escape = escape, made->mm = mm;
    made->count = list_energies(material, NULL);
    SKG_TRY_CLEANUP(skg_alloc(made->count, sizeof *made->kev, "deposition", &made->kev));
    SKG_TRY_CLEANUP(skg_alloc(made->count, sizeof *made->rows, "deposition", &made->rows));
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *work, "deposition", &work));
    list_energies(material, made->kev);
    find_grids(made);
    for (int m = 0; m < WAYS; m++) find_turning(made, made->way[m], work->to[m]);
    for (int64_t k = 0; k < made->count; k++) solve_row(made, k, work);
    *deposition = made;
    made = NULL;
cleanup:
    skg_free(&work);
    skg_deposition_release(&made);
    return status;
}

void skg_deposition_release(skg_deposition **deposition) {
    if (!*deposition) return;
    skg_free(&(*deposition)->kev);
    skg_free(&(*deposition)->rows);
    skg_free(deposition);
}

void skg_deposition_moments(const skg_deposition *d, double energy_kev, double per_mm, double oblique,
                            double *energy, double *square) {
    const double along = per_mm * oblique, all = -expm1(-along * d->mm);
    collision c;
    balance b;
    turning to;
    find_turning(d, 1 / oblique, to);
    find_collision(d, energy_kev, &c);
    absorb(d, &c);
    find_balances(d, &c, d->count, d->count, 1, &to, &b);
    *energy = *square = 0;
    for (int cell = 0; cell < CELLS; cell++) {
        const double here =
            -exp(-along * d->bounds[cell]) * expm1(-along * (d->bounds[cell + 1] - d->bounds[cell])) / all;
        *energy += here * b.first[cell];
        *square += here * b.second[cell];
    }
}
