/* The inside of a material. */
#include "material/material.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

skg_status skg_material_make(const char *name, const char *note, int32_t kind, skg_material **material) {
    skg_material *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *made, "material", &made));
    skg_refs_init(&made->refs);
    made->kind = kind;
    SKG_TRY_CLEANUP(skg_copy_text(name && *name ? name : "material", &made->name));
    SKG_TRY_CLEANUP(skg_copy_text(note ? note : "", &made->note));
    *material = made;
    return SKG_OK;
cleanup:
    skg_material_release(&made);
    return status;
}

skg_status skg_material_compose(const char *name, const char *note, int64_t count,
                                const skg_mass_fraction *parts, double density, skg_material **material) {
    skg_material *made = NULL;
    SKG_TRY(skg_material_make(name, note, SKG_MATTER_COMPOSITION, &made));
    skg_status status = skg_alloc(count, sizeof *parts, "material", &made->parts);
    if (status != SKG_OK) {
        skg_material_release(&made);
        return status;
    }
    memcpy(made->parts, parts, (size_t)count * sizeof *parts);
    made->count = count;
    made->density = density;
    *material = made;
    return SKG_OK;
}

skg_status skg_material_create_mu(const char *name, double per_cm, skg_material **material) {
    SKG_PLAIN;
    SKG_NEEDS(material);
    *material = NULL;
    if (!isfinite(per_cm) || per_cm < 0)
        return skg_fail(
            SKG_ERR_MATERIAL,
            "%s: a linear attenuation coefficient of %g 1/cm is not usable; give a finite value of at "
            "least 0",
            name && *name ? name : "material", per_cm);
    SKG_TRY(skg_material_make(name, NULL, SKG_MATTER_CONSTANT, material));
    (*material)->mu_per_cm = per_cm;
    return SKG_OK;
}

skg_status skg_material_retain(skg_material *material) {
    SKG_NEEDS(material);
    skg_ref(&material->refs);
    return SKG_OK;
}

void skg_material_release(skg_material **material) {
    if (!material || !*material) return;
    if (skg_unref(&(*material)->refs)) {
        skg_free(&(*material)->name);
        skg_free(&(*material)->note);
        skg_free(&(*material)->parts);
        skg_free(&(*material)->energy_kev);
        skg_free(&(*material)->per_cm);
        skg_free(&(*material)->momenta);
        skg_free(&(*material)->coherent);
        skg_free(material);
    }
    *material = NULL;
}

skg_status skg_material_bind(int64_t count, const double *x, const double *squares, double scale,
                             skg_material *to) {
    SKG_TRY(skg_alloc(count, sizeof(double), "form factors", &to->momenta));
    SKG_TRY(skg_alloc(count, sizeof(double), "form factors", &to->coherent));
    memcpy(to->momenta, x, (size_t)count * sizeof(double));
    for (int64_t i = 0; i < count; i++) to->coherent[i] = scale * squares[i];
    to->momentum_count = count;
    return SKG_OK;
}

skg_status skg_material_create_at_density(const skg_material *material, double density,
                                          skg_material **dense) {
    SKG_PLAIN;
    SKG_NEEDS(dense);
    *dense = NULL;
    SKG_NEEDS(material);
    if (material->kind != SKG_MATTER_COMPOSITION)
        return skg_fail(SKG_ERR_MATERIAL,
                        "%s: a material given by its linear attenuation coefficient has no density to change",
                        material->name);
    if (!(isfinite(density) && density > 0))
        return skg_fail(SKG_ERR_MATERIAL, "%s: a density of %g g/cm3 is not usable; give one above 0",
                        material->name, density);
    SKG_TRY(skg_material_compose(material->name, material->note, material->count, material->parts, density,
                                 dense));
    if (material->momentum_count == 0) return SKG_OK;
    const skg_status status =
        skg_material_bind(material->momentum_count, material->momenta, material->coherent, 1, *dense);
    if (status != SKG_OK) skg_material_release(dense);
    return status;
}

skg_status skg_material_name_get(const skg_material *material, const char **name) {
    SKG_NEEDS(material);
    SKG_NEEDS(name);
    *name = material->name;
    return SKG_OK;
}

skg_status skg_material_note_get(const skg_material *material, const char **note) {
    SKG_NEEDS(material);
    SKG_NEEDS(note);
    *note = material->note;
    return SKG_OK;
}

skg_status skg_material_density_get(const skg_material *material, double *density) {
    SKG_NEEDS(material);
    SKG_NEEDS(density);
    *density = material->density;
    return SKG_OK;
}

skg_status skg_material_element_count(const skg_material *material, int64_t *count) {
    SKG_NEEDS(material);
    SKG_NEEDS(count);
    *count = material->kind == SKG_MATTER_COMPOSITION ? material->count : 0;
    return SKG_OK;
}

skg_status skg_material_element_get(const skg_material *material, int64_t index, int32_t *z,
                                    double *fraction) {
    int64_t count = 0;
    SKG_NEEDS(z);
    SKG_NEEDS(fraction);
    SKG_TRY(skg_material_element_count(material, &count));
    if (index < 0 || index >= count)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: element %" PRId64 " of %" PRId64, material->name, index,
                        count);
    *z = material->parts[index].z;
    *fraction = material->parts[index].fraction;
    return SKG_OK;
}
