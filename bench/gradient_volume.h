/* The contender of bench_gradient that a volume has: sums of values along rays, and their derivative by six numbers. */
#ifndef BENCH_GRADIENT_VOLUME_H
#define BENCH_GRADIENT_VOLUME_H

#include <skiagraph/scene.h>

enum { VOLUME_POINTS = 256, VOLUME_SIDE = 256 }; /* points of a ray; cells along each side */

typedef struct {
    float *cells; /* [VOLUME_SIDE][VOLUME_SIDE][VOLUME_SIDE], z slowest */
    double size;  /* of a side, mm; its middle is at the world's origin */
    skg_view view;
    const double *adjoint; /* [rows][columns] */
    double twist[6];       /* result */
} volume_work;

/* Fills the cells with an ellipsoid of lungs and bones. */
void volume_fill(volume_work *work);

/* Makes the image of all rays and the derivative of a loss by the volume's twist, on all threads: DiffDRR's method (V. Gopalakrishnan,
 * P. Golland, MICCAI workshop CLIP 2022): values between cells are trilinear, at points that divide the ray evenly. Image and
 * derivative are made together, point by point, without the records that differentiation by a library keeps. */
void volume_frame(void *work);

#endif
