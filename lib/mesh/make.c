/* Closed meshes of simple shapes. Their triangles face outward and they are centred at the origin. */
#include "mesh/mesh.h"

#include "core/maths.h"
#include "core/plain.h"

#include <inttypes.h>
#include <math.h>

static skg_status check_length(const char *shape, const char *what, double length) {
    if (isfinite(length) && length > 0) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %s %g mm: finite and above 0", shape, what, length);
}

static skg_status check_count(const char *shape, const char *what, int64_t count, int64_t fewest,
                              int64_t most) {
    if (count >= fewest && count <= most) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " %s: %" PRId64 " to %" PRId64, shape, count, what,
                    fewest, most);
}

static skg_status start(const char *shape, int64_t vertices, int64_t triangles, skg_mesh_arrays *arrays) {
    *arrays = (skg_mesh_arrays){0};
    skg_status status = skg_alloc(3 * vertices, sizeof(double), shape, &arrays->positions);
    if (status == SKG_OK) status = skg_alloc(3 * triangles, sizeof(int32_t), shape, &arrays->corners);
    if (status != SKG_OK) skg_mesh_arrays_free(arrays);
    return status;
}

static void add_vertex(skg_mesh_arrays *arrays, double x, double y, double z) {
    double *p = arrays->positions + 3 * arrays->vertices++;
    p[0] = x, p[1] = y, p[2] = z;
}

static void add_triangle(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c) {
    int32_t *corner = arrays->corners + 3 * arrays->triangles++;
    corner[0] = (int32_t)a, corner[1] = (int32_t)b, corner[2] = (int32_t)c;
}

/* The corners run counter-clockwise as seen from outside. */
static void add_quad(skg_mesh_arrays *arrays, int64_t a, int64_t b, int64_t c, int64_t d) {
    add_triangle(arrays, a, b, c);
    add_triangle(arrays, a, c, d);
}

static skg_status make_cuboid(const char *shape, const double length[3], skg_mesh **mesh) {
    skg_mesh_arrays arrays;
    SKG_TRY(start(shape, 8, 12, &arrays));
    for (int i = 0; i < 8; i++) /* bits of i: x, y, z at the upper end */
        add_vertex(&arrays, (i & 1 ? 0.5 : -0.5) * length[0], (i & 2 ? 0.5 : -0.5) * length[1],
                   (i & 4 ? 0.5 : -0.5) * length[2]);
    add_quad(&arrays, 0, 2, 3, 1); /* -z */
    add_quad(&arrays, 4, 5, 7, 6); /* +z */
    add_quad(&arrays, 0, 1, 5, 4); /* -y */
    add_quad(&arrays, 2, 6, 7, 3); /* +y */
    add_quad(&arrays, 0, 4, 6, 2); /* -x */
    add_quad(&arrays, 1, 3, 7, 5); /* +x */
    return skg_mesh_adopt(NULL, shape, &arrays, mesh);
}

skg_status skg_mesh_create_cube(double edge, skg_mesh **mesh) {
    SKG_PLAIN;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_length("cube", "edge", edge));
    return make_cuboid("cube", (double[3]){edge, edge, edge}, mesh);
}

skg_status skg_mesh_create_cuboid(double length_x, double length_y, double length_z, skg_mesh **mesh) {
    SKG_PLAIN;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_length("cuboid", "length along x", length_x));
    SKG_TRY(check_length("cuboid", "length along y", length_y));
    SKG_TRY(check_length("cuboid", "length along z", length_z));
    return make_cuboid("cuboid", (double[3]){length_x, length_y, length_z}, mesh);
}

/* Adds a ring of vertices around the z axis. Sine and cosine are found for each: a ring turned step by step would not
 * close exactly. */
static void add_ring(skg_mesh_arrays *arrays, double radius, double z, int64_t segments) {
    for (int64_t s = 0; s < segments; s++) {
        double angle = 2 * SKG_PI * (double)s / (double)segments;
        add_vertex(arrays, radius * cos(angle), radius * sin(angle), z);
    }
}

/* Adds triangles from a vertex on the axis to a ring. up: the vertex is above the ring. */
static void add_fan(skg_mesh_arrays *arrays, int64_t hub, int64_t ring, int64_t segments, int up) {
    for (int64_t s = 0; s < segments; s++) {
        int64_t a = ring + s, b = ring + (s + 1) % segments;
        add_triangle(arrays, hub, up ? a : b, up ? b : a);
    }
}

/* Adds the wall between a ring and the one above it. */
static void add_wall(skg_mesh_arrays *arrays, int64_t lower, int64_t upper, int64_t segments) {
    for (int64_t s = 0; s < segments; s++) {
        int64_t next = (s + 1) % segments;
        add_quad(arrays, lower + s, lower + next, upper + next, upper + s);
    }
}

