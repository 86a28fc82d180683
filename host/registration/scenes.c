/* Scenes that a registration renders, made of the parts of the caller's. */
#include "registration/types.h"

#include "core/eigen.h"

#include <string.h>

static int moves(const skg_registration *r, int64_t part) {
    for (int64_t p = 0; p < r->part_count; p++)
        if (r->parts[p] == part) return 1;
    return 0;
}

/* Marks the parts that a scene of this kind has. */
static skg_status choose(const skg_registration *r, reg_kind kind, int64_t count, char *chosen) {
    skg_part part;
    skg_part_init(&part);
    if (kind == REG_ALL || kind == REG_REST) memset(chosen, 1, (size_t)count);
    for (int64_t p = 0; p < r->part_count; p++) {
        chosen[r->parts[p]] = 1;
        if (kind == REG_SHADOW) continue;
        SKG_TRY(skg_scene_part_get(r->scene, r->parts[p], &part));
        for (int64_t steps = 0; part.inside >= 0 && steps < count; steps++) {
            chosen[part.inside] = 1;
            SKG_TRY(skg_scene_part_get(r->scene, part.inside, &part));
        }
    }
    for (int64_t p = 0; p < r->part_count && (kind == REG_AROUND || kind == REG_REST); p++)
        chosen[r->parts[p]] = 0;
    return SKG_OK;
}

/* Adds a part after the one that it lies inside. number: [parts] of each in the new scene, -1: not yet. */
static skg_status add(const skg_registration *r, reg_kind kind, int64_t id, const char *chosen,
                      int64_t *number, reg_scene *made) {
    skg_part part;
    if (number[id] >= 0) return SKG_OK;
    skg_part_init(&part);
    SKG_TRY(skg_scene_part_get(r->scene, id, &part));
    if (kind == REG_SHADOW) part.inside = -1;
    if (part.inside >= 0) {
        if (chosen[part.inside]) SKG_TRY(add(r, kind, part.inside, chosen, number, made));
        part.inside = chosen[part.inside] ? number[part.inside] : -1;
    }
    SKG_TRY(skg_scene_part_add(made->scene, &part, &number[id]));
    if (moves(r, id)) made->parts[made->count++] = number[id];
    return SKG_OK;
}

skg_status reg_scene_make(const skg_registration *r, reg_kind kind, reg_scene *made) {
    int64_t count = 0, *number = NULL;
    char *chosen = NULL;
    skg_status status = SKG_OK;
    *made = (reg_scene){0};
    SKG_TRY(skg_scene_part_count(r->scene, &count));
    SKG_TRY_CLEANUP(skg_alloc(count, 1, "parts of a registration", &chosen));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *number, "parts of a registration", &number));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *made->parts, "parts of a registration", &made->parts));
    SKG_TRY_CLEANUP(skg_scene_create(NULL, &made->scene)); /* its parts were warned of when they were read */
    SKG_TRY_CLEANUP(choose(r, kind, count, chosen));
    for (int64_t id = 0; id < count; id++) number[id] = -1;
    for (int64_t id = 0; id < count; id++)
        if (chosen[id]) SKG_TRY_CLEANUP(add(r, kind, id, chosen, number, made));
cleanup:
    skg_free(&chosen);
    skg_free(&number);
    if (status != SKG_OK) reg_scene_free(made);
    return status;
}

void reg_scene_free(reg_scene *made) {
    skg_scene_release(&made->scene);
    skg_free(&made->parts);
    made->count = 0;
}

/* Adds the vertices of a part to sums: [0] their number, [1..3] coordinates, [4..9] products. about: [3]; NULL: 0. */
static skg_status sum_vertices(const skg_registration *r, int64_t id, const double *about, double *sums) {
    skg_part part;
    int64_t vertices = 0, triangles = 0;
    double *positions = NULL;
    skg_part_init(&part);
    SKG_TRY(skg_scene_part_get(r->scene, id, &part));
    SKG_TRY(skg_mesh_count(part.mesh, &vertices, &triangles));
    SKG_TRY(skg_alloc(3 * vertices, sizeof *positions, "vertices of a body", &positions));
    const skg_status status = skg_mesh_positions_get(part.mesh, positions, 0);
    for (int64_t v = 0; v < vertices && status == SKG_OK; v++) {
        double x[3];
        skg_pose_point(part.pose, positions + 3 * v, x);
        if (about) skg_add_scaled(x, -1, about, x);
        sums[0] += 1;
        for (int k = 0; k < 3; k++) sums[1 + k] += x[k];
        for (int k = 0, at = 4; k < 3; k++)
            for (int l = k; l < 3; l++) sums[at++] += x[k] * x[l];
    }
    skg_free(&positions);
    return status;
}

/* Attenuations add unless parts compete by priority. */
static skg_status find_additive(skg_registration *r) {
    int64_t count = 0;
    int32_t first = 0;
    skg_part part;
    skg_part_init(&part);
    SKG_TRY(skg_scene_part_count(r->scene, &count));
    r->additive = r->options.free == SKG_REGISTRATION_FREE_POSE && !r->plan.clip && !r->plan.unite;
    for (int64_t id = 0; id < count; id++) {
        SKG_TRY(skg_scene_part_get(r->scene, id, &part));
        if (id == 0) first = part.priority;
        if (part.priority != first) r->additive = 0;
    }
    return SKG_OK;
}

skg_status reg_body_measure(skg_registration *r) {
    double sums[10] = {0}, matrix[9], values[3], vectors[9], moved[10] = {0};
    for (int64_t p = 0; p < r->part_count; p++) SKG_TRY(sum_vertices(r, r->parts[p], NULL, sums));
    if (!(sums[0] > 0)) return skg_fail(SKG_ERR_MESH, "the parts to register have no vertices");
    skg_scale_vector(1 / sums[0], sums + 1, r->middle);
    for (int64_t p = 0; p < r->part_count; p++) SKG_TRY(sum_vertices(r, r->parts[p], r->middle, moved));
    for (int k = 0, at = 4; k < 3; k++)
        for (int l = k; l < 3; l++) matrix[3 * k + l] = matrix[3 * l + k] = moved[at++] / moved[0];
    r->radius = sqrt(matrix[0] + matrix[4] + matrix[8]);
    if (!(r->radius > 0)) return skg_fail(SKG_ERR_MESH, "the parts to register have no extent");
    skg_eigen(3, matrix, values, vectors);
    memcpy(r->axis, vectors, sizeof r->axis); /* of the largest value */
    return find_additive(r);
}
