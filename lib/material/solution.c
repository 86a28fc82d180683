/* Solutions in water, such as contrast media by their mass of iodine. */
#include "material/mixture.h"

#include <math.h>
#include <stdio.h>

static const double WATER_G_CM3 = 1;

/* Adds a share of a material's elements. */
static void add_share(const skg_material *of, double share, double fraction[SKG_LAST_ELEMENT + 1]) {
    for (int64_t i = 0; i < of->count; i++) fraction[of->parts[i].z] += share * of->parts[i].fraction;
}

/* Volumes add: 1 ml holds the solute at its own density, and water. */
skg_status skg_material_dissolve(const char *name, const skg_material *solute, double g_ml,
                                 skg_material **material) {
    double fraction[SKG_LAST_ELEMENT + 1] = {0};
    skg_mass_fraction parts[SKG_LAST_ELEMENT];
    int64_t count = 0;
    char label[160], note[256];
    skg_material *water = NULL;
    const double volume = g_ml / solute->density, density = g_ml + (1 - volume) * WATER_G_CM3;
    if (!(volume < 1))
        return skg_fail(SKG_ERR_MATERIAL,
                        "solution of %s: %g mg/ml are more than the solute itself has (%g mg/ml)", name,
                        1000 * g_ml, 1000 * solute->density);
    SKG_TRY(skg_material_create_formula("H2O", 0, &water));
    add_share(solute, g_ml / density, fraction);
    add_share(water, 1 - g_ml / density, fraction);
    skg_material_release(&water);
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        if (fraction[z] > 0) parts[count++] = (skg_mass_fraction){z, fraction[z]};
    snprintf(label, sizeof label, "%.100s %g mg/ml in water", name, 1000 * g_ml);
    snprintf(note, sizeof note,
             "%.100s is taken to fill its volume at %g g/cm3 in water: %.5g g/cm3, an assumption", name,
             solute->density, density);
    return skg_material_compose(label, note, count, parts, density, material);
}
