/* Scatter in the units of the image, sent to the device. */
#include "scatter/tracing.h"

#include "core/maths.h"
#include "core/threads.h"
#include "scatter/beams.h"
#include "spectral/model.h"

#include <math.h>

/* The intensity of the open beam in a pixel over that at the foot of the perpendicular from the source. */
static double falloff_at(const skg_view *view, int64_t row, int64_t column) {
    double normal[3], way[3];
    if (view->projection != SKG_PROJECTION_POINT) return 1;
    skg_cross(view->column_step, view->row_step, normal);
    skg_add_scaled(view->centre, -1, view->source, way);
    const double foot = fabs(skg_dot(way, normal)) / skg_length(normal);
    skg_add_scaled(way, (double)column - 0.5 * (double)(view->columns - 1), view->column_step, way);
    skg_add_scaled(way, (double)row - 0.5 * (double)(view->rows - 1), view->row_step, way);
    const double share = foot / skg_length(way);
    return share * share * share;
}

/* From photons' signals in a pixel to what the stages add to, and to what is shown. */
typedef struct {
    int flat;      /* 1: every pixel of the open beam is taken to receive the same */
    double staged; /* factor of what the stages have */
    double shown;  /* of what is shown */
} units;

static units units_of(const skg_scatter_work *work, int32_t channel) {
    const skg_recipe *recipe = work->recipe;
    const skg_plan_options *options = &recipe->options;
    const int ratio = skg_quantity_is_ratio(options), absolute = skg_quantity_is_absolute(options);
    const double exposure = skg_recipe_exposure(recipe, work->view);
    double normal[3];
    units u = {.flat = !options->falloff || ratio, .staged = exposure, .shown = exposure};
    skg_cross(work->view->column_step, work->view->row_step, normal);
    if (options->quantity == SKG_QUANTITY_FLUENCE) u.shown /= skg_length(normal);
    if (ratio) u.shown = 1 / recipe->model.flat_field[channel];
    if (!absolute) u.staged = u.shown;
    return u;
}

/* An image of cosines. squares: 1: of their variance; root: 1: of its root; flat: 1: over the open beam's falloff; open: and over its
 * share that this has, or NULL; factor: of all values; least: of the image, which cosines may swing below. */
typedef struct {
    const skg_cosines *cosines;
    int squares, root, flat;
    const skg_open_beam *open;
    double factor, least;
} picture;

/* One that is being drawn. values, floats: [rows][columns] */
typedef struct {
    const skg_view *view;
    const picture *picture;
    double *values;
    float *floats;
} drawn;

/* From photons to the unit of the picture. */
static skg_status draw_row(void *user, int64_t row) {
    const drawn *d = user;
    const picture *p = d->picture;
    for (int64_t column = 0; column < d->view->columns; column++) {
        const int64_t i = row * d->view->columns + column;
        const double kept = fmax(d->values[i], p->least);
        d->values[i] = (p->root ? sqrt(kept) : kept) * p->factor;
        if (p->flat) d->values[i] /= falloff_at(d->view, row, column);
        if (p->open) d->values[i] /= skg_open_beam_at(p->open, d->view, row, column);
        d->floats[i] = (float)d->values[i];
    }
    return SKG_OK;
}

static skg_status draw(const skg_view *view, const picture *p, double *values, float *floats) {
    drawn d = {view, p, values, floats};
    memset(values, 0, (size_t)(view->rows * view->columns) * sizeof *values);
    if (p->cosines && p->cosines->value)
        SKG_TRY(skg_cosines_show(p->cosines, p->squares, view->rows, view->columns, values));
    return skg_parallel(view->rows, draw_row, &d);
}

/* Sends pictures, one behind another. mean, square: of them all */
static skg_status send(skg_context *context, const skg_view *view, int64_t count, const picture *pictures,
                       skg_buffer *buffer, double *mean, double *square) {
    const int64_t size = view->rows * view->columns;
    double *values = NULL;
    float *floats = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *values, "scatter", &values));
    SKG_TRY_CLEANUP(skg_alloc(count * size, sizeof *floats, "scatter", &floats));
    *mean = *square = 0;
    for (int64_t k = 0; k < count; k++) {
        SKG_TRY_CLEANUP(draw(view, &pictures[k], values, floats + k * size));
        for (int64_t i = 0; i < size; i++) {
            *mean += values[i] / (double)(count * size);
            *square += values[i] * values[i] / (double)(count * size);
        }
    }
    status = skg_buffer_write(context, buffer, count * size * (int64_t)sizeof *floats, floats, "scatter");
cleanup:
    skg_free(&values);
    skg_free(&floats);
    return status;
}

