/* With what share a photon leaves the tube in a direction. */
#include "scatter/beams.h"

#include "beam/spectrum.h"
#include "core/maths.h"
#include "geometry/optics.h"
#include "spectral/shading.h"

#include <math.h>

/* Points of a side of the field at which rays are. */
enum { SIDE = 17 };

/* Angles are printed with some digits, degrees. */
static const double ROUNDING = 1e-5;

typedef struct {
    double low, high; /* of what a ray has */
} extent;

/* A ray of the field, from the middle of the source. */
static void ray_of(const skg_field *field, const skg_view *view, int i, double ray[3]) {
    const double u = (i % SIDE) / (SIDE - 1.0), v = (i / SIDE) / (SIDE - 1.0);
    skg_add_scaled(field->centre, -1, view->source, ray);
    skg_add_scaled(ray, field->low[0] + u * (field->high[0] - field->low[0]), field->column, ray);
    skg_add_scaled(ray, field->low[1] + v * (field->high[1] - field->low[1]), field->row, ray);
}

static void widen(extent *e, double value) {
    e->low = fmin(e->low, value), e->high = fmax(e->high, value);
}

/* --- the heel effect */

static skg_status find_face(const skg_scatter_work *work, const skg_camera *camera, skg_beam_profile *p) {
    const skg_heel *heel = work->recipe->options.heel;
    const double angle = heel->angle_deg * (SKG_PI / 180);
    double toward[3], central[3], across[3];
    SKG_TRY(skg_shade_direction(&work->recipe->view, heel->direction, "heel",
                                "the direction from the detector's centre to the side of the anode", toward));
    if (!skg_shade_axes(camera, toward, central, across))
        return skg_fail(SKG_ERR_SCENE, "the heel's direction points along the central ray");
    skg_scale_vector(sin(angle), central, p->anode);
    skg_add_scaled(p->anode, -cos(angle), across, p->anode);
    return SKG_OK;
}

static skg_status fill_shares(const skg_recipe *recipe, skg_beam_profile *p) {
    const skg_heel *heel = recipe->options.heel;
    const skg_heel_tube tube = {
        .anode = heel->anode, .kvp = heel->kvp, .angle_deg = heel->angle_deg, .bin_kev = heel->bin_kev};
    SKG_TRY(skg_alloc(SKG_HEEL_ROWS * p->bins, sizeof *p->shares, "heel", &p->shares));
    for (int r = 0; r < SKG_HEEL_ROWS; r++) {
        const double q = p->low + (p->high - p->low) * r / (SKG_HEEL_ROWS - 1);
        double *row = p->shares + r * p->bins;
        const skg_status status =
            skg_heel_losses(&tube, asin(fmin(fmax(q, -1), 1)) * (180 / SKG_PI), recipe->spectrum, row);
        if (status != SKG_OK)
            return skg_fail(status, "scatter: in the field of the beam, %s", skg_last_error());
        for (int64_t b = 0; b < p->bins; b++) row[b] = exp(-row[b]);
    }
    return SKG_OK;
}

static skg_status make_heel(const skg_scatter_work *work, const skg_camera *camera, const skg_field *field,
                            skg_beam_profile *p) {
    extent e = {1, -1};
    SKG_TRY(find_face(work, camera, p));
    for (int i = 0; i < SIDE * SIDE; i++) {
        double ray[3];
        ray_of(field, work->view, i, ray);
        widen(&e, skg_dot(p->anode, ray) / skg_length(ray));
    }
    p->low = e.low, p->high = e.high;
    p->heel = 1;
    return fill_shares(work->recipe, p);
}

/* --- the bow-tie filter */

static skg_status check_reach(const skg_bowtie *bowtie, const extent *e) {
    const double low = atan(e->low) * (180 / SKG_PI), high = atan(e->high) * (180 / SKG_PI);
    const double last = bowtie->angle_deg[bowtie->count - 1];
    if (low >= bowtie->angle_deg[0] - ROUNDING && high <= last + ROUNDING) return SKG_OK;
    return skg_fail(
        SKG_ERR_SCENE,
        "scatter: the bow-tie's profile goes from %g to %g degrees, but the field of the beam from %.4g to "
        "%.4g degrees; add rows to the profile, or narrow the field (Collimation)",
        bowtie->angle_deg[0], last, low, high);
}

static skg_status fill_filter(const skg_recipe *recipe, skg_beam_profile *p) {
    const skg_bowtie *bowtie = recipe->options.bowtie;
    SKG_TRY(skg_alloc(bowtie->count, sizeof *p->tangents, "bow-tie", &p->tangents));
    SKG_TRY(skg_alloc(p->bins, sizeof *p->attenuation, "bow-tie", &p->attenuation));
    for (int64_t k = 0; k < bowtie->count; k++) p->tangents[k] = tan(bowtie->angle_deg[k] * (SKG_PI / 180));
    for (int64_t b = 0; b < p->bins; b++) {
        SKG_TRY(skg_material_attenuation_get(bowtie->material, recipe->spectrum->energy_kev[b],
                                             &p->attenuation[b]));
        p->attenuation[b] /= 10;
    }
    return SKG_OK;
}

