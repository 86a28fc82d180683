/* What filter, grid and detector do to the image of a device test. Private. */
#ifndef SKG_TRIAL_EXPOSURE_H
#define SKG_TRIAL_EXPOSURE_H

#include "selftest/finding.h"
#include "selftest/scene.h"

/* Electronic noise and steps, of an image that is divided by a flat field which falls with the distance. */
void skg_trial_detector_choose(skg_plan_options *options);

/* Whether the noise has its mean and variance, and every value is a step. image, shown: [pixels * pixels], of the former as
 * a share of the flat field, of the latter in keV. open: keV of the open beam. */
void skg_trial_detector_compare(const skg_view *view, const double *image, const double *shown, double open,
                                skg_finding *finding);

/* A bow-tie filter, a grid whose focus is not at the source, and a scintillator that rays cross obliquely. */
skg_status skg_trial_shades_choose(skg_trial_scene *scene);

/* What these leave of the energy of a pixel, from the formulas of skg_bowtie, skg_grid_transmission_get and
 * skg_response_create_scintillator. */
skg_status skg_trial_shade(const skg_trial_scene *scene, int64_t row, int64_t column, double *share);

/* A tube whose anode is beside the beam, oblique to the detector's rows. */
void skg_trial_heel_choose(skg_trial_scene *scene);

/* What the heel effect leaves of each energy of the beam in a pixel, from the tube's spectrum at the angle at which the pixel's ray
 * leaves the anode. shares: [SKG_TRIAL_ENERGIES_MAX] */
skg_status skg_trial_heel(const skg_trial_scene *scene, int64_t row, int64_t column, double *shares);

#endif
