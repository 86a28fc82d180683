/* The naive way from a Hounsfield number to mu: interpolation between four materials of the tables. It is kept
 * to show its error. */
#include "core/text.h"
#include "material/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Table 2 of Vidal and Villard (2016), in the order of rising Hounsfield numbers at 80 keV. */
static const char *const steps[] = {"Tissue-Equivalent Gas (Propane based)", "Water, Liquid",
                                    "Tissue, Soft (ICRU-44)", "Bone, Cortical (ICRU-44)"};
enum { STEPS = sizeof steps / sizeof *steps };

typedef struct {
    skg_material *material[STEPS];
    double hu[STEPS];
} ladder;

static skg_status climb(ladder *l) {
    for (int i = 0; i < STEPS; i++) {
        SKG_TRY(skg_material_create_named(steps[i], &l->material[i]));
        SKG_TRY(skg_material_hounsfield_get(l->material[i], 80, &l->hu[i]));
    }
    return SKG_OK;
}

/* Interpolates between two steps: linearly in HU and mu, or in ln(HU + 1000) and ln mu. */
static skg_status between(const ladder *l, double hu, int logarithmic, double energy_kev, double *per_cm) {
    int i = 0;
    double low = 0, high = 0;
    while (i + 2 < STEPS && hu >= l->hu[i + 1]) i++;
    SKG_TRY(skg_material_attenuation_get(l->material[i], energy_kev, &low));
    SKG_TRY(skg_material_attenuation_get(l->material[i + 1], energy_kev, &high));
    double a = l->hu[i], b = l->hu[i + 1];
    double part =
        logarithmic ? log((hu + 1000) / (a + 1000)) / log((b + 1000) / (a + 1000)) : (hu - a) / (b - a);
    *per_cm = logarithmic ? low * pow(high / low, part) : low + part * (high - low);
    return SKG_OK;
}

static skg_status fill(const ladder *l, double hu, int32_t interpolation, skg_material *material) {
    const skg_element_row *hydrogen =
        &skg_elements[1]; /* it has no edges, and every energy that all tables share */
    for (int32_t i = hydrogen->first; i < hydrogen->last && skg_knots[i].energy_kev <= SKG_HIGHEST_KEV; i++)
        material->energy_kev[material->count++] = skg_knots[i].energy_kev;
    for (int64_t i = 0; i < material->count; i++)
        SKG_TRY(between(l, hu, interpolation == SKG_INTERPOLATION_BILOGARITHMIC, material->energy_kev[i],
                        &material->per_cm[i]));
    material->linear = interpolation == SKG_INTERPOLATION_BILINEAR;
    return SKG_OK;
}

skg_status skg_material_create_naive_hounsfield(double hu, int32_t interpolation, skg_material **material) {
    SKG_PLAIN;
    char name[64];
    ladder l = {{NULL}, {0}};
    skg_material *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(material);
    *material = NULL;
    if (interpolation != SKG_INTERPOLATION_BILINEAR && interpolation != SKG_INTERPOLATION_BILOGARITHMIC)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_material_create_naive_hounsfield: no such interpolation");
    SKG_TRY_CLEANUP(climb(&l));
    if (!(hu >= l.hu[0] && hu <= l.hu[STEPS - 1])) {
        status = skg_fail(SKG_ERR_MATERIAL,
                          "HU %g lies outside %.1f (tissue-equivalent gas) to %.1f (cortical bone)", hu,
                          l.hu[0], l.hu[STEPS - 1]);
        goto cleanup;
    }
    snprintf(name, sizeof name, "HU %g, naive, %s", hu,
             interpolation == SKG_INTERPOLATION_BILINEAR ? "bilinear" : "bilogarithmic");
    SKG_TRY_CLEANUP(
        skg_material_make(name, "not for images: no tissue is like this", SKG_MATTER_TABLE, &made));
    int64_t capacity = skg_elements[1].last - skg_elements[1].first;
    SKG_TRY_CLEANUP(skg_alloc(capacity, sizeof(double), "material", &made->energy_kev));
    SKG_TRY_CLEANUP(skg_alloc(capacity, sizeof(double), "material", &made->per_cm));
    SKG_TRY_CLEANUP(fill(&l, hu, interpolation, made));
    *material = made;
    made = NULL;
cleanup:
    for (int i = 0; i < STEPS; i++) skg_material_release(&l.material[i]);
    skg_material_release(&made);
    return status;
}
