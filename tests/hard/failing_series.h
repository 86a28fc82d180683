/* Scatter for failing_test: predicted, of a series of frames, and its orders apart; and the variance of noise. */
#ifndef SKG_TESTS_FAILING_SERIES_H
#define SKG_TESTS_FAILING_SERIES_H

#include <skiagraph/skiagraph.h>

/* image: [row][column] a frame with the scatter of the series. components: [row][column] the photons with two Compton scatterings, of the first channel. */
skg_status failing_series(skg_plan *plan, const skg_view *view, float *image, float *components);

/* variance: [row][column] that noise gives, made with the mean. */
skg_status failing_noise(skg_plan *plan, float *variance);

#endif
