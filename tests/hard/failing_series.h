/* Scatter for failing_test: predicted, of a series of frames, and its orders apart. */
#ifndef SKG_TESTS_FAILING_SERIES_H
#define SKG_TESTS_FAILING_SERIES_H

#include <skiagraph/skiagraph.h>

/* image: [row][column] a frame with the scatter of the series. components: [row][column] the photons with two Compton scatterings, of the first channel. */
skg_status failing_series(skg_plan *plan, const skg_view *view, float *image, float *components);

#endif
