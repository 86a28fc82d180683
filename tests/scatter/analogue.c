/* Photons one by one, as nature has them: neither forced nor weighted nor smoothed. */
#include "analogue.h"

#include "matter.h"
#include "support/random.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* Where a line enters and leaves the box; 0 if it misses it. */
static int cross(const analogue_scene *s, const double from[3], const double way[3], double *enter,
                 double *leave) {
    *enter = 0, *leave = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double a = (s->low[k] - from[k]) / way[k], b = (s->high[k] - from[k]) / way[k];
        *enter = fmax(*enter, fmin(a, b));
        *leave = fmin(*leave, fmax(a, b));
    }
    return *leave > *enter;
}

/* A photon towards a random place of the detector. Returns how many it stands for, but for their number of histories. */
static double emit(const analogue_scene *s, double from[3], double way[3], uint64_t *seed) {
    const double on[3] = {draw(seed, -0.5, 0.5) * s->side[0], draw(seed, -0.5, 0.5) * s->side[1], s->plane};
    const double photons = s->per_area * s->side[0] * s->side[1], far = s->plane - s->source[2];
    double r = 0;
    for (int k = 0; k < 3; k++) {
        way[k] = s->parallel ? s->source[k] : on[k] - s->source[k];
        from[k] = s->parallel ? on[k] - 1e4 * s->source[k] : s->source[k];
        r += way[k] * way[k];
    }
    for (int k = 0; k < 3; k++) way[k] /= sqrt(r);
    return photons * (s->parallel ? 1 : pow(far / sqrt(r), 3));
}

typedef struct {
    double from[3], way[3], kev;
    int order; /* interactions so far */
} photon;

/* An interaction. Returns 0 if the photon is absorbed; *twin is then the other one of an annihilation, or has 0 keV. */
static int interact(const matter *m, photon *p, photon *twin, uint64_t *seed) {
    const double kind = draw(seed, 0, 1), compton = matter_at_energy(m->compton, m, p->kev),
                 scatters = compton + matter_at_energy(m->rayleigh, m, p->kev);
    p->order++;
    if (kind > scatters) {
        if (kind > scatters + matter_at_energy(m->pairs, m, p->kev)) return 0;
        p->kev = MATTER_ANNIHILATION_KEV;
        matter_anywhere(p->way, seed);
        *twin = *p;
        for (int k = 0; k < 3; k++) twin->way[k] = -p->way[k];
        return 1;
    }
    const double cosine = matter_draw(m, p->kev, kind < compton, seed);
    matter_turn(p->way, cosine, draw(seed, 0, 2 * PI));
    if (kind < compton) p->kev *= matter_ratio(p->kev, cosine);
    return 1;
}

/* Follows a photon, which makes a pair once at most. Returns the keV that it brings. */
static double follow(const analogue_scene *s, const matter *m, photon *p, photon *twin, uint64_t *seed) {
    double enter, leave;
    while (p->kev > MATTER_LOWEST_KEV && cross(s, p->from, p->way, &enter, &leave)) {
        const double on = enter - log(draw(seed, 0x1p-53, 1)) / matter_at_energy(m->total, m, p->kev);
        if (on > leave) break;
        for (int k = 0; k < 3; k++) p->from[k] += on * p->way[k];
        if (!interact(m, p, twin, seed)) return 0;
    }
    const double on = (s->plane - p->from[2]) / p->way[2];
    if (p->order == 0 || !(p->way[2] > 0) || !(on >= 0)) return 0;
    for (int k = 0; k < 2; k++)
        if (fabs(2 * (p->from[k] + on * p->way[k])) > s->side[k]) return 0;
    return p->kev;
}

analogue_result analogue_run(const analogue_scene *scene, int64_t histories, uint64_t seed) {
    static matter m;
    analogue_result result = {0};
    double squares = 0;
    matter_make(scene->material, 0, scene->kev, &m);
    for (int64_t h = 0; h < histories; h++) {
        photon both[2] = {{.kev = scene->kev}};
        double brought = 0;
        const double stands = emit(scene, both[0].from, both[0].way, &seed) / (double)histories;
        for (int p = 0; p < 2 && both[p].kev > 0; p++) {
            const double kev = stands * follow(scene, &m, &both[p], &both[1], &seed);
            if (kev > 0) result.order[(both[p].order < 3 ? both[p].order : 3) - 1] += kev;
            brought += kev;
        }
        squares += brought * brought;
    }
    for (int k = 0; k < 3; k++) result.sum += result.order[k];
    result.sigma = sqrt(squares - result.sum * result.sum / (double)histories);
    return result;
}
