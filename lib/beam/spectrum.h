/* The inside of a spectrum. Private. */
#ifndef SKG_SPECTRUM_PRIVATE_H
#define SKG_SPECTRUM_PRIVATE_H

#include "core/core.h"

#include <skiagraph/beam.h>

struct skg_spectrum {
    skg_refs refs;
    int64_t count;
    double *energy_kev; /* [count] */
    double *photons;    /* [count] per pixel */
};

#endif
