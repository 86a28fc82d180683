/* The vertices of meshes on their way from the host to the device. */
#include "core/context.h"
#include "stage/project.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <string.h>

static size_t real_size(const skg_geometry *geometry) {
    return geometry->precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
}

skg_status skg_geometry_upload(skg_context *context, skg_geometry *geometry, int64_t first, int64_t count,
                               const void *offsets, skg_stage_log *log) {
    const int64_t row = 3 * (int64_t)real_size(geometry);
    if (count == 0) return SKG_OK;
    geometry->state++;
    return skg_stage_write(context, "upload", geometry->offsets.memory, first * row, count * row, offsets,
                           log);
}

static void read_floats(const skg_mesh_layout *layout, const skg_mesh *mesh, float *to) {
    const int32_t *source = layout->source;
    if (!source) memcpy(to, mesh->offsets, (size_t)mesh->vertices * 3 * sizeof *to);
    for (int64_t i = 0; source && i < layout->vertices; i++) {
        const float *from = mesh->offsets + 3 * (int64_t)source[i];
        to[3 * i] = from[0], to[3 * i + 1] = from[1], to[3 * i + 2] = from[2];
    }
}

/* The rest that rounding the offsets has lost. */
static void read_lost(const skg_mesh_layout *layout, const skg_mesh *mesh, float *to) {
    double at[3];
    for (int64_t i = 0; i < layout->vertices; i++) {
        const int64_t vertex = layout->source ? layout->source[i] : i;
        skg_mesh_vertex(mesh, vertex, at);
        for (int k = 0; k < 3; k++)
            to[3 * i + k] = (float)(at[k] - mesh->origin[k] - (double)mesh->offsets[3 * vertex + k]);
    }
}

static void read_doubles(const skg_mesh_layout *layout, const skg_mesh *mesh, double *to) {
    for (int64_t i = 0; i < layout->vertices; i++) {
        skg_mesh_vertex(mesh, layout->source ? layout->source[i] : i, to + 3 * i);
        for (int k = 0; k < 3; k++) to[3 * i + k] -= mesh->origin[k];
    }
}

skg_status skg_geometry_part_vertices(skg_context *context, skg_geometry *geometry, const skg_mesh *mesh,
                                      int64_t index) {
    skg_mesh_layout *layout = &geometry->layouts[index];
    if (layout->copies > 0) SKG_TRY(skg_mesh_layout_part(mesh, layout));
    if (!layout->corners) return SKG_OK;
    geometry->versions[index] = 0;
    SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, geometry->corners.memory, CL_TRUE,
                                    (size_t)geometry->mesh_triangle[index] * 3 * sizeof(int32_t),
                                    (size_t)layout->triangles * 3 * sizeof(int32_t), layout->corners, 0, NULL,
                                    NULL));
    skg_free(&layout->corners); /* until here, a call that fails is repeated by the next one */
    return SKG_OK;
}

/* Merged vertices of a leaky mesh may part; a closed one refuses such positions. */
static skg_status keep_apart(skg_context *context, skg_geometry *geometry, const skg_mesh *mesh,
                             int64_t index) {
    if (geometry->layouts[index].copies > 0) {
        const int64_t vertex = skg_mesh_parted(mesh);
        if (vertex < 0) return SKG_OK;
        skg_log(
            context, SKG_LOG_NOTE,
            "%s: vertices %" PRId32 " and %" PRId64
            " of this leaky mesh were at the same place and now are not; from now on the plan uploads all of "
            "its vertices, not one for each place",
            mesh->name, mesh->weld[vertex], vertex);
    }
    return skg_geometry_part_vertices(context, geometry, mesh, index);
}

/* The end of the meshes from number `first` on that have changed and lie on the device without a gap. */
static int64_t end_of_run(const skg_geometry *geometry, skg_mesh *const *meshes, int64_t first) {
    int64_t m = first;
    while (m < geometry->meshes && geometry->versions[m] != meshes[m]->version &&
           (m == first || geometry->layouts[m - 1].copies == 0))
        m++;
    return m;
}

/* Uploads the vertices of a run of meshes by one command: each costs the device as much as thousands of vertices. */
static skg_status update_run(skg_geometry *geometry, skg_mesh *const *meshes, int64_t first, int64_t end,
                             skg_staging *staging) {
    const size_t row = 3 * real_size(geometry);
    const int64_t start = geometry->mesh_vertex[first], last = end - 1;
    const int64_t count = geometry->mesh_vertex[end] - geometry->layouts[last].copies - start;
    char *offsets = NULL;
    SKG_TRY(skg_staging_take(staging, count, row, "vertices", &offsets));
    for (int64_t m = first; m < end; m++) {
        const skg_mesh_layout *layout = &geometry->layouts[m];
        void *own = offsets + (size_t)(geometry->mesh_vertex[m] - start) * row;
        if (geometry->precision == SKG_PRECISION_DOUBLE)
            read_doubles(layout, meshes[m], own);
        else
            read_floats(layout, meshes[m], own);
        if (layout->fine) read_lost(layout, meshes[m], (float *)own + 3 * layout->vertices);
    }
    SKG_TRY(skg_geometry_upload(staging->context, geometry, start, count, offsets, &staging->log));
    for (int64_t m = first; m < end; m++) geometry->versions[m] = meshes[m]->version;
    return SKG_OK;
}

skg_status skg_geometry_update(skg_geometry *geometry, skg_mesh *const *meshes, skg_staging *staging) {
    int64_t m = 0;
    for (int64_t k = 0; k < geometry->meshes; k++)
        if (geometry->versions[k] != meshes[k]->version)
            SKG_TRY(keep_apart(staging->context, geometry, meshes[k], k));
    while (m < geometry->meshes) {
        const int64_t end = end_of_run(geometry, meshes, m);
        if (end > m) SKG_TRY(update_run(geometry, meshes, m, end, staging));
        m = end > m ? end : m + 1;
    }
    return SKG_OK;
}