/* Makes the denominators of ratios: the open beam in each pixel, for each channel. */
static skg_status find_open(const skg_scatter_work *work, skg_open_beam *open) {
    if (!skg_quantity_is_ratio(&work->recipe->options)) return SKG_OK;
    for (int32_t c = 0; c < work->recipe->model.channels; c++) SKG_TRY(skg_open_beam_make(work, c, &open[c]));
    return SKG_OK;
}

static void drop_open(skg_open_beam *open) {
    for (int c = 0; c < SKG_CHANNELS_MAX; c++) skg_open_beam_free(&open[c]);
}

/* All pictures of a frame. */
typedef struct {
    picture staged[SKG_CHANNELS_MAX], variance[SKG_CHANNELS_MAX]; /* of layers and channels */
    picture image[SKG_CHANNELS_MAX], sigma[SKG_CHANNELS_MAX];     /* of channels */
} album;

static void fill_album(const skg_shown_scatter *shown, const skg_open_beam *open, album *a) {
    const skg_recipe *recipe = shown->work->recipe;
    const int absolute = skg_quantity_is_absolute(&recipe->options);
    const int32_t channels = recipe->model.channels;
    const double unit = shown->photons * shown->signal;
    for (int32_t i = 0; i < skg_model_sums(&recipe->model); i++) {
        const units u = units_of(shown->work, i % channels);
        const int flat = absolute ? !recipe->options.falloff : u.flat;
        a->staged[i] = (picture){shown->mean ? &shown->staged[i] : NULL,
                                 0,
                                 0,
                                 flat,
                                 absolute ? NULL : &open[i % channels],
                                 unit * u.staged,
                                 0};
        a->variance[i] = (picture){shown->variance ? &shown->variance[i] : NULL, 0, 0, flat, NULL,
                                   shown->photons * shown->power * u.staged,     0};
    }
    for (int32_t c = 0; c < channels; c++) {
        const units u = units_of(shown->work, c);
        const skg_cosines *mean = shown->mean ? &shown->mean[c] : NULL;
        a->image[c] = (picture){mean, 0, 0, u.flat, &open[c], unit * u.shown, 0};
        a->sigma[c] = (picture){mean, 1, 1, u.flat, &open[c], unit * u.shown, 0};
    }
}

skg_status skg_shown_scatter_send(skg_context *context, const skg_shown_scatter *shown,
                                  skg_scatter_images *images) {
    const skg_view *view = shown->work->view;
    const int64_t sums = skg_model_sums(&shown->work->recipe->model),
                  channels = shown->work->recipe->model.channels;
    skg_open_beam open[SKG_CHANNELS_MAX] = {{0}};
    album a;
    double mean = 0, square = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(find_open(shown->work, open));
    fill_album(shown, open, &a);
    SKG_TRY_CLEANUP(send(context, view, sums, a.staged, &images->mean, &mean, &square));
    if (shown->variance)
        SKG_TRY_CLEANUP(send(context, view, sums, a.variance, &images->variance, &mean, &square));
    SKG_TRY_CLEANUP(send(context, view, channels, a.image, &images->shown, &images->average, &square));
    SKG_TRY_CLEANUP(send(context, view, channels, a.sigma, &images->sigma, &mean, &square));
    images->error = sqrt(square);
cleanup:
    drop_open(open);
    return status;
}

skg_status skg_shown_component_send(skg_context *context, const skg_shown_scatter *shown, int component,
                                    skg_scatter_images *images) {
    const int32_t channels = shown->work->recipe->model.channels;
    skg_open_beam open[SKG_CHANNELS_MAX] = {{0}};
    picture pictures[SKG_CHANNELS_MAX];
    double mean = 0, square = 0;
    skg_status status = find_open(shown->work, open);
    for (int32_t c = 0; c < channels; c++) {
        const units u = units_of(shown->work, c);
        const skg_cosines *own = shown->mean ? &shown->mean[c * SKG_SCATTER_KINDS + component] : NULL;
        pictures[c] =
            (picture){own, 0, 0, u.flat, &open[c], shown->photons * shown->signal * u.shown, -HUGE_VAL};
    }
    if (status == SKG_OK)
        status = send(context, shown->work->view, channels, pictures, &images->component, &mean, &square);
    drop_open(open);
    return status;
}

void skg_scatter_images_release(skg_scatter_images *images) {
    skg_buffer_release(&images->component);
    skg_buffer_release(&images->mean);
    skg_buffer_release(&images->variance);
    skg_buffer_release(&images->shown);
    skg_buffer_release(&images->sigma);
}

int64_t skg_scatter_images_bytes(const skg_scatter_images *images) {
    return images->component.bytes + images->mean.bytes + images->variance.bytes + images->shown.bytes +
           images->sigma.bytes;
}
