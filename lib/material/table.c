/* Materials by a table of the user: mu by energy. */
#include "core/files.h"
#include "core/text.h"
#include "material/material.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static skg_status check_rows(const char *name, int64_t count, const double *energies, const double *values) {
    if (count < 2 || !energies || !values)
        return skg_fail(SKG_ERR_MATERIAL, "%s: a table has at least two energies", name);
    for (int64_t i = 0; i < count; i++) {
        if (!(isfinite(energies[i]) && energies[i] > 0 && isfinite(values[i]) && values[i] > 0))
            return skg_fail(SKG_ERR_MATERIAL,
                            "%s: row %" PRId64 " (%g keV, %g 1/cm): energy and value have to be above 0",
                            name, i + 1, energies[i], values[i]);
        if ((i > 0 && energies[i] < energies[i - 1]) || (i > 1 && !(energies[i] > energies[i - 2])))
            return skg_fail(SKG_ERR_MATERIAL,
                            "%s: row %" PRId64 ": energies have to rise (an edge: one energy twice)", name,
                            i + 1);
    }
    if (!(energies[count - 1] > energies[count - 2]) || !(energies[1] > energies[0]))
        return skg_fail(SKG_ERR_MATERIAL, "%s: an edge at the end of the table has one side only", name);
    return SKG_OK;
}

skg_status skg_material_create_table(const char *name, int64_t count, const double *energies_kev,
                                     const double *per_cm, skg_material **material) {
    SKG_PLAIN;
    SKG_NEEDS(material);
    *material = NULL;
    if (!name || !*name) name = "table";
    SKG_TRY(check_rows(name, count, energies_kev, per_cm));
    skg_material *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_material_make(name, "table of the user", SKG_MATTER_TABLE, &made));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "table", &made->energy_kev));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "table", &made->per_cm));
    memcpy(made->energy_kev, energies_kev, (size_t)count * sizeof(double));
    memcpy(made->per_cm, per_cm, (size_t)count * sizeof(double));
    made->count = count;
    *material = made;
    return SKG_OK;
cleanup:
    skg_material_release(&made);
    return status;
}

skg_status skg_material_load_table(const char *path, const char *unit, skg_material **material) {
    SKG_PLAIN;
    double *energies = NULL, *values = NULL, kev = 1;
    int64_t count = 0;
    SKG_NEEDS(material);
    SKG_NEEDS(path);
    SKG_NEEDS(unit);
    *material = NULL;
    SKG_TRY(skg_unit_of_energy(unit, &kev));
    SKG_TRY(skg_read_columns(path, NULL, &count, &energies, &values));
    for (int64_t i = 0; i < count; i++) energies[i] *= kev;
    skg_status status = skg_material_create_table(path, count, energies, values, material);
    skg_free(&energies);
    skg_free(&values);
    return status;
}
