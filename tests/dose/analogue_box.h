/* Dose in a box by analogue photons, one by one: no expectation, no weights, no surfaces but the box's. */
#ifndef SKG_TESTS_DOSE_ANALOGUE_BOX_H
#define SKG_TESTS_DOSE_ANALOGUE_BOX_H

#include <stdint.h>

typedef struct {
    const char *material;
    double kev;
    double low[3], high[3];
    /* z; photons fly towards even places of a square of `side` mm at z = plane, which stops none */
    double source;
    double plane, side;
    double inner[2]; /* z: the layer whose share is asked for */
} analogue_box;

/* Shares of the energy that leaves the source. */
typedef struct {
    double absorbed, absorbed_sigma;
    double inner, inner_sigma;
} analogue_absorbed;

analogue_absorbed analogue_box_run(const analogue_box *box, int64_t photons, uint64_t seed);

#endif
