/* What interactions send to places where kerma is asked for. */
#include "dose/photons.h"

#include "core/maths.h"

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

/* Kerma of what fluorescence sends, per sr and interaction. */
static double glow(skg_dose_batch *b, double kev, const skg_dose_matter *m, const skg_dose_meeting *i) {
    const skg_dose_place place = skg_dose_place_of(m, kev);
    double sum = 0;
    for (int64_t s = 0; s < m->physics.shells; s++) {
        const double line = skg_dose_draw_line(m, s, &b->seed);
        sum += skg_dose_emitted(m, place, s) / i->total / (4 * SKG_PI) * skg_kerma_at(&b->hall->kerma, line) *
               passes(b, line);
    }
    return sum;
}

static skg_status send_to(skg_dose_batch *b, int64_t point, const skg_dose_photon *photon,
                          const skg_dose_matter *m, const skg_dose_meeting *i) {
    const double near = SKG_DOSE_NEAR * SKG_DOSE_NEAR;
    double direction[3], compton, rayleigh, left;
    skg_add_scaled(b->hall->walk->spots[point].at, -1, photon->at, direction);
    const double mm = skg_length(direction);
    if (!(mm > 0)) return SKG_OK;
    skg_scale_vector(1 / mm, direction, direction);
    SKG_TRY(skg_way_find(b->hall->walk->tree, &b->hall->rules, photon->at, direction, mm, &b->sight));
    const double cosine = fmin(fmax(skg_dot(photon->direction, direction), -1), 1);
    skg_dose_scattered(m, i, photon->kev, cosine, &compton, &rayleigh, &left);
    double kerma = rayleigh * skg_kerma_at(&b->hall->kerma, photon->kev) * passes(b, photon->kev);
    if (left > SKG_DOSE_LOWEST_KEV) kerma += compton * skg_kerma_at(&b->hall->kerma, left) * passes(b, left);
    if (i->emitted > 0) kerma += glow(b, photon->kev, m, i);
    /* Of interactions in a ball, whose density changes little there, each counts as all do on average: the mean of 1 / mm^2 over a ball
     * is three times that of its rim. Otherwise the variance would have no bound. */
    b->kerma[point] += photon->weight * kerma * (mm * mm < near ? 3 / near : 1 / (mm * mm));
    return SKG_OK;
}

skg_status skg_dose_send(skg_dose_batch *b, const skg_dose_photon *photon, const skg_dose_matter *m,
                         const skg_dose_meeting *meeting) {
    for (int64_t p = 0; p < b->hall->walk->points; p++)
        if (b->hall->walk->spots[p].wanted) SKG_TRY(send_to(b, p, photon, m, meeting));
    return SKG_OK;
}
