/* The verb `mesh`: the health of a mesh, and its repair. */
#include "verbs/mesh_groups.h"
#include "verbs/mesh_volume.h"
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "common/values.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Properties that the verb reports of a mesh. */
typedef struct {
    skg_mesh_health health;
    skg_mesh_nesting nesting;
    skg_mesh_unit unit;
    json_t *groups; /* NULL: not asked for */
} findings;

static const char *const origins[] = {
    [SKG_UNIT_ASSUMED] = "assumed", [SKG_UNIT_FILE] = "file", [SKG_UNIT_NAMED] = "named"};

static json_t *unit_json(const skg_mesh_unit *unit) {
    return json_pack("{s:s,s:f,s:s}", "name", unit->name, "mm", unit->mm, "from", origins[unit->from]);
}

static json_t *health_json(const char *path, const findings *found) {
    const skg_mesh_health *health = &found->health;
    const skg_mesh_nesting *nesting = &found->nesting;
    json_t *object = json_object();
    json_object_set_new(object, "file", cli_json_text(path));
    json_object_set_new(object, "unit", unit_json(&found->unit));
    if (found->groups) json_object_set(object, "groups", found->groups);
    json_object_set_new(object, "triangles", json_integer(health->triangles));
    json_object_set_new(object, "vertices", json_integer(health->vertices));
    json_object_set_new(object, "closed", json_boolean(health->closed));
    json_object_set_new(object, "open_edges", json_integer(health->open_edges));
    json_object_set_new(object, "flipped", json_boolean(health->flipped));
    json_object_set_new(object, "components", json_integer(health->components));
    json_object_set_new(object, "volume_mm3", cli_json_number(health->volume));
    json_object_set_new(object, "area_mm2", cli_json_number(health->area));
    json_object_set_new(object, "bounds", cli_json_numbers(health->bounds, 6));
    json_object_set_new(object, "welded_vertices", json_integer(health->welded_vertices));
    json_object_set_new(object, "nonmanifold_edges", json_integer(health->nonmanifold_edges));
    json_object_set_new(object, "degenerate_triangles", json_integer(health->degenerate_triangles));
    json_object_set_new(object, "duplicate_triangles", json_integer(health->duplicate_triangles));
    json_object_set_new(object, "turned", json_integer(health->turned));
    json_object_set_new(object, "same_way_edges", json_integer(health->same_way_edges));
    json_object_set_new(object, "one_sided", json_integer(health->one_sided));
    if (health->turned)
        json_object_set_new(object, "first_turned_position_mm",
                            cli_json_numbers(health->first_turned_position, 3));
    json_object_set_new(object, "left_out", json_integer(health->left_out));
    json_object_set_new(object, "trailing_bytes", json_integer(health->trailing_bytes));
    json_object_set_new(object, "duplicates", json_integer(health->duplicate_triangles));
    json_object_set_new(object, "inverted_components", json_integer(nesting->inverted));
    if (nesting->inverted)
        json_object_set_new(object, "inverted_position_mm", cli_json_numbers(nesting->inverted_place, 3));
    json_object_set_new(object, "leaving_cavities", json_integer(nesting->leaving));
    if (nesting->leaving)
        json_object_set_new(object, "leaving_position_mm", cli_json_numbers(nesting->leaving_place, 3));
    json_object_set_new(object, "overlapping_components", json_integer(nesting->overlapping));
    if (nesting->overlapping)
        json_object_set_new(object, "overlapping_position_mm",
                            cli_json_numbers(nesting->overlapping_place, 3));
    if (!health->closed) {
        json_object_set_new(object, "first_open_vertex", json_integer(health->first_open_vertex));
        json_object_set_new(object, "first_open_position_mm",
                            cli_json_numbers(health->first_open_position, 3));
    }
    return object;
}

static void print_unit(const skg_mesh_unit *unit) {
    static const char *const words[] = {[SKG_UNIT_ASSUMED] = ", assumed: the file names none",
                                        [SKG_UNIT_FILE] = ", from the file",
                                        [SKG_UNIT_NAMED] = ", as named"};
    const int differs = unit->from == SKG_UNIT_NAMED && unit->file_mm > 0 && unit->file_mm != unit->mm;
    printf("  unit: %s%s", unit->name, words[unit->from]);
    if (differs) printf("; the file says %g mm", unit->file_mm);
    printf("\n");
}

