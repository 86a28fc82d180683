/* Form factors of molecules, by a table of the user: where photons go that Rayleigh scattering turns, when atoms are not free. */
#include "material/scattering.h"

#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* From here on the order of molecules hardly matters, 1/Angstrom: a table has to reach so far. */
static const double FREE = 0.4;

/* Share of the table's momentum transfers, the last ones, from which its scale is found. */
static const double LAST = 0.2;

static skg_status check_rows(const char *name, int64_t count, const double *x, const double *squares) {
    if (count < 2 || !x || !squares)
        return skg_fail(SKG_ERR_MATERIAL, "%s: a table of form factors has at least two rows", name);
    for (int64_t i = 0; i < count; i++) {
        if (!(isfinite(x[i]) && x[i] >= 0 && isfinite(squares[i]) && squares[i] > 0))
            return skg_fail(SKG_ERR_MATERIAL,
                            "%s: row %" PRId64
                            " (%g/Angstrom, %g): a momentum transfer is at least 0, a square above 0",
                            name, i + 1, x[i], squares[i]);
        if (i > 0 && !(x[i] > x[i - 1]))
            return skg_fail(SKG_ERR_MATERIAL, "%s: row %" PRId64 ": momentum transfers have to rise", name,
                            i + 1);
    }
    if (!(x[count - 1] >= FREE))
        return skg_fail(
            SKG_ERR_MATERIAL,
            "%s: the table ends at %g/Angstrom; it has to reach %g, from where on atoms are taken as free",
            name, x[count - 1], FREE);
    return SKG_OK;
}

/* Factor that makes the squares those of 1 g where atoms are as if free. */
static skg_status find_scale(const skg_material *material, int64_t count, const double *x,
                             const double *squares, double *scale) {
    double free = 0, bound = 0;
    for (int64_t i = 0; i < count; i++) {
        double coherent = 0, incoherent = 0;
        if (x[i] < (1 - LAST) * x[count - 1]) continue;
        SKG_TRY(skg_scattering_free(material, x[i], &coherent, &incoherent));
        free += coherent, bound += squares[i];
    }
    *scale = free / bound;
    return SKG_OK;
}

skg_status skg_material_create_form_factor(const skg_material *material, int64_t count,
                                           const double *per_angstrom, const double *squares,
                                           skg_material **bound) {
    SKG_PLAIN;
    double scale = 0;
    skg_material *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(bound);
    *bound = NULL;
    SKG_NEEDS(material);
    SKG_TRY(skg_scattering_check(material));
    if (skg_material_is_void(material))
        return skg_fail(SKG_ERR_MATERIAL, "%s: scatters nothing, and has no form factors", material->name);
    SKG_TRY(check_rows(material->name, count, per_angstrom, squares));
    SKG_TRY(find_scale(material, count, per_angstrom, squares, &scale));
    SKG_TRY(skg_material_compose(material->name, material->note, material->count, material->parts,
                                 material->density, &made));
    SKG_TRY_CLEANUP(skg_material_bind(count, per_angstrom, squares, scale, made));
    *bound = made;
    return SKG_OK;
cleanup:
    skg_material_release(&made);
    return status;
}

skg_status skg_material_form_factor_get(const skg_material *material, int64_t capacity, double *per_angstrom,
                                        double *squares, int64_t *count) {
    SKG_NEEDS(material);
    SKG_NEEDS(count);
    if (capacity < 0 || (capacity > 0 && (!per_angstrom || !squares)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: room for %" PRId64 " rows of form factors, without a place for them",
                        material->name, capacity);
    *count = material->momentum_count;
    for (int64_t i = 0; i < capacity && i < *count; i++)
        per_angstrom[i] = material->momenta[i], squares[i] = material->coherent[i];
    return SKG_OK;
}
