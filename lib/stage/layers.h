/* Blur of images, or of several layers that add up to them, each with a blur of its own: photons that interact in several depths of
 * a scintillator, or means and noise. Private. */
#ifndef SKG_LAYERS_H
#define SKG_LAYERS_H

#include "stage/blur.h"

typedef struct {
    int32_t count; /* of blurs; 0: images are not blurred */
    int32_t reserved;
    skg_blur *blurs[SKG_DEPTHS_MAX];
    skg_buffer images; /* [count][channels][rows][columns], if there are several layers */
} skg_layers;

/* Makes the blurs: of the whole image, or of each depth. blur, depths: the caller's; NULL: none. */
skg_status skg_layers_create(skg_context *context, const skg_detector_blur *blur,
                             const skg_depth_blur *depths, skg_layers *layers);

/* Adds the layer of the noise, whose power follows from the blur and the DQE. pixel_mm: along rows and along columns. */
skg_status skg_layers_add_noise(skg_context *context, const skg_detector_blur *blur, const skg_dqe *dqe,
                                const double pixel_mm[2], skg_layers *layers);

void skg_layers_release(skg_layers *layers);

/* Where the layers of an image go that the stage `attenuate` writes: to the image itself if one layer is used, otherwise to memory
 * that is allocated at the first call. used: how many layers, the first ones, the image has. */
skg_status skg_layers_place(skg_context *context, skg_layers *layers, int32_t used,
                            const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                            skg_image_place *place);

/* Enqueues the blur of what was written to `place`; the sum goes to the image. */
skg_status skg_layers_blur(skg_layers *layers, int32_t used, const skg_image_place *place,
                           const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                           skg_stage_log *log);

/* Likewise for the variances of independent pixels of `used` layers. apart: 1: one layer, which is blurred as the layer of the noise. */
skg_status skg_layers_blur_variance(skg_layers *layers, int32_t used, int32_t apart,
                                    const skg_image_place *place, const skg_image_place *image,
                                    int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* Bytes on the device. */
int64_t skg_layers_bytes(const skg_layers *layers);

#endif
