#include "scatter/shown.h"

#include "core/vector.h"
#include "scatter/open_beam.h"
#include "spectral/quantity.h"

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

static units units_of(const skg_scatter_work *work) {
    const skg_recipe *recipe = work->recipe;
    const skg_plan_options *options = &recipe->options;
    const int ratio = skg_quantity_is_ratio(options), absolute = skg_quantity_is_absolute(options);
    const double exposure = skg_recipe_exposure(recipe, work->view);
    double normal[3];
    units u = {.flat = !options->falloff || ratio, .staged = exposure, .shown = exposure};
    skg_cross(work->view->column_step, work->view->row_step, normal);
    if (options->quantity == SKG_QUANTITY_FLUENCE) u.shown /= skg_length(normal);
    if (ratio) u.shown = 1 / recipe->model.flat_field[0];
    if (!absolute) u.staged = u.shown;
    return u;
}

/* An image of cosines. squares: 1: of their variance; root: 1: of its root; flat: 1: over the open beam's falloff; open: and over its share that this
 * has, or NULL; factor: of all
 * values; least: of the image, which cosines may swing below. */
typedef struct {
    const skg_cosines *cosines;
    int squares, root, flat;
    const skg_open_beam *open;
    double factor, least;
} picture;

static skg_status send(skg_context *context, const skg_view *view, const picture *p, skg_buffer *buffer,
                       double *mean, double *square) {
    const int64_t size = view->rows * view->columns;
    double *values = NULL;
    float *floats = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *values, "scatter", &values));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *floats, "scatter", &floats));
    if (p->cosines)
        SKG_TRY_CLEANUP(skg_cosines_show(p->cosines, p->squares, view->rows, view->columns, values));
    *mean = *square = 0;
    for (int64_t i = 0; i < size; i++) {
        const double kept = fmax(values[i], p->least);
        double value = (p->root ? sqrt(kept) : kept) * p->factor;
        if (p->flat) value /= falloff_at(view, i / view->columns, i % view->columns);
        if (p->open) value /= skg_open_beam_at(p->open, view, i / view->columns, i % view->columns);
        floats[i] = (float)value;
        *mean += value / (double)size;
        *square += value * value / (double)size;
    }
    status = skg_buffer_write(context, buffer, size * (int64_t)sizeof *floats, floats, "scatter");
cleanup:
    skg_free(&values);
    skg_free(&floats);
    return status;
}

/* What ratios are over in each pixel. */
static skg_status find_open(const skg_scatter_work *work, skg_open_beam *open) {
    *open = (skg_open_beam){0};
    return skg_quantity_is_ratio(&work->recipe->options) ? skg_open_beam_make(work, open) : SKG_OK;
}

skg_status skg_shown_scatter_send(skg_context *context, const skg_shown_scatter *shown,
                                  skg_scatter_images *images) {
    const skg_scatter_work *work = shown->work;
    const units u = units_of(work);
    const int absolute = skg_quantity_is_absolute(&work->recipe->options);
    const int staged_flat = absolute ? !work->recipe->options.falloff : u.flat;
    const double unit = shown->photons * shown->signal;
    double mean = 0, square = 0;
    skg_open_beam open;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(find_open(work, &open));
    const picture staged = {shown->mean, 0, 0, staged_flat, absolute ? NULL : &open, unit * u.staged, 0};
    const picture variance = {
        shown->variance, 0, 0, staged_flat, NULL, shown->photons * shown->power * u.staged, 0};
    const picture image = {shown->mean, 0, 0, u.flat, &open, unit * u.shown, 0};
    const picture sigma = {shown->mean, 1, 1, u.flat, &open, unit * u.shown, 0};
    SKG_TRY_CLEANUP(send(context, work->view, &staged, &images->mean, &mean, &square));
    if (shown->variance)
        SKG_TRY_CLEANUP(send(context, work->view, &variance, &images->variance, &mean, &square));
    SKG_TRY_CLEANUP(send(context, work->view, &image, &images->shown, &images->average, &square));
    SKG_TRY_CLEANUP(send(context, work->view, &sigma, &images->sigma, &mean, &square));
    images->error = sqrt(square);
cleanup:
    skg_open_beam_free(&open);
    return status;
}

skg_status skg_shown_component_send(skg_context *context, const skg_shown_scatter *shown,
                                    skg_scatter_images *images) {
    const units u = units_of(shown->work);
    double mean = 0, square = 0;
    skg_open_beam open;
    skg_status status = find_open(shown->work, &open);
    const picture image = {shown->mean, 0, 0, u.flat, &open, shown->photons * shown->signal * u.shown,
                           -HUGE_VAL};
    if (status == SKG_OK)
        status = send(context, shown->work->view, &image, &images->component, &mean, &square);
    skg_open_beam_free(&open);
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
