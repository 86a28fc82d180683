/* The attenuation of materials: linear, by process, as a Hounsfield number, and where it jumps. */
#include "core/text.h"
#include "material/material.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const skg_mass_fraction water[2] = {{1, 0.111898}, {8, 0.888102}}; /* NIST, at 1 g/cm3 */

static skg_status table_value(const skg_material *material, double energy_kev, double *per_cm) {
    const double *e = material->energy_kev, *mu = material->per_cm;
    int64_t low = 0, high = material->count - 1;
    if (!(energy_kev >= e[0] && energy_kev <= e[high]))
        return skg_fail(SKG_ERR_MATERIAL,
                        "%s: a photon energy of %g keV lies outside the table's %g to %g keV", material->name,
                        energy_kev, e[0], e[high]);
    while (high - low > 1) { /* at an edge the row above it is found */
        int64_t middle = low + (high - low) / 2;
        if (e[middle] <= energy_kev)
            low = middle;
        else
            high = middle;
    }
    if (energy_kev >= e[high])
        *per_cm = mu[high];
    else if (material->linear)
        *per_cm = mu[low] + (mu[high] - mu[low]) * (energy_kev - e[low]) / (e[high] - e[low]);
    else
        *per_cm = mu[low] * exp(log(mu[high] / mu[low]) * log(energy_kev / e[low]) / log(e[high] / e[low]));
    return SKG_OK;
}

/* The order of the sum is that of the fields of skg_coefficients, so that a caller gets the same bits. */
double skg_total_section(const double sections[SKG_PROCESSES]) {
    return sections[SKG_RAYLEIGH] + sections[SKG_COMPTON] + sections[SKG_PHOTO] + sections[SKG_PAIR];
}

/* Checks material and energy. Gives the attenuation unless cross sections are needed. */
static skg_status check(const skg_material *material, double energy_kev, double *per_cm) {
    SKG_TRY(skg_check_energy(material->name, energy_kev));
    if (material->kind == SKG_MATTER_CONSTANT) *per_cm = material->mu_per_cm;
    if (material->kind == SKG_MATTER_TABLE) return table_value(material, energy_kev, per_cm);
    if (material->kind == SKG_MATTER_COMPOSITION && !(material->density > 0))
        return skg_fail(SKG_ERR_MATERIAL, "%s: its density is not known; give one in g/cm3", material->name);
    return SKG_OK;
}

skg_status skg_material_attenuation_get(const skg_material *material, double energy_kev, double *per_cm) {
    SKG_PLAIN;
    SKG_NEEDS(material);
    SKG_NEEDS(per_cm);
    SKG_TRY(check(material, energy_kev, per_cm));
    if (material->kind != SKG_MATTER_COMPOSITION) return SKG_OK;
    double sections[SKG_PROCESSES];
    skg_mixed_sections(material->count, material->parts, energy_kev, sections);
    *per_cm = material->density * skg_total_section(sections);
    return SKG_OK;
}

static skg_status tabulate_element(int32_t z, skg_section_table *table) {
    if (table->of_element[z]) return SKG_OK;
    SKG_TRY(skg_alloc(table->count, sizeof *table->of_element[z], "cross sections", &table->of_element[z]));
    for (int64_t n = 0; n < table->count; n++)
        skg_element_sections(z, table->energy_kev[n], table->of_element[z][n]);
    return SKG_OK;
}

skg_status skg_attenuation_tabulate(const skg_material *material, skg_section_table *table, double *per_cm) {
    for (int64_t n = 0; n < table->count; n++) SKG_TRY(check(material, table->energy_kev[n], &per_cm[n]));
    if (material->kind != SKG_MATTER_COMPOSITION) return SKG_OK;
    for (int64_t i = 0; i < material->count; i++) SKG_TRY(tabulate_element(material->parts[i].z, table));
    for (int64_t n = 0; n < table->count; n++) {
        double sections[SKG_PROCESSES] = {0};
        for (int64_t i = 0; i < material->count; i++)
            skg_add_sections(&material->parts[i], table->of_element[material->parts[i].z][n], sections);
        per_cm[n] = material->density * skg_total_section(sections);
    }
    return SKG_OK;
}