static void print_groups(json_t *groups) {
    size_t i;
    json_t *group;
    json_array_foreach(groups, i, group) {
        const char *name = json_string_value(json_object_get(group, "name"));
        cli_print("  group \"%s\": %" JSON_INTEGER_FORMAT " triangles\n", name ? name : "",
                  json_integer_value(json_object_get(group, "triangles")));
    }
}

static void print_health(const char *path, const skg_mesh_health *health) {
    const double *b = health->bounds, *p = health->first_open_position, *q = health->first_turned_position;
    cli_print("%s: %s%s%s\n", path, health->closed ? "closed" : "LEAKY",
              health->turned ? ", wound inconsistently" : "",
              health->flipped ? ", wound inward (turned outward)" : "");
    if (health->turned)
        printf("  %" PRId64 " directed edges that two triangles run along in one direction; %" PRId64
               " triangles turned, first number %" PRId64
               " near (%.6g, %.6g, %.6g) mm. --fix -o FILE writes them so\n",
               health->same_way_edges, health->turned, health->first_turned, q[0], q[1], q[2]);
    if (health->left_out) printf("  %" PRId64 " points or lines left out\n", health->left_out);
    if (health->trailing_bytes)
        printf("  %" PRId64 " bytes behind the last triangle are not read\n", health->trailing_bytes);
    if (health->one_sided)
        printf("  %" PRId64 " patches are one-sided, as a Moebius strip is; turning cannot mend them\n",
               health->one_sided);
    if (!health->closed)
        printf("  %" PRId64 " open edges, first at vertex %" PRId64 " (%.6g, %.6g, %.6g) mm\n",
               health->open_edges, health->first_open_vertex, p[0], p[1], p[2]);
    printf("  %" PRId64 " triangles, %" PRId64 " vertices (%" PRId64 " after welding), %" PRId64
           " component%s\n",
           health->triangles, health->vertices, health->welded_vertices, health->components,
           health->components == 1 ? "" : "s");
    if (health->closed) printf("  volume %.6g mm3,", health->volume);
    printf("%s area %.6g mm2, x %.6g to %.6g, y %.6g to %.6g, z %.6g to %.6g mm\n", health->closed ? "" : " ",
           health->area, b[0], b[3], b[1], b[4], b[2], b[5]);
    if (health->degenerate_triangles || health->duplicate_triangles || health->nonmanifold_edges)
        printf("  %" PRId64 " degenerate and %" PRId64 " duplicate triangles, %" PRId64
               " edges of more than two triangles\n",
               health->degenerate_triangles, health->duplicate_triangles, health->nonmanifold_edges);
}

static void print_nesting(const skg_mesh_nesting *nesting) {
    char text[1024];
    if (skg_mesh_nesting_describe(nesting, sizeof text, text) != SKG_OK || !*text) return;
    printf("  %s%s\n", text, nesting->inverted ? ". --fix -o FILE turns inverted components" : "");
}

/* Loads a mesh and examines it. fixed: NULL, or where it is written with its inverted components turned. */
static skg_status examine(const char *path, const skg_mesh_reading *reading, const char *fixed,
                          int lists_groups, findings *found) {
    skg_mesh *mesh = NULL, *oriented = NULL;
    skg_mesh_health *health = &found->health;
    skg_mesh_nesting *nesting = &found->nesting;
    skg_mesh_health_init(health);
    skg_mesh_nesting_init(nesting);
    skg_mesh_unit_init(&found->unit);
    found->groups = NULL;
    skg_status status = skg_mesh_load_as(NULL, path, reading, &mesh);
    if (status == SKG_OK) status = skg_mesh_unit_get(mesh, &found->unit);
    if (status == SKG_OK && lists_groups) status = cli_mesh_groups(mesh, &found->groups);
    if (status == SKG_OK && fixed) status = skg_mesh_create_oriented(NULL, mesh, &oriented);
    if (status == SKG_OK && fixed) status = skg_mesh_save(oriented, fixed);
    const skg_mesh *examined = fixed ? oriented : mesh;
    if (status == SKG_OK) status = skg_mesh_health_get(examined, health);
    if (status == SKG_OK) status = skg_mesh_nesting_get(examined, nesting);
    if (status == SKG_OK && fixed) { /* what the file was, before it was written */
        skg_mesh_health was;
        skg_mesh_health_init(&was);
        status = skg_mesh_health_get(mesh, &was);
        health->turned = was.turned, health->first_turned = was.first_turned;
        health->same_way_edges = was.same_way_edges;
        for (int k = 0; k < 3; k++) health->first_turned_position[k] = was.first_turned_position[k];
    }
    skg_mesh_release(&mesh);
    skg_mesh_release(&oriented);
    return status;
}

