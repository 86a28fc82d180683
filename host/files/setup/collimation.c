/* The key Collimation. */
#include "geometry/optics.h"
#include "setup/keys.h"
#include "setup/sections.h"

static const char *const rectangle_example = "[[-50, 50], [-40, 60], \"mm\"]";
static const char *const distance_example = "[300, \"mm\"]";

/* [[left, right], [bottom, top], unit]. Rows of the detector grow downward, and so does the second axis of the field. */
static skg_status read_rectangle(const skg_json_node *node, skg_collimation *collimation) {
    int64_t count = 0;
    double across[2], up[2], mm = 1;
    SKG_TRY(skg_json_array(node, rectangle_example, &count));
    if (count != 3)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "has %d entries; give left and right, bottom and top, and a unit, such as %s",
                             (int)count, rectangle_example);
    const skg_json_node columns = skg_json_element(node, 0), rows = skg_json_element(node, 1),
                        unit = skg_json_element(node, 2);
    SKG_TRY(skg_json_numbers(&columns, "[left, right]", 2, across));
    SKG_TRY(skg_json_numbers(&rows, "[bottom, top]", 2, up));
    SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    if (!(across[0] < across[1]))
        return skg_json_fail(&columns, SKG_ERR_SCENE,
                             "is %g to %g; the right edge has to exceed the left one", across[0], across[1]);
    if (!(up[0] < up[1]))
        return skg_json_fail(&rows, SKG_ERR_SCENE, "is %g to %g; the top has to exceed the bottom", up[0],
                             up[1]);
    collimation->low[0] = across[0] * mm, collimation->high[0] = across[1] * mm;
    collimation->low[1] = -up[1] * mm, collimation->high[1] = -up[0] * mm;
    return SKG_OK;
}

static skg_status read_jaws(const skg_json_object *object, int parallel, skg_collimation *collimation) {
    const skg_json_node margin = skg_json_member(object, "Margin");
    skg_json_node rectangle, distance = skg_json_member(object, "Distance");
    collimation->kind = SKG_COLLIMATION_RECTANGLE;
    collimation->distance_mm = 1; /* of a parallel beam: without effect */
    SKG_TRY(skg_json_need(object, "Rectangle", rectangle_example, &rectangle));
    SKG_TRY(read_rectangle(&rectangle, collimation));
    if (margin.value)
        return skg_json_fail(&margin, SKG_ERR_FORMAT,
                             "is that of a field of the detector; leave it out, or give \"Field\": "
                             "\"detector\" instead of Rectangle");
    if (parallel && !distance.value) return SKG_OK;
    SKG_TRY(skg_json_need(object, "Distance", distance_example, &distance));
    SKG_TRY(skg_json_lengths(&distance, distance_example, 1, &collimation->distance_mm));
    return skg_json_at(&distance, skg_collimation_check(collimation));
}

static skg_status read_field(const skg_json_object *object, const skg_json_node *field,
                             skg_collimation *collimation) {
    static const char *const names[] = {"detector"}, *const others[] = {"Rectangle", "Distance"};
    const skg_json_node margin = skg_json_member(object, "Margin");
    int64_t choice = 0;
    collimation->kind = SKG_COLLIMATION_DETECTOR;
    SKG_TRY(skg_json_choice(field, "field", names, 1, &choice));
    for (int k = 0; k < 2; k++) {
        const skg_json_node other = skg_json_member(object, others[k]);
        if (other.value)
            return skg_json_fail(&other, SKG_ERR_FORMAT,
                                 "and Field exclude each other: Rectangle and Distance, or Field and Margin");
    }
    if (!margin.value) return SKG_OK;
    SKG_TRY(skg_json_lengths(&margin, "[10, \"mm\"]", 1, &collimation->margin_mm));
    return skg_json_at(&margin, skg_collimation_check(collimation));
}

skg_status skg_setup_read_collimation(skg_setup_reader *reader, const skg_json_node *node, int has_view) {
    static const char *const names[] = {"open"};
    skg_setup *setup = reader->setup;
    const int parallel = setup->view.projection != SKG_PROJECTION_POINT;
    skg_json_object object;
    skg_field made;
    int64_t choice = 0;
    skg_collimation_init(&setup->collimation);
    if (!node->value) return SKG_OK;
    setup->said.collimation = &setup->collimation;
    if (json_is_string(node->value)) return skg_json_choice(node, "collimation", names, 1, &choice);
    SKG_TRY(skg_json_read_object(node, &skg_keys_collimation, &object));
    const skg_json_node field = skg_json_member(&object, "Field");
    if (field.value)
        SKG_TRY(read_field(&object, &field, &setup->collimation));
    else
        SKG_TRY(read_jaws(&object, parallel, &setup->collimation));
    return has_view ? skg_json_at(node, skg_field_make(&setup->collimation, &setup->view, &made)) : SKG_OK;
}
