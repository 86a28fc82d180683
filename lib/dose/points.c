/* Scores the kerma that photons of each interaction give to the points: next-event estimates. */
#include "dose/photons.h"

#include "core/maths.h"

/* Interactions nearer to a place count by their mean, mm, and in mean free paths of what is met: so near that their density changes little,
 * and so far that some are there. Of first interactions there are many near it, because photons are sent there. */
static const double NEAR = 3, NEAR_SHARE = 0.3, NEAR_FIRST = 0.2, NEAR_SHARE_FIRST = 0.1;

/* The share of photons of an energy that come through the pieces of b->sight. */
static double passes(const skg_dose_batch *b, double kev) {
    double depth = 0;
    for (int64_t i = 0; i < b->sight.piece_count; i++) {
        const skg_piece *piece = &b->sight.pieces[i];
        for (int64_t k = piece->first; k < piece->first + piece->count; k++) {
            const skg_presence *at = &b->sight.presences[k];
            const skg_dose_matter *m = skg_dose_matter_of(b->hall, at);
            if (m)
                depth += at->share * (piece->to - piece->from) * skg_dose_total(m, skg_dose_place_of(m, kev));
        }
    }
    return exp(-depth);
}

/* An interaction as a place sees it. */
typedef struct {
    const skg_dose_matter *matter;
    const skg_dose_meeting *meeting;
    double share; /* of the matter there */
    double mm;    /* from one to the other */
    double near;  /* mm: nearer ones count by their mean */
} seen;

/* Photons of an energy that arrive, per mm2, of one per sr: exp(-t) / mm^2. Of interactions in a ball, whose density changes little there, each
 * counts as all do on average in the matter where it is, because the variance would have no bound otherwise. */
static double arrive(const skg_dose_batch *b, const seen *s, double kev) {
    if (!(s->mm < s->near)) return passes(b, kev) / (s->mm * s->mm);
    const double mu = s->share * skg_dose_total(s->matter, skg_dose_place_of(s->matter, kev)),
                 own = mu * s->near;
    return 3 / (s->near * s->near) * (own > 1e-6 ? -expm1(-own) / own : 1);
}

/* Kerma of what fluorescence sends, per sr and interaction. */
static double glow(skg_dose_batch *b, double kev, const seen *s) {
    const skg_dose_place place = skg_dose_place_of(s->matter, kev);
    double sum = 0;
    for (int64_t k = 0; k < s->matter->physics.shells; k++) {
        const double line = skg_dose_draw_line(s->matter, k, &b->seed);
        sum += skg_dose_emitted(s->matter, place, k) / s->meeting->total / (4 * SKG_PI) *
               skg_kerma_at(&b->hall->kerma, line) * arrive(b, s, line);
    }
    return sum;
}

static skg_status send_to(skg_dose_batch *b, int64_t point, const skg_dose_photon *photon, seen *s) {
    double direction[3], compton, rayleigh, left;
    skg_add_scaled(b->hall->walk->spots[point].at, -1, photon->at, direction);
    s->mm = skg_length(direction);
    if (!(s->mm > 0)) return SKG_OK;
    skg_scale_vector(1 / s->mm, direction, direction);
    if (!(s->mm < s->near))
        SKG_TRY(skg_way_find_cells(b->hall->walk->tree, &b->hall->rules, photon->at, direction, s->mm,
                                   &b->sight));
    const double cosine = fmin(fmax(skg_dot(photon->direction, direction), -1), 1);
    skg_dose_scattered(s->matter, s->meeting, photon->kev, cosine, &compton, &rayleigh, &left);
    double kerma = rayleigh * skg_kerma_at(&b->hall->kerma, photon->kev) * arrive(b, s, photon->kev);
    if (left > SKG_DOSE_LOWEST_KEV)
        kerma += compton * skg_kerma_at(&b->hall->kerma, left) * arrive(b, s, left);
    if (s->meeting->emitted > 0) kerma += glow(b, photon->kev, s);
    b->kerma[point] += photon->weight * kerma;
    return SKG_OK;
}

skg_status skg_dose_send(skg_dose_batch *b, const skg_dose_photon *photon, const skg_presence *in,
                         const skg_dose_meeting *meeting, int is_first) {
    seen s = {.matter = skg_dose_matter_of(b->hall, in), .meeting = meeting, .share = in->share};
    const double mu = in->share * meeting->total;
    s.near = is_first ? fmin(NEAR_FIRST, NEAR_SHARE_FIRST / mu) : fmin(NEAR, NEAR_SHARE / mu);
    for (int64_t p = 0; p < b->hall->walk->points; p++)
        if (b->hall->walk->spots[p].wanted) SKG_TRY(send_to(b, p, photon, &s));
    return SKG_OK;
}
