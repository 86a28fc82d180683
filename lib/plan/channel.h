/* What the channels of a plan's images are. Private. */
#ifndef SKG_CHANNEL_H
#define SKG_CHANNEL_H

#include "spectral/model.h"

typedef struct {
    char text[64];
} skg_channel_name;

/* Names the channels of a model by the caller's bands; [channels], freed by the caller. */
skg_status skg_channel_names_create(const skg_plan_options *options, int32_t channels,
                                    skg_channel_name **names);

/* The unit of a quantity; static storage. */
const char *skg_channel_unit(int32_t quantity);

/* What a channel shows without parts and world, not weakened by falloff. exposure: the photons per pixel of the view over
 * those of the model. */
double skg_channel_flat_field(const skg_plan_options *options, const skg_model *model, const skg_view *view,
                              double exposure, int64_t channel);

#endif
