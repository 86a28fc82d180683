/* Named groups of a file in the verb mesh: lists them, and splits a file into one file a part with a scene. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "verbs/mesh_groups.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "common/values.h"
#include "manual/manual.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

skg_status cli_mesh_groups(const skg_mesh *mesh, json_t **groups) {
    int64_t count = 0;
    json_t *list = json_array(), *by_name = json_object();
    skg_status status = skg_mesh_group_count(mesh, &count);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) {
        const char *name = NULL;
        int64_t triangles = 0;
        status = skg_mesh_group_get(mesh, i, &name, NULL, &triangles);
        if (status != SKG_OK || !name || triangles == 0) continue;
        json_t *known = json_object_get(by_name, name);
        if (known) {
            json_t *sum = json_object_get(known, "triangles");
            json_integer_set(sum, json_integer_value(sum) + triangles);
            continue;
        }
        known = json_pack("{s:o,s:I}", "name", cli_json_text(name), "triangles", (json_int_t)triangles);
        json_array_append(list, known);
        json_object_set_new(by_name, name, known);
    }
    json_decref(by_name);
    *groups = list;
    return status;
}

/* A path of a file as the scene file names it: from the scene's folder, so that both may be moved, if the file lies in it; otherwise
 * absolute. scene: NULL: there is none */
static json_t *path_from(const char *scene, const char *path) {
    char *whole = realpath(path, NULL), *folder = NULL;
    if (scene) {
        const char *slash = strrchr(scene, '/');
        char *above = slash ? strndup(scene, (size_t)(slash - scene + 1)) : strdup(".");
        folder = above ? realpath(above, NULL) : NULL;
        free(above);
    }
    const size_t length = folder ? strlen(folder) : 0;
    const int below = whole && length > 1 && strncmp(whole, folder, length) == 0 && whole[length] == '/';
    json_t *text = cli_json_text(below ? whole + length + 1 : whole ? whole : path);
    free(folder);
    free(whole);
    return text;
}

/* Writes one group, and adds its sample. */
static int write_group(const char *file, const char *folder, const char *scene,
                       const skg_mesh_reading *reading, const char *name, int64_t number, json_t *samples) {
    skg_mesh_reading its = *reading;
    char plain[CLI_NAME_OF_PART];
    skg_mesh *mesh = NULL;
    its.group = name;
    cli_name_of_part(name, number, plain);
    char *path = cli_path_in(folder, "%s.ply", plain);
    if (!path) return cli_error(CLI_DEVICE, "out of host memory");
    skg_status status = skg_mesh_load_as(NULL, file, &its, &mesh);
    if (status == SKG_OK) status = skg_mesh_save(mesh, path);
    if (status == SKG_OK)
        json_array_append_new(samples,
                              json_pack("{s:o,s:o,s:s,s:s,s:n}", "Label", cli_json_text(name), "Path",
                                        path_from(scene, path), "Unit", "mm", "Material", "Water", "Parent"));
    skg_mesh_release(&mesh);
    free(path);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int write_scene(const char *path, json_t *samples) {
    json_t *scene = json_pack("{s:s,s:{s:s,s:s,s:[{s:i,s:s,s:i}]},s:O}", "$schema", "scene.schema.json",
                              "Source", "Shape", "PointSource", "From", "front", "Beam", "Energy", 60, "Unit",
                              "keV", "PhotonCount", 1000, "Samples", samples);
    char *text = scene ? json_dumps(scene, JSON_INDENT(2)) : NULL;
    json_decref(scene);
    if (!text) return cli_error(CLI_DEVICE, "out of host memory");
    const int exit_status = cli_write_file(path, text, strlen(text));
    free(text);
    return exit_status;
}

/* Lists the groups of the one file. */
static int list_groups(const char *file, const skg_mesh_reading *reading, json_t **groups) {
    skg_mesh *mesh = NULL;
    skg_status status = skg_mesh_load_as(NULL, file, reading, &mesh);
    if (status == SKG_OK) status = cli_mesh_groups(mesh, groups);
    skg_mesh_release(&mesh);
    if (status != SKG_OK) return cli_fail(status);
    if (json_array_size(*groups) > 0) return CLI_DONE;
    return cli_error(CLI_INPUT, "%s: has no groups or objects with names; the whole file is one part", file);
}

int cli_mesh_split(const cli_arguments *arguments, const skg_mesh_reading *reading) {
    const char *folder = cli_value(arguments, "--split"), *file = arguments->operands[0];
    const char *scene = cli_value(arguments, "--scene");
    json_t *groups = NULL, *samples = json_array();
    if (!folder || arguments->operand_count != 1 || reading->group)
        return cli_error(CLI_USAGE, "mesh: --split takes one file: mesh FILE --split DIR --scene FILE");
    int exit_status = scene ? cli_file_check(scene) : CLI_DONE;
    if (exit_status == CLI_DONE) exit_status = list_groups(file, reading, &groups);
    if (exit_status == CLI_DONE) exit_status = cli_make_folder(folder);
    for (size_t i = 0; exit_status == CLI_DONE && i < json_array_size(groups); i++)
        exit_status = write_group(file, folder, scene, reading,
                                  json_string_value(json_object_get(json_array_get(groups, i), "name")),
                                  (int64_t)i, samples);
    if (exit_status == CLI_DONE && scene) exit_status = write_scene(scene, samples);
    if (exit_status == CLI_DONE && cli_given(arguments, "--json")) {
        json_t *object = json_pack("{s:o,s:O}", "folder", cli_json_text(folder), "groups", groups);
        if (scene) json_object_set_new(object, "scene", cli_json_text(scene));
        exit_status = cli_json_print(object);
    } else if (exit_status == CLI_DONE && !cli_is_quiet())
        cli_print("wrote %zu parts to %s%s%s\n", json_array_size(groups), folder, scene ? " and " : "",
                  scene ? scene : "");
    json_decref(groups);
    json_decref(samples);
    return exit_status;
}
