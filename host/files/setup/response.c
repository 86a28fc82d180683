/* Reads the detector's response to a photon: Energy response and Scintillator. */
#include "core/text.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <string.h>

/* The unit of energies, and what these mean for noise. */
typedef struct {
    const char *unit;
    double kev;
    int32_t meaning;
} response_form;

static skg_status read_form(const skg_json_object *response, response_form *form) {
    static const char *const meanings[] = {
        [SKG_RESPONSE_MEANING_SIGNAL] = "signal", [SKG_RESPONSE_MEANING_ABSORBED] = "absorbed"};
    skg_json_node unit = skg_json_member(response, "Unit"), meaning = skg_json_member(response, "Meaning");
    int64_t choice = SKG_RESPONSE_MEANING_SIGNAL;
    *form = (response_form){.unit = "keV", .kev = 1};
    if (meaning.value) SKG_TRY(skg_json_choice(&meaning, "meaning of a response", meanings, 2, &choice));
    form->meaning = (int32_t)choice;
    if (!unit.value) return SKG_OK;
    SKG_TRY(skg_json_text(&unit, &form->unit));
    skg_status status = skg_unit_of_energy(form->unit, &form->kev);
    return skg_json_at(&unit, status);
}

static skg_status read_file(skg_setup_reader *reader, const skg_json_node *node, const response_form *form) {
    const char *name = NULL, *path = NULL;
    SKG_TRY(skg_json_text(node, &name));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    return skg_json_at(node, skg_response_load(path, form->unit, form->meaning, &reader->setup->response));
}

/* [[10, 10], [20, 19.98], ...]: energy, recorded energy, and in every row or none efficiency, Swank factor. */
static skg_status read_rows(skg_setup_reader *reader, const skg_json_node *node, const response_form *form) {
    static const char *const example =
        "[energy, recorded energy], in every row or none also efficiency, Swank factor";
    double *columns[4] = {NULL, NULL, NULL, NULL};
    int64_t count = 0, width = 0;
    skg_response_table table;
    skg_status status = SKG_OK;
    skg_response_table_init(&table);
    SKG_TRY(skg_json_array(node, "[[10, 10], [20, 19.98]]", &count));
    skg_json_node first = skg_json_element(node, 0);
    if (count > 0) SKG_TRY(skg_json_array(&first, example, &width));
    width = width < 2 ? 2 : width > 4 ? 4 : width;
    for (int64_t k = 0; k < width; k++)
        SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "energy response", &columns[k]));
    for (int64_t i = 0; i < count; i++) {
        skg_json_node row = skg_json_element(node, i);
        double numbers[4];
        SKG_TRY_CLEANUP(skg_json_numbers(&row, example, width, numbers));
        for (int64_t k = 0; k < width; k++) columns[k][i] = numbers[k] * (k < 2 ? form->kev : 1);
    }
    table.meaning = form->meaning, table.count = count;
    table.energies_kev = columns[0], table.recorded_kev = columns[1];
    table.efficiency = columns[2], table.swank = columns[3];
    status = skg_response_create_table(&table, &reader->setup->response);
    status = skg_json_at(node, status);
cleanup:
    for (int k = 0; k < 4; k++) skg_free(&columns[k]);
    return status;
}