void skg_section_table_release(skg_section_table *table) {
    for (int32_t z = 0; z <= SKG_LAST_ELEMENT; z++) skg_free(&table->of_element[z]);
}

void skg_coefficients_init_sized(void *coefficients, int32_t size) {
    const skg_coefficients defaults = {0};
    skg_struct_init(coefficients, size, &defaults, sizeof defaults);
}

skg_status skg_material_coefficients_get(const skg_material *material, double energy_kev,
                                         skg_coefficients *coefficients) {
    SKG_PLAIN;
    SKG_NEEDS(material);
    SKG_NEEDS(coefficients);
    if (material->kind != SKG_MATTER_COMPOSITION)
        return skg_fail(SKG_ERR_MATERIAL,
                        "%s: a material given by its linear attenuation coefficient has no mass coefficients",
                        material->name);
    SKG_TRY(skg_check_energy(material->name, energy_kev));
    double sections[SKG_PROCESSES];
    skg_mixed_sections(material->count, material->parts, energy_kev, sections);
    skg_coefficients ours;
    skg_coefficients_init(&ours);
    ours.rayleigh = sections[SKG_RAYLEIGH];
    ours.compton = sections[SKG_COMPTON];
    ours.photo = sections[SKG_PHOTO];
    ours.pair = sections[SKG_PAIR];
    ours.total = skg_total_section(sections);
    return skg_struct_write(&ours, sizeof ours, "skg_coefficients", coefficients);
}

skg_status skg_material_hounsfield_get(const skg_material *material, double energy_kev, double *hu) {
    SKG_PLAIN;
    double mu = 0, sections[SKG_PROCESSES];
    SKG_NEEDS(hu);
    SKG_TRY(skg_material_attenuation_get(material, energy_kev, &mu));
    skg_mixed_sections(2, water, energy_kev, sections);
    *hu = 1000 * (mu / skg_total_section(sections) - 1);
    return SKG_OK;
}

static int by_energy(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Appends an edge. Those beyond `most` are counted only. */
static void add_edge(double energy_kev, int64_t most, double *edges, int64_t *count) {
    if (energy_kev < SKG_LOWEST_KEV || energy_kev > SKG_HIGHEST_KEV) return;
    if (*count < most) edges[*count] = energy_kev;
    ++*count;
}

skg_status skg_material_edges_get(const skg_material *material, int64_t capacity, double *edges_kev,
                                  int64_t *count) {
    SKG_NEEDS(material);
    SKG_NEEDS(count);
    if (capacity > 0) SKG_NEEDS(edges_kev);
    if (capacity < 0)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_material_edges_get: a capacity of %" PRId64 " edges; give at least 0", capacity);
    *count = 0;
    if (material->kind == SKG_MATTER_TABLE)
        for (int64_t i = 1; i < material->count; i++)
            if (!(material->energy_kev[i] > material->energy_kev[i - 1]))
                add_edge(material->energy_kev[i], capacity, edges_kev, count);
    if (material->kind == SKG_MATTER_COMPOSITION)
        for (int64_t k = 0; k < material->count; k++) {
            const skg_element_row *element = &skg_elements[material->parts[k].z];
            for (int32_t i = element->first + 1; i < element->last; i++)
                if (!(skg_knots[i].energy_kev > skg_knots[i - 1].energy_kev))
                    add_edge(skg_knots[i].energy_kev, capacity, edges_kev, count);
        }
    if (capacity > 0)
        qsort(edges_kev, (size_t)(*count < capacity ? *count : capacity), sizeof *edges_kev, by_energy);
    return SKG_OK;
}
