/* The makers of the parts, each in the file of its name, and how they add a part to the thorax. Private.
 *
 * Places and sizes in them are in mm: aggregates of the surfaces of BodyParts3D (one man, lying), to about 5 mm,
 * moved apart where parts would touch; stomach, spleen and kidneys are of typical size. Gaps, and widths over which
 * shapes change, are choices. Hounsfield numbers are typical of CT at about 120 kV. Numbers of points and rings are
 * those of resolution 1, chosen so that all parts together have about 42,000 triangles. */
#ifndef SKG_PHANTOM_MAKERS_H
#define SKG_PHANTOM_MAKERS_H

#include "core/core.h"
#include "mesh/mesh.h"
#include "phantom/anatomy.h"
#include "phantom/shapes.h"

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

skg_status skg_thorax_muscle(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_scapulae(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_spine(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_vessels(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_belly(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_airways(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_bones(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_diaphragm(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_lungs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_organs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_ducts(const skg_thorax_plan *plan, int64_t liver, int64_t skin, skg_thorax *thorax);
skg_status skg_thorax_skin(const skg_thorax_plan *plan, skg_thorax *thorax);
skg_status skg_thorax_needle(skg_thorax *thorax);

/* --- Organs under the diaphragm. */

/* <= 0 in the region of all organs of the belly: a gap under the diaphragm, within its rim, and clear of the spine; by
 * `wall` mm more than the gap. No distance. */
double skg_belly_inside(const skg_thorax_plan *plan, double wall, const double point[3]);

/* Adds a part as a star (skg_shape_star), drawn back from those before it with the same `inside`. standard_rings: at
 * resolution 1. */
skg_status skg_thorax_star(const skg_thorax_plan *plan, const char *label, double hounsfield, int64_t inside,
                           skg_region region, const void *shape, const double centre[3],
                           double standard_rings, skg_thorax *thorax);

#endif
