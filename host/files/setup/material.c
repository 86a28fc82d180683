/* The key Material of a sample, and of everything else that has one. */
#include "material/material.h"
#include "core/context.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const char *const example = "[\"mu\", 0.2], [\"Compound\", \"H2O\"] or a name such as \"Water\"";

/* A number, or a string with a number, as gVXR's exporter writes it. */
static skg_status read_mu(const skg_json_node *node, double *per_cm) {
    if (!json_is_string(node->value)) return skg_json_number(node, per_cm);
    const char *text = json_string_value(node->value);
    json_t *number = json_loads(text, JSON_DECODE_ANY, NULL);
    int usable = json_is_number(number);
    *per_cm = usable ? json_number_value(number) : 0;
    json_decref(number);
    if (usable) return SKG_OK;
    return skg_json_fail(node, SKG_ERR_FORMAT, "\"%s\" is no number; give mu in 1/cm", text);
}

/* 26, "Fe" or "Iron". */
static skg_status read_z(const skg_json_node *node, int32_t *z) {
    const char *text = NULL;
    if (json_is_integer(node->value)) {
        int64_t number = 0;
        SKG_TRY(skg_json_integer(node, 1, 92, &number));
        *z = (int32_t)number;
        return SKG_OK;
    }
    SKG_TRY(skg_json_text(node, &text));
    skg_status status = skg_element_number_get(text, z);
    return skg_json_at(node, status);
}

static skg_status read_named(const skg_json_node *node, const char *before, skg_material **material) {
    char text[512];
    const char *name = NULL;
    SKG_TRY(skg_json_text(node, &name));
    if (strlen(before) + strlen(name) >= sizeof text)
        return skg_json_fail(node, SKG_ERR_FORMAT, "is too long for a material");
    strcpy(text, before);
    strcat(text, name);
    skg_status status = skg_material_create_named(text, material);
    return skg_json_at(node, status);
}

static skg_status read_element(const skg_json_node *node, skg_material **material) {
    int32_t z = 0;
    SKG_TRY(read_z(node, &z));
    return skg_material_create_element(z, material);
}

/* Logs the note of a material. */
static skg_status tell_note(skg_setup_reader *reader, const skg_json_node *node,
                            const skg_material *material) {
    const char *note = NULL;
    char place[256];
    SKG_TRY(skg_material_note_get(material, &note));
    if (!*note) return SKG_OK;
    skg_json_place(node, place, sizeof place);
    skg_logger_say(&reader->log, SKG_LOG_NOTE, "%s: %s", place, note);
    return SKG_OK;
}

/* Read leniently, fractions may sum to anything above 0, such as 100; they are scaled to 1. */
static skg_status scale_fractions(const skg_json_node *node, int64_t count, double *fractions) {
    /* Sums within this of 1 are scaled in any case, with a note of the material's own (skg_material_create_mixture). */
    const double close = 5e-3;
    double sum = 0;
    for (int64_t i = 0; i < count; i++) sum += fractions[i];
    if (!(sum > 0) || fabs(sum - 1) <= close || !isfinite(sum)) return SKG_OK;
    if (!node->file->lenient)
        return skg_json_fault(node, SKG_ERR_MATERIAL,
                              "the fractions by mass sum to %.6g; they have to sum to 1 within %g", sum,
                              close);
    for (int64_t i = 0; i < count; i++) fractions[i] /= sum;
    return skg_json_remark(node, "the fractions by mass sum to %g; they are scaled to 1", sum);
}

/* [1, 0.112, 8, 0.888]: elements and fractions by mass. */
static skg_status read_fractions(skg_setup_reader *reader, const skg_json_node *node, const char *label,
                                 skg_material **material) {
    enum { LIMIT = 2 * 92 };
    int32_t z[LIMIT / 2];
    double fractions[LIMIT / 2];
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, "[1, 0.112, 8, 0.888]", &count));
    if (count % 2 != 0 || count > LIMIT)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "has %" PRId64 " elements; give pairs of an element and its fraction by mass: "
                             "[1, 0.112, 8, 0.888]",
                             count);
    for (int64_t i = 0; i < count; i += 2) {
        skg_json_node element = skg_json_element(node, i), fraction = skg_json_element(node, i + 1);
        SKG_TRY(read_z(&element, &z[i / 2]));
        SKG_TRY(skg_json_number(&fraction, &fractions[i / 2]));
    }
    SKG_TRY(scale_fractions(node, count / 2, fractions));
    skg_status status = skg_material_create_mixture(label, count / 2, z, fractions, 0, material);
    SKG_TRY(skg_json_at(node, status));
    return tell_note(reader, node, *material);
}

/* A chemical formula, or a name of the material tables. */
static skg_status read_compound(const skg_json_node *node, skg_material **material) {
    const char *formula = NULL;
    SKG_TRY(skg_json_text(node, &formula));
    if (skg_material_create_formula(formula, 0, material) == SKG_OK) return SKG_OK;
    return read_named(node, "", material);
}