skg_status skg_mesh_create_sphere(double radius, int64_t segments, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_length("sphere", "radius", radius));
    /* 26,000 around are 676 million triangles, within SKG_MESH_LIMIT. */
    SKG_TRY(check_count("sphere", "segments", segments, 3, 26000));
    int64_t bands = segments / 2 < 2 ? 2 : segments / 2, rings = bands - 1;
    SKG_TRY(start("sphere", 2 + rings * segments, 2 * rings * segments, &arrays));
    add_vertex(&arrays, 0, 0, -radius);
    for (int64_t r = 1; r <= rings; r++) {
        double angle = SKG_PI * (double)r / (double)bands; /* from the lower pole */
        add_ring(&arrays, radius * sin(angle), -radius * cos(angle), segments);
    }
    add_vertex(&arrays, 0, 0, radius);
    add_fan(&arrays, 0, 1, segments, 0);
    for (int64_t r = 1; r < rings; r++) add_wall(&arrays, 1 + (r - 1) * segments, 1 + r * segments, segments);
    add_fan(&arrays, 1 + rings * segments, 1 + (rings - 1) * segments, segments, 1);
    return skg_mesh_adopt(NULL, "sphere", &arrays, mesh);
}

skg_status skg_mesh_create_cylinder(double radius, double height, int64_t segments, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_length("cylinder", "radius", radius));
    SKG_TRY(check_length("cylinder", "height", height));
    SKG_TRY(check_count("cylinder", "segments", segments, 3, SKG_MESH_LIMIT / 4));
    SKG_TRY(start("cylinder", 2 + 2 * segments, 4 * segments, &arrays));
    add_vertex(&arrays, 0, 0, -0.5 * height);
    add_ring(&arrays, radius, -0.5 * height, segments);
    add_ring(&arrays, radius, 0.5 * height, segments);
    add_vertex(&arrays, 0, 0, 0.5 * height);
    add_fan(&arrays, 0, 1, segments, 0);
    add_wall(&arrays, 1, 1 + segments, segments);
    add_fan(&arrays, 1 + 2 * segments, 1 + segments, segments, 1);
    return skg_mesh_adopt(NULL, "cylinder", &arrays, mesh);
}

/* The outline lies in the plane of x and z and runs counter-clockwise as seen from -y: along the foot of every edge
 * between steps, then down the stairs from the last step. Front (-y) and back (+y) have `outline` vertices each. */
skg_status skg_mesh_create_step_wedge(double length_x, double length_y, double height_z, int64_t steps,
                                      skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_length("step wedge", "length along x", length_x));
    SKG_TRY(check_length("step wedge", "length along y", length_y));
    SKG_TRY(check_length("step wedge", "height", height_z));
    SKG_TRY(check_count("step wedge", "steps", steps, 1, SKG_MESH_LIMIT / 12));
    int64_t outline = 3 * steps + 1;
    SKG_TRY(start("step wedge", 2 * outline, 12 * steps, &arrays));
    for (int side = 0; side < 2; side++) {
        double y = (side ? 0.5 : -0.5) * length_y, n = (double)steps;
        for (int64_t k = 0; k <= steps; k++)
            add_vertex(&arrays, length_x * ((double)k / n - 0.5), y, -0.5 * height_z);
        for (int64_t k = steps - 1; k >= 0; k--)
            for (int64_t end = 1; end >= 0; end--)
                add_vertex(&arrays, length_x * ((double)(k + end) / n - 0.5), y,
                           height_z * ((double)(k + 1) / n - 0.5));
    }
    for (int64_t k = 0; k < steps; k++) {
        /* Front and back of a step are fans from its lower right corner. The step before ends on its left edge. */
        int64_t foot = k + 1, right = steps + 1 + 2 * (steps - 1 - k), before = right + 2;
        for (int64_t back = 0; back < 2; back++) {
            int64_t ring[5] = {foot, right, right + 1, before, k}, corners = 5;
            if (k == 0) ring[3] = k, corners = 4; /* the first has none before it */
            for (int64_t c = 1; c + 1 < corners; c++)
                add_triangle(&arrays, back * outline + ring[0], back * outline + ring[back ? c + 1 : c],
                             back * outline + ring[back ? c : c + 1]);
        }
    }
    for (int64_t i = 0; i < outline; i++) {
        int64_t next = (i + 1) % outline;
        add_quad(&arrays, i, outline + i, outline + next, next);
    }
    return skg_mesh_adopt(NULL, "step wedge", &arrays, mesh);
}
