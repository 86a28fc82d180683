/* The histories of a plan's view with cross sections of our own: photons that scatter alike in all directions and keep their energy. */
#ifndef SKG_TESTS_SCATTER_ISOTROPIC_H
#define SKG_TESTS_SCATTER_ISOTROPIC_H

#include <skiagraph/context.h>
#include <skiagraph/frame.h>

/* Replaces what the plan's one material does. orders: result, share of the photons of the field that arrive after one, two, and more
 * interactions. sigma: result, standard error of their sum.
 *
 * albedo       of an interaction
 * per_mm       of all interactions
 * histories    of each of the 32 batches */
skg_status isotropic_run(skg_context *context, const skg_plan *plan, double albedo, double per_mm,
                         int64_t histories, double orders[3], double *sigma);

#endif
