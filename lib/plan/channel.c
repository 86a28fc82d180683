/* The names, units and flat fields of an image's channels. */
#include "beam/counter.h"
#include "geometry/optics.h"
#include "plan/inputs.h"
#include "plan/rules.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const char *const quantity_names[] = {"energy", "fluence", "photons", "transmission", "attenuation"};
static const char *const quantity_units[] = {"keV per pixel", "keV/mm2", "photons per pixel", "I/I0",
                                             "-ln(I/I0)"};

static void name_window(const skg_counting *counting, const char *quantity, int32_t c,
                        skg_channel_name *name) {
    const double from = counting->threshold_kev[c];
    if (c + 1 < counting->count)
        snprintf(name->text, sizeof name->text, "%s counted from %g to %g keV", quantity, from,
                 counting->threshold_kev[c + 1]);
    else
        snprintf(name->text, sizeof name->text, "%s counted above %g keV", quantity, from);
}

skg_status skg_channel_names_create(const skg_plan_options *options, int32_t channels,
                                    skg_channel_name **names) {
    SKG_TRY(skg_alloc(channels, sizeof **names, "channels", names));
    for (int32_t c = 0; c < channels; c++) {
        skg_channel_name *name = &(*names)[c];
        if (options->counter)
            name_window(&options->counter->counting, quantity_names[options->quantity], c, name);
        else if (options->bands == 0)
            snprintf(name->text, sizeof name->text, "%s", quantity_names[options->quantity]);
        else
            snprintf(name->text, sizeof name->text, "%s from %g to %g keV", quantity_names[options->quantity],
                     options->band_kev[c], options->band_kev[c + 1]);
    }
    return SKG_OK;
}

skg_status skg_quantity_get(int32_t quantity, const char **name, const char **unit) {
    enum { QUANTITIES = sizeof quantity_names / sizeof *quantity_names };
    if (name) *name = NULL;
    if (unit) *unit = NULL;
    if (quantity < 0 || quantity >= QUANTITIES)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_quantity_get: there is no quantity %" PRId32 "; 0 to %d are known", quantity,
                        QUANTITIES - 1);
    if (name) *name = quantity_names[quantity];
    if (unit) *unit = quantity_units[quantity];
    return SKG_OK;
}

const char *skg_channel_unit(int32_t quantity) {
    return quantity_units[quantity];
}

double skg_open_pulses(const skg_plan_options *options, const skg_model *model, double exposure) {
    const skg_counting *c = &options->counter->counting;
    double pulses = 0;
    for (int32_t k = 0; k < model->channels; k++) pulses += exposure * model->flat_field[k];
    return pulses * c->dead_time_ns * 1e-9 / c->exposure_s;
}

skg_status skg_open_recorded(const skg_plan_options *options, const skg_model *model, double exposure,
                             double recorded[SKG_THRESHOLDS_MAX]) {
    return skg_counter_record(options->counter, model->nodes, model->node_kev, model->node_photons, exposure,
                              recorded);
}

skg_status skg_channel_flat_field(const skg_plan_options *options, const skg_model *model,
                                  const skg_view *view, double exposure, int64_t channel,
                                  double *flat_field) {
    double recorded[SKG_THRESHOLDS_MAX] = {0};
    skg_camera camera;
    *flat_field = exposure * model->flat_field[channel];
    switch (options->quantity) {
    case SKG_QUANTITY_TRANSMISSION:
        *flat_field = 1;
        return SKG_OK;
    case SKG_QUANTITY_ATTENUATION:
        *flat_field = 0;
        return SKG_OK;
    case SKG_QUANTITY_FLUENCE:
        SKG_TRY(skg_camera_make(view, NULL, 0, 0, &camera));
        *flat_field /= skg_camera_pixel_area(&camera);
        return SKG_OK;
    default:
        if (!options->counter) return SKG_OK;
        SKG_TRY(skg_open_recorded(options, model, exposure, recorded));
        /* A low window of a paralysable detector may be negative; pictures take 0 as no scale. */
        *flat_field = fmax(recorded[channel], 0);
        return SKG_OK;
    }
}
