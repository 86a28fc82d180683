/* The inside of a material. Private. */
#ifndef SKG_MATERIAL_PRIVATE_H
#define SKG_MATERIAL_PRIVATE_H

#include "core/core.h"

#include <skiagraph/material.h>

struct skg_material {
    skg_refs refs;
    char *name;
    double mu_per_cm; /* the same at every energy */
};

#endif
