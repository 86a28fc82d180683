/* Refuses what a glTF file says and Assimp passes over, though it moves vertices: extensions, skins, morph targets. */
#include "mesh/gltf_unread.h"

#include <stdio.h>
#include <string.h>

enum { FLOAT = 5126 }; /* glTF 2.0, 3.6.2.2 */

/* Extensions that a file may require: how their names begin. They concern looks or notes, except those that Assimp applies (Draco,
 * the binary form of version 1) and quantised attributes, whose positions are looked at. */
static const char *const harmless[] = {"KHR_materials_",       "KHR_texture_",
                                       "KHR_lights_",          "KHR_xmp",
                                       "KHR_techniques_webgl", "EXT_texture_",
                                       "MSFT_texture_",        "EXT_lights_",
                                       "KHR_binary_glTF",      "KHR_draco_mesh_compression",
                                       "ADOBE_materials_",     "VRMC_materials_",
                                       "KHR_mesh_quantization"};

json_t *skg_gltf_find(json_t *root, const char *list, const json_t *name) {
    json_t *all = json_object_get(root, list);
    if (json_is_string(name)) return json_object_get(all, json_string_value(name));
    const json_int_t index = json_integer_value(name);
    return json_is_integer(name) && index >= 0 ? json_array_get(all, (size_t)index) : NULL;
}

static int is_harmless(const char *name) {
    for (size_t k = 0; k < sizeof harmless / sizeof *harmless; k++)
        if (strncmp(name, harmless[k], strlen(harmless[k])) == 0) return 1;
    return 0;
}

static skg_status check_extensions(const char *path, json_t *root) {
    json_t *name;
    size_t k;
    json_array_foreach(json_object_get(root, "extensionsRequired"), k, name) {
        const char *text = json_string_value(name);
        if (text && !is_harmless(text))
            return skg_fail(
                SKG_ERR_FORMAT,
                "%s: requires the extension \"%.64s\", which is not read: what it says of the shape would be "
                "missing; export the file again without it",
                path, text);
    }
    return SKG_OK;
}

static skg_status fail_node(const char *path, const char *number, const json_t *node, const char *has) {
    const char *name = json_string_value(json_object_get(node, "name"));
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: the node \"%.64s\" has %s in the program that made it, and export again", path,
                    name ? name : number, has);
}

static int is_moved(const json_t *weights) {
    const json_t *weight;
    size_t k;
    json_array_foreach(weights, k, weight) if (json_number_value(weight) != 0) return 1;
    return 0;
}

static skg_status check_primitives(const char *path, json_t *root, const json_t *mesh, int *has_targets) {
    const json_t *primitive;
    size_t k;
    json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
        const json_t *position = json_object_get(json_object_get(primitive, "attributes"), "POSITION");
        const json_t *type = json_object_get(skg_gltf_find(root, "accessors", position), "componentType");
        *has_targets |= json_array_size(json_object_get(primitive, "targets")) > 0;
        if (json_is_integer(type) && json_integer_value(type) != FLOAT)
            return skg_fail(
                SKG_ERR_FORMAT,
                "%s: has positions that are whole numbers (KHR_mesh_quantization), which are not read; export "
                "the file again without quantisation",
                path);
    }
    return SKG_OK;
}

/* Weights of a node win over those of its mesh (glTF 2.0, 3.7.2.2). */
static skg_status check_node(const char *path, json_t *root, const char *number, const json_t *node) {
    const json_t *mesh = skg_gltf_find(root, "meshes", json_object_get(node, "mesh"));
    const json_t *weights = json_object_get(node, "weights");
    int has_targets = 0;
    if (json_object_get(json_object_get(node, "extensions"), "EXT_mesh_gpu_instancing"))
        return fail_node(
            path, number, node,
            "instances by the extension \"EXT_mesh_gpu_instancing\", which is not read: each would be "
            "missing; make objects of them");
    if (!mesh) return SKG_OK;
    if (json_object_get(node, "skin"))
        return fail_node(path, number, node, "a skin, whose pose is not read; apply the pose to the mesh");
    SKG_TRY(check_primitives(path, root, mesh, &has_targets));
    if (has_targets && is_moved(weights ? weights : json_object_get(mesh, "weights")))
        return fail_node(path, number, node,
                         "morph targets of weights other than 0, which are not read; apply them to the mesh");
    return SKG_OK;
}

skg_status skg_mesh_check_gltf_unread(const char *path, json_t *root) {
    json_t *nodes = json_object_get(root, "nodes"), *node;
    const char *name;
    char number[24];
    size_t k;
    SKG_TRY(check_extensions(path, root));
    json_object_foreach(nodes, name, node) SKG_TRY(check_node(path, root, name, node));
    json_array_foreach(nodes, k, node) {
        snprintf(number, sizeof number, "%zu", k);
        SKG_TRY(check_node(path, root, number, node));
    }
    return SKG_OK;
}
