/* The makers of the parts, each in the file of its name. Each adds its parts to the thorax; skin: number of the part
 * that they lie in. Private.
 *
 * Places and sizes in them are in mm: aggregates of the surfaces of BodyParts3D (one man, lying), to about 5 mm,
 * moved apart where parts would touch; stomach, spleen and kidneys are of typical size. Gaps, and widths over which
 * shapes change, are choices. Hounsfield numbers are typical of CT at about 120 kV. Numbers of points and rings are
 * those of resolution 1, chosen so that all parts together have about 42,000 triangles. */
#ifndef SKG_MAKERS_H
#define SKG_MAKERS_H

#include "phantom/builder.h"
#include "phantom/plan.h"

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

#endif
