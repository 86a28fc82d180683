/* Derivatives for failing_test: of everything, and along a direction. */
#ifndef SKG_TESTS_FAILING_GRADIENT_H
#define SKG_TESTS_FAILING_GRADIENT_H

#include <skiagraph/skiagraph.h>

/* weights: a cl_mem of floats, [row][column]. image: [row][column] the derivative when the second part turns and its vertices move;
 * the first values are those of the gradient. */
skg_status failing_gradient(skg_plan *plan, const skg_scene *scene, const skg_view *view, void *weights,
                            float *image);

#endif
