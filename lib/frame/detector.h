/* What the detector makes of a frame's intensities, of their means and of their variances. Private. */
#ifndef SKG_FRAME_DETECTOR_H
#define SKG_FRAME_DETECTOR_H

#include "frame/job.h"

/* Whether a frame shows what photons are expected, without noise, or how much noise varies. */
static inline int skg_frame_is_expected(const skg_recipe *recipe, const skg_frame_work *work) {
    return recipe->linear || work->shows == SKG_OUTPUT_MEAN || work->shows == SKG_OUTPUT_VARIANCE;
}

/* What the weights of the model are multiplied by for a view: those of a ratio hold for any. */
double skg_frame_exposure(const skg_recipe *recipe, const skg_view *view);

/* How many layers the stage `attenuate` writes; expected intensities have none of noise. */
int32_t skg_frame_layers(const skg_job *job, const skg_frame_work *work);

/* Enqueues what the detector makes of intensities: blur, electronic noise, steps. layers: where these are. */
skg_status skg_frame_detect(skg_job *job, const skg_frame_work *work, const skg_image_place *layers);

/* Enqueues what the detector makes of the variances of intensities. mean: [channels][rows][columns] of the transmission, if
 * variances are those of its -ln; else NULL. */
skg_status skg_frame_detect_variance(skg_job *job, const skg_frame_work *work, const skg_image_place *layers,
                                     cl_mem mean);

/* Enqueues -ln of a finished mean. */
skg_status skg_frame_take_logarithm(skg_job *job, const skg_frame_work *work);

#endif
