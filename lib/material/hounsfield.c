/* Tissue by Hounsfield number.
 *
 * The density follows Schneider, Bortfeld and Schlegel, Phys. Med. Biol. 45 (2000) 459, Eq. 19, 21 and 23, with a
 * straight line from air to adipose tissue below -98 HU and a constant between the two lines of soft tissue. */
#include "core/text.h"
#include "material/material.h"

#include <math.h>
#include <stdio.h>

/* HU. Noise takes air below -1000; bone of rising density goes on to 3000, where 12-bit scanners end. */
static const double LOWEST = -1050, HIGHEST = 3000;

double skg_hounsfield_density(double hu) {
    const double air = 1.21e-3, fat = 0.93; /* g/cm3, at -1000 and -98 */
    if (hu <= -1000) return air;
    if (hu < -98) return air + (hu + 1000) * (fat - air) / 902;
    if (hu <= 14) return 1.018 + 0.893e-3 * hu; /* Eq. 21 */
    if (hu < 23) return 1.03;                   /* soft tissue */
    if (hu < 100) return 1.003 + 1.169e-3 * hu; /* Eq. 23 */
    return 1.017 + 0.592e-3 * hu;               /* Eq. 19 */
}

int32_t skg_hounsfield_row_of(double hu) {
    int32_t row = 0;
    while (row + 1 < skg_hounsfield_count && hu >= skg_hounsfield_rows[row + 1].lowest) row++;
    return row;
}

skg_status skg_hounsfield_row_create(int64_t row, skg_material **material) {
    const skg_hounsfield_row *tissue = &skg_hounsfield_rows[row];
    return skg_material_compose(tissue->name, "composition by Schneider 2000", tissue->count,
                                skg_mass_fractions + tissue->first, 1, material);
}

skg_status skg_material_create_hounsfield(double hu, skg_material **material) {
    SKG_PLAIN;
    char name[64], note[256];
    SKG_NEEDS(material);
    *material = NULL;
    if (!(hu >= LOWEST && hu <= HIGHEST))
        return skg_fail(SKG_ERR_MATERIAL, "HU %g lies outside %g to %g, where tissue is tabled", hu, LOWEST,
                        HIGHEST);
    const skg_hounsfield_row *tissue = &skg_hounsfield_rows[skg_hounsfield_row_of(hu)];
    snprintf(name, sizeof name, "HU %g", hu);
    snprintf(
        note, sizeof note, "%s; composition and density by Schneider 2000%s", tissue->name,
        hu > SKG_HOUNSFIELD_TABLED
            ? ", whose table ends at HU 1600: beyond it bone of rising density goes on. If it is a metal, name it, "
              "such as Ti"
            : "");
    return skg_material_compose(name, note, tissue->count, skg_mass_fractions + tissue->first,
                                skg_hounsfield_density(hu), material);
}
