/* Photons of the beam: from where, in which direction, of which energy, and for how many they stand.
 *
 * Most go to even places of the field. Where backscatter is asked for, some go near the ray to that place, with a density that falls with
 * the square of the distance from it: what comes back from there would otherwise be known from few. Weights are those of both ways
 * together (Veach and Guibas, SIGGRAPH 1995). */
#include "dose/photons.h"

#include "beam/spectrum.h"
#include "core/maths.h"

/* Of the photons, those that go to even places; of the others, those in the innermost disc. */
static const double EVEN = 0.7, INNERMOST = 0.1;

/* The radius of that disc at the place itself, mm: a tenth of the way of photons in tungsten. */
static const double INNER_MM = 0.002;

skg_status skg_dose_aims_find(skg_dose_hall *h) {
    const skg_dose_walk *walk = h->walk;
    const skg_dose_beam *beam = walk->beam;
    const double side[2] = {beam->field.high[0] - beam->field.low[0],
                            beam->field.high[1] - beam->field.low[1]};
    SKG_TRY(skg_alloc(walk->points, sizeof *h->aims, "dose", &h->aims));
    h->reach = hypot(side[0], side[1]);
    for (int64_t p = 0; p < walk->points; p++) {
        double way[3], on[3], mm, scale = 1;
        if (!walk->spots[p].wanted || !skg_dose_beam_way(beam, walk->spots[p].at, way, &mm)) continue;
        /* To the plane of the field. */
        skg_add_scaled(beam->field.centre, -1, walk->spots[p].at, on);
        const double along = skg_dot(on, beam->normal) / skg_dot(way, beam->normal);
        if (!beam->parallel) scale = beam->depth / (mm * skg_dot(way, beam->normal));
        skg_add_scaled(walk->spots[p].at, along, way, on);
        skg_add_scaled(on, -1, beam->field.centre, on);
        skg_dose_aim *aim = &h->aims[h->aim_count++];
        *aim = (skg_dose_aim){{skg_dot(on, beam->field.column), skg_dot(on, beam->field.row)},
                              fmin(INNER_MM * scale, 0.1 * h->reach)};
    }
    return SKG_OK;
}

/* Photons per mm2 of the field's plane, of one photon that is sent. */
static double density_at(const skg_dose_hall *h, const double place[2]) {
    double sum = 0;
    if (h->aim_count == 0) return 1 / h->walk->beam->area;
    for (int64_t k = 0; k < h->aim_count; k++) {
        const skg_dose_aim *aim = &h->aims[k];
        const double r = hypot(place[0] - aim->place[0], place[1] - aim->place[1]);
        if (r < aim->radius)
            sum += INNERMOST / (SKG_PI * aim->radius * aim->radius);
        else if (r < h->reach)
            sum += (1 - INNERMOST) / (log(h->reach / aim->radius) * 2 * SKG_PI * r * r);
    }
    return EVEN / h->walk->beam->area + (1 - EVEN) * sum / (double)h->aim_count;
}

/* Draws a place of the field's plane. Returns 0 if it is outside the field, where photons stay in the jaws. */
static int draw_place(const skg_dose_hall *h, uint64_t *seed, double place[2]) {
    const skg_field *f = &h->walk->beam->field;
    if (h->aim_count == 0 || skg_draw(seed) < EVEN) {
        for (int k = 0; k < 2; k++) place[k] = f->low[k] + skg_draw(seed) * (f->high[k] - f->low[k]);
        return 1;
    }
    const skg_dose_aim *aim = &h->aims[(int64_t)(skg_draw(seed) * (double)h->aim_count)];
    const int is_inner = skg_draw(seed) < INNERMOST;
    const double share = skg_draw(seed), turn = 2 * SKG_PI * skg_draw(seed);
    const double r = aim->radius * (is_inner ? sqrt(share) : pow(h->reach / aim->radius, share));
    place[0] = aim->place[0] + r * cos(turn), place[1] = aim->place[1] + r * sin(turn);
    return place[0] >= f->low[0] && place[0] <= f->high[0] && place[1] >= f->low[1] && place[1] <= f->high[1];
}

static int64_t draw_bin(const skg_dose_hall *h, uint64_t *seed) {
    const double place = skg_draw(seed);
    int64_t low = 0, high = h->walk->beam->recipe->spectrum->count - 1;
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (h->bins[middle] > place)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

int skg_dose_emit(const skg_dose_hall *h, uint64_t *seed, skg_dose_photon *photon) {
    const skg_dose_beam *beam = h->walk->beam;
    const int64_t bin = draw_bin(h, seed);
    double place[2], on[3];
    photon->kev = beam->recipe->spectrum->energy_kev[bin];
    if (!draw_place(h, seed, place)) return 0;
    skg_add_scaled(beam->field.centre, place[0], beam->field.column, on);
    skg_add_scaled(on, place[1], beam->field.row, on);
    photon->weight = beam->photons / density_at(h, place) / (double)h->walk->histories;
    if (beam->parallel) {
        skg_scale_vector(1, beam->direction, photon->direction);
        skg_dose_beam_begin(beam, h->walk->tree, on, photon->at);
        return 1;
    }
    skg_scale_vector(1, beam->recipe->view.source, photon->at);
    skg_add_scaled(on, -1, photon->at, photon->direction);
    const double mm = skg_length(photon->direction);
    skg_scale_vector(1 / mm, photon->direction, photon->direction);
    const skg_beam_place found = skg_beam_profile_find(&beam->profile, photon->direction);
    photon->weight *= skg_dot(photon->direction, beam->normal) / (mm * mm) *
                      skg_beam_profile_at(&beam->profile, &found, bin);
    return 1;
}
