/* Materials as people write them. */
#include "core/columns.h"
#include "core/names.h"
#include "material/material.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 256, SUGGESTIONS = 6, MOST_NAMES = 1024 };

/* Letters and digits only, in lower case: "Bone, cortical" and "bone cortical" are one name. */
static void plain(const char *text, size_t length, char *out) {
    size_t used = 0;
    for (size_t i = 0; i < length && used + 1 < LONGEST; i++)
        if (isalnum((unsigned char)text[i])) out[used++] = (char)tolower((unsigned char)text[i]);
    out[used] = '\0';
}

/* Copies the k-th of names separated by ';'; 0 where there is none. */
static int name_at(const char *names, int k, char *out) {
    for (; k > 0; k--) {
        names = strchr(names, ';');
        if (!names) return 0;
        names++;
    }
    while (*names == ' ') names++;
    size_t length = strcspn(names, ";");
    if (length >= LONGEST) length = LONGEST - 1;
    memcpy(out, names, length);
    out[length] = '\0';
    return 1;
}

const skg_mixture_row *skg_find_mixture(const char *name) {
    char wanted[LONGEST], one[LONGEST], own[LONGEST];
    plain(name, strlen(name), wanted);
    if (!*wanted) return NULL;
    for (int32_t i = 0; i < skg_mixture_count; i++)
        for (int k = 0; name_at(skg_mixtures[i].names, k, one); k++) {
            plain(one, strlen(one), own);
            if (strcmp(own, wanted) == 0) return &skg_mixtures[i];
        }
    return NULL;
}

/* Whether the text begins with these letters; hyphens in it are read past: icru44 begins ICRU-44. */
static int begins(const char *text, const char *word, size_t length) {
    for (; length > 0; text++) {
        if (*text == '-') continue;
        if (tolower((unsigned char)*text) != tolower((unsigned char)*word)) return 0;
        word++, length--;
    }
    return 1;
}

/* Whether every word of the query begins a word of the names. */
static int has_words(const char *names, const char *query) {
    for (const char *word = query; *word;) {
        while (*word && !isalnum((unsigned char)*word)) word++;
        size_t length = 0;
        while (isalnum((unsigned char)word[length])) length++;
        if (length == 0) break;
        int found = 0;
        for (const char *c = names; *c && !found; c++) {
            int start = c == names || !isalnum((unsigned char)c[-1]);
            found = start && begins(c, word, length);
        }
        if (!found) return 0;
        word += length;
    }
    return 1;
}

/* How many mixtures have all words of the query; the last of them, and a list of the first few names. */
static int find_by_words(const char *query, const skg_mixture_row **row, char *list, size_t size) {
    int found = 0;
    size_t used = 0;
    char name[LONGEST];
    list[0] = '\0';
    for (int32_t i = 0; i < skg_mixture_count; i++) {
        if (!has_words(skg_mixtures[i].names, query)) continue;
        *row = &skg_mixtures[i];
        if (found++ < SUGGESTIONS && name_at(skg_mixtures[i].names, 0, name) && used < size) {
            int wrote = snprintf(list + used, size - used, "%s\"%s\"", found > 1 ? ", " : "", name);
            used += wrote > 0 ? (size_t)wrote : 0;
        }
    }
    return found;
}

/* The nearest of all names of mixtures and elements. */
static skg_status nearest(const char *text, char *near) {
    char(*names)[LONGEST] = NULL;
    const char **list = NULL;
    skg_status status = SKG_OK;
    int64_t count = 0;
    near[0] = '\0';
    SKG_TRY_CLEANUP(skg_alloc(MOST_NAMES, sizeof *names, "names", &names));
    SKG_TRY_CLEANUP(skg_alloc(MOST_NAMES, sizeof *list, "names", &list));
    for (int32_t i = 0; i < skg_mixture_count; i++)
        for (int k = 0; count < MOST_NAMES && name_at(skg_mixtures[i].names, k, names[count]); k++) count++;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int k = 0; count < MOST_NAMES && name_at(skg_elements[z].names, k, names[count]); k++) count++;
    for (int64_t i = 0; i < count; i++) list[i] = names[i];
    const char *found = skg_nearest_name(text, list, count);
    if (found) snprintf(near, LONGEST, "%s", found);
cleanup:
    skg_free(&names);
    skg_free(&list);
    return status;
}

static skg_status from_row(const skg_mixture_row *row, skg_material **material) {
    char name[LONGEST];
    name_at(row->names, 0, name);
    return skg_material_compose(name, row->source, row->count, skg_mass_fractions + row->first, row->density,
                                material);
}

static skg_status fail_unknown(const char *text, const char *formula_error) {
    char near[LONGEST], why[LONGEST];
    snprintf(why, sizeof why, "%s", formula_error);
    SKG_TRY(nearest(text, near));
    if (*near)
        return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no material that is known; did you mean \"%s\"?", text,
                        near);
    return skg_fail(SKG_ERR_MATERIAL,
                    "\"%s\" is no material that is known (%s); give an element, a formula (H2O), weight:..., "
                    "HU:..., mu:... or a name of the tables",
                    text, why);
}

