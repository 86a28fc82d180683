/* The key Fit of the section Breathing. */
#include "setup/keys.h"
#include "setup/sections.h"

#include <string.h>

static skg_status read_parameters(const skg_json_node *node, skg_body_fit_section *fit) {
    static const char example[] = "[\"tendon\", \"liver-beta\"]";
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, example, &count));
    if (count == 0) return skg_json_fail(node, SKG_ERR_FORMAT, "is empty; give %s", example);
    fit->chooses = 1;
    for (int64_t i = 0; i < count; i++) {
        const skg_json_node one = skg_json_element(node, i);
        const char *word = NULL;
        SKG_TRY(skg_json_text(&one, &word));
        SKG_TRY(skg_json_at(&one, skg_parameters_choose(word, fit->chosen)));
    }
    return SKG_OK;
}

static skg_status read_bound(const skg_json_node *node, skg_body_fit_section *fit) {
    double range[2] = {0, 0};
    int p;
    SKG_TRY(skg_json_at(node, skg_parameter_find(node->key, &p)));
    if (strcmp(skg_parameter_kinds[p].unit, "mm") == 0)
        SKG_TRY(skg_json_lengths(node, "[-30, 0, \"mm\"]", 2, range));
    else
        SKG_TRY(skg_json_numbers(node, "[0.6, 0.95]", 2, range));
    SKG_TRY(skg_json_at(node, skg_parameter_check_range(p, range[0], range[1])));
    fit->has_range[p] = 1;
    fit->low[p] = range[0], fit->high[p] = range[1];
    return SKG_OK;
}

skg_status skg_setup_read_body_fit(const skg_json_node *node, skg_body_fit_section *fit) {
    skg_json_object object;
    const char *name;
    json_t *value;
    SKG_TRY(skg_json_read_object(node, &skg_keys_body_fit, &object));
    const skg_json_node parameters = skg_json_member(&object, "Parameters"),
                        bounds = skg_json_member(&object, "Bounds");
    if (parameters.value) SKG_TRY(read_parameters(&parameters, fit));
    if (bounds.value && !json_is_object(bounds.value))
        return skg_json_fail(&bounds, SKG_ERR_FORMAT, "is no object; give {\"tendon-z\": [-30, 0, \"mm\"]}");
    json_object_foreach(bounds.value, name, value) {
        const skg_json_node one = {.file = bounds.file, .up = &bounds, .key = name, .value = value};
        SKG_TRY(read_bound(&one, fit));
    }
    return SKG_OK;
}