static skg_status read_hounsfield(skg_setup_reader *reader, const skg_json_node *node,
                                  skg_material **material) {
    double hu = 0;
    SKG_TRY(skg_json_number(node, &hu));
    skg_status status = skg_material_create_hounsfield(hu, material);
    SKG_TRY(skg_json_at(node, status));
    if (hu <= SKG_HOUNSFIELD_TABLED || reader->noted_beyond_table) return SKG_OK;
    reader->noted_beyond_table = 1;
    return tell_note(reader, node, *material);
}

/* ["Table", "mu.txt", "keV"] */
static skg_status read_table(skg_setup_reader *reader, const skg_json_node *path_node,
                             const skg_json_node *unit_node, skg_material **material) {
    const char *name = NULL, *path = NULL, *unit = NULL;
    SKG_TRY(skg_json_text(path_node, &name));
    SKG_TRY(skg_json_text(unit_node, &unit));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    return skg_json_at(path_node, skg_material_load_table(path, unit, material));
}

/* ["Solution", "Iodine", 300, "mg/ml"] */
static skg_status read_solution(skg_setup_reader *reader, const skg_json_node *node, int64_t count,
                                skg_material **material) {
    static const char *const units[] = {"mg/ml", "g/l", "g/ml", "kg/l"};
    static const double mg_ml[] = {1, 1, 1000, 1000};
    const char *solute = NULL;
    double amount = 0;
    int64_t unit = 0;
    if (count != 4)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "has %" PRId64 " elements; give [\"Solution\", \"Iodine\", 300, \"mg/ml\"]",
                             count);
    const skg_json_node name = skg_json_element(node, 1), number = skg_json_element(node, 2),
                        word = skg_json_element(node, 3);
    SKG_TRY(skg_json_text(&name, &solute));
    SKG_TRY(skg_json_number(&number, &amount));
    SKG_TRY(skg_json_choice(&word, "unit of a solution", units, 4, &unit));
    SKG_TRY(skg_json_at(node, skg_material_create_solution(solute, amount * mg_ml[unit], material)));
    return tell_note(reader, node, *material);
}

/* The material without the density that the sample gives. */
static skg_status read_kind(skg_setup_reader *reader, const skg_json_node *node, const char *label,
                            skg_material **material) {
    enum { MU, ELEMENT, MIXTURE, COMPOUND, HU, TABLE, SOLUTION, KINDS };
    static const char *const kinds[KINDS] = {"mu", "Element", "Mixture", "Compound",
                                             "HU", "Table",   "Solution"};
    int64_t count = 0, kind = 0;
    double per_cm = 0;
    if (json_is_string(node->value)) return read_named(node, "", material);
    SKG_TRY(skg_json_array(node, example, &count));
    skg_json_node name = skg_json_element(node, 0), value = skg_json_element(node, 1);
    skg_json_node unit = skg_json_element(node, 2);
    SKG_TRY(skg_json_choice(&name, "kind of material", kinds, KINDS, &kind));
    if (kind == SOLUTION) return read_solution(reader, node, count, material);
    if (count != (kind == TABLE ? 3 : 2))
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " elements; give %s", count,
                             kind == MU      ? "[\"mu\", 0.2], in 1/cm"
                             : kind == TABLE ? "[\"Table\", \"mu.txt\", \"keV\"]"
                                             : example);
    if (kind == ELEMENT) return read_element(&value, material);
    if (kind == MIXTURE && json_is_string(value.value)) return read_named(&value, "weight:", material);
    if (kind == MIXTURE) return read_fractions(reader, &value, label, material);
    if (kind == COMPOUND) return read_compound(&value, material);
    if (kind == HU) return read_hounsfield(reader, &value, material);
    if (kind == TABLE) return read_table(reader, &value, &unit, material);
    SKG_TRY(read_mu(&value, &per_cm));
    skg_status status = skg_material_create_mu(label, per_cm, material);
    return skg_json_at(&value, status);
}

/* g/cm3, rounded up: of osmium, the densest element. */
static const double DENSEST = 22.7;

skg_status skg_setup_read_material(skg_setup_reader *reader, const skg_json_node *node,
                                   const skg_json_node *density, const char *label, skg_material **material) {
    double g_cm3 = 0, known = 0;
    skg_material *made = NULL;
    int64_t elements = 0;
    skg_status status = SKG_OK;
    if (density->value) SKG_TRY(skg_json_number(density, &g_cm3));
    if (density->value && !(g_cm3 > 0))
        return skg_json_fail(density, SKG_ERR_MATERIAL, "is %g; a density in g/cm3 is above 0", g_cm3);
    if (g_cm3 > DENSEST)
        SKG_TRY(skg_json_remark(density, "is more than anything has (osmium: 22.6 g/cm3); is it in kg/m3?"));
    SKG_TRY(read_kind(reader, node, label, &made));
    SKG_TRY_CLEANUP(skg_material_element_count(made, &elements));
    SKG_TRY_CLEANUP(skg_material_density_get(made, &known));
    /* A material without elements is given by its attenuation, which no density changes. */
    if (elements == 0 || (known > 0 && !density->value)) {
        *material = made;
        return SKG_OK;
    }
    if (density->value)
        status = skg_material_create_at_density(made, g_cm3, material);
    else
        status = skg_json_fail(node, SKG_ERR_MATERIAL,
                               "its density is not known; give \"Density\", in g/cm3, beside it");
cleanup:
    skg_material_release(&made);
    return status;
}
