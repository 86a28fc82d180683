/* Pieces of which bodies are made: they append vertices and triangles to arrays that have room for them. */
#include "mesh/pieces.h"
#include "core/maths.h"

#include <inttypes.h>
#include <math.h>

skg_status skg_check_length(const char *shape, const char *what, double length) {
    if (isfinite(length) && length > 0) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %s %g mm: finite and above 0", shape, what, length);
}

skg_status skg_check_count(const char *shape, const char *what, int64_t count, int64_t fewest, int64_t most) {
    if (count >= fewest && count <= most) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " %s: %" PRId64 " to %" PRId64, shape, count, what,
                    fewest, most);
}

skg_status skg_pieces_start(const char *shape, int64_t vertices, int64_t triangles, skg_mesh_arrays *arrays) {
    *arrays = (skg_mesh_arrays){0};
    if (vertices > SKG_MESH_LIMIT || triangles > SKG_MESH_LIMIT)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: %" PRId64 " triangles are more than a mesh may have (%" PRId64 ")", shape,
                        triangles, SKG_MESH_LIMIT);
    skg_status status = skg_alloc(3 * vertices, sizeof(double), shape, &arrays->positions);
    if (status == SKG_OK) status = skg_alloc(3 * triangles, sizeof(int32_t), shape, &arrays->corners);
    if (status != SKG_OK) skg_mesh_arrays_free(arrays);
    return status;
}

void skg_add_vertex(skg_mesh_arrays *arrays, double x, double y, double z) {
    double *p = arrays->positions + 3 * arrays->vertices++;
    p[0] = x, p[1] = y, p[2] = z;
}

void skg_add_triangle(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c) {
    int32_t *corner = arrays->corners + 3 * arrays->triangles++;
    corner[0] = (int32_t)a, corner[1] = (int32_t)b, corner[2] = (int32_t)c;
}

void skg_add_quad(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c, int64_t d) {
    skg_add_triangle(arrays, a, b, c);
    skg_add_triangle(arrays, a, c, d);
}

void skg_add_cuboid(skg_mesh_arrays *arrays, const double low[3], const double high[3]) {
    const int64_t o = arrays->vertices;
    for (int i = 0; i < 8; i++) /* bits of i: x, y, z at the upper end */
        skg_add_vertex(arrays, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    skg_add_quad(arrays, o + 0, o + 2, o + 3, o + 1); /* -z */
    skg_add_quad(arrays, o + 4, o + 5, o + 7, o + 6); /* +z */
    skg_add_quad(arrays, o + 0, o + 1, o + 5, o + 4); /* -y */
    skg_add_quad(arrays, o + 2, o + 6, o + 7, o + 3); /* +y */
    skg_add_quad(arrays, o + 0, o + 4, o + 6, o + 2); /* -x */
    skg_add_quad(arrays, o + 1, o + 3, o + 7, o + 5); /* +x */
}

void skg_add_fan(skg_mesh_arrays *arrays, int64_t hub, int64_t ring, int64_t segments, int up) {
    for (int64_t s = 0; s < segments; s++) {
        int64_t a = ring + s, b = ring + (s + 1) % segments;
        skg_add_triangle(arrays, hub, up ? a : b, up ? b : a);
    }
}

void skg_add_wall(skg_mesh_arrays *arrays, int64_t lower, int64_t upper, int64_t segments) {
    for (int64_t s = 0; s < segments; s++) {
        int64_t next = (s + 1) % segments;
        skg_add_quad(arrays, lower + s, lower + next, upper + next, upper + s);
    }
}

int64_t skg_sphere_rings(int64_t segments) {
    return segments / 2 < 2 ? 1 : segments / 2 - 1;
}

void skg_add_sphere(skg_mesh_arrays *arrays, const double centre[3], double radius, int64_t segments) {
    const int64_t first = arrays->vertices, rings = skg_sphere_rings(segments), bands = rings + 1;
    skg_add_vertex(arrays, centre[0], centre[1], centre[2] - radius);
    for (int64_t r = 1; r <= rings; r++) {
        const double angle = SKG_PI * (double)r / (double)bands; /* from the lower pole */
        const double out = radius * sin(angle), z = centre[2] - radius * cos(angle);
        for (int64_t s = 0; s < segments; s++) {
            const double turn = 2 * SKG_PI * (double)s / (double)segments;
            skg_add_vertex(arrays, centre[0] + out * cos(turn), centre[1] + out * sin(turn), z);
        }
    }
    skg_add_vertex(arrays, centre[0], centre[1], centre[2] + radius);
    skg_add_fan(arrays, first, first + 1, segments, 0);
    for (int64_t r = 1; r < rings; r++)
        skg_add_wall(arrays, first + 1 + (r - 1) * segments, first + 1 + r * segments, segments);
    skg_add_fan(arrays, first + 1 + rings * segments, first + 1 + (rings - 1) * segments, segments, 1);
}
