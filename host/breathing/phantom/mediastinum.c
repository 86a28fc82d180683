/* The great vessels and the oesophagus as parts. */
#include "phantom/contacts.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

skg_status skg_thorax_vessels(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    for (int v = 0; v < VESSELS; v++) {
        const skg_vessel *vessel = plan->vessel + v;
        skg_mesh_arrays arrays = {0};
        skg_status status =
            skg_shape_hose(vessel->label, vessel->line, VESSEL_POINTS, vessel->radius[0], vessel->radius[1],
                           1, skg_shape_count(plan->resolution, vessel->rings, 3),
                           skg_shape_count(plan->resolution, 12, 6), &arrays);
        if (status == SKG_OK) status = skg_shape_unfold(vessel->label, &arrays);
        if (status == SKG_OK)
            status = skg_thorax_fit(thorax, vessel->label, vessel->hounsfield, outer, &arrays);
        skg_mesh_arrays_free(&arrays);
        SKG_TRY(status);
    }
    return SKG_OK;
}
