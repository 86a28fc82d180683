/* Materials by a text as people write it: a name, a formula, or "key:value". */
#include "core/files.h"
#include "core/text.h"
#include "material/mixture.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static skg_status from_row(const skg_mixture_row *row, skg_material **material) {
    char name[SKG_LONGEST_NAME];
    skg_mixture_name(row, name);
    return skg_material_compose(name, row->source, row->count, skg_mass_fractions + row->first, row->density,
                                material);
}

static skg_status fail_unknown(const char *text, const char *formula_error) {
    char near[SKG_LONGEST_NAME], why[SKG_LONGEST_NAME];
    snprintf(why, sizeof why, "%s", formula_error);
    SKG_TRY(skg_nearest_material(text, near));
    if (*near)
        return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no material that is known; did you mean \"%s\"?", text,
                        near);
    return skg_fail(SKG_ERR_MATERIAL,
                    "\"%s\" is no material that is known (%s); give an element, a formula (H2O), weight:..., "
                    "HU:..., mu:... or a name of the tables",
                    text, why);
}

/* The mass attenuation coefficient at 80 keV, cm2/g, by which messages tell two readings of a text apart. */
static double total_at_80(int64_t count, const skg_mass_fraction *parts) {
    double section[SKG_PROCESSES], total = 0;
    skg_mixed_sections(count, parts, 80, section);
    for (int p = 0; p < SKG_PROCESSES; p++) total += section[p];
    return total;
}

/* Parts by mass in percent sum to 100; one more or less is allowed for numbers that are rounded. */
static const double PERCENT = 100, PERCENT_MARGIN = 1;

/* A formula whose numbers sum to 100 is usually meant by mass. It is refused, and the message gives both readings. */
static skg_status check_reading(const char *text, double sum, int64_t count, const skg_mass_fraction *atoms) {
    skg_mass_fraction by_mass[SKG_LAST_ELEMENT];
    double ignored = 0;
    int64_t same = 0;
    if (count < 2 || !(fabs(sum - PERCENT) <= PERCENT_MARGIN)) return SKG_OK;
    SKG_TRY(skg_read_formula(text, 1, &same, by_mass, &ignored));
    return skg_fail(SKG_ERR_MATERIAL,
                    "\"%s\" can be read by atoms (mu/rho %.5g cm2/g at 80 keV) or by mass (%.5g); its "
                    "numbers sum to %g: write weight:%s for the latter",
                    text, total_at_80(count, atoms), total_at_80(same, by_mass), sum, text);
}

/* "Ti6Al4V" counts atoms as a formula, but is also how people write the alloy Ti-6Al-4V, whose numbers are parts by mass. */
static skg_status check_alloy(const char *text, const skg_mixture_row *row) {
    skg_mass_fraction atoms[SKG_LAST_ELEMENT];
    char name[SKG_LONGEST_NAME];
    double sum = 0;
    int64_t count = 0;
    if (!skg_lacks_hyphens(row, text)) return SKG_OK;
    if (skg_read_formula(text, 0, &count, atoms, &sum) != SKG_OK) return SKG_OK;
    skg_mixture_name(row, name);
    return skg_fail(
        SKG_ERR_MATERIAL,
        "\"%s\" can be read as a formula that counts atoms (mu/rho %.5g cm2/g at 80 keV) or as \"%s\" (%.5g): "
        "write that name for the alloy, or [\"Compound\", \"%s\"] with a density for the formula",
        text, total_at_80(count, atoms), name, total_at_80(row->count, skg_mass_fractions + row->first),
        text);
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
    if (count > 1 && !(fabs(sum - PERCENT) <= PERCENT_MARGIN))
        return skg_fail(SKG_ERR_MATERIAL, "weight:%s: the parts by mass sum to %g; they have to sum to 100",
                        text, sum);
    const skg_mixture_row *known = skg_find_mixture(text);
    const double density = count == 1 ? skg_elements[parts[0].z].density
                           : known    ? known->density
                                      : skg_mixture_density(count, parts);
    return skg_material_compose(text, "parts by mass", count, parts, density, material);
}

/* The digits below the line (U+2080 to U+2089) are written on it. */
static int lift_digits(const char *text, char plain[SKG_LONGEST_NAME]) {
    size_t length = 0;
    int found = 0;
    for (; *text && length + 1 < SKG_LONGEST_NAME; text++) {
        const unsigned char *c = (const unsigned char *)text;
        const int is_below = c[0] == 0xE2 && c[1] == 0x82 && c[2] >= 0x80 && c[2] <= 0x89;
        plain[length++] = is_below ? (char)('0' + (c[2] - 0x80)) : *text;
        if (is_below) text += 2, found = 1;
    }
    plain[length] = '\0';
    return found && !*text;
}

/* Letters that are a formula to a program and a plastic to everybody else. */
static const char *const plastics[][2] = {{"PB", "polybutylene"},   {"PC", "polycarbonate"},
                                          {"PF", "phenolic resin"}, {"PI", "polyimide"},
                                          {"PS", "polystyrene"},    {"PU", "polyurethane"}};

