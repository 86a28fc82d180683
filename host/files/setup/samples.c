/* The section Samples. */
#include "core/files.h"
#include "core/maths.h"
#include "scene/volume.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A sample after the first pass, for the second one, which sets parents. */
typedef struct {
    skg_json_node node; /* of the sample, in Samples or the scene graph */
    int64_t part;
    int32_t outer;
} sample_part;

typedef struct {
    sample_part *parts;
    int64_t count;
    int64_t outers, outer_part; /* how many outer samples, and the last one's part */
    int32_t move_to_centre;     /* all together */
} sample_list;

static skg_status read_sample_object(const skg_json_node *node, skg_json_object *sample) {
    return skg_json_read_object(node, &skg_keys_sample, sample);
}

static skg_status read_flag(const skg_json_object *object, const char *name, int32_t *flag) {
    skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_flag(&node, flag) : SKG_OK;
}

/* Puts in place of a material the same with the form factors of a file. */
static skg_status read_form_factor(skg_setup_reader *reader, const skg_json_node *node,
                                   skg_material **material) {
    const char *name = NULL, *path = NULL;
    double *momenta = NULL, *squares = NULL;
    int64_t count = 0;
    skg_material *bound = NULL;
    SKG_TRY(skg_json_text(node, &name));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    skg_status status = skg_read_columns(path, NULL, &count, &momenta, &squares);
    if (status == SKG_OK)
        status = skg_material_create_form_factor(*material, count, momenta, squares, &bound);
    skg_free(&momenta);
    skg_free(&squares);
    SKG_TRY(skg_json_at(node, status));
    skg_material_release(material);
    *material = bound;
    return SKG_OK;
}

static skg_status read_material(skg_setup_reader *reader, const skg_json_object *sample, const char *label,
                                skg_material **material) {
    skg_json_node node, density = skg_json_member(sample, "Density");
    skg_status status = skg_json_need(sample, "Material", "\"Water\", [\"mu\", 0.2]", &node);
    const int is_absent = status != SKG_OK;
    if (!is_absent) status = skg_setup_read_material(reader, &node, &density, label, material);
    const skg_json_node form = skg_json_member(sample, "FormFactor");
    if (status == SKG_OK && form.value) return read_form_factor(reader, &form, material);
    if (!reader->file.lengths || !(is_absent || status == SKG_ERR_MATERIAL)) return status;
    /* Path lengths need no material: one that attenuates nothing stands in. */
    SKG_TRY(skg_json_remark(
        sample->node, "has no usable Material: its path lengths are right, its attenuation is not known"));
    return skg_material_create_mu(label, 0, material);
}

/* pose = pose T(-centre of the mesh's bounds) */
static skg_status centre_mesh(const skg_mesh *mesh, double *pose) {
    skg_mesh_health health;
    double move[16];
    skg_mesh_health_init(&health);
    SKG_TRY(skg_mesh_health_get(mesh, &health));
    const double *b = health.bounds;
    skg_pose_translation(-0.5 * (b[0] + b[3]), -0.5 * (b[1] + b[4]), -0.5 * (b[2] + b[5]), move);
    skg_pose_multiply(pose, move, pose);
    return SKG_OK;
}

/* own: pose of a generated mesh; result: what comes before Transform, and the whole pose */
static skg_status read_pose(const skg_json_object *sample, const skg_mesh *mesh, double *own, double *pose) {
    int32_t centred = 0;
    skg_pose_identity(pose);
    skg_json_node transform = skg_json_member(sample, "Transform");
    if (transform.value) SKG_TRY(skg_setup_read_transform(&transform, pose));
    SKG_TRY(read_flag(sample, "MoveToCentre", &centred));
    if (centred) SKG_TRY(centre_mesh(mesh, own));
    skg_pose_multiply(pose, own, pose);
    return SKG_OK;
}

static int has_label(const skg_scene *scene, const char *label) {
    for (int64_t i = 0; i < scene->count; i++)
        if (strcmp(scene->parts[i].label, label) == 0) return 1;
    return 0;
}

