/* Test objects: line pairs and a Siemens star. */
#include "core/maths.h"
#include "core/text.h"
#include "mesh/mesh.h"
#include "mesh/pieces.h"

#include <skiagraph/bodies.h>

#include <math.h>

static double width_of(const double *per_mm, int64_t group) {
    return 0.5 / per_mm[group];
}

skg_status skg_mesh_create_line_pairs(int64_t groups, const double *per_mm, int64_t bars, double length,
                                      double thickness, skg_mesh **mesh) {
    SKG_PLAIN;
    static const char *const shape = "line pairs";
    skg_mesh_arrays arrays;
    double whole = 0, x = 0;
    SKG_NEEDS(per_mm);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_count(shape, "groups", groups, 1, 10000));
    SKG_TRY(skg_check_count(shape, "bars", bars, 1, 10000));
    SKG_TRY(skg_check_length(shape, "length", length));
    SKG_TRY(skg_check_length(shape, "thickness", thickness));
    for (int64_t g = 0; g < groups; g++) {
        if (!(per_mm[g] > 0 && isfinite(per_mm[g])))
            return skg_fail(SKG_ERR_ARGUMENT, "line pairs: %g line pairs per mm: finite and above 0",
                            per_mm[g]);
        const double gap = g + 1 < groups ? 2 * fmax(width_of(per_mm, g), width_of(per_mm, g + 1)) : 0;
        whole += (double)(2 * bars - 1) * width_of(per_mm, g) + gap;
    }
    SKG_TRY(skg_pieces_start(shape, 8 * groups * bars, 12 * groups * bars, &arrays));
    x = -0.5 * whole;
    for (int64_t g = 0; g < groups; g++) {
        const double width = width_of(per_mm, g);
        for (int64_t b = 0; b < bars; b++) {
            const double left = x + (double)(2 * b) * width;
            skg_add_cuboid(&arrays, (double[3]){left, -0.5 * length, -0.5 * thickness},
                           (double[3]){left + width, 0.5 * length, 0.5 * thickness});
        }
        x += (double)(2 * bars - 1) * width;
        if (g + 1 < groups) x += 2 * fmax(width, width_of(per_mm, g + 1));
    }
    return skg_mesh_adopt(NULL, shape, &arrays, mesh);
}

/* The prism of a spoke between two angles, its arcs divided into `parts`. */
static void add_spoke(const double radii[2], double from, double to, double thickness, int64_t parts,
                      skg_mesh_arrays *arrays) {
    const int64_t first = arrays->vertices;
    for (int64_t p = 0; p <= parts; p++) { /* four vertices at each angle: inner and outer, low and high */
        const double angle = from + (to - from) * (double)p / (double)parts;
        for (int corner = 0; corner < 4; corner++)
            skg_add_vertex(arrays, radii[corner & 1] * cos(angle), radii[corner & 1] * sin(angle),
                           corner & 2 ? 0.5 * thickness : -0.5 * thickness);
    }
    for (int64_t p = 0; p < parts; p++) {
        const int64_t a = first + 4 * p, b = a + 4;
        skg_add_quad(arrays, a, b, b + 1, a + 1);         /* low */
        skg_add_quad(arrays, a + 2, a + 3, b + 3, b + 2); /* high */
        skg_add_quad(arrays, a, a + 2, b + 2, b);         /* inner arc */
        skg_add_quad(arrays, a + 1, b + 1, b + 3, a + 3); /* outer arc */
    }
    const int64_t end = first + 4 * parts;
    skg_add_quad(arrays, first, first + 1, first + 3, first + 2);
    skg_add_quad(arrays, end, end + 2, end + 3, end + 1);
}

skg_status skg_mesh_create_star(double radius, double inner, int64_t spokes, double thickness,
                                skg_mesh **mesh) {
    SKG_PLAIN;
    static const char *const shape = "star";
    skg_mesh_arrays arrays;
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_length(shape, "radius", radius));
    SKG_TRY(skg_check_length(shape, "inner radius", inner));
    SKG_TRY(skg_check_length(shape, "thickness", thickness));
    SKG_TRY(skg_check_count(shape, "spokes", spokes, 2, 100000));
    if (!(inner < radius))
        return skg_fail(SKG_ERR_ARGUMENT, "star: inner radius %g mm: below the outer one, %g mm", inner,
                        radius);
    /* Arcs of two degrees at most: the chord is 0.015 % of the radius inside. */
    const int64_t parts = (89 + spokes) / spokes;
    SKG_TRY(skg_pieces_start(shape, spokes * 4 * (parts + 1), spokes * (8 * parts + 4), &arrays));
    for (int64_t s = 0; s < spokes; s++) {
        const double from = 2 * SKG_PI * (double)s / (double)spokes;
        add_spoke((double[2]){inner, radius}, from, from + SKG_PI / (double)spokes, thickness, parts,
                  &arrays);
    }
    return skg_mesh_adopt(NULL, shape, &arrays, mesh);
}