/* Refuses names that read as a formula and are hardly ever meant as one. */
static skg_status check_meaning(const char *text) {
    const char *bracket = strrchr(text, '(');
    const size_t length = strlen(text);
    for (size_t i = 0; i < sizeof plastics / sizeof *plastics; i++)
        if (strcmp(text, plastics[i][0]) == 0)
            return skg_fail(
                SKG_ERR_MATERIAL,
                "\"%s\" is ambiguous: a formula of two elements, or %s; write that name, its formula with a density, or "
                "[\"Compound\", \"%s1\"]",
                text, plastics[i][1], text);
    if (!bracket || bracket == text || text[length - 1] != ')' || length - (size_t)(bracket - text) > 4)
        return SKG_OK;
    char symbol[4] = "";
    memcpy(symbol, bracket + 1, length - (size_t)(bracket - text) - 2);
    if (!skg_find_element(symbol)) return SKG_OK;
    return skg_fail(
        SKG_ERR_MATERIAL,
        "\"%s\" is ambiguous: as a formula it has a whole atom of %s for each %.*s; leave a dopant out (%.*s), or give "
        "it a number, as in %s0.001",
        text, symbol, (int)(bracket - text), text, (int)(bracket - text), text, text);
}

/* The text behind "key:"; NULL if the text does not begin with it. */
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
    SKG_PLAIN;
    char list[SKG_NAME_SUGGESTIONS * SKG_LONGEST_NAME], lifted[SKG_LONGEST_NAME];
    const char *rest;
    double value = 0;
    SKG_NEEDS(material);
    *material = NULL;
    if (!text || !*text) return skg_fail(SKG_ERR_MATERIAL, "a material without a name; give H2O, Fe, HU:52");
    if (lift_digits(text, lifted)) text = lifted;
    if ((rest = after(text, "weight"))) return from_mass(rest, material);
    if ((rest = after(text, "hu"))) {
        SKG_TRY(number_of(text, rest, &value));
        return skg_material_create_hounsfield(value, material);
    }
    if ((rest = after(text, "mu"))) {
        SKG_TRY(number_of(text, rest, &value));
        return skg_material_create_mu(text, value, material);
    }
    if ((rest = after(text, "solution"))) {
        char solute[128];
        const char *colon = strrchr(rest, ':');
        if (!colon || colon == rest || (size_t)(colon - rest) >= sizeof solute)
            return skg_fail(SKG_ERR_MATERIAL,
                            "\"%s\": give solution:SOLUTE:MG_PER_ML, such as solution:Iodine:300", text);
        snprintf(solute, sizeof solute, "%.*s", (int)(colon - rest), rest);
        SKG_TRY(number_of(text, colon + 1, &value));
        return skg_material_create_solution(solute, value, material);
    }
    if (skg_same_name(text, "vacuum")) return skg_material_create_mu("Vacuum", 0, material);
    int32_t z = skg_find_element(text);
    if (z) return skg_material_create_element(z, material);
    const skg_mixture_row *row = skg_find_mixture(text);
    if (row) SKG_TRY(check_alloy(text, row));
    if (row) return from_row(row, material);
    SKG_TRY(check_meaning(text));
    skg_status status = from_formula(text, material);
    if (status == SKG_OK || (status != SKG_ERR_MATERIAL) || strstr(skg_last_error(), "weight:") ||
        strstr(skg_last_error(), "is ambiguous"))
        return status;
    int found = skg_find_mixtures(text, &row, list, sizeof list);
    if (found == 1) return from_row(row, material);
    if (found > 1)
        return skg_fail(SKG_ERR_MATERIAL, "\"%s\" fits %d materials: %s%s; name one", text, found, list,
                        found > SKG_NAME_SUGGESTIONS ? " and others" : "");
    return fail_unknown(text, skg_last_error());
}

/* Finds the solute: an element, a formula or a name of the tables, with a density. */
static skg_status find_solute(const char *name, skg_material **solute) {
    SKG_TRY(skg_material_create_named(name, solute));
    if ((*solute)->kind == SKG_MATTER_COMPOSITION && (*solute)->density > 0) return SKG_OK;
    skg_material_release(solute);
    return skg_fail(
        SKG_ERR_MATERIAL,
        "solution of %s: its density is not known, so that the volume that it takes is not; name an element or a "
        "compound of the tables, such as Iodine or NaI",
        name);
}

skg_status skg_material_create_solution(const char *solute, double mg_ml, skg_material **material) {
    SKG_PLAIN;
    skg_material *found = NULL;
    SKG_NEEDS(material);
    *material = NULL;
    SKG_NEEDS(solute);
    if (!(mg_ml > 0) || isinf(mg_ml))
        return skg_fail(SKG_ERR_MATERIAL, "solution of %s: %g mg/ml; give an amount above 0", solute, mg_ml);
    SKG_TRY(find_solute(solute, &found));
    const skg_status status = skg_material_dissolve(solute, found, mg_ml / 1000, material);
    skg_material_release(&found);
    return status;
}
