/* A photon of the beam, from surface to surface through the parts: what it leaves in each, and where it goes.
 *
 * Energy is scored in expectation along the whole line of a flight, with the mean energy that an interaction leaves; where the photon
 * really interacts, and how, is drawn. So parts in which few photons would interact are known, too, and the first flight has no noise but
 * that of its place. The first interaction is forced. */
#include "dose/photons.h"

#include "beam/spectrum.h"
#include "core/maths.h"

/* Interactions of a photon at most: none of those that matter has so many. */
enum { ORDERS = 1000 };

/* Turns a direction of length 1 by an angle, and at random about itself. */
static void turn(double direction[3], double cosine, uint64_t *seed) {
    const double azimuth = 2 * SKG_PI * skg_draw(seed), sine = sqrt(fmax(1 - cosine * cosine, 0));
    const double axis[3] = {fabs(direction[2]) > 0.7, 0, !(fabs(direction[2]) > 0.7)};
    double a[3], b[3];
    skg_cross(axis, direction, a);
    skg_scale_vector(1 / skg_length(a), a, a);
    skg_cross(direction, a, b);
    for (int k = 0; k < 3; k++)
        direction[k] = cosine * direction[k] + sine * (cos(azimuth) * a[k] + sin(azimuth) * b[k]);
    skg_scale_vector(1 / skg_length(direction), direction, direction);
}

/* --- a flight */

/* How far a photon may fly: to the detector, which stops it, or out of the box in which anything is met. */
static double reach_of(const skg_dose_batch *b, const skg_dose_photon *photon) {
    const skg_view *view = &b->hall->walk->beam->recipe->view;
    double reach = HUGE_VAL, normal[3], way[3], on[3];
    for (int k = 0; k < 3; k++) {
        const double limit = photon->direction[k] > 0 ? b->hall->high[k] : b->hall->low[k];
        if (photon->direction[k] < 0 || photon->direction[k] > 0)
            reach = fmin(reach, fmax((limit - photon->at[k]) / photon->direction[k], 0));
    }
    skg_cross(view->column_step, view->row_step, normal);
    skg_add_scaled(view->centre, -1, photon->at, way);
    const double toward = skg_dot(photon->direction, normal), mm = skg_dot(way, normal) / toward;
    if (!(mm > 0 && mm < reach)) return reach;
    skg_add_scaled(photon->at, mm, photon->direction, on);
    skg_add_scaled(on, -1, view->centre, on);
    const double u = skg_dot(on, view->column_step) / skg_dot(view->column_step, view->column_step),
                 v = skg_dot(on, view->row_step) / skg_dot(view->row_step, view->row_step);
    return fabs(u) <= 0.5 * (double)view->columns && fabs(v) <= 0.5 * (double)view->rows ? mm : reach;
}

static void leave(skg_dose_batch *b, const skg_presence *where, double kev) {
    *(where->part < 0 ? &b->around : &b->energy[where->part]) += kev;
}

/* 1/mm of a piece. */
static double per_mm(const skg_dose_batch *b, const skg_piece *piece, double kev) {
    double sum = 0;
    for (int64_t k = piece->first; k < piece->first + piece->count; k++) {
        const skg_presence *at = &b->way.presences[k];
        const skg_dose_matter *m = skg_dose_matter_of(b->hall, at);
        if (m) sum += at->share * skg_dose_total(m, skg_dose_place_of(m, kev));
    }
    return sum;
}

/* Scores the expected energy that the flight leaves along its line. Returns the optical depth of the line. */
static double leave_along(skg_dose_batch *b, const skg_dose_photon *photon) {
    double depth = 0;
    for (int64_t i = 0; i < b->way.piece_count; i++) {
        const skg_piece *piece = &b->way.pieces[i];
        const double mu = per_mm(b, piece, photon->kev), own = mu * (piece->to - piece->from);
        if (!(own > 0)) continue;
        const double met = photon->weight * exp(-depth) * -expm1(-own) / mu;
        for (int64_t k = piece->first; k < piece->first + piece->count; k++) {
            const skg_presence *at = &b->way.presences[k];
            const skg_dose_matter *m = skg_dose_matter_of(b->hall, at);
            if (m) leave(b, at, met * at->share * skg_dose_transfer(m, skg_dose_place_of(m, photon->kev)));
        }
        depth += own;
    }
    b->escaped += photon->weight * photon->kev * exp(-depth);
    return depth;
}

