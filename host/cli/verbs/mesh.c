#include "verbs/verbs.h"

#include "common/json.h"
#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const double units_mm[] = {1e-3, 1, 10, 100, 1000}; /* by the values of --unit */

static json_t *health_json(const char *path, const skg_mesh_health *health) {
    json_t *object = json_object();
    json_object_set_new(object, "file", cli_json_text(path));
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
    if (!health->closed) {
        json_object_set_new(object, "first_open_vertex", json_integer(health->first_open_vertex));
        json_object_set_new(object, "first_open_position_mm",
                            cli_json_numbers(health->first_open_position, 3));
    }
    return object;
}

static void print_health(const char *path, const skg_mesh_health *health) {
    const double *b = health->bounds, *p = health->first_open_position;
    printf("%s: %s%s\n", path, health->closed ? "closed" : "LEAKY",
           health->flipped ? ", wound inward (turned outward)" : "");
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

static skg_status examine(const char *path, double unit_mm, skg_mesh_health *health) {
    skg_mesh *mesh = NULL;
    skg_mesh_health_init(health);
    skg_status status = skg_mesh_load(NULL, path, unit_mm, &mesh);
    if (status == SKG_OK) status = skg_mesh_health_get(mesh, health);
    skg_mesh_release(&mesh);
    return status;
}

/* Examines every file. Returns the exit status of the first that cannot be read. */
int cli_mesh(const cli_arguments *arguments) {
    int32_t chosen = 1;
    int exit_status = cli_choice(arguments, &cli_flag_mesh_unit, &chosen);
    if (exit_status != CLI_DONE) return exit_status;
    json_t *list = cli_given(arguments, &cli_flag_json) ? json_array() : NULL;
    int failure = CLI_DONE, all_closed = 1;
    for (int i = 0; i < arguments->operand_count; i++) {
        const char *path = arguments->operands[i];
        skg_mesh_health health;
        skg_status status = examine(path, units_mm[chosen], &health);
        if (status != SKG_OK) {
            int its = cli_fail(status);
            if (failure == CLI_DONE) failure = its;
            continue;
        }
        all_closed = all_closed && health.closed;
        if (list)
            json_array_append_new(list, health_json(path, &health));
        else if (!cli_is_quiet())
            print_health(path, &health);
    }
    if (list) {
        json_t *object = json_object();
        json_object_set_new(object, "files", list);
        exit_status = cli_json_print(object);
        if (exit_status != CLI_DONE) return exit_status;
    }
    return failure != CLI_DONE ? failure : all_closed ? CLI_DONE : CLI_CHECK_FAILED;
}
