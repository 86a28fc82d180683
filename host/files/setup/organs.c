/* The organs of a breathing body, from a scene file. */
#include "setup/types.h"

#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <math.h>
#include <string.h>

static const char *const link_example = "[{\"To\": \"rib\", \"Distance\": [15, \"mm\"]}]";

/* An angle of at most half a turn, in degrees. */
static skg_status read_angle(const skg_json_object *object, const char *name, double *radians) {
    skg_json_node node = skg_json_member(object, name);
    double degrees = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_number(&node, &degrees));
    if (!(fabs(degrees) <= 180))
        return skg_json_fail(&node, SKG_ERR_BREATHING, "is %g degrees; the range is -180 to 180", degrees);
    *radians = degrees * (SKG_PI / 180);
    return SKG_OK;
}

static skg_status read_rotation(const skg_json_object *object, skg_organ *organ) {
    skg_json_node axis = skg_json_member(object, "Axis"), centre = skg_json_member(object, "Centre");
    double direction[3] = {0}, angle = 0;
    SKG_TRY(read_angle(object, "Gamma", &organ->gamma_rad));
    SKG_TRY(read_angle(object, "Lambda", &organ->lambda_rad));
    SKG_TRY(read_angle(object, "Angle", &angle));
    if (axis.value) SKG_TRY(skg_json_direction(&axis, direction));
    if ((axis.value != NULL) != (skg_json_member(object, "Angle").value != NULL))
        return skg_json_fail(
            object->node, SKG_ERR_FORMAT,
            "has only one of Axis and Angle; give both (\"Axis\": [0, 0, 1], \"Angle\": 10), or "
            "Gamma and Lambda");
    skg_scale_vector(angle, direction, organ->turn_rad);
    if (centre.value) SKG_TRY(skg_json_lengths(&centre, "[0, 20, 100, \"mm\"]", 3, organ->centre_mm));
    return SKG_OK;
}

static skg_status read_link(const skg_json_node *node, skg_organ_link *link, char **to) {
    skg_json_object object;
    skg_json_node name, distance;
    const char *label = NULL;
    SKG_TRY(skg_json_read_object(node, &skg_keys_link, &object));
    SKG_TRY(skg_json_need(&object, "To", "\"rib\"", &name));
    SKG_TRY(skg_json_need(&object, "Distance", "[15, \"mm\"]", &distance));
    skg_json_node rigid = skg_json_member(&object, "RigidDistance");
    SKG_TRY(skg_json_text(&name, &label));
    skg_organ_link_init(link);
    SKG_TRY(skg_json_lengths(&distance, "[15, \"mm\"]", 1, &link->distance_mm));
    link->rigid_mm = link->distance_mm;
    if (rigid.value) SKG_TRY(skg_json_lengths(&rigid, "[3, \"mm\"]", 1, &link->rigid_mm));
    if (!(link->distance_mm > 0 && link->distance_mm <= 1000))
        return skg_json_fail(&distance, SKG_ERR_BREATHING, "is %g mm; the range is above 0 to 1000 mm",
                             link->distance_mm);
    if (!(link->rigid_mm >= 0 && link->rigid_mm <= link->distance_mm))
        return skg_json_fail(&rigid, SKG_ERR_BREATHING, "is %g mm; the range is 0 to Distance, %g mm",
                             link->rigid_mm, link->distance_mm);
    SKG_TRY(skg_copy_text(label, to));
    link->to = *to;
    return SKG_OK;
}

static skg_status read_links(const skg_json_node *node, struct skg_breathing_organ *organ) {
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, link_example, &count));
    if (count == 0) return skg_json_fail(node, SKG_ERR_FORMAT, "is empty; give %s", link_example);
    SKG_TRY(skg_alloc(count, sizeof *organ->links, "links", &organ->links));
    SKG_TRY(skg_alloc(count, sizeof *organ->to, "links", &organ->to));
    organ->organ.links = organ->links;
    organ->organ.link_count = count;
    for (int64_t l = 0; l < count; l++) {
        skg_json_node one = skg_json_element(node, l);
        SKG_TRY(read_link(&one, organ->links + l, organ->to + l));
    }
    return SKG_OK;
}

