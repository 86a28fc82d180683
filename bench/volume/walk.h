/* The contender of bench_volume: rays through cells in plain C with OpenMP. */
#ifndef BENCH_VOLUME_WALK_H
#define BENCH_VOLUME_WALK_H

#include <skiagraph/scene.h>

typedef struct {
    const int16_t *cells; /* [side][side][side] */
    const float *weights; /* by value, from `low` on: 1/mm */
    int low, side;
    double size; /* of a side, mm; its middle is at the world's origin */
    skg_view view;
    float *image; /* [rows][columns] attenuation */
} walk_work;

/* From plane to plane, in float (J. Amanatides, A. Woo, Eurographics 1987), a thread for each row. */
void walk_frame(void *work);

/* Attenuation along the ray to one pixel, in double. */
double walk_exactly(const walk_work *work, int64_t row, int64_t column);

#endif
