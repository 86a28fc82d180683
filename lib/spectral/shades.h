/* Shades: what thins a beam smoothly over the detector before it meets the scene. Private.
 *
 * Energy E of a pixel is multiplied by exp(-sum over k of amount_k(z) loss_k(E)). The losses are few directions that the
 * changes of the spectrum span, each with a plane of its own, so that compression, ranges and logarithms treat them as they
 * treat materials. The amounts are polynomials of z = (q - middle) / half, where q is the cosine between a ray and an axis
 * that is fixed to the detector. */
#ifndef SKG_SHADES_H
#define SKG_SHADES_H

#include "beam/spectrum.h"
#include "geometry/camera.h"

#include <skiagraph/plan.h>

enum { SKG_SHADE_TERMS = 12, SKG_SHADES_MOST = 4 };

typedef struct {
    int32_t count, reserved; /* 0: none */
    double toward[3];        /* of the anode, in the detector's frame: along columns, rows and across */
    double angle;            /* of the anode, radians */
    double middle, half;     /* of z */
    double *losses;          /* [count][bins] */
    double amounts[SKG_SHADES_MOST][SKG_SHADE_TERMS]; /* coefficients of 1, z, z^2, ... */
    double low[SKG_SHADES_MOST], high[SKG_SHADES_MOST];
    double error; /* of the logarithm of what is transmitted, by the least squares of the beam's energies */
} skg_shades;

/* Finds the shades of a heel effect over the detectors of the view and of the options' further views. Without a heel, with a
 * parallel beam, or where one energy is divided by its flat field, there are none. Free with skg_shades_release. */
skg_status skg_shades_find(const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_shades *shades);
void skg_shades_release(skg_shades *shades);

/* Sets axis so that z of pixel (i, j) is (axis[0] + axis[1] i + axis[2] j) / |ray| + axis[3]. */
void skg_shades_axis(const skg_shades *shades, const skg_camera *camera, double axis[4]);

#endif
