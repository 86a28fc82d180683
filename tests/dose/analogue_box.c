/* Photons one by one through a box; each leaves its energy where it interacts. */
#include "analogue_box.h"

#include "scatter/matter.h"
#include "support/random.h"

#include <math.h>
#include <stdlib.h>

/* The piece of a line in the box; 0: none. */
static int cross(const analogue_box *box, const double from[3], const double way[3], double *enter,
                 double *leave) {
    *enter = 0, *leave = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double a = (box->low[k] - from[k]) / way[k], b = (box->high[k] - from[k]) / way[k];
        *enter = fmax(*enter, fmin(a, b)), *leave = fmin(*leave, fmax(a, b));
    }
    return *leave > *enter;
}

static void emit(const analogue_box *box, double from[3], double way[3], uint64_t *seed) {
    double length = 0;
    from[0] = from[1] = 0, from[2] = box->source;
    for (int k = 0; k < 2; k++) way[k] = draw(seed, -0.5, 0.5) * box->side;
    way[2] = box->plane - box->source;
    for (int k = 0; k < 3; k++) length += way[k] * way[k];
    for (int k = 0; k < 3; k++) way[k] /= sqrt(length);
}

typedef struct {
    double from[3], way[3], kev;
} photon;

/* An interaction. Returns the keV that stay, and leaves p what flies on; *twin: the other photon of an annihilation. */
static double interact(const matter *m, photon *p, photon *twin, uint64_t *seed) {
    const double process = draw(seed, 0, 1), compton = matter_at_energy(m->compton, m, p->kev),
                 scatters = compton + matter_at_energy(m->rayleigh, m, p->kev), before = p->kev;
    if (process >= scatters + matter_at_energy(m->pairs, m, p->kev)) {
        p->kev = 0;
    } else if (process >= scatters) {
        p->kev = MATTER_ANNIHILATION_KEV;
        matter_anywhere(p->way, seed);
        *twin = *p;
        for (int k = 0; k < 3; k++) twin->way[k] = -p->way[k];
        return before - 2 * MATTER_ANNIHILATION_KEV;
    } else {
        const double cosine = matter_draw(m, p->kev, process < compton, seed);
        if (process < compton) p->kev *= matter_ratio(p->kev, cosine);
        matter_turn(p->way, cosine, draw(seed, 0, 6.283185307179586));
    }
    if (p->kev <= MATTER_LOWEST_KEV) p->kev = 0;
    return before - p->kev;
}

/* left: [2] keV that stay, in all of the box and in its layer */
static void follow(const analogue_box *box, const matter *m, photon *p, photon *twin, uint64_t *seed,
                   double left[2]) {
    double enter, leave;
    while (p->kev > 0 && cross(box, p->from, p->way, &enter, &leave)) {
        const double on = enter - log1p(-draw(seed, 0, 1)) / matter_at_energy(m->total, m, p->kev);
        if (!(on < leave)) return;
        for (int k = 0; k < 3; k++) p->from[k] += on * p->way[k];
        const int inner = p->from[2] >= box->inner[0] && p->from[2] < box->inner[1];
        const double stays = interact(m, p, twin, seed);
        left[0] += stays, left[1] += inner ? stays : 0;
    }
}

/* The field as the source sees it: photons towards even places of a plane are fewer per sr at its rim, which weights make good. Fields here
 * are small, so that even directions are even places within the cube of the cosine; photons carry it. */
static double weight_of(const double way[3]) {
    return way[2] * way[2] * way[2];
}

analogue_absorbed analogue_box_run(const analogue_box *box, int64_t photons, uint64_t seed) {
    enum { BATCHES = 40 };
    matter *m = malloc(sizeof *m);
    analogue_absorbed found = {0};
    double sums[2] = {0}, squares[2] = {0};
    if (!m) abort();
    matter_make(box->material, 0, box->kev, m);
    for (int b = 0; b < BATCHES; b++) {
        double left[2] = {0}, given = 0;
        for (int64_t i = 0; i < photons / BATCHES; i++) {
            double own[2] = {0};
            photon both[2] = {{.kev = box->kev}};
            emit(box, both[0].from, both[0].way, &seed);
            const double weight = weight_of(both[0].way);
            for (int p = 0; p < 2; p++) follow(box, m, &both[p], &both[1], &seed, own);
            given += weight * box->kev;
            for (int k = 0; k < 2; k++) left[k] += weight * own[k];
        }
        for (int k = 0; k < 2; k++) {
            const double share = left[k] / given;
            sums[k] += share / BATCHES, squares[k] += share * share / BATCHES;
        }
    }
    free(m);
    found.absorbed = sums[0], found.inner = sums[1];
    found.absorbed_sigma = sqrt(fmax(squares[0] - sums[0] * sums[0], 0) / (BATCHES - 1));
    found.inner_sigma = sqrt(fmax(squares[1] - sums[1] * sums[1], 0) / (BATCHES - 1));
    return found;
}