/* A bare formula whose numbers sum to 100 is as a rule meant by mass: both readings are told. */
static skg_status check_reading(const char *text, double sum, int64_t count, const skg_mass_fraction *atoms) {
    skg_mass_fraction by_mass[SKG_LAST_ELEMENT];
    double ignored = 0, a[SKG_PROCESSES], m[SKG_PROCESSES];
    int64_t same = 0;
    if (count < 2 || !(fabs(sum - 100) <= 1)) return SKG_OK;
    SKG_TRY(skg_read_formula(text, 1, &same, by_mass, &ignored));
    skg_mixed_sections(count, atoms, 80, a);
    skg_mixed_sections(same, by_mass, 80, m);
    for (int p = 1; p < SKG_PROCESSES; p++) a[0] += a[p], m[0] += m[p];
    return skg_fail(SKG_ERR_MATERIAL,
                    "\"%s\" can be read by atoms (mu/rho %.5g cm2/g at 80 keV) or by mass (%.5g); its "
                    "numbers sum to %g: write weight:%s for the latter",
                    text, a[0], m[0], sum, text);
}

static skg_status from_formula(const char *text, skg_material **material) {
    skg_mass_fraction parts[SKG_LAST_ELEMENT];
    int64_t count = 0;
    double sum = 0;
    SKG_TRY(skg_read_formula(text, 0, &count, parts, &sum));
    SKG_TRY(check_reading(text, sum, count, parts));
    return skg_material_create_formula(text, 0, material);
}

static skg_status from_mass(const char *text, skg_material **material) {
    skg_mass_fraction parts[SKG_LAST_ELEMENT];
    int64_t count = 0;
    double sum = 0;
    SKG_TRY(skg_read_formula(text, 1, &count, parts, &sum));
    if (count > 1 && !(fabs(sum - 100) <= 1))
        return skg_fail(SKG_ERR_MATERIAL, "weight:%s: the parts by mass sum to %g; they have to sum to 100",
                        text, sum);
    const skg_mixture_row *known = skg_find_mixture(text);
    double density = count == 1 ? skg_elements[parts[0].z].density : known ? known->density : 0;
    return skg_material_compose(text, "parts by mass", count, parts, density, material);
}

/* The text after "key:" or NULL. */
static const char *after(const char *text, const char *key) {
    size_t length = strlen(key);
    for (size_t i = 0; i < length; i++)
        if (tolower((unsigned char)text[i]) != key[i]) return NULL;
    return text[length] == ':' ? text + length + 1 : NULL;
}

static skg_status number_of(const char *text, const char *digits, double *value) {
    const char *end = NULL;
    *value = skg_read_number(digits, &end);
    if (end == digits || *end || !isfinite(*value))
        return skg_fail(SKG_ERR_MATERIAL, "\"%s\": \"%s\" is no number", text, digits);
    return SKG_OK;
}

skg_status skg_material_create_named(const char *text, skg_material **material) {
    char list[SUGGESTIONS * LONGEST];
    const char *rest;
    double value = 0;
    SKG_NEEDS(material);
    *material = NULL;
    if (!text || !*text) return skg_fail(SKG_ERR_MATERIAL, "a material without a name; give H2O, Fe, HU:52");
    if ((rest = after(text, "weight"))) return from_mass(rest, material);
    if ((rest = after(text, "hu"))) {
        SKG_TRY(number_of(text, rest, &value));
        return skg_material_create_hounsfield(value, material);
    }
    if ((rest = after(text, "mu"))) {
        SKG_TRY(number_of(text, rest, &value));
        return skg_material_create_mu(text, value, material);
    }
    int32_t z = skg_find_element(text);
    if (z) return skg_material_create_element(z, material);
    const skg_mixture_row *row = skg_find_mixture(text);
    if (row) return from_row(row, material);
    skg_status status = from_formula(text, material);
    if (status == SKG_OK || (status != SKG_ERR_MATERIAL) || strstr(skg_last_error(), "weight:"))
        return status;
    int found = find_by_words(text, &row, list, sizeof list);
    if (found == 1) return from_row(row, material);
    if (found > 1)
        return skg_fail(SKG_ERR_MATERIAL, "\"%s\" fits %d materials: %s%s; name one", text, found, list,
                        found > SUGGESTIONS ? " and others" : "");
    return fail_unknown(text, skg_last_error());
}

skg_status skg_material_tabled_count(int64_t *count) {
    SKG_NEEDS(count);
    *count = skg_mixture_count;
    return SKG_OK;
}

skg_status skg_material_tabled_get(int64_t index, const char **name, double *density) {
    SKG_NEEDS(name);
    SKG_NEEDS(density);
    if (index < 0 || index >= skg_mixture_count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_material_tabled_get: no entry %lld", (long long)index);
    *name = skg_mixtures[index].names;
    *density = skg_mixtures[index].density;
    return SKG_OK;
}
