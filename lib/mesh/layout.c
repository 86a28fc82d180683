/* How a mesh lies in the memory of a device: vertices at one place are one vertex there, and vertices follow the
 * triangles that use them. No image depends on it, since sums do not depend on the order of triangles. */
#include "core/maths.h"
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

/* Merging pays where it saves at least this share of the vertices: a mesh without it is copied as it is. */
enum { MIN_SHARE = 8 };

static int is_together(const skg_mesh *mesh, int64_t v) {
    double mine[3], first[3];
    skg_mesh_vertex(mesh, v, mine);
    skg_mesh_vertex(mesh, mesh->weld[v], first);
    return mine[0] == first[0] && mine[1] == first[1] && mine[2] == first[2];
}

int64_t skg_mesh_parted(const skg_mesh *mesh) {
    for (int64_t v = 0; mesh->weld && v < mesh->vertices; v++)
        if (mesh->weld[v] != v && !is_together(mesh, v)) return v;
    return -1;
}

static int pays_to_merge(const skg_mesh *mesh) {
    const int64_t saved = mesh->vertices - mesh->health.welded_vertices;
    return mesh->weld && MIN_SHARE * saved >= mesh->vertices && (mesh->closed || skg_mesh_parted(mesh) < 0);
}

static double distance(const float *a, const float *b) {
    return (double)(fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]));
}

/* Whether vertices that follow each other are neighbours: on average, no more than four edges apart. */
static int are_neighbours(const skg_mesh *mesh) {
    const float *p = mesh->offsets;
    double step = 0, edge = 0;
    for (int64_t v = 1; v < mesh->vertices; v++) step += distance(p + 3 * v, p + 3 * (v - 1));
    for (int64_t t = 0; t < mesh->triangles; t++)
        edge += distance(p + 3 * (int64_t)mesh->corners[3 * t], p + 3 * (int64_t)mesh->corners[3 * t + 1]);
    return step / (double)mesh->vertices <= 4 * edge / (double)mesh->triangles;
}

/* Numbers the vertices by their first use. Those that no triangle uses come last, because a device looks at them, too.
 *
 * of   [mesh->vertices] result: the number on the device of each vertex that stands for itself */
static void number_by_use(const skg_mesh *mesh, int merged, skg_mesh_layout *layout, int32_t *of) {
    int32_t next = 0;
    for (int64_t v = 0; v < mesh->vertices; v++) of[v] = -1;
    for (int64_t c = 0; c < 3 * mesh->triangles; c++) {
        const int32_t v = merged ? mesh->weld[layout->corners[c]] : layout->corners[c];
        if (of[v] < 0) layout->source[next] = v, of[v] = next++;
        layout->corners[c] = of[v];
    }
    for (int32_t v = 0; v < mesh->vertices; v++)
        if (of[v] < 0 && (!merged || mesh->weld[v] == v)) layout->source[next] = v, of[v] = next++;
    layout->vertices = next;
    layout->copies = 0;
    for (int32_t v = 0; merged && !mesh->closed && v < mesh->vertices; v++)
        if (mesh->weld[v] != v) layout->source[next + layout->copies++] = v;
}

/* Whether a closed mesh is much thinner than wide, as a plate, whose thickness is twice its volume by its area. Of 10,000 plates
 * those that lost digits with single corners were thinner than 1.6e-3 of their diagonals and 7e-3 of the root of their area. Grains
 * all over a picture are small against its diagonal, too. */
static int is_thin(const skg_mesh *mesh) {
    const skg_mesh_health *health = &mesh->health;
    double diagonal[3];
    for (int k = 0; k < 3; k++) diagonal[k] = health->bounds[3 + k] - health->bounds[k];
    const double wide = 0x1p-6 * sqrt(health->area / (double)health->components);
    return mesh->closed && health->components > 0 &&
           2 * fabs(health->volume) < fmin(0x1p-8 * skg_length(diagonal), wide) * health->area;
}

skg_status skg_mesh_layout_create(const skg_mesh *mesh, skg_mesh_layout *layout) {
    skg_status status = SKG_OK;
    int32_t sorted = 0, *of = NULL;
    *layout =
        (skg_mesh_layout){.vertices = mesh->vertices, .triangles = mesh->triangles, .thin = is_thin(mesh)};
    SKG_TRY_CLEANUP(skg_alloc(3 * mesh->triangles, sizeof *layout->corners, mesh->name, &layout->corners));
    SKG_TRY_CLEANUP(skg_mesh_sorted_corners(mesh, layout->corners, &sorted));
    const int merged = pays_to_merge(mesh);
    const int is_large = mesh->triangles >= SKG_MESH_SMALL && mesh->first_bad < 0;
    if (!merged && !sorted && (!is_large || are_neighbours(mesh))) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *layout->source, mesh->name, &layout->source));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *of, mesh->name, &of));
    number_by_use(mesh, merged, layout, of);
cleanup:
    skg_free(&of);
    if (status != SKG_OK) skg_mesh_layout_release(layout);
    return status;
}

/* The corners of `layout` name merged vertices, and do not say which of those at one place the caller means. So the
 * triangles are put in order anew. */
skg_status skg_mesh_layout_part(const skg_mesh *mesh, skg_mesh_layout *layout) {
    skg_status status = SKG_OK;
    int32_t sorted = 0, *of = NULL;
    const int64_t vertices = layout->vertices + layout->copies;
    SKG_ASSERT(!layout->corners && (layout->source || layout->copies == 0));
    SKG_TRY_CLEANUP(skg_alloc(3 * mesh->triangles, sizeof *layout->corners, mesh->name, &layout->corners));
    SKG_TRY_CLEANUP(skg_alloc(vertices, sizeof *of, mesh->name, &of));
    SKG_TRY_CLEANUP(skg_mesh_sorted_corners(mesh, layout->corners, &sorted));
    for (int32_t i = 0; i < vertices; i++) of[layout->source[i]] = i;
    for (int64_t c = 0; c < 3 * mesh->triangles; c++) layout->corners[c] = of[layout->corners[c]];
    layout->vertices = vertices;
    layout->copies = 0;
cleanup:
    skg_free(&of);
    if (status != SKG_OK) skg_free(&layout->corners);
    return status;
}

void skg_mesh_layout_release(skg_mesh_layout *layout) {
    skg_free(&layout->source);
    skg_free(&layout->corners);
    skg_free(&layout->planes);
}
