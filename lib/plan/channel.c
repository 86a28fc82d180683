/* What the channels of a plan's images are. */
#include "frame/plan.h"

#include <inttypes.h>
#include <stdio.h>

static const char *const quantity_names[] = {"energy", "fluence", "photons", "transmission", "attenuation"};
static const char *const quantity_units[] = {"keV per pixel", "keV/mm2", "photons per pixel", "I/I0",
                                             "-ln(I/I0)"};

skg_status skg_plan_name_channels(skg_plan *plan) {
    const skg_plan_options *options = &plan->options;
    SKG_TRY(skg_alloc(plan->model.channels, sizeof *plan->channel_names, "channels", &plan->channel_names));
    for (int32_t c = 0; c < plan->model.channels; c++) {
        char *name = plan->channel_names[c].text;
        const size_t room = sizeof plan->channel_names[c].text;
        if (options->bands == 0)
            snprintf(name, room, "%s", quantity_names[options->quantity]);
        else
            snprintf(name, room, "%s from %g to %g keV", quantity_names[options->quantity],
                     options->band_kev[c], options->band_kev[c + 1]);
    }
    return SKG_OK;
}

static double open_beam(const skg_plan *plan, int64_t channel) {
    skg_camera camera;
    switch (plan->options.quantity) {
    case SKG_QUANTITY_TRANSMISSION:
        return 1;
    case SKG_QUANTITY_ATTENUATION:
        return 0;
    case SKG_QUANTITY_FLUENCE:
        if (skg_camera_make(&plan->view, NULL, 0, 0, &camera) != SKG_OK) return 0;
        return plan->model.flat_field[channel] / skg_camera_pixel_area(&camera);
    default:
        return plan->model.flat_field[channel];
    }
}

void skg_channel_init(skg_channel *channel) {
    if (channel) *channel = (skg_channel){.size = (int32_t)sizeof *channel};
}

skg_status skg_plan_channel_count(const skg_plan *plan, int64_t *channels) {
    if (!plan || !channels) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_channel_count: no plan or no result");
    *channels = plan->model.channels;
    return SKG_OK;
}

skg_status skg_plan_channel_get(const skg_plan *plan, int64_t index, skg_channel *channel) {
    if (!plan) return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_channel_get: no plan");
    if (index < 0 || index >= plan->model.channels)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_plan_channel_get: channel %" PRId64 " of %" PRId32, index,
                        plan->model.channels);
    const skg_channel ours = {.size = sizeof ours,
                              .name = plan->channel_names[index].text,
                              .unit = quantity_units[plan->options.quantity],
                              .flat_field = open_beam(plan, index)};
    return skg_struct_write(&ours, sizeof ours, "skg_channel", channel);
}
