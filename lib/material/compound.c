/* Elements, formulas and mixtures as materials. */
#include "core/text.h"
#include "material/mixture.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static skg_status check_density(const char *name, double density) {
    if (isfinite(density) && density >= 0) return SKG_OK;
    return skg_fail(SKG_ERR_MATERIAL,
                    "%s: a density of %g g/cm3 is not usable; give one above 0, or 0 for that of the tables",
                    name, density);
}

skg_status skg_material_create_element(int32_t z, skg_material **material) {
    SKG_PLAIN;
    const char *symbol;
    SKG_NEEDS(material);
    *material = NULL;
    SKG_TRY(skg_element_symbol_get(z, &symbol));
    skg_mass_fraction part = {z, 1};
    return skg_material_compose(symbol, NULL, 1, &part, skg_elements[z].density, material);
}

/* Molecules of one element. Another formula of one element, such as "SS304" or "C45", is rather the name of an alloy. */
static const struct {
    int32_t z;
    double atoms;
} molecules[] = {{1, 2},  {7, 2},  {8, 2},  {8, 3},  {9, 2},  {15, 4}, {16, 8},
                 {17, 2}, {34, 8}, {35, 2}, {53, 2}, {6, 60}, {6, 70}};

static skg_status check_molecule(const char *formula, int64_t count, int32_t z, double atoms) {
    if (count != 1 || atoms == 1) return SKG_OK;
    for (size_t i = 0; i < sizeof molecules / sizeof *molecules; i++)
        if (molecules[i].z == z && molecules[i].atoms == atoms) return SKG_OK;
    return skg_fail(
        SKG_ERR_MATERIAL,
        "\"%s\" is ambiguous: as a formula it is the element %s alone; write %s for that, and an alloy by its name in "
        "the tables (such as 304, 316L, Ti-6Al-4V) or by its parts by mass (weight:Fe98.5C0.5Mn1)",
        formula, skg_elements[z].symbol, skg_elements[z].symbol);
}

skg_status skg_material_create_formula(const char *formula, double density, skg_material **material) {
    SKG_PLAIN;
    skg_mass_fraction parts[SKG_LAST_ELEMENT];
    int64_t count = 0;
    double sum = 0;
    SKG_NEEDS(material);
    SKG_NEEDS(formula);
    *material = NULL;
    SKG_TRY(check_density(formula, density));
    SKG_TRY(skg_read_formula(formula, 0, &count, parts, &sum));
    SKG_TRY(check_molecule(formula, count, parts[0].z, sum));
    const skg_mixture_row *known = skg_find_mixture(formula);
    if (!(density > 0) && count == 1) density = skg_elements[parts[0].z].density;
    if (!(density > 0) && known && !skg_lacks_hyphens(known, formula)) density = known->density;
    return skg_material_compose(formula, NULL, count, parts, density, material);
}

enum { LONGEST_NOTE = 160 };
/* Published fractions are rounded to three or four decimals: those of ten elements sum to 1 within this. */
static const double SUM_TOLERANCE = 5e-3;
/* A sum that is off by less than this differs by the rounding of doubles only. */
static const double SUM_ROUNDING = 1e-9;

skg_status skg_material_create_mixture(const char *name, int64_t count, const int32_t *z,
                                       const double *fractions, double density, skg_material **material) {
    SKG_PLAIN;
    skg_mass_fraction parts[SKG_LAST_ELEMENT];
    double of[SKG_LAST_ELEMENT + 1] = {0}, sum = 0;
    char note[LONGEST_NOTE] = "";
    const char *symbol;
    SKG_NEEDS(material);
    *material = NULL;
    if (!name || !*name) name = "mixture";
    if (count < 1 || !z || !fractions)
        return skg_fail(SKG_ERR_MATERIAL, "%s: a mixture has at least one element", name);
    SKG_TRY(check_density(name, density));
    for (int64_t i = 0; i < count; i++) {
        SKG_TRY(skg_element_symbol_get(z[i], &symbol));
        if (!(isfinite(fractions[i]) && fractions[i] >= 0))
            return skg_fail(SKG_ERR_MATERIAL, "%s: the fraction of %s is %g; a fraction by mass is 0 to 1",
                            name, symbol, fractions[i]);
        of[z[i]] += fractions[i];
        sum += fractions[i];
    }
    if (!(fabs(sum - 1) <= SUM_TOLERANCE))
        return skg_fail(SKG_ERR_MATERIAL,
                        "%s: the fractions by mass sum to %.6g; they have to sum to 1 within %g", name, sum,
                        SUM_TOLERANCE);
    if (fabs(sum - 1) > SUM_ROUNDING)
        snprintf(note, sizeof note, "fractions by mass sum to %.6g and were scaled to 1", sum);
    int64_t used = 0;
    for (int32_t k = 1; k <= SKG_LAST_ELEMENT; k++)
        if (of[k] > 0) parts[used++] = (skg_mass_fraction){k, of[k] / sum};
    return skg_material_compose(name, note, used, parts, density, material);
}
