/* The surfaces of parts as a page holds them. */
#include "view/surfaces.h"

#include "common/say.h"
#include "core/maths.h"

#include <stdlib.h>
#include <string.h>

/* No part loses all of its shape. */
enum { MIN_TRIANGLES = 100, ROUNDS_MAX = 3 };

static skg_status get_part(const skg_scene *scene, int64_t id, skg_part *part) {
    skg_part_init(part);
    return skg_scene_part_get(scene, id, part);
}

static skg_status count_triangles(const skg_scene *scene, view_shapes *shapes) {
    skg_status status = skg_scene_part_count(scene, &shapes->count);
    for (int64_t i = 0; i < shapes->count && status == SKG_OK; i++) {
        skg_part part;
        int64_t vertices = 0, triangles = 0;
        status = get_part(scene, i, &part);
        if (status == SKG_OK) status = skg_mesh_count(part.mesh, &vertices, &triangles);
        shapes->of += triangles;
    }
    return status;
}

static void free_shape(view_shape *shape) {
    view_surface_free(&shape->surface);
    free(shape->positions);
    *shape = (view_shape){0};
}

static int make_shape(const skg_scene *scene, int64_t id, int64_t frames, double share, view_shape *shape) {
    skg_part part;
    int64_t vertices = 0, triangles = 0;
    skg_status status = get_part(scene, id, &part);
    if (status == SKG_OK) status = skg_mesh_count(part.mesh, &vertices, &triangles);
    if (status != SKG_OK) return cli_fail(status);
    const int64_t wanted = (int64_t)(share * (double)triangles);
    const int exit_status =
        view_thin(&part, wanted > MIN_TRIANGLES ? wanted : MIN_TRIANGLES, &shape->surface);
    if (exit_status != CLI_DONE) return exit_status;
    shape->positions = malloc((size_t)(frames * shape->surface.vertices + 1) * 3 * sizeof *shape->positions);
    return shape->positions ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory for %s", part.label);
}

/* Every part keeps this share of its triangles. */
static int make_shapes(const skg_scene *scene, double share, view_shapes *shapes) {
    int exit_status = CLI_DONE;
    shapes->triangles = 0;
    for (int64_t i = 0; i < shapes->count && exit_status == CLI_DONE; i++) {
        free_shape(shapes->shapes + i);
        exit_status = make_shape(scene, i, shapes->frames, share, shapes->shapes + i);
        shapes->triangles += shapes->shapes[i].surface.triangles;
    }
    return exit_status;
}

int view_shapes_make(const skg_scene *scene, int64_t frames, int64_t most, view_shapes *shapes) {
    *shapes = (view_shapes){.frames = frames};
    const skg_status status = count_triangles(scene, shapes);
    if (status != SKG_OK) return cli_fail(status);
    shapes->shapes = calloc((size_t)shapes->count + 1, sizeof *shapes->shapes);
    if (!shapes->shapes) return cli_error(CLI_DEVICE, "out of host memory");
    double share = shapes->of > most ? (double)most / (double)shapes->of : 1;
    int exit_status = make_shapes(scene, share, shapes);
    /* Where some surfaces keep more than they should, the others keep less. */
    for (int round = 0; round < ROUNDS_MAX && exit_status == CLI_DONE && view_can_thin; round++) {
        if (shapes->triangles <= most) break;
        share *= (double)most / (double)shapes->triangles;
        exit_status = make_shapes(scene, share, shapes);
    }
    return exit_status;
}

static int take_shape(const skg_part *part, int64_t frame, view_shape *shape) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_count(part->mesh, &vertices, &triangles);
    if (status != SKG_OK) return cli_fail(status);
    double *all = malloc((size_t)(vertices + 1) * 3 * sizeof *all);
    if (!all) return cli_error(CLI_DEVICE, "out of host memory for %s", part->label);
    const size_t count = 3 * (size_t)shape->surface.vertices;
    float *to = shape->positions + (size_t)frame * count;
    status = skg_mesh_positions_get(part->mesh, all, 0);
    for (int64_t v = 0; v < shape->surface.vertices && status == SKG_OK; v++) {
        double at[3];
        skg_pose_point(part->pose, all + 3 * shape->surface.origin[v], at);
        for (int k = 0; k < 3; k++) to[3 * v + k] = (float)at[k];
    }
    free(all);
    if (status != SKG_OK) return cli_fail(status);
    if (memcmp(to, shape->positions, count * sizeof *to) != 0) shape->moves = 1;
    return CLI_DONE;
}

int view_shapes_take(const skg_scene *scene, int64_t frame, view_shapes *shapes) {
    int exit_status = CLI_DONE;
    for (int64_t i = 0; i < shapes->count && exit_status == CLI_DONE; i++) {
        skg_part part;
        const skg_status status = get_part(scene, i, &part);
        exit_status = status == SKG_OK ? take_shape(&part, frame, shapes->shapes + i) : cli_fail(status);
    }
    return exit_status;
}

void view_shapes_free(view_shapes *shapes) {
    for (int64_t i = 0; shapes->shapes && i < shapes->count; i++) free_shape(shapes->shapes + i);
    free(shapes->shapes);
    *shapes = (view_shapes){0};
}
