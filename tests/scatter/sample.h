/* Single interactions as the kernel samples them. */
#ifndef SKG_TESTS_SCATTER_SAMPLE_H
#define SKG_TESTS_SCATTER_SAMPLE_H

#include <skiagraph/context.h>
#include <skiagraph/frame.h>

enum { SAMPLE_PHOTONS = 1 << 20 };

/* Photons of an energy that interact at a place of the cells of the last frame, in shares of their box. out: [SAMPLE_PHOTONS][4]:
 * weight, cosine of the angle, keV, 1 after a Compton scattering */
skg_status sample_run(skg_context *context, const skg_plan *plan, const double at[3], double kev, float *out);

#endif
