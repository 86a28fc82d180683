/* What the detector makes of a photon: Energy response and Scintillator. */
#include "core/names.h"
#include "core/units.h"
#include "setup/sections.h"

#include <inttypes.h>

static const skg_json_key response_keys[] = {
    {"File", NULL, SKG_KEY_READ},
    {"LUT", NULL, SKG_KEY_READ},
    {"Unit", NULL, SKG_KEY_READ},
    {"Energy", "Unit", SKG_KEY_READ}, /* files in use have this */
};

static const skg_json_key scintillator_keys[] = {
    {"Material", NULL, SKG_KEY_READ}, {"Thickness", NULL, SKG_KEY_READ}, {"Unit", NULL, SKG_KEY_READ},
    {"Density", NULL, SKG_KEY_READ},  {"Packing", NULL, SKG_KEY_READ},
};

static skg_status read_file(skg_setup_reader *reader, const skg_json_node *node, const char *unit) {
    const char *name = NULL, *path = NULL;
    SKG_TRY(skg_json_text(node, &name));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    return skg_json_at(node, skg_response_load(path, unit, &reader->setup->response));
}

/* [[10, 10], [20, 19.98], ...] */
static skg_status read_rows(skg_setup_reader *reader, const skg_json_node *node, double kev) {
    double *energies = NULL, *recorded = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_json_array(node, "[[10, 10], [20, 19.98]]", &count));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "energy response", &energies));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "energy response", &recorded));
    for (int64_t i = 0; i < count; i++) {
        skg_json_node row = skg_json_element(node, i);
        double pair[2];
        SKG_TRY_CLEANUP(skg_json_numbers(&row, "[energy, recorded energy]", 2, pair));
        energies[i] = pair[0] * kev;
        recorded[i] = pair[1] * kev;
    }
    status = skg_response_create_table(count, energies, recorded, NULL, &reader->setup->response);
    status = skg_json_at(node, status);
cleanup:
    skg_free(&energies);
    skg_free(&recorded);
    return status;
}

static skg_status read_response(skg_setup_reader *reader, const skg_json_node *node) {
    skg_json_object response;
    const char *unit = "keV";
    double kev = 1;
    SKG_TRY(
        skg_json_read_object(node, response_keys, sizeof response_keys / sizeof *response_keys, &response));
    skg_json_node unit_node = skg_json_member(&response, "Unit");
    if (unit_node.value) {
        SKG_TRY(skg_json_text(&unit_node, &unit));
        skg_status status = skg_unit_of_energy(unit, &kev);
        SKG_TRY(skg_json_at(&unit_node, status));
    }
    skg_json_node file = skg_json_member(&response, "File"), rows = skg_json_member(&response, "LUT");
    if (file.value && rows.value)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has both File and LUT; give one of them");
    if (file.value) return read_file(reader, &file, unit);
    if (rows.value) return read_rows(reader, &rows, kev);
    return skg_json_fail(node, SKG_ERR_FORMAT,
                         "has no table; give \"File\": \"response.txt\" or \"LUT\": [...]");
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

static skg_status read_scintillator(skg_setup_reader *reader, const skg_json_node *node) {
    skg_json_object object;
    skg_json_node material_node;
    skg_material *material = NULL;
    SKG_TRY(skg_json_read_object(node, scintillator_keys,
                                 sizeof scintillator_keys / sizeof *scintillator_keys, &object));
    SKG_TRY(skg_json_need(&object, "Material", "\"CsI\"", &material_node));
    skg_json_node density = skg_json_member(&object, "Density");
    SKG_TRY(skg_setup_read_material(reader, &material_node, &density, "scintillator", &material));
    skg_status status = make_scintillator(reader, &object, material);
    skg_material_release(&material);
    return status;
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