/* Moves the photon to where the optical depth reaches `depth`, and says in which part that is; NULL: rounding has it nowhere. */
static const skg_presence *move(skg_dose_batch *b, double depth, skg_dose_photon *photon) {
    for (int64_t i = 0; i < b->way.piece_count; i++) {
        const skg_piece *piece = &b->way.pieces[i];
        const double mu = per_mm(b, piece, photon->kev), own = mu * (piece->to - piece->from);
        if (!(own > 0)) continue;
        if (depth > own) {
            depth -= own;
            continue;
        }
        double wanted = skg_draw(&b->seed) * mu;
        const skg_presence *found = NULL;
        for (int64_t k = piece->first; k < piece->first + piece->count && !(found && wanted < 0); k++) {
            const skg_dose_matter *m = skg_dose_matter_of(b->hall, &b->way.presences[k]);
            if (!m) continue;
            found = &b->way.presences[k];
            wanted -= found->share * skg_dose_total(m, skg_dose_place_of(m, photon->kev));
        }
        skg_add_scaled(photon->at, piece->from + depth / mu, photon->direction, photon->at);
        return found;
    }
    return NULL;
}

/* --- an interaction */

/* Photons of the lines of shells after photo absorption, and two back to back after pair production; what they take was not left.
 * absorbed: 1/mm of both processes */
static void glow(skg_dose_batch *b, const skg_dose_photon *photon, const skg_dose_matter *m,
                 double absorbed) {
    const skg_dose_place place = skg_dose_place_of(m, photon->kev);
    for (int64_t s = 0; s < m->physics.shells; s++) {
        const int together = m->emitters.of[s].pairs ? 2 : 1;
        if (!(skg_draw(&b->seed) * absorbed < skg_dose_emitted(m, place, s) / together)) continue;
        if (b->waiting_count + together > SKG_DOSE_WAITING) return;
        skg_dose_photon *emitted = &b->waiting[b->waiting_count];
        *emitted = *photon;
        emitted->kev = skg_dose_draw_line(m, s, &b->seed);
        turn(emitted->direction, 2 * skg_draw(&b->seed) - 1, &b->seed);
        b->waiting_count += together;
        if (together == 1) continue;
        emitted[1] = emitted[0];
        skg_scale_vector(-1, emitted[0].direction, emitted[1].direction);
    }
}

/* Draws the process. Returns 0 if the photon is absorbed. */
static int interact(skg_dose_batch *b, const skg_dose_matter *m, const skg_dose_meeting *i,
                    skg_dose_photon *photon) {
    const double wanted = skg_draw(&b->seed) * i->total;
    if (wanted >= i->compton + i->rayleigh) {
        glow(b, photon, m, i->total - i->compton - i->rayleigh);
        return 0;
    }
    if (wanted < i->compton) {
        const double cosine = skg_dose_draw_compton(m, photon->kev, &b->seed);
        const double before = photon->kev;
        double compton, rayleigh;
        skg_dose_scattered(m, i, before, cosine, &compton, &rayleigh, &photon->kev);
        turn(photon->direction, cosine, &b->seed);
    } else {
        turn(photon->direction, skg_dose_draw_rayleigh(m, photon->kev, &b->seed), &b->seed);
    }
    return 1;
}

/* Follows one photon to its end. is_first: it comes from the source, and is made to interact. */
static skg_status follow_one(skg_dose_batch *b, skg_dose_photon photon, int is_first) {
    const skg_dose_hall *hall = b->hall;
    for (int order = 0; order < ORDERS; order++) {
        SKG_TRY(skg_way_find_cells(hall->walk->tree, &hall->rules, photon.at, photon.direction,
                                   reach_of(b, &photon), &b->way));
        const double depth = leave_along(b, &photon), met = -expm1(-depth);
        const double drawn = skg_draw(&b->seed);
        if (is_first && order == 0) photon.weight *= met;
        const double until = is_first && order == 0 ? -log1p(-met * drawn) : -log1p(-drawn);
        if (!(until < depth)) return SKG_OK;
        const skg_presence *where = move(b, until, &photon);
        if (!where) return SKG_OK;
        const skg_dose_matter *m = skg_dose_matter_of(hall, where);
        const skg_dose_meeting meeting = skg_dose_meet(m, photon.kev);
        SKG_TRY(skg_dose_send(b, &photon, where, &meeting, is_first && order == 0));
        if (!interact(b, m, &meeting, &photon)) return SKG_OK;
        if (photon.kev > SKG_DOSE_LOWEST_KEV) continue;
        leave(b, where, photon.weight * photon.kev);
        return SKG_OK;
    }
    return SKG_OK;
}

skg_status skg_dose_follow(skg_dose_batch *b) {
    skg_dose_photon photon;
    if (!skg_dose_emit(b->hall, &b->seed, &photon)) return SKG_OK;
    b->incident += photon.weight * photon.kev;
    SKG_TRY(follow_one(b, photon, 1));
    while (b->waiting_count > 0) {
        photon = b->waiting[--b->waiting_count];
        SKG_TRY(follow_one(b, photon, 0));
    }
    return SKG_OK;
}
