/* The heel effect: how the spectrum of a tube changes with the angle at which photons leave the anode. */
#include "beam/spectrum.h"
#include "core/text.h"

#include <math.h>

/* Nothing leaves the anode along its face. */
static const double MIN_ANGLE = 0.5;

/* The tube with its own angle, and with another one, which may be below the least that a tube has. */
static skg_status make_both(const skg_heel_tube *heel, double angle_deg, skg_spectrum **centre,
                            skg_spectrum **there) {
    skg_tube tube;
    skg_tube_init(&tube);
    tube.anode = heel->anode, tube.kvp = heel->kvp, tube.bin_kev = heel->bin_kev;
    tube.angle_deg = heel->angle_deg;
    SKG_TRY(skg_tube_check(&tube));
    SKG_TRY(skg_tube_bare(&tube, centre));
    tube.angle_deg = angle_deg;
    return skg_tube_bare(&tube, there);
}

skg_status skg_heel_losses(const skg_heel_tube *heel, double angle_deg, const skg_spectrum *spectrum,
                           double *losses) {
    skg_spectrum *there = NULL, *centre = NULL;
    skg_status status = SKG_OK;
    if (!(angle_deg >= MIN_ANGLE && angle_deg < 90))
        return skg_fail(
            SKG_ERR_BEAM,
            "heel effect: photons would leave the anode at %.3g degrees, that is, along its face or "
            "behind it; give a larger anode angle, or a smaller detector",
            angle_deg);
    SKG_TRY_CLEANUP(make_both(heel, angle_deg, &centre, &there));
    for (int64_t i = 0; i < spectrum->count; i++) {
        const double kev = spectrum->energy_kev[i];
        int64_t bin = (int64_t)floor((kev - centre->energy_kev[0]) / heel->bin_kev + 0.5);
        if (kev > heel->kvp) {
            status = skg_fail(SKG_ERR_BEAM,
                              "heel effect: the beam has photons of %g keV, but the tube voltage is %g kV",
                              kev, heel->kvp);
            goto cleanup;
        }
        bin = bin < 0 ? 0 : bin < centre->count ? bin : centre->count - 1;
        losses[i] = log(centre->photons[bin] / there->photons[bin]);
    }
cleanup:
    skg_spectrum_release(&there);
    skg_spectrum_release(&centre);
    return status;
}