/* The file of -o, which goes with --fix and one mesh. */
static int read_fix(const cli_arguments *arguments, const char **fixed) {
    *fixed = cli_value(arguments, "-o");
    if (!*fixed && !cli_given(arguments, "--fix")) return CLI_DONE;
    if (!*fixed || !cli_given(arguments, "--fix") || arguments->operand_count != 1)
        return cli_error(CLI_USAGE,
                         "mesh: --fix and -o go together, with one mesh: mesh FILE --fix -o OTHER");
    if (!cli_has_extension(*fixed, ".stl") && !cli_has_extension(*fixed, ".ply"))
        return cli_error(CLI_USAGE, "%s: a mesh is written as .ply or .stl", *fixed);
    return CLI_DONE;
}

/* Examines every file. Returns the exit status of the first that cannot be read. */
int cli_mesh(const cli_arguments *arguments) {
    skg_mesh_reading reading;
    const char *fixed = NULL;
    skg_mesh_reading_init(&reading);
    reading.group = cli_value(arguments, "--group");
    int exit_status = cli_mesh_unit(arguments, &reading.unit_mm);
    if (exit_status == CLI_DONE && (cli_given(arguments, "--split") || cli_given(arguments, "--scene")))
        return cli_mesh_split(arguments, &reading);
    if (exit_status == CLI_DONE) exit_status = read_fix(arguments, &fixed);
    if (exit_status != CLI_DONE) return exit_status;
    json_t *list = cli_given(arguments, "--json") ? json_array() : NULL;
    const int strict = cli_given(arguments, "--strict");
    int failure = CLI_DONE, all_healthy = 1;
    for (int i = 0; i < arguments->operand_count; i++) {
        const char *path = arguments->operands[i];
        findings found;
        if (cli_is_volume(path)) {
            const skg_status read = cli_mesh_volume(path, reading.unit_mm, list);
            if (read != SKG_OK && failure == CLI_DONE) failure = cli_fail(read);
            continue;
        }
        skg_status status = examine(path, &reading, fixed, cli_given(arguments, "--groups"), &found);
        const skg_mesh_health *health = &found.health;
        const skg_mesh_nesting *nesting = &found.nesting;
        if (status != SKG_OK) {
            int its = cli_fail(status);
            if (failure == CLI_DONE) failure = its;
            json_decref(found.groups);
            continue;
        }
        all_healthy = all_healthy && health->closed && !(strict && (health->turned || health->flipped)) &&
                      nesting->inverted == 0 && nesting->leaving == 0 && nesting->overlapping == 0 &&
                      health->duplicate_triangles == 0;
        if (list)
            json_array_append_new(list, health_json(path, &found));
        else if (!cli_is_quiet())
            print_health(path, health), print_unit(&found.unit), print_nesting(nesting),
                print_groups(found.groups);
        json_decref(found.groups);
        if (fixed && !list && !cli_is_quiet()) cli_print("wrote %s\n", fixed);
    }
    if (list) {
        json_t *object = json_object();
        json_object_set_new(object, "files", list);
        exit_status = cli_json_print(object);
        if (exit_status != CLI_DONE) return exit_status;
    }
    return failure != CLI_DONE ? failure : all_healthy ? CLI_DONE : CLI_CHECK_FAILED;
}
