/* Photons one by one, as nature has them: neither forced nor weighted nor smoothed. */
#include "analogue.h"

#include "material/scattering.h"
#include "suite.h"
#include "support/random.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846, LOWEST_KEV = 2;

enum { ENERGIES = 2000, MOMENTA = 4000 };

/* What the material does, even in energy from LOWEST_KEV on and in momentum transfer from 0 on. */
typedef struct {
    double kev, momentum;
    double total[ENERGIES + 1], compton[ENERGIES + 1], rayleigh[ENERGIES + 1]; /* 1/mm */
    double incoherent[MOMENTA + 1], coherent[MOMENTA + 1]; /* over their greatest values */
} matter;

static void tabulate(const analogue_scene *scene, matter *m) {
    skg_material *material = NULL;
    ck_skg(skg_material_create_named(scene->material, &material));
    m->kev = scene->kev;
    m->momentum = scene->kev / SKG_HC_KEV_ANGSTROM;
    for (int i = 0; i <= ENERGIES; i++) {
        const double kev = LOWEST_KEV + (scene->kev - LOWEST_KEV) * i / ENERGIES;
        skg_coefficients c;
        double per_cm = 0;
        skg_coefficients_init(&c);
        ck_skg(skg_material_coefficients_get(material, kev, &c));
        ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
        m->total[i] = per_cm / 10;
        m->compton[i] = c.compton / c.total;
        m->rayleigh[i] = c.rayleigh / c.total;
    }
    for (int i = 0; i <= MOMENTA; i++)
        ck_skg(
            skg_scattering_factors(material, m->momentum * i / MOMENTA, &m->coherent[i], &m->incoherent[i]));
    const double most[2] = {m->incoherent[MOMENTA], m->coherent[0]};
    for (int i = 0; i <= MOMENTA; i++) m->incoherent[i] /= most[0], m->coherent[i] /= most[1];
    skg_material_release(&material);
}

static double at(const double *table, int count, double share) {
    const double place = fmin(fmax(share, 0), 1) * count;
    const int i = place < count - 1 ? (int)place : count - 1;
    return table[i] + (place - i) * (table[i + 1] - table[i]);
}

static double at_energy(const matter *m, const double *table, double kev) {
    return at(table, ENERGIES, (kev - LOWEST_KEV) / (m->kev - LOWEST_KEV));
}

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

/* Turns a direction by an angle. */
static void turn(double way[3], double cosine, double azimuth) {
    const double sine = sqrt(fmax(1 - cosine * cosine, 0)), axis = fabs(way[2]) < 0.9;
    double a[3] = {way[1] * axis, axis ? -way[0] : way[2], axis ? 0 : -way[1]}, b[3];
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3; k++) a[k] /= length;
    for (int k = 0; k < 3; k++) b[k] = way[(k + 1) % 3] * a[(k + 2) % 3] - way[(k + 2) % 3] * a[(k + 1) % 3];
    for (int k = 0; k < 3; k++) way[k] = cosine * way[k] + sine * (cos(azimuth) * a[k] + sin(azimuth) * b[k]);
}

/* One scattering: the cosine by rejection from all angles alike. */
static void scatter(const matter *m, double *kev, double way[3], int is_compton, uint64_t *seed) {
    for (;;) {
        const double cosine = draw(seed, -1, 1), ratio = 1 / (1 + *kev / SKG_ELECTRON_KEV * (1 - cosine));
        const double x = *kev / SKG_HC_KEV_ANGSTROM * sqrt((1 - cosine) / 2) / m->momentum;
        const double chance = is_compton ? 0.5 * ratio * ratio * (ratio + 1 / ratio - 1 + cosine * cosine) *
                                               at(m->incoherent, MOMENTA, x)
                                         : 0.5 * (1 + cosine * cosine) * at(m->coherent, MOMENTA, x);
        if (draw(seed, 0, 1) >= chance) continue;
        turn(way, cosine, draw(seed, 0, 2 * PI));
        if (is_compton) *kev *= ratio;
        return;
    }
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
    for (*order = 0; kev > LOWEST_KEV && cross(s, from, way, &enter, &leave); ++*order) {
        const double on = enter - log(draw(seed, 0x1p-53, 1)) / at_energy(m, m->total, kev);
        if (on > leave) break;
        for (int k = 0; k < 3; k++) from[k] += on * way[k];
        const double kind = draw(seed, 0, 1), compton = at_energy(m, m->compton, kev);
        if (kind > compton + at_energy(m, m->rayleigh, kev)) return 0;
        scatter(m, &kev, way, kind < compton, seed);
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
    tabulate(scene, &m);
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
