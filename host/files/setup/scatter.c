/* The key Scatter. */
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>

enum { HISTORIES_MAX = 1 << 30, PLACES_MAX = 256 };

static skg_status read_tolerance(const skg_json_node *node, skg_scatter *scatter) {
    double tolerance = 0;
    SKG_TRY(skg_json_number(node, &tolerance));
    if (!(tolerance > 0 && tolerance < 1))
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "is %g; give the standard error of the scatter over its mean, above 0 and below "
                             "1, such as 0.01%s",
                             tolerance, tolerance >= 1 ? ", or {\"Histories\": 1000000}" : "");
    scatter->tolerance = tolerance;
    return SKG_OK;
}

/* The accuracy is given once: a tolerance, or a number of histories. */
static skg_status read_accuracy(const skg_json_object *object, skg_scatter *scatter) {
    const skg_json_node tolerance = skg_json_member(object, "Tolerance"),
                        histories = skg_json_member(object, "Histories");
    if (tolerance.value && histories.value)
        return skg_json_fail(&histories, SKG_ERR_FORMAT,
                             "and Tolerance exclude each other: with a tolerance, the number of histories "
                             "follows; leave one out");
    if (tolerance.value) return read_tolerance(&tolerance, scatter);
    if (!histories.value) return SKG_OK;
    scatter->tolerance = 0;
    return skg_json_integer(&histories, 1, HISTORIES_MAX, &scatter->histories);
}

/* [columns, rows] */
static skg_status read_places(const skg_json_node *node, skg_scatter *scatter) {
    static const char *const example = "[32, 32]";
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, example, &count));
    if (count != 2)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "has %" PRId64 " elements; give columns and rows, such as %s", count, example);
    const skg_json_node columns = skg_json_element(node, 0), rows = skg_json_element(node, 1);
    SKG_TRY(skg_json_integer(&columns, 1, PLACES_MAX, &scatter->columns));
    return skg_json_integer(&rows, 1, PLACES_MAX, &scatter->rows);
}

static skg_status read_voxel(const skg_json_node *node, skg_scatter *scatter) {
    SKG_TRY(skg_json_lengths(node, "[5, \"mm\"]", 1, &scatter->voxel_mm));
    if (!(scatter->voxel_mm > 0))
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "is %g mm; give a length above 0, or leave it out for 64 cells along each side",
                             scatter->voxel_mm);
    return SKG_OK;
}

static skg_status read_object(const skg_json_node *node, skg_scatter *scatter) {
    skg_json_object object;
    SKG_TRY(skg_json_read_object(node, &skg_keys_scatter, &object));
    const skg_json_node seed = skg_json_member(&object, "Seed"), voxel = skg_json_member(&object, "Voxel"),
                        places = skg_json_member(&object, "Detector"),
                        glow = skg_json_member(&object, "Fluorescence");
    SKG_TRY(read_accuracy(&object, scatter));
    if (seed.value) SKG_TRY(skg_json_integer(&seed, INT32_MIN, INT32_MAX, &scatter->seed));
    if (voxel.value) SKG_TRY(read_voxel(&voxel, scatter));
    if (glow.value) {
        int32_t on = 0;
        SKG_TRY(skg_json_flag(&glow, &on));
        scatter->fluorescence = on ? SKG_FLUORESCENCE_ON : SKG_FLUORESCENCE_OFF;
    }
    return places.value ? read_places(&places, scatter) : SKG_OK;
}

skg_status skg_setup_read_scatter(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    skg_scatter_init(&setup->scatter);
    if (!node->value) return SKG_OK;
    if (json_is_boolean(node->value)) {
        if (json_is_true(node->value)) setup->said.scatter = &setup->scatter;
        return SKG_OK;
    }
    setup->said.scatter = &setup->scatter;
    if (json_is_number(node->value)) return read_tolerance(node, &setup->scatter);
    if (!json_is_object(node->value))
        return skg_json_fail(
            node, SKG_ERR_FORMAT,
            "is neither a tolerance, true, nor an object; give 0.01, or {\"Tolerance\": 0.01}");
    return read_object(node, &setup->scatter);
}
