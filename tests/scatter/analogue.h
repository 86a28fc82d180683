/* Photons one by one, as nature has them: neither forced nor weighted nor smoothed. The judge of scatter in a box of one material.
 * It shares the cross sections of materials with the library, and nothing else. */
#ifndef SKG_TESTS_SCATTER_ANALOGUE_H
#define SKG_TESTS_SCATTER_ANALOGUE_H

#include <skiagraph/material.h>

typedef struct {
    const char *material;
    double kev;
    double low[3], high[3]; /* of the box, mm */
    double source[3];       /* of a parallel beam its direction */
    int parallel;
    double plane, side[2]; /* detector: z, and its sides around the z axis; it is the field, too */
    double per_area;       /* photons per mm2 at the foot of the perpendicular from the source */
} analogue_scene;

/* keV that arrive after one, two, and more interactions, and the standard error of the sum. */
typedef struct {
    double order[3], sum, sigma;
} analogue_result;

analogue_result analogue_run(const analogue_scene *scene, int64_t histories, uint64_t seed);

#endif
