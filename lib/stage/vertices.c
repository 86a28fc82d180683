/* The vertices of meshes on their way from the host to the device. */
#include "core/context.h"
#include "stage/project.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <string.h>

static size_t real_size(const skg_geometry *geometry) {
    return geometry->precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float);
}

skg_status skg_geometry_upload(skg_context *context, skg_geometry *geometry, int64_t mesh,
                               const void *offsets, skg_stage_log *log) {
    const skg_mesh_layout *layout = &geometry->layouts[mesh];
    const int64_t row = 3 * (int64_t)real_size(geometry), count = (1 + layout->fine) * layout->vertices;
    if (count == 0) return SKG_OK;
    geometry->state++;
    return skg_stage_write(context, "upload", geometry->offsets.memory, geometry->mesh_vertex[mesh] * row,
                           count * row, offsets, log);
}

static void read_floats(const skg_mesh_layout *layout, const skg_mesh *mesh, float *to) {
    const int32_t *source = layout->source;
    if (!source) memcpy(to, mesh->offsets, (size_t)mesh->vertices * 3 * sizeof *to);
    for (int64_t i = 0; source && i < layout->vertices; i++) {
        const float *from = mesh->offsets + 3 * (int64_t)source[i];
        to[3 * i] = from[0], to[3 * i + 1] = from[1], to[3 * i + 2] = from[2];
    }
}

/* What rounding the offsets has lost. */
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

skg_status skg_geometry_update(skg_geometry *geometry, skg_mesh *const *meshes, skg_staging *staging) {
    for (int64_t m = 0; m < geometry->meshes; m++) {
        void *offsets = NULL;
        const skg_mesh_layout *layout = &geometry->layouts[m];
        if (geometry->versions[m] == meshes[m]->version) continue;
        SKG_TRY(keep_apart(staging->context, geometry, meshes[m], m));
        SKG_TRY(skg_staging_take(staging, (1 + layout->fine) * 3 * layout->vertices, real_size(geometry),
                                 "vertices", &offsets));
        if (geometry->precision == SKG_PRECISION_DOUBLE)
            read_doubles(layout, meshes[m], offsets);
        else
            read_floats(layout, meshes[m], offsets);
        if (layout->fine) read_lost(layout, meshes[m], (float *)offsets + 3 * layout->vertices);
        SKG_TRY(skg_geometry_upload(staging->context, geometry, m, offsets, &staging->log));
        geometry->versions[m] = meshes[m]->version;
    }
    return SKG_OK;
}
