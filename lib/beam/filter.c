/* Filters: what a layer takes off a spectrum. */
#include "beam/spectrum.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>

static const double NEGLIGIBLE = 1e-9; /* of the strongest energy's photons */

void skg_filter_init_sized(void *filter, int32_t size) {
    const skg_filter defaults = {0};
    skg_struct_init(filter, size, &defaults, sizeof defaults);
}

skg_status skg_filters_pass(int64_t count, const skg_filter *filters, double energy_kev, double *passed) {
    double exponent = 0;
    if (count < 0 || (count > 0 && !filters))
        return skg_fail(SKG_ERR_ARGUMENT, "no filters where there should be %" PRId64, count);
    for (int64_t i = 0; i < count; i++) {
        double per_cm = 0;
        skg_filter filter;
        skg_filter_init(&filter);
        SKG_TRY(skg_struct_read_at(filters, i, "skg_filter", &filter, sizeof filter));
        if (!filter.material) return skg_fail(SKG_ERR_BEAM, "filter %" PRId64 " has no material", i + 1);
        if (!(isfinite(filter.thickness_mm) && filter.thickness_mm >= 0))
            return skg_fail(SKG_ERR_BEAM, "filter %" PRId64 " is %g mm thick; give at least 0", i + 1,
                            filter.thickness_mm);
        SKG_TRY(skg_material_attenuation_get(filter.material, energy_kev, &per_cm));
        exponent += per_cm * filter.thickness_mm / 10;
    }
    *passed = exp(-exponent);
    return SKG_OK;
}

skg_status skg_spectrum_create_filtered(const skg_spectrum *spectrum, int64_t count,
                                        const skg_filter *filters, skg_spectrum **behind) {
    SKG_PLAIN;
    SKG_NEEDS(behind);
    *behind = NULL;
    SKG_NEEDS(spectrum);
    skg_spectrum *made = NULL;
    skg_status status = SKG_OK;
    double strongest = 0;
    SKG_TRY(skg_spectrum_make(spectrum->count, &made));
    for (int64_t i = 0; i < spectrum->count; i++) {
        double passed = 0;
        SKG_TRY_CLEANUP(skg_filters_pass(count, filters, spectrum->energy_kev[i], &passed));
        made->photons[i] = spectrum->photons[i] * passed;
        strongest = fmax(strongest, made->photons[i]);
    }
    if (!(strongest > 0)) {
        status = skg_fail(SKG_ERR_BEAM, "the filters let no photon through");
        goto cleanup;
    }
    int64_t used = 0;
    for (int64_t i = 0; i < spectrum->count; i++) {
        if (made->photons[i] < NEGLIGIBLE * strongest) continue;
        made->energy_kev[used] = spectrum->energy_kev[i];
        made->photons[used++] = made->photons[i];
    }
    made->count = used;
    made->absolute = spectrum->absolute;
    made->unloaded = spectrum->unloaded;
    *behind = made;
    return SKG_OK;
cleanup:
    skg_spectrum_release(&made);
    return status;
}
