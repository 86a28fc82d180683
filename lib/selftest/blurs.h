/* Blur, and noise by its power, of the image of a device test. Private. */
#ifndef SKG_TRIAL_BLURS_H
#define SKG_TRIAL_BLURS_H

#include "selftest/finding.h"
#include "selftest/scene.h"

/* SKG_TRIAL_BLUR: two line spread functions. SKG_TRIAL_DEPTHS: three depths of a scintillator with blurs of their own.
 * SKG_TRIAL_APART: noise whose power rises with the frequency, in an image that is not blurred. */
skg_status skg_trial_blurs_choose(skg_trial_scene *scene);

/* What blurs make of an image. shown, wanted: [rows][columns] */
skg_status skg_trial_blur(const skg_trial_scene *scene, const double *shown, double *wanted);

/* Whether the noise of SKG_TRIAL_NOISE or SKG_TRIAL_APART has its mean, its variance, and its covariance with that of the
 * pixel beside it. open: keV of the open beam. */
void skg_trial_noise_compare(const skg_trial_scene *scene, const double *image, const double *shown,
                             double open, skg_finding *finding);

#endif