static skg_status read_organ(const skg_json_node *node, struct skg_breathing_organ *organ) {
    static const char *const kinds[] = {"ByLabel", "Static", "Rigid", "Deformable"}; /* as SKG_ORGAN_ */
    skg_json_object object;
    double limits[3] = {0, 0, 0};
    const char *as = NULL;
    int64_t kind = SKG_ORGAN_BY_LABEL;
    SKG_TRY(skg_json_read_object(node, &skg_keys_organ, &object));
    skg_json_node alias = skg_json_member(&object, "As"), tissue = skg_json_member(&object, "Tissue");
    skg_json_node named = skg_json_member(&object, "Kind"), links = skg_json_member(&object, "Links");
    if (alias.value) SKG_TRY(skg_json_text(&alias, &as));
    SKG_TRY(skg_copy_text(as, &organ->as));
    if (named.value) SKG_TRY(skg_json_choice(&named, "kind of an organ", kinds, 4, &kind));
    organ->organ.kind = (int32_t)kind;
    if (tissue.value) SKG_TRY(skg_json_numbers(&tissue, "[0.7, 1.1, 0.1]", 3, limits));
    if (tissue.value && !(limits[0] >= 0 && limits[0] <= 1 && limits[1] >= 1 && limits[2] >= 0))
        return skg_json_fail(
            &tissue, SKG_ERR_BREATHING,
            "is [%g, %g, %g]; 0 <= alpha_min <= 1 <= alpha_max and beta >= 0, or the organ does "
            "not hold at rest",
            limits[0], limits[1], limits[2]);
    organ->organ.alpha_min = limits[0];
    organ->organ.alpha_max = limits[1];
    organ->organ.beta = limits[2];
    SKG_TRY(read_rotation(&object, &organ->organ));
    return links.value ? read_links(&links, organ) : SKG_OK;
}

skg_status skg_setup_read_organs(skg_setup_reader *reader, const skg_json_node *node) {
    skg_breathing_section *section = &reader->setup->breathing;
    if (!json_is_object(node->value))
        return skg_json_fail(node, SKG_ERR_FORMAT, "is no object; give {\"envelope\": {\"As\": \"skin\"}}");
    SKG_TRY(skg_alloc((int64_t)json_object_size(node->value), sizeof *section->organs, "organs",
                      &section->organs));
    const char *label;
    json_t *value;
    json_object_foreach(node->value, label, value) {
        skg_json_node own = {.file = node->file, .up = node, .key = label, .value = value};
        struct skg_breathing_organ *organ = &section->organs[section->organ_count++];
        skg_organ_init(&organ->organ);
        SKG_TRY(skg_setup_find_part(reader, &own, label, &organ->part));
        SKG_TRY(read_organ(&own, organ));
    }
    return SKG_OK;
}

void skg_setup_describe_organ(const skg_breathing_section *section, int64_t part, skg_organ *organ) {
    for (int64_t i = 0; i < section->organ_count; i++) {
        const struct skg_breathing_organ *said = section->organs + i;
        const skg_organ given = *organ;
        if (said->part != part) continue;
        *organ = said->organ;
        organ->mesh = given.mesh;
        organ->inside = given.inside;
        organ->label = said->as ? said->as : given.label;
    }
}

void skg_setup_organs_free(skg_breathing_section *section) {
    for (int64_t i = 0; i < section->organ_count; i++) {
        struct skg_breathing_organ *organ = section->organs + i;
        for (int64_t l = 0; organ->to && l < organ->organ.link_count; l++) skg_free(organ->to + l);
        skg_free(&organ->to);
        skg_free(&organ->links);
        skg_free(&organ->as);
    }
    skg_free(&section->organs);
}