static skg_status make_filter(const skg_scatter_work *work, const skg_camera *camera, const skg_field *field,
                              skg_beam_profile *p) {
    const skg_bowtie *bowtie = work->recipe->options.bowtie;
    const skg_view *view = &work->recipe->view;
    const double *toward = skg_length(bowtie->direction) > 0 ? bowtie->direction : view->column_step;
    extent e = {HUGE_VAL, -HUGE_VAL};
    double own[3];
    SKG_TRY(skg_shade_direction(view, toward, "bow-tie", "the direction in which its angles grow", own));
    if (!skg_shade_axes(camera, own, p->central, p->fan))
        return skg_fail(SKG_ERR_SCENE,
                        "the bow-tie's direction points along the ray to the detector's centre");
    for (int i = 0; i < SIDE * SIDE; i++) {
        double ray[3];
        ray_of(field, work->view, i, ray);
        widen(&e, skg_dot(ray, p->fan) / fmax(skg_dot(ray, p->central), 1e-9 * skg_length(ray)));
    }
    SKG_TRY(check_reach(bowtie, &e));
    p->filter = bowtie;
    p->bowtie = 1;
    return fill_filter(work->recipe, p);
}

void skg_beam_profile_free(skg_beam_profile *p) {
    skg_free(&p->shares);
    skg_free(&p->tangents);
    skg_free(&p->attenuation);
}

static void find_row(const skg_beam_profile *p, const double way[3], skg_beam_place *place) {
    const double q = skg_dot(p->anode, way) / skg_length(way), last = SKG_HEEL_ROWS - 1;
    const double range = p->high - p->low, at = range > 0 ? fmin(fmax((q - p->low) / range, 0), 1) * last : 0;
    place->row = at < last - 1 ? (int64_t)at : SKG_HEEL_ROWS - 2;
    place->share = at - (double)place->row;
}

/* mm of the filter along a ray. */
static double path_in(const skg_beam_profile *p, const double way[3]) {
    const double x = skg_dot(way, p->fan), y = skg_dot(way, p->central), tangent = x / y;
    const double *path = p->filter->path_mm;
    int64_t low = 0, high = p->filter->count - 1;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        *(p->tangents[middle] <= tangent ? &low : &high) = middle;
    }
    const double share = (tangent - p->tangents[low]) / (p->tangents[high] - p->tangents[low]);
    const double mm = path[low] + fmin(fmax(share, 0), 1) * (path[high] - path[low]);
    return mm * skg_length(way) / hypot(x, y);
}

skg_beam_place skg_beam_profile_find(const skg_beam_profile *p, const double way[3]) {
    skg_beam_place place = {0};
    if (p->heel) find_row(p, way, &place);
    if (p->bowtie) place.mm = path_in(p, way);
    return place;
}

double skg_beam_profile_at(const skg_beam_profile *p, const skg_beam_place *place, int64_t bin) {
    double share = 1;
    if (p->heel) {
        const double *here = p->shares + place->row * p->bins + bin;
        share = here[0] + place->share * (here[p->bins] - here[0]);
    }
    return p->bowtie ? share * exp(-p->attenuation[bin] * place->mm) : share;
}

static void find_mean(const skg_scatter_work *work, const skg_field *field, skg_beam_profile *p) {
    const skg_spectrum *spectrum = work->recipe->spectrum;
    double all = 0, sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double ray[3];
        ray_of(field, work->view, i, ray);
        const skg_beam_place place = skg_beam_profile_find(p, ray);
        for (int64_t b = 0; b < p->bins; b++) {
            if (!(spectrum->photons[b] > 0)) continue;
            all += spectrum->photons[b];
            sum += spectrum->photons[b] * skg_beam_profile_at(p, &place, b);
        }
    }
    p->mean = sum > 0 ? sum / all : 1;
}

skg_status skg_beam_profile_make(const skg_scatter_work *work, skg_beam_profile *p) {
    const skg_plan_options *options = &work->recipe->options;
    skg_camera camera;
    skg_field field;
    *p = (skg_beam_profile){.bins = work->recipe->spectrum->count, .mean = 1};
    if (work->view->projection != SKG_PROJECTION_POINT || !(options->heel || options->bowtie)) return SKG_OK;
    SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_field_make(options->collimation, work->view, &field));
    if (options->heel) SKG_TRY(make_heel(work, &camera, &field, p));
    if (options->bowtie) SKG_TRY(make_filter(work, &camera, &field, p));
    find_mean(work, &field, p);
    return SKG_OK;
}