/* {"Heights": [10, 20], "Rows": [[15, 0.1, 0.8], [30, ...]]}: each row has an energy and a probability for each height. */
static skg_status read_pulses(skg_setup_reader *reader, const skg_json_node *node,
                              const response_form *form) {
    double *heights = NULL, *energies = NULL, *probability = NULL, *row = NULL;
    int64_t height_count = 0, count = 0;
    skg_json_object object;
    skg_json_node height_node, row_node;
    skg_status status = SKG_OK;
    if (form->meaning != SKG_RESPONSE_MEANING_SIGNAL)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "says how often a pulse has each height, so there is no Meaning");
    SKG_TRY(skg_json_read_object(node, &skg_keys_pulses, &object));
    SKG_TRY(skg_json_need(&object, "Heights", "[10, 20, 30]", &height_node));
    SKG_TRY(skg_json_need(&object, "Rows", "[[15, 0.1, 0.8, 0], [30, 0, 0.1, 0.7]]", &row_node));
    SKG_TRY(skg_json_array(&height_node, "[10, 20, 30]", &height_count));
    SKG_TRY(skg_json_array(&row_node, "[[15, 0.1, 0.8, 0], [30, 0, 0.1, 0.7]]", &count));
    SKG_TRY_CLEANUP(skg_alloc(height_count + 1, sizeof *heights, "pulse heights", &heights));
    SKG_TRY_CLEANUP(skg_alloc(height_count + 1, sizeof *row, "pulse heights", &row));
    SKG_TRY_CLEANUP(skg_alloc(count + 1, sizeof *energies, "pulse heights", &energies));
    SKG_TRY_CLEANUP(skg_alloc((count + 1) * (height_count + 1), sizeof *row, "pulse heights", &probability));
    SKG_TRY_CLEANUP(skg_json_numbers(&height_node, "[10, 20, 30]", height_count, heights));
    for (int64_t h = 0; h < height_count; h++) heights[h] *= form->kev;
    for (int64_t i = 0; i < count; i++) {
        skg_json_node at = skg_json_element(&row_node, i);
        SKG_TRY_CLEANUP(
            skg_json_numbers(&at, "an energy and a probability for each height", height_count + 1, row));
        energies[i] = row[0] * form->kev;
        memcpy(probability + i * height_count, row + 1, (size_t)height_count * sizeof *row);
    }
    status = skg_response_create_pulses(count, energies, height_count, heights, probability,
                                        &reader->setup->response);
    status = skg_json_at(node, status);
cleanup:
    skg_free(&heights);
    skg_free(&row);
    skg_free(&energies);
    skg_free(&probability);
    return status;
}

static skg_status read_response(skg_setup_reader *reader, const skg_json_node *node) {
    skg_json_object response;
    response_form form;
    SKG_TRY(skg_json_read_object(node, &skg_keys_response, &response));
    SKG_TRY(read_form(&response, &form));
    skg_json_node file = skg_json_member(&response, "File"), rows = skg_json_member(&response, "LUT");
    skg_json_node pulses = skg_json_member(&response, "PulseHeights");
    if ((file.value != NULL) + (rows.value != NULL) + (pulses.value != NULL) > 1)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "has several of File, LUT and PulseHeights; give one of them");
    if (file.value) return read_file(reader, &file, &form);
    if (rows.value) return read_rows(reader, &rows, &form);
    if (pulses.value) return read_pulses(reader, &pulses, &form);
    return skg_json_fail(
        node, SKG_ERR_FORMAT,
        "has no table; give \"File\": \"response.txt\", \"LUT\": [...] or \"PulseHeights\": {...}");
}

/* Thickness and Unit: a length, or mass per area. */
static skg_status make_scintillator(skg_setup_reader *reader, const skg_json_object *object,
                                    const skg_material *material) {
    skg_json_node thickness_node, unit_node, packing_node = skg_json_member(object, "Packing");
    double thickness = 0, packing = 1, mm = 1;
    const char *unit = NULL;
    SKG_TRY(skg_json_need(object, "Thickness", "600", &thickness_node));
    SKG_TRY(skg_json_number(&thickness_node, &thickness));
    SKG_TRY(skg_json_need(object, "Unit", "\"um\" or \"mg/cm2\"", &unit_node));
    SKG_TRY(skg_json_text(&unit_node, &unit));
    if (packing_node.value) SKG_TRY(skg_json_number(&packing_node, &packing));
    skg_status status;
    if (skg_same_name(unit, "mg/cm2")) {
        if (packing_node.value)
            return skg_json_fail(&packing_node, SKG_ERR_FORMAT,
                                 "has no meaning with a mass per area; leave it out");
        status = skg_response_create_screen(material, thickness, &reader->setup->response);
    } else {
        SKG_TRY(skg_json_unit_of_length(&unit_node, &mm));
        status =
            skg_response_create_scintillator(material, thickness * mm, packing, &reader->setup->response);
    }
    return skg_json_at(object->node, status);
}

