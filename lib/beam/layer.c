/* Responses of scintillators: layers that absorb, from which fluorescence may escape and in which scattered photons may be followed. */
#include "beam/response.h"
#include "core/core.h"
#include "core/text.h"

#include <math.h>

static skg_status make_layer(const skg_material *material, double mm, skg_response **response) {
    skg_response *made = NULL;
    skg_material *own = NULL;
    double unused = 0, density = 0;
    SKG_TRY(skg_material_density_get(material, &density));
    SKG_TRY(skg_material_attenuation_get(material, 60, &unused)); /* fails unless the density is known */
    /* The caller's material is const and cannot be retained, so the layer gets its own. */
    SKG_TRY(skg_material_create_at_density(material, density, &own));
    skg_status status = skg_alloc(1, sizeof *made, "energy response", &made);
    if (status != SKG_OK) {
        skg_material_release(&own);
        return status;
    }
    skg_refs_init(&made->refs);
    made->material = own;
    made->mm = mm;
    *response = made;
    return SKG_OK;
}

skg_status skg_response_create_scintillator(const skg_material *material, double thickness_mm, double packing,
                                            skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(response);
    *response = NULL;
    if (!(isfinite(thickness_mm) && thickness_mm > 0))
        return skg_fail(SKG_ERR_BEAM, "a scintillator of %g mm is not usable; give a thickness above 0",
                        thickness_mm);
    if (!(packing > 0 && packing <= 1))
        return skg_fail(SKG_ERR_BEAM, "a scintillator's packing of %g is not usable; give above 0, up to 1",
                        packing);
    return make_layer(material, thickness_mm * packing, response);
}

skg_status skg_response_create_screen(const skg_material *material, double mg_cm2, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(response);
    *response = NULL;
    double density = 0;
    if (!(isfinite(mg_cm2) && mg_cm2 > 0))
        return skg_fail(SKG_ERR_BEAM, "a screen of %g mg/cm2 is not usable; give a mass above 0", mg_cm2);
    SKG_TRY(skg_material_density_get(material, &density));
    if (!(density > 0)) return make_layer(material, 1, response); /* fails with the sentence on the density */
    return make_layer(material, mg_cm2 / 1000 / density * 10, response);
}

/* Makes the layer again with fluorescence that leaves it, scattered photons that are followed, or both. */
static skg_status make_again(const skg_response *layer, int escapes, int transports,
                             skg_response **response) {
    SKG_TRY(make_layer(layer->material, layer->mm, response));
    skg_response *made = *response;
    skg_status status = SKG_OK;
    if (escapes) status = skg_escape_create(made->material, made->mm, &made->escape);
    if (status == SKG_OK && transports)
        status = skg_deposition_create(made->material, made->mm, made->escape, &made->deposition);
    if (status != SKG_OK) skg_response_release(response);
    return status;
}

skg_status skg_response_create_escaping(const skg_response *scintillator, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(scintillator);
    SKG_NEEDS(response);
    *response = NULL;
    if (scintillator->count > 0) /* also of one with a DQE, which knows its noise */
        return skg_fail(
            SKG_ERR_BEAM,
            "fluorescence escapes from a scintillator of given thickness, not from a table, which "
            "has its own recorded energies and Swank factors");
    return make_again(scintillator, 1, scintillator->deposition != NULL, response);
}

skg_status skg_response_create_transporting(const skg_response *scintillator, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(scintillator);
    SKG_NEEDS(response);
    *response = NULL;
    if (scintillator->count > 0)
        return skg_fail(
            SKG_ERR_BEAM,
            "scattered photons are followed in a scintillator of given thickness, not in a table, "
            "which has its own recorded energies");
    return make_again(scintillator, scintillator->escape != NULL, 1, response);
}
