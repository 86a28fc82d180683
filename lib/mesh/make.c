/* Closed meshes of simple shapes. Their triangles face outward and they are centred at the origin. */
#include "mesh/mesh.h"
#include "mesh/pieces.h"

#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>

static skg_status make_cuboid(const char *shape, const double length[3], skg_mesh **mesh) {
    const double low[3] = {-0.5 * length[0], -0.5 * length[1], -0.5 * length[2]};
    const double high[3] = {0.5 * length[0], 0.5 * length[1], 0.5 * length[2]};
    skg_mesh_arrays arrays;
    SKG_TRY(skg_pieces_start(shape, 8, 12, &arrays));
    skg_add_cuboid(&arrays, low, high);
    return skg_mesh_adopt(NULL, shape, &arrays, mesh);
}

skg_status skg_mesh_create_cube(double edge, skg_mesh **mesh) {
    SKG_PLAIN;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length("cube", "edge", edge));
    return make_cuboid("cube", (double[3]){edge, edge, edge}, mesh);
}

skg_status skg_mesh_create_cuboid(double length_x, double length_y, double length_z, skg_mesh **mesh) {
    SKG_PLAIN;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length("cuboid", "length along x", length_x));
    SKG_TRY(skg_check_length("cuboid", "length along y", length_y));
    SKG_TRY(skg_check_length("cuboid", "length along z", length_z));
    return make_cuboid("cuboid", (double[3]){length_x, length_y, length_z}, mesh);
}

/* Adds a ring of vertices around the z axis. Sine and cosine are found for each: a ring turned step by step would not
 * close exactly. */
static void add_ring(skg_mesh_arrays *arrays, double radius, double z, int64_t segments) {
    for (int64_t s = 0; s < segments; s++) {
        double angle = 2 * SKG_PI * (double)s / (double)segments;
        skg_add_vertex(arrays, radius * cos(angle), radius * sin(angle), z);
    }
}

skg_status skg_mesh_create_sphere(double radius, int64_t segments, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length("sphere", "radius", radius));
    /* 26,000 around are 676 million triangles, within SKG_MESH_LIMIT. */
    SKG_TRY(skg_check_count("sphere", "segments", segments, 3, 26000));
    const int64_t rings = skg_sphere_rings(segments);
    SKG_TRY(skg_pieces_start("sphere", 2 + rings * segments, 2 * rings * segments, &arrays));
    skg_add_sphere(&arrays, (double[3]){0, 0, 0}, radius, segments);
    return skg_mesh_adopt(NULL, "sphere", &arrays, mesh);
}

skg_status skg_mesh_create_cylinder(double radius, double height, int64_t segments, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length("cylinder", "radius", radius));
    SKG_TRY(skg_check_length("cylinder", "height", height));
    SKG_TRY(skg_check_count("cylinder", "segments", segments, 3, SKG_MESH_LIMIT / 4));
    SKG_TRY(skg_pieces_start("cylinder", 2 + 2 * segments, 4 * segments, &arrays));
    skg_add_vertex(&arrays, 0, 0, -0.5 * height);
    add_ring(&arrays, radius, -0.5 * height, segments);
    add_ring(&arrays, radius, 0.5 * height, segments);
    skg_add_vertex(&arrays, 0, 0, 0.5 * height);
    skg_add_fan(&arrays, 0, 1, segments, 0);
    skg_add_wall(&arrays, 1, 1 + segments, segments);
    skg_add_fan(&arrays, 1 + 2 * segments, 1 + segments, segments, 1);
    return skg_mesh_adopt(NULL, "cylinder", &arrays, mesh);
}

/* Adds front (-y) or back (+y): along the foot of every edge between steps, then down the stairs from the last step. */
static void add_stairs(skg_mesh_arrays *arrays, const double length[2], const double *heights, int64_t steps,
                       int back) {
    const double y = (back ? 0.5 : -0.5) * length[1], n = (double)steps, middle = 0.5 * heights[steps - 1];
    for (int64_t k = 0; k <= steps; k++)
        skg_add_vertex(arrays, length[0] * ((double)k / n - 0.5), y, -middle);
    for (int64_t k = steps - 1; k >= 0; k--)
        for (int64_t end = 1; end >= 0; end--)
            skg_add_vertex(arrays, length[0] * ((double)(k + end) / n - 0.5), y, heights[k] - middle);
}

/* The outline lies in the plane of x and z and runs counter-clockwise as seen from -y. Front and back have `outline`
 * vertices each. Heights rise. */
static skg_status make_steps(const double length[2], const double *heights, int64_t steps, skg_mesh **mesh) {
    skg_mesh_arrays arrays;
    int64_t outline = 3 * steps + 1;
    SKG_TRY(skg_pieces_start("step wedge", 2 * outline, 12 * steps, &arrays));
    for (int back = 0; back < 2; back++) add_stairs(&arrays, length, heights, steps, back);
    for (int64_t k = 0; k < steps; k++) {
        /* Front and back of a step are fans from its lower right corner. The step before ends on its left edge. */
        int64_t foot = k + 1, right = steps + 1 + 2 * (steps - 1 - k), before = right + 2;
        for (int64_t back = 0; back < 2; back++) {
            int64_t ring[5] = {foot, right, right + 1, before, k}, corners = 5;
            if (k == 0) ring[3] = k, corners = 4; /* the first has none before it */
            for (int64_t c = 1; c + 1 < corners; c++)
                skg_add_triangle(&arrays, back * outline + ring[0], back * outline + ring[back ? c + 1 : c],
                                 back * outline + ring[back ? c : c + 1]);
        }
    }
    for (int64_t i = 0; i < outline; i++) {
        int64_t next = (i + 1) % outline;
        skg_add_quad(&arrays, i, outline + i, outline + next, next);
    }
    return skg_mesh_adopt(NULL, "step wedge", &arrays, mesh);
}

static skg_status check_wedge(double length_x, double length_y, int64_t steps) {
    SKG_TRY(skg_check_length("step wedge", "length along x", length_x));
    SKG_TRY(skg_check_length("step wedge", "length along y", length_y));
    return skg_check_count("step wedge", "steps", steps, 1, SKG_MESH_LIMIT / 12);
}

skg_status skg_mesh_create_steps(double length_x, double length_y, int64_t steps, const double *heights,
                                 skg_mesh **mesh) {
    SKG_PLAIN;
    SKG_NEEDS(heights);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(check_wedge(length_x, length_y, steps));
    for (int64_t k = 0; k < steps; k++) {
        SKG_TRY(skg_check_length("step wedge", "height", heights[k]));
        if (k > 0 && !(heights[k] > heights[k - 1]))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "step wedge: step %" PRId64
                            " is %g mm high after one of %g mm; heights have to rise",
                            k, heights[k], heights[k - 1]);
    }
    return make_steps((double[2]){length_x, length_y}, heights, steps, mesh);
}

skg_status skg_mesh_create_step_wedge(double length_x, double length_y, double height_z, int64_t steps,
                                      skg_mesh **mesh) {
    SKG_PLAIN;
    double *heights = NULL;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length("step wedge", "height", height_z));
    SKG_TRY(check_wedge(length_x, length_y, steps));
    SKG_TRY(skg_alloc(steps, sizeof *heights, "step wedge", &heights));
    for (int64_t k = 0; k < steps; k++) heights[k] = height_z * ((double)(k + 1) / (double)steps);
    const skg_status status = make_steps((double[2]){length_x, length_y}, heights, steps, mesh);
    skg_free(&heights);
    return status;
}
