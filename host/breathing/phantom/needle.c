/* The needle. */
#include "core/maths.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

#include <string.h>

/* A Chiba needle of 22 G: 0.72 mm across, 200 mm long. Its tip lies in the right hepatic duct, 110 mm deep; it passes
 * through the space below rib 8 in the right mid-axillary line. */
skg_status skg_thorax_needle(skg_thorax *thorax) {
    static const double tip[3] = {-54, -60, -81.5}, toward[3] = {-1, 0.02, -0.36};
    skg_tube_ring ring[2] = {{{0}, 0.36, 0.36}, {{0}, 0.36, 0.36}};
    memcpy(ring[0].centre, tip, sizeof tip);
    skg_add_scaled(tip, 200 / skg_length(toward), toward, ring[1].centre);
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_tube("needle", 2, ring, 0.36, 8, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "needle", 0, -1, &arrays);
    if (status == SKG_OK) thorax->part[thorax->parts - 1].through = 1;
    skg_mesh_arrays_free(&arrays);
    return status;
}
