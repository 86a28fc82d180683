/* The names, units and flat fields of an image's channels. */
#include "beam/counter.h"
#include "geometry/optics.h"
#include "plan/inputs.h"
#include "plan/rules.h"

#include <inttypes.h>
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

/* The share of the pulses of the flat field that count. */
static double left_of(const skg_plan_options *options, const skg_model *model, double exposure) {
    const skg_counting *c = options->counter ? &options->counter->counting : NULL;
    double counted = 0;
    if (!c || !c->pile_up) return 1;
    const double pulses = skg_open_pulses(options, model, exposure);
    return pulses > 0 && skg_pile_up_get(c->pile_up, pulses, &counted, NULL) == SKG_OK ? counted / pulses : 1;
}

double skg_channel_flat_field(const skg_plan_options *options, const skg_model *model, const skg_view *view,
                              double exposure, int64_t channel) {
    skg_camera camera;
    switch (options->quantity) {
    case SKG_QUANTITY_TRANSMISSION:
        return 1;
    case SKG_QUANTITY_ATTENUATION:
        return 0;
    case SKG_QUANTITY_FLUENCE:
        if (skg_camera_make(view, NULL, 0, 0, &camera) != SKG_OK) return 0;
        return exposure * model->flat_field[channel] / skg_camera_pixel_area(&camera);
    default:
        return exposure * model->flat_field[channel] * left_of(options, model, exposure);
    }
}
