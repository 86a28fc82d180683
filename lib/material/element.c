/* Cross sections of the elements at any energy. */
#include "core/text.h"
#include "material/material.h"
#include "materials/spline.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

skg_status skg_check_energy(const char *name, double energy_kev) {
    if (energy_kev >= SKG_LOWEST_KEV && energy_kev <= SKG_HIGHEST_KEV) return SKG_OK;
    return skg_fail(SKG_ERR_MATERIAL,
                    "%s: a photon energy of %g keV lies outside the cross sections' %g to %g keV", name,
                    energy_kev, SKG_LOWEST_KEV, SKG_HIGHEST_KEV);
}

/* The last knot at or below the energy. At an edge this is the knot above it. */
static const skg_knot *find_knot(int32_t z, double energy_kev) {
    int32_t low = skg_elements[z].first, high = skg_elements[z].last - 1;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (skg_knots[middle].energy_kev <= energy_kev)
            low = middle;
        else
            high = middle;
    }
    return &skg_knots[low];
}

void skg_element_sections(int32_t z, double energy_kev, double sections[SKG_PROCESSES]) {
    const skg_knot *a = find_knot(z, energy_kev), *b = a + 1;
    double t = log(energy_kev);
    for (int p = 0; p < SKG_PROCESSES; p++) {
        double y[2] = {a->value[p], b->value[p]}, d[2] = {a->second[p], b->second[p]};
        sections[p] = exp(skg_spline_value(t, a->log_energy, b->log_energy, y, d));
    }
    double left = 1 - SKG_PAIR_THRESHOLD_KEV / energy_kev;
    sections[SKG_PAIR] = left > 0 ? sections[SKG_PAIR] * left * left * left : 0;
}

void skg_add_sections(const skg_mass_fraction *part, const double own[SKG_PROCESSES],
                      double sections[SKG_PROCESSES]) {
    for (int p = 0; p < SKG_PROCESSES; p++) sections[p] += part->fraction * own[p];
}

void skg_mixed_sections(int64_t count, const skg_mass_fraction *parts, double energy_kev,
                        double sections[SKG_PROCESSES]) {
    for (int p = 0; p < SKG_PROCESSES; p++) sections[p] = 0;
    for (int64_t i = 0; i < count; i++) {
        double own[SKG_PROCESSES];
        skg_element_sections(parts[i].z, energy_kev, own);
        skg_add_sections(&parts[i], own, sections);
    }
}

/* Whether `name` is one of the `names` that ';' separates, without regard to case. */
static int one_of(const char *names, const char *name) {
    size_t length = strlen(name);
    for (const char *start = names; *start;) {
        size_t own = strcspn(start, ";");
        size_t k = 0;
        while (k < own && k < length && tolower((unsigned char)start[k]) == tolower((unsigned char)name[k]))
            k++;
        if (own == length && k == own) return 1;
        start += own + (start[own] == ';');
    }
    return 0;
}

int32_t skg_find_element(const char *text) {
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        if (strcmp(skg_elements[z].symbol, text) == 0 || one_of(skg_elements[z].names, text)) return z;
    return 0;
}

static skg_status check_number(int32_t z) {
    if (z >= 1 && z <= SKG_LAST_ELEMENT) return SKG_OK;
    return skg_fail(SKG_ERR_MATERIAL, "atomic number %d: elements 1 (H) to %d (U) are known", (int)z,
                    SKG_LAST_ELEMENT);
}

skg_status skg_element_symbol_get(int32_t z, const char **symbol) {
    SKG_NEEDS(symbol);
    *symbol = NULL;
    SKG_TRY(check_number(z));
    *symbol = skg_elements[z].symbol;
    return SKG_OK;
}

skg_status skg_element_names_get(int32_t z, const char **names) {
    SKG_NEEDS(names);
    *names = NULL;
    SKG_TRY(check_number(z));
    *names = skg_elements[z].names;
    return SKG_OK;
}

skg_status skg_element_number_get(const char *text, int32_t *z) {
    SKG_NEEDS(text);
    SKG_NEEDS(z);
    *z = skg_find_element(text);
    if (*z) return SKG_OK;
    char *end = NULL;
    long number = strtol(text, &end, 10);
    if (end != text && *end == '\0' && number >= 1 && number <= SKG_LAST_ELEMENT) {
        *z = (int32_t)number;
        return SKG_OK;
    }
    const char *names[2 * SKG_LAST_ELEMENT];
    for (int32_t i = 0; i < SKG_LAST_ELEMENT; i++) {
        names[2 * i] = skg_elements[i + 1].symbol;
        names[2 * i + 1] = skg_elements[i + 1].names;
        if (skg_same_name(text, names[2 * i])) /* only the case is wrong, as in "fe" */
            return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no element; did you mean %s?", text, names[2 * i]);
    }
    const char *near = skg_nearest_name(text, names, sizeof names / sizeof *names);
    return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no element from H (1) to U (92)%s%s%s", text,
                    near ? "; did you mean " : "", near ? near : "", near ? "?" : "");
}
