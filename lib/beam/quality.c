/* The quality of a beam: half-value layers and mean energy. */
#include "beam/spectrum.h"
#include "core/text.h"

void skg_quality_init_sized(void *quality, int32_t size) {
    const skg_quality defaults = {0};
    skg_struct_init(quality, size, &defaults, sizeof defaults);
}

static skg_status layers(const skg_spectrum *spectrum, int32_t z, double *first, double *second) {
    skg_material *metal = NULL;
    SKG_TRY(skg_material_create_element(z, &metal));
    skg_status status = skg_half_value_layers(spectrum, metal, first, second);
    skg_material_release(&metal);
    return status;
}

skg_status skg_spectrum_quality_get(const skg_spectrum *spectrum, skg_quality *quality) {
    SKG_PLAIN;
    enum { ALUMINIUM = 13, COPPER = 29 };
    SKG_NEEDS(spectrum);
    SKG_NEEDS(quality);
    skg_quality ours;
    skg_quality_init(&ours);
    for (int64_t i = 0; i < spectrum->count; i++) {
        ours.photons += spectrum->photons[i];
        ours.energy_kev += spectrum->photons[i] * spectrum->energy_kev[i];
    }
    ours.mean_kev = ours.energy_kev / ours.photons;
    ours.air_kerma_ugy = skg_spectrum_kerma(spectrum);
    SKG_TRY(layers(spectrum, ALUMINIUM, &ours.hvl1_mm_al, &ours.hvl2_mm_al));
    SKG_TRY(layers(spectrum, COPPER, &ours.hvl1_mm_cu, &ours.hvl2_mm_cu));
    ours.homogeneity = ours.hvl1_mm_al / ours.hvl2_mm_al;
    return skg_struct_write(&ours, sizeof ours, "skg_quality", quality);
}