/* The label of a part, or of its mesh; with a number behind it if a part before has the same. */
static skg_status choose_label(const skg_setup_reader *reader, const skg_json_object *sample, skg_part *part,
                               char *numbered, size_t size) {
    const skg_json_node node = skg_json_member(sample, "Label");
    if (node.value) SKG_TRY(skg_json_text(&node, &part->label));
    const char *label = part->label;
    if (!label) SKG_TRY(skg_mesh_name_get(part->mesh, &label));
    if (!has_label(reader->setup->scene, label)) return SKG_OK;
    for (int64_t number = 2;; number++) {
        snprintf(numbered, size, "%s %" PRId64, label, number);
        if (!has_label(reader->setup->scene, numbered)) break;
    }
    part->label = numbered;
    return skg_json_remark(node.value ? &node : sample->node,
                           "another sample has the label %s, so this one is called \"%s\"", label, numbered);
}

/* Priority, or Through: a part that passes through others on purpose has the highest. */
static skg_status read_priority(const skg_json_object *sample, int32_t *priority) {
    const skg_json_node node = skg_json_member(sample, "Priority"),
                        through = skg_json_member(sample, "Through");
    int64_t number = 0;
    int32_t passes = 0;
    if (node.value) SKG_TRY(skg_json_integer(&node, INT32_MIN, INT32_MAX - 1, &number));
    if (through.value) SKG_TRY(skg_json_flag(&through, &passes));
    if (passes && node.value)
        return skg_json_fail(
            &through, SKG_ERR_FORMAT,
            "a sample that passes through others has the highest priority; give Through or Priority, "
            "not both");
    *priority = passes ? INT32_MAX : (int32_t)number;
    return SKG_OK;
}

/* Reads the matter of a part: a mesh and its material, or a volume, whose box stands for its mesh. */
static skg_status read_matter(skg_setup_reader *reader, const skg_json_object *sample, int32_t flip,
                              skg_mesh_cache *cache, skg_part *part, double *own) {
    if (!skg_json_member(sample, "Volume").value)
        return skg_setup_read_shape(reader, sample, flip, cache, &part->mesh, own);
    skg_pose_identity(own);
    SKG_TRY(skg_setup_read_volume(reader, sample, &part->volume));
    part->mesh = part->volume->hull;
    return skg_mesh_retain(part->mesh);
}

/* The sample's part, with everything but its parent. */
static skg_status read_part(skg_setup_reader *reader, const skg_json_object *sample, skg_mesh_cache *cache,
                            int64_t *id) {
    skg_part part;
    double own[16];
    int32_t flip = 0;
    char numbered[512];
    skg_part_init(&part);
    SKG_TRY(read_priority(sample, &part.priority));
    SKG_TRY(read_flag(sample, "FlipNormals", &flip));
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(read_matter(reader, sample, flip, cache, &part, own));
    SKG_TRY_CLEANUP(choose_label(reader, sample, &part, numbered, sizeof numbered));
    if (!part.volume) SKG_TRY_CLEANUP(read_material(reader, sample, part.label, &part.material));
    SKG_TRY_CLEANUP(read_pose(sample, part.mesh, own, part.pose));
    status = skg_scene_part_add(reader->setup->scene, &part, id);
    SKG_TRY_CLEANUP(skg_json_at(sample->node, status));
    const skg_json_node poses = skg_json_member(sample, "Poses");
    if (poses.value) status = skg_setup_read_poses(reader, &poses, own, *id);
cleanup:
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    skg_volume_release(&part.volume);
    return status;
}

static skg_status read_element(skg_setup_reader *reader, const skg_json_node *node, skg_mesh_cache *cache,
                               sample_list *list) {
    static const char *const types[] = {"inner", "outer"}, *const moves[] = {"MoveToCentre", "MoveToCenter"};
    int64_t choice = 0;
    if (json_is_string(node->value)) {
        list->move_to_centre = 1;
        return skg_json_choice(node, "command in the list of samples", moves, 2, &choice);
    }
    skg_json_object sample;
    SKG_TRY(read_sample_object(node, &sample));
    sample_part *part = &list->parts[list->count];
    skg_json_node type = skg_json_member(&sample, "Type");
    if (type.value) SKG_TRY(skg_json_choice(&type, "type of a sample", types, 2, &choice));
    SKG_TRY(read_part(reader, &sample, cache, &part->part));
    part->node = *node;
    part->outer = choice == 1;
    list->count++;
    if (part->outer) list->outers++, list->outer_part = part->part;
    return SKG_OK;
}