static skg_status let_escape(skg_setup_reader *reader, const skg_json_object *object) {
    const skg_json_node node = skg_json_member(object, "Escape");
    skg_response *all = reader->setup->response, *escaping = NULL;
    int32_t escape = 0;
    if (node.value) SKG_TRY(skg_json_flag(&node, &escape));
    if (!escape) return SKG_OK;
    SKG_TRY(skg_json_at(&node, skg_response_create_escaping(all, &escaping)));
    skg_response_release(&all);
    reader->setup->response = escaping;
    return SKG_OK;
}

/* Scattered photons are followed unless one asks that they are not. */
static skg_status follow_scattered(skg_setup_reader *reader, const skg_json_object *object) {
    static const char *const ways[] = {"transport", "all"};
    const skg_json_node node = skg_json_member(object, "Deposition");
    skg_response *all = reader->setup->response, *transporting = NULL;
    int64_t choice = 0;
    if (node.value) SKG_TRY(skg_json_choice(&node, "deposition", ways, 2, &choice));
    if (choice == 1) return SKG_OK;
    SKG_TRY(
        skg_json_at(node.value ? &node : object->node, skg_response_create_transporting(all, &transporting)));
    skg_response_release(&all);
    reader->setup->response = transporting;
    return SKG_OK;
}

/* [[20, 0.8], [60, 0.7]]: keV and DQE at spatial frequency 0. */
static skg_status read_dqe(skg_setup_reader *reader, const skg_json_object *object) {
    const skg_json_node node = skg_json_member(object, "DQE");
    skg_response *plain = reader->setup->response, *measured = NULL;
    double *columns[2] = {NULL, NULL};
    int64_t count = 0;
    skg_status status = SKG_OK;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_array(&node, "[[20, 0.8], [60, 0.7]], in keV", &count));
    for (int k = 0; k < 2; k++) SKG_TRY_CLEANUP(skg_alloc(count + 1, sizeof(double), "DQE", &columns[k]));
    for (int64_t i = 0; i < count; i++) {
        const skg_json_node row = skg_json_element(&node, i);
        double numbers[2];
        SKG_TRY_CLEANUP(skg_json_numbers(&row, "[energy, DQE]", 2, numbers));
        columns[0][i] = numbers[0], columns[1][i] = numbers[1];
    }
    status = skg_response_create_dqe(plain, count, columns[0], columns[1], &measured);
    SKG_TRY_CLEANUP(skg_json_at(&node, status));
    skg_response_release(&plain);
    reader->setup->response = measured;
cleanup:
    for (int k = 0; k < 2; k++) skg_free(&columns[k]);
    return status;
}

static skg_status read_scintillator(skg_setup_reader *reader, const skg_json_node *node) {
    skg_json_object object;
    skg_json_node material_node;
    skg_material *material = NULL;
    SKG_TRY(skg_json_read_object(node, &skg_keys_scintillator, &object));
    SKG_TRY(skg_json_need(&object, "Material", "\"CsI\"", &material_node));
    skg_json_node density = skg_json_member(&object, "Density");
    SKG_TRY(skg_setup_read_material(reader, &material_node, &density, "scintillator", &material));
    skg_status status = make_scintillator(reader, &object, material);
    skg_material_release(&material);
    SKG_TRY(status);
    const skg_json_node oblique = skg_json_member(&object, "Oblique");
    if (oblique.value) SKG_TRY(skg_json_flag(&oblique, &reader->setup->oblique));
    SKG_TRY(let_escape(reader, &object));
    SKG_TRY(follow_scattered(reader, &object));
    SKG_TRY(read_dqe(reader, &object));
    const skg_json_node depths = skg_json_member(&object, "Depths");
    return skg_setup_read_depths(reader, &depths);
}

skg_status skg_setup_read_response(skg_setup_reader *reader, const skg_json_object *detector) {
    skg_json_node response = skg_json_member(detector, "EnergyResponse");
    skg_json_node scintillator = skg_json_member(detector, "Scintillator");
    if (response.value && scintillator.value)
        return skg_json_fail(&scintillator, SKG_ERR_FORMAT,
                             "give either EnergyResponse or Scintillator, not both");
    if (response.value) return read_response(reader, &response);
    return scintillator.value ? read_scintillator(reader, &scintillator) : SKG_OK;
}
