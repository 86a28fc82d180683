/* Adding parts to the generated thorax. Private. */
#ifndef SKG_BUILDER_H
#define SKG_BUILDER_H

#include "core/core.h"
#include "mesh/mesh.h"

#include <skiagraph/breathing.h>

struct skg_thorax {
    int64_t parts, capacity;
    struct {
        char label[40];
        const char *material; /* a name of the material tables; NULL: by hounsfield */
        double hounsfield;
        double density; /* g/cm3; 0: that of the tables */
        int64_t inside;
        skg_mesh *mesh;
        int32_t through; /* 1: it passes through others on purpose */
    } * part;
};

/* Adds a part with the surface in the arrays, which the mesh takes over. inside: number of the part around it; -1:
 * none. */
skg_status skg_thorax_add(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays);

/* Adds a part whose surface first draws back from the parts before it with the same `inside`, and from the part around
 * it unless that is the skin. */
skg_status skg_thorax_fit(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays);

#endif