/* An inner sample without Parent lies inside the one outer sample, where there is one. "Parent": null puts it
 * into the world. */
static skg_status read_parent(skg_scene *scene, const sample_list *list, const sample_part *part) {
    skg_json_object sample;
    SKG_TRY(read_sample_object(&part->node, &sample));
    skg_json_node parent = skg_json_member(&sample, "Parent");
    int64_t inside = -1;
    if (parent.value && !json_is_null(parent.value)) {
        const char *label = NULL;
        SKG_TRY(skg_json_text(&parent, &label));
        skg_status status = skg_scene_part_find(scene, label, &inside);
        if (status == SKG_OK) status = skg_scene_set_inside(scene, part->part, inside);
        return skg_json_at(&parent, status);
    }
    if (parent.value || part->outer || list->outers == 0) return SKG_OK;
    if (list->outers > 1)
        return skg_json_fail(&part->node, SKG_ERR_SCENE,
                             "there are %" PRId64 " outer samples, so each inner one needs a Parent: the "
                             "label of the sample around it, or null",
                             list->outers);
    skg_status status = skg_scene_set_inside(scene, part->part, list->outer_part);
    return skg_json_at(&part->node, status);
}

static skg_status move_all_to_centre(skg_scene *scene) {
    double bounds[6];
    SKG_TRY(skg_setup_bounds(scene, bounds));
    for (int64_t i = 0; i < scene->count; i++) {
        double pose[16];
        memcpy(pose, scene->parts[i].pose, sizeof pose);
        for (int k = 0; k < 3; k++) pose[4 * k + 3] -= 0.5 * (bounds[k] + bounds[3 + k]);
        SKG_TRY(skg_scene_part_pose_set(scene, i, pose));
    }
    return SKG_OK;
}

/* Loads the meshes of the samples beforehand, up to the first sample that is at fault: none behind it is read. */
static skg_status fetch_meshes(const skg_setup_reader *reader, const skg_json_node *node, int64_t count,
                               skg_mesh_cache *cache) {
    for (int64_t i = 0; i < count; i++) {
        skg_json_object sample;
        const skg_json_node element = skg_json_element(node, i);
        if (json_is_string(element.value)) continue;
        if (read_sample_object(&element, &sample) != SKG_OK) break;
        SKG_TRY(skg_mesh_cache_want(reader, &sample, cache));
    }
    return skg_mesh_cache_fetch(cache);
}

skg_status skg_setup_read_samples(skg_setup_reader *reader, const skg_json_node *node,
                                  const skg_json_node *graph) {
    int64_t count = 0;
    sample_list list = {.outer_part = -1};
    skg_mesh_cache cache = {.as_wound = reader->setup->as_wound};
    skg_status status = SKG_OK;
    if (node->value) SKG_TRY(skg_json_array(node, "an array of samples [ ... ]", &count));
    SKG_TRY(skg_scene_create(reader->context, &reader->setup->scene));
    SKG_TRY(skg_alloc(count + 1, sizeof *list.parts, "samples", &list.parts));
    if (graph->value) { /* an object: a string would be a command */
        skg_json_object sample;
        SKG_TRY_CLEANUP(read_sample_object(graph, &sample));
        SKG_TRY_CLEANUP(read_element(reader, graph, &cache, &list));
    }
    SKG_TRY_CLEANUP(fetch_meshes(reader, node, count, &cache));
    for (int64_t i = 0; i < count; i++) {
        skg_json_node element = skg_json_element(node, i);
        SKG_TRY_CLEANUP(read_element(reader, &element, &cache, &list));
    }
    if (list.count == 0 && !reader->source.partial) {
        status = skg_json_fail(node, SKG_ERR_SCENE, "is empty; give at least one sample");
        goto cleanup;
    }
    for (int64_t i = 0; i < list.count; i++)
        SKG_TRY_CLEANUP(read_parent(reader->setup->scene, &list, &list.parts[i]));
    if (list.move_to_centre) SKG_TRY_CLEANUP(move_all_to_centre(reader->setup->scene));
cleanup:
    skg_mesh_cache_clear(&cache);
    skg_free(&list.parts);
    return status;
}
