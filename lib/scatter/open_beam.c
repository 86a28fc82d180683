/* The open beam on the coarse detector, which ratios are over. */
#include "scatter/beams.h"

#include "beam/grid.h"
#include "beam/spectrum.h"
#include "core/maths.h"
#include "geometry/optics.h"
#include "spectral/model.h"

#include <math.h>

/* Places along a side of the detector, at most. */
enum { SIDE = 129 };

/* Of the table of an oblique scintillator, even from the least cosine of the detector to 1. */
enum { COSINES = 33 };

/* Recorded signal and attenuation of each bin of the spectrum. */
typedef struct {
    double recorded;          /* photons times what one adds */
    double strip, interspace; /* of the grid, 1/mm */
    double world;             /* 1/mm */
    double layer[COSINES];    /* the cosine times what is recorded over what is of straight photons */
} bin;

typedef struct {
    const skg_scatter_work *work;
    int32_t channel;
    skg_beam_profile profile;
    skg_camera camera;
    double across[3], normal[3]; /* of the strips; of the detector */
    double sum;                  /* of what is recorded */
    double least;                /* cosine to the normal */
    bin *bins;
} beam;

static int is_in_band(const skg_plan_options *options, int32_t channel, double kev) {
    return options->bands == 0 || (kev >= options->band_kev[channel] && kev < options->band_kev[channel + 1]);
}

static skg_status fill_layer(const beam *b, double kev, bin *own) {
    double straight = 0, oblique = 0;
    SKG_TRY(skg_signal_get(&b->work->recipe->options, kev, &straight));
    for (int k = 0; k < COSINES; k++) {
        const double cosine = b->least + (1 - b->least) * k / (COSINES - 1);
        SKG_TRY(skg_signal_oblique_get(&b->work->recipe->options, kev, 1 / cosine, &oblique));
        own->layer[k] = straight > 0 ? cosine * oblique / straight : 0;
    }
    return SKG_OK;
}

static double share_of_layer(const beam *b, const bin *own, double cosine) {
    const double range = 1 - b->least,
                 at = range > 0 ? fmin(fmax((cosine - b->least) / range, 0), 1) * (COSINES - 1) : 0;
    const int k = at < COSINES - 2 ? (int)at : COSINES - 2;
    return (own->layer[k] + (at - k) * (own->layer[k + 1] - own->layer[k])) / cosine;
}

static skg_status fill_bins(beam *b) {
    const skg_recipe *recipe = b->work->recipe;
    const skg_spectrum *spectrum = recipe->spectrum;
    SKG_TRY(skg_alloc(spectrum->count, sizeof *b->bins, "flat field", &b->bins));
    for (int64_t i = 0; i < spectrum->count; i++) {
        bin *own = &b->bins[i];
        if (!(spectrum->photons[i] > 0) || !is_in_band(&recipe->options, b->channel, spectrum->energy_kev[i]))
            continue;
        SKG_TRY(skg_signal_get(&recipe->options, spectrum->energy_kev[i], &own->recorded));
        b->sum += own->recorded *= spectrum->photons[i];
        if (recipe->options.grid)
            SKG_TRY(skg_grid_attenuation(recipe->options.grid, spectrum->energy_kev[i], &own->strip,
                                         &own->interspace));
        if (recipe->options.oblique) SKG_TRY(fill_layer(b, spectrum->energy_kev[i], own));
        if (recipe->options.world)
            SKG_TRY(
                skg_material_attenuation_get(recipe->options.world, spectrum->energy_kev[i], &own->world));
        own->world /= 10;
    }
    return SKG_OK;
}

/* From the source to column i and row j of the detector, and how far that is from its middle across the strips. */
static void ray_to(const beam *b, double i, double j, double ray[3], double *place) {
    const skg_camera *camera = &b->camera;
    double at[3];
    skg_add_scaled(camera->corner, i, camera->column, at);
    skg_add_scaled(at, j, camera->row, at);
    *place = skg_dot(at, b->across);
    memcpy(ray, camera->first, 3 * sizeof *ray);
    if (camera->parallel) return;
    skg_add_scaled(ray, i, camera->column, ray);
    skg_add_scaled(ray, j, camera->row, ray);
}

