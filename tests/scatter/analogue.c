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

/* Follows a photon. Returns the keV that it brings, and sets its number of interactions. */
static double follow(const analogue_scene *s, const matter *m, double from[3], double way[3], uint64_t *seed,
                     int *order) {
    double kev = s->kev, enter, leave;
    for (*order = 0; kev > MATTER_LOWEST_KEV && cross(s, from, way, &enter, &leave); ++*order) {
        const double on = enter - log(draw(seed, 0x1p-53, 1)) / matter_at_energy(m->total, m, kev);
        if (on > leave) break;
        for (int k = 0; k < 3; k++) from[k] += on * way[k];
        const double kind = draw(seed, 0, 1), compton = matter_at_energy(m->compton, m, kev);
        if (kind > compton + matter_at_energy(m->rayleigh, m, kev)) return 0;
        const double cosine = matter_draw(m, kev, kind < compton, seed);
        matter_turn(way, cosine, draw(seed, 0, 2 * PI));
        if (kind < compton) kev *= matter_ratio(kev, cosine);
    }
    const double on = (s->plane - from[2]) / way[2];
    if (*order == 0 || !(way[2] > 0) || !(on >= 0)) return 0;
    for (int k = 0; k < 2; k++)
        if (fabs(2 * (from[k] + on * way[k])) > s->side[k]) return 0;
    return kev;
}

analogue_result analogue_run(const analogue_scene *scene, int64_t histories, uint64_t seed) {
    static matter m;
    analogue_result result = {0};
    double squares = 0, from[3], way[3];
    matter_make(scene->material, 0, scene->kev, &m);
    for (int64_t h = 0; h < histories; h++) {
        int order = 0;
        const double stands = emit(scene, from, way, &seed);
        const double kev = stands * follow(scene, &m, from, way, &seed, &order) / (double)histories;
        if (kev > 0) result.order[(order < 3 ? order : 3) - 1] += kev;
        squares += kev * kev;
    }
    for (int k = 0; k < 3; k++) result.sum += result.order[k];
    result.sigma = sqrt(squares - result.sum * result.sum / (double)histories);
    return result;
}
