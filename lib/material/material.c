#include "material/material.h"

#include <math.h>

skg_status skg_material_mu(const char *name, double per_cm, skg_material **material) {
    if (!material) return skg_fail(SKG_ERR_ARGUMENT, "skg_material_mu: no place for the material");
    *material = NULL;
    if (!isfinite(per_cm) || per_cm < 0)
        return skg_fail(
            SKG_ERR_MATERIAL,
            "%s: a linear attenuation coefficient of %g 1/cm is not usable; give a finite value of at "
            "least 0",
            name && *name ? name : "material", per_cm);
    skg_material *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "material", &made));
    skg_refs_init(&made->refs);
    made->mu_per_cm = per_cm;
    skg_status status = skg_copy_text(name && *name ? name : "material", &made->name);
    if (status != SKG_OK) skg_free(&made);
    *material = made;
    return status;
}

skg_status skg_material_retain(skg_material *material) {
    if (!material) return skg_fail(SKG_ERR_ARGUMENT, "skg_material_retain: no material");
    skg_ref(&material->refs);
    return SKG_OK;
}

void skg_material_release(skg_material **material) {
    if (!material || !*material) return;
    if (skg_unref(&(*material)->refs)) {
        skg_free(&(*material)->name);
        skg_free(material);
    }
    *material = NULL;
}

skg_status skg_material_attenuation(const skg_material *material, double energy_kev, double *per_cm) {
    if (!material || !per_cm)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_material_attenuation: no material or no result");
    if (!isfinite(energy_kev) || energy_kev <= 0)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a photon energy of %g keV is not usable", material->name,
                        energy_kev);
    *per_cm = material->mu_per_cm;
    return SKG_OK;
}

skg_status skg_material_name(const skg_material *material, const char **name) {
    if (!material || !name) return skg_fail(SKG_ERR_ARGUMENT, "skg_material_name: no material or no result");
    *name = material->name;
    return SKG_OK;
}