static double share_at(const beam *b, double column, double row) {
    const skg_plan_options *options = &b->work->recipe->options;
    double ray[3], place = 0, sum = 0;
    ray_to(b, column, row, ray, &place);
    const double height = fabs(skg_dot(b->normal, ray)), oblique = skg_length(ray) / height;
    const double focus = options->grid && options->grid->focus_mm > 0 ? 1 / options->grid->focus_mm : 0;
    const double tilt = skg_dot(b->across, ray) / height - place * focus;
    /* Of a parallel beam, `first` is 1 in units of the path parameter that starts at `start`. */
    const double *start = b->camera.start;
    const double path =
        skg_length(ray) * (b->camera.parallel ? 1 - start[0] - start[1] * column - start[2] * row : 1);
    const skg_beam_place at = skg_beam_profile_find(&b->profile, ray);
    for (int64_t i = 0; i < b->profile.bins; i++) {
        const bin *own = &b->bins[i];
        double share = own->recorded;
        if (!(share > 0)) continue;
        share *= skg_beam_profile_at(&b->profile, &at, i);
        if (options->grid) share *= skg_grid_pass(options->grid, own->strip, own->interspace, oblique, tilt);
        if (options->oblique) share *= share_of_layer(b, own, 1 / oblique);
        sum += share * exp(-own->world * path);
    }
    return b->sum > 0 ? sum / b->sum : 1;
}

static int64_t places_of(int64_t pixels) {
    return pixels < SIDE ? pixels : SIDE;
}

/* The pixel at a place of the table, which goes from the first pixel to the last. */
static double at_place(int64_t place, int64_t pixels) {
    const int64_t places = places_of(pixels);
    return places > 1 ? (double)place * (double)(pixels - 1) / (double)(places - 1) : 0;
}

static skg_status fill(beam *b, skg_open_beam *open) {
    const skg_scatter_work *work = b->work;
    SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &b->camera));
    SKG_TRY(skg_beam_profile_make(work, &b->profile));
    if (work->recipe->options.grid) SKG_TRY(skg_sight_strips(work, b->across));
    skg_cross(work->view->column_step, work->view->row_step, b->normal);
    skg_scale_vector(1 / skg_length(b->normal), b->normal, b->normal);
    b->least = 1;
    for (int k = 0; k < 4; k++) {
        double ray[3], place = 0;
        ray_to(b, k & 1 ? (double)work->view->columns : 0, k & 2 ? (double)work->view->rows : 0, ray, &place);
        b->least = fmin(b->least, fabs(skg_dot(b->normal, ray)) / skg_length(ray));
    }
    SKG_TRY(fill_bins(b));
    open->columns = places_of(work->view->columns), open->rows = places_of(work->view->rows);
    SKG_TRY(skg_alloc(open->rows * open->columns, sizeof *open->shares, "flat field", &open->shares));
    for (int64_t i = 0; i < open->rows * open->columns; i++)
        open->shares[i] = share_at(b, at_place(i % open->columns, work->view->columns),
                                   at_place(i / open->columns, work->view->rows));
    return SKG_OK;
}

skg_status skg_open_beam_make(const skg_scatter_work *work, int32_t channel, skg_open_beam *open) {
    const skg_plan_options *options = &work->recipe->options;
    const int is_point = work->view->projection == SKG_PROJECTION_POINT;
    beam b = {.work = work, .channel = channel};
    *open = (skg_open_beam){0};
    if (!options->grid && !options->oblique && !options->world &&
        !(is_point && (options->heel || options->bowtie)))
        return SKG_OK;
    const skg_status status = fill(&b, open);
    skg_beam_profile_free(&b.profile);
    skg_free(&b.bins);
    return status;
}

void skg_open_beam_free(skg_open_beam *open) {
    skg_free(&open->shares);
}

/* The place of a pixel among those of the table. */
static int64_t place_of(int64_t pixel, int64_t pixels, double *share) {
    const int64_t places = places_of(pixels);
    const double at = pixels > 1 ? (double)pixel * (double)(places - 1) / (double)(pixels - 1) : 0;
    const int64_t place = (int64_t)at < places - 2 ? (int64_t)at : places > 1 ? places - 2 : 0;
    *share = at - (double)place;
    return place;
}

double skg_open_beam_at(const skg_open_beam *open, const skg_view *view, int64_t row, int64_t column) {
    double u = 0, v = 0;
    if (!open->shares) return 1;
    const int64_t i = place_of(column, view->columns, &u), j = place_of(row, view->rows, &v);
    const int64_t right = open->columns > 1, down = open->rows > 1 ? open->columns : 0;
    const double *here = open->shares + j * open->columns + i, *next = here + down;
    return (1 - v) * ((1 - u) * here[0] + u * here[right]) + v * ((1 - u) * next[0] + u * next[right]);
}
