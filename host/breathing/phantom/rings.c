/* Surfaces from rings of points. */
#include "phantom/shapes.h"

#include <math.h>

int64_t skg_shape_count(double resolution, double standard, int64_t fewest) {
    int64_t count = (int64_t)llround(resolution * standard);
    return count > fewest ? count : fewest;
}

/* Triangles between two rings: m points from index `low`, n points from index `high`. */
static void stitch(int64_t low, int64_t m, int64_t high, int64_t n, skg_mesh_arrays *arrays) {
    int64_t i = 0, j = 0, steps = (m > 1 ? m : 0) + (n > 1 ? n : 0);
    for (int64_t s = 0; s < steps; s++) {
        /* the next corner is from the ring whose next point has the smaller azimuth: (i + 1)/m or (j + 1)/n */
        int lower = n == 1 || (m > 1 && (i + 1) * n <= (j + 1) * m);
        int32_t *c = arrays->corners + 3 * arrays->triangles++;
        c[0] = (int32_t)(low + i % m);
        c[1] = (int32_t)(lower ? low + (i + 1) % m : high + (j + 1) % n);
        c[2] = (int32_t)(high + j % n);
        if (lower)
            i++;
        else
            j++;
    }
}

skg_status skg_shape_rings(const char *name, int64_t rings, const int64_t *counts, skg_ring_place place,
                           const void *shape, skg_mesh_arrays *arrays) {
    int64_t vertices = arrays->vertices, triangles = arrays->triangles;
    for (int64_t r = 0; r < rings; r++) {
        vertices += counts[r];
        triangles += (counts[r] > 1 ? counts[r] : 0) * (r > 0 && r + 1 < rings ? 2 : 1);
    }
    if (vertices > SKG_MESH_LIMIT || triangles > SKG_MESH_LIMIT)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: more triangles than a mesh may have", name);
    SKG_TRY(skg_realloc(3 * vertices, sizeof(double), name, &arrays->positions));
    SKG_TRY(skg_realloc(3 * triangles, sizeof(int32_t), name, &arrays->corners));
    int64_t below = 0;
    for (int64_t r = 0; r < rings; r++) {
        int64_t here = arrays->vertices;
        for (int64_t i = 0; i < counts[r]; i++)
            place(shape, r, (double)i / (double)counts[r], arrays->positions + 3 * arrays->vertices++);
        if (r > 0) stitch(below, counts[r - 1], here, counts[r], arrays);
        below = here;
    }
    return SKG_OK;
}
