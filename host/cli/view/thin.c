/* Fewer triangles of a part, for pages. */
#include "view/surfaces.h"

#include "common/say.h"

#include <stdlib.h>
#include <string.h>

#if SKG_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

void view_surface_free(view_surface *surface) {
    free(surface->origin);
    free(surface->corners);
    *surface = (view_surface){0};
}

static int read_whole(const skg_part *part, view_surface *surface) {
    *surface = (view_surface){0};
    skg_status status = skg_mesh_count(part->mesh, &surface->vertices, &surface->triangles);
    if (status != SKG_OK) return cli_fail(status);
    surface->of = surface->triangles;
    surface->origin = malloc((size_t)(surface->vertices + 1) * sizeof *surface->origin);
    surface->corners = malloc((size_t)(surface->triangles + 1) * 3 * sizeof *surface->corners);
    if (!surface->origin || !surface->corners)
        return cli_error(CLI_DEVICE, "out of host memory for %s", part->label);
    for (int64_t v = 0; v < surface->vertices; v++) surface->origin[v] = (int32_t)v;
    status = skg_mesh_triangles_get(part->mesh, surface->corners, 0);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

#if SKG_HAS_MESHOPTIMIZER

const int view_can_thin = 1;

/* The positions as meshoptimizer wants them, which the caller frees; NULL if memory is exhausted. */
static float *read_positions(const skg_part *part, int64_t vertices) {
    double *wide = malloc((size_t)(vertices + 1) * 3 * sizeof *wide);
    float *positions = malloc((size_t)(vertices + 1) * 3 * sizeof *positions);
    if (!wide || !positions || skg_mesh_positions_get(part->mesh, wide, 0) != SKG_OK) {
        free(wide);
        free(positions);
        return NULL;
    }
    /* relative to the first vertex, because a float far from 0 has few digits left */
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] = (float)(wide[i] - wide[i % 3]);
    free(wide);
    return positions;
}

/* Keeps the vertices that triangles have, in the order of their first use. number: room for all vertices. */
static void drop_unused(view_surface *surface, float *positions, unsigned int *number) {
    unsigned int *corners = (unsigned int *)surface->corners;
    const size_t count = 3 * (size_t)surface->triangles, vertices = (size_t)surface->vertices;
    surface->vertices = (int64_t)meshopt_optimizeVertexFetchRemap(number, corners, count, vertices);
    meshopt_remapIndexBuffer(corners, corners, count, number);
    meshopt_remapVertexBuffer(surface->origin, surface->origin, vertices, sizeof *surface->origin, number);
    meshopt_remapVertexBuffer(positions, positions, vertices, 3 * sizeof *positions, number);
}

/* Each corner moves to the first vertex at its place. The other vertices there have to go before surfaces are simplified: where three
 * and more stand, as in every STL file, meshoptimizer moves none. */
static void weld(view_surface *surface, float *positions, unsigned int *number, unsigned int *welded) {
    const size_t corners = 3 * (size_t)surface->triangles, stride = 3 * sizeof *positions;
    meshopt_generateShadowIndexBuffer(welded, (const unsigned int *)surface->corners, corners, positions,
                                      (size_t)surface->vertices, stride, stride);
    memcpy(surface->corners, welded, corners * sizeof *welded);
    drop_unused(surface, positions, number);
}

/* Any error that the number of triangles calls for: 1 is the size of the part. */
static void simplify(const float *positions, int64_t wanted, view_surface *surface, unsigned int *welded) {
    const size_t corners = 3 * (size_t)surface->triangles;
    memcpy(welded, surface->corners, corners * sizeof *welded);
    surface->triangles = (int64_t)meshopt_simplify((unsigned int *)surface->corners, welded, corners,
                                                   positions, (size_t)surface->vertices,
                                                   3 * sizeof *positions, 3 * (size_t)wanted, 1, 0, NULL) /
                         3;
}

int view_thin(const skg_part *part, int64_t wanted, view_surface *surface) {
    const int exit_status = read_whole(part, surface);
    if (exit_status != CLI_DONE) return exit_status;
    const size_t vertices = (size_t)surface->vertices, corners = 3 * (size_t)surface->triangles;
    float *positions = read_positions(part, surface->vertices);
    unsigned int *number = malloc((vertices + 1) * sizeof *number);
    unsigned int *welded = malloc((corners + 1) * sizeof *welded);
    const int is_whole = positions && number && welded;
    if (is_whole) weld(surface, positions, number, welded);
    if (is_whole && surface->triangles > wanted) {
        simplify(positions, wanted, surface, welded);
        drop_unused(surface, positions, number);
    }
    free(positions);
    free(number);
    free(welded);
    return is_whole ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory for %s", part->label);
}

#else

const int view_can_thin = 0;

int view_thin(const skg_part *part, int64_t wanted, view_surface *surface) {
    (void)wanted;
    return read_whole(part, surface);
}

#endif
