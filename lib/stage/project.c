/* Stage `project`: the meshes of a scene on the device, the tables of its parts, and the projected vertices of a frame. */
#include "stage/project.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static size_t real_size(const skg_geometry *geometry) {
    return skg_geometry_is_double(geometry) ? sizeof(double) : sizeof(float);
}

/* Enqueues that no vertex was bad in the frames from number `first` on. */
static skg_status fill_bad(skg_context *context, const skg_geometry *geometry, int64_t first, int64_t count) {
    const cl_int none = INT32_MAX;
    SKG_CL_TRY(clEnqueueFillBuffer(context->device->queue, geometry->bad.memory, &none, sizeof none,
                                   (size_t)first * sizeof none, (size_t)count * sizeof none, 0, NULL, NULL));
    return SKG_OK;
}

skg_status skg_geometry_clear_bad(skg_context *context, skg_geometry *geometry, int64_t frames) {
    SKG_TRY(skg_buffer_reserve(context, &geometry->bad, frames * (int64_t)sizeof(cl_int), CL_MEM_READ_WRITE,
                               "vertex check"));
    return fill_bad(context, geometry, 0, frames);
}

void skg_geometry_begin_frame(skg_geometry *geometry, int64_t frame, int32_t each) {
    geometry->projected_state = geometry->projections = geometry->bad_stands = 0;
    geometry->frame = (int32_t)frame;
    geometry->each = each;
}

skg_status skg_geometry_reset_bad(skg_context *context, skg_geometry *geometry) {
    skg_geometry_begin_frame(geometry, geometry->frame, 0);
    return fill_bad(context, geometry, geometry->frame, 1);
}

skg_status skg_geometry_continue(skg_context *context, skg_geometry *geometry) {
    if (geometry->projections != 1) return skg_geometry_reset_bad(context, geometry);
    geometry->bad_stands = 1;
    return SKG_OK;
}

/* Uploads a table that says, for each block of SKG_BLOCK items, to which part the block's first item belongs: a work-item
 * searches from there. The items are numbered through all parts; first[p] is the first one of part p, [parts + 1]. */
static skg_status upload_blocks(skg_context *context, int64_t parts, const int64_t *first, const char *what,
                                skg_buffer *buffer) {
    const int64_t blocks = first[parts] / SKG_BLOCK + 1;
    int32_t *table = NULL;
    SKG_TRY(skg_alloc(blocks, sizeof *table, what, &table));
    int64_t part = 0;
    for (int64_t b = 0; b < blocks; b++) {
        while (part + 1 < parts && first[part + 1] <= b * SKG_BLOCK) part++;
        table[b] = (int32_t)part;
    }
    skg_status status = skg_buffer_write(context, buffer, blocks * (int64_t)sizeof *table, table, what);
    skg_free(&table);
    return status;
}

static skg_status upload_corners(skg_context *context, skg_geometry *geometry) {
    const int64_t total = geometry->mesh_triangle[geometry->meshes];
    SKG_TRY(skg_buffer_reserve(context, &geometry->corners, total * 3 * (int64_t)sizeof(int32_t),
                               CL_MEM_READ_ONLY, "corners of the triangles"));
    cl_int code = CL_SUCCESS;
    for (int64_t m = 0; m < geometry->meshes && code == CL_SUCCESS; m++) {
        const size_t size = (size_t)geometry->layouts[m].triangles * 3 * sizeof(int32_t);
        if (size > 0)
            code = clEnqueueWriteBuffer(context->device->queue, geometry->corners.memory, CL_FALSE,
                                        (size_t)geometry->mesh_triangle[m] * 3 * sizeof(int32_t), size,
                                        geometry->layouts[m].corners, 0, NULL, NULL);
    }
    const cl_int done = clFinish(context->device->queue); /* until then the device reads the layouts */
    for (int64_t m = 0; m < geometry->meshes; m++) skg_free(&geometry->layouts[m].corners);
    if (code == CL_SUCCESS) SKG_CL_TRY(done);
    SKG_CL_TRY(code);
    return SKG_OK;
}

/* Numbers vertices and triangles through all meshes and through all parts. Fails where 32 bits do not number them all. */
static skg_status number(skg_geometry *geometry, int64_t *first_triangle) {
    for (int64_t m = 0; m < geometry->meshes; m++) {
        const skg_mesh_layout *layout = &geometry->layouts[m];
        /* Copies become vertices when a leaky mesh parts, and then have rests, too. */
        geometry->mesh_vertex[m + 1] =
            geometry->mesh_vertex[m] + (layout->vertices + layout->copies) * (layout->fine ? 2 : 1);
        geometry->mesh_triangle[m + 1] = geometry->mesh_triangle[m] + layout->triangles;
    }
    for (int64_t p = 0; p < geometry->parts; p++) {
        const skg_mesh_layout *of = &geometry->layouts[geometry->mesh_of_part[p]];
        geometry->first_vertex[p + 1] = geometry->first_vertex[p] + of->vertices + of->copies;
        first_triangle[p + 1] = first_triangle[p] + of->triangles;
    }
    geometry->mesh_vertices = geometry->mesh_vertex[geometry->meshes];
    geometry->vertices = geometry->first_vertex[geometry->parts];
    geometry->triangles = first_triangle[geometry->parts];
    const int64_t most = INT32_MAX / 4;
    if (geometry->vertices > most || geometry->triangles > most || geometry->mesh_vertices > most)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%" PRId64 " triangles with %" PRId64
                        " vertices over all parts are more than the tables number (%" PRId64 ")",
                        geometry->triangles, geometry->vertices, most);
    return SKG_OK;
}

/* Writes into a part's entry where its vertices and triangles stand in the other tables. */
#define SKG_PLACE(entry, p, m)                                                                               \
    do {                                                                                                     \
        (entry).mesh_vertex = (SKG_INT)geometry->mesh_vertex[m];                                             \
        (entry).first_vertex = (SKG_INT)geometry->first_vertex[p];                                           \
        (entry).mesh_triangle = (SKG_INT)geometry->mesh_triangle[m];                                         \
        (entry).first_triangle = (SKG_INT)first_triangle[p];                                                 \
        (entry).triangles = (SKG_INT)(first_triangle[(p) + 1] - first_triangle[p]);                          \
    } while (0)

static void place_parts(const skg_geometry *geometry, const int64_t *first_triangle, void *entries) {
    for (int64_t p = 0; p < geometry->parts; p++) {
        const int64_t m = geometry->mesh_of_part[p];
        if (skg_geometry_is_double(geometry))
            SKG_PLACE(((skg_part_double *)entries)[p], p, m);
        else
            SKG_PLACE(((skg_part_float *)entries)[p], p, m);
    }
}

/* Takes the layouts over, and allocates the tables of meshes and parts. */
static skg_status take_over(skg_geometry *geometry, skg_mesh_layout *layouts, const int64_t *mesh_of_part) {
    const int64_t meshes = geometry->meshes, parts = geometry->parts;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(meshes, sizeof *geometry->layouts, "mesh table", &geometry->layouts));
    memcpy(geometry->layouts, layouts, (size_t)meshes * sizeof *layouts);
    memset(layouts, 0, (size_t)meshes * sizeof *layouts);
    for (int64_t m = 0; m < meshes; m++) {
        skg_mesh_layout *layout = &geometry->layouts[m];
        layout->fine = !skg_geometry_is_double(geometry) && (layout->thin || layout->flat);
    }
    SKG_TRY_CLEANUP(skg_alloc(meshes + 1, sizeof(int64_t), "mesh table", &geometry->mesh_triangle));
    SKG_TRY_CLEANUP(skg_alloc(meshes + 1, sizeof(int64_t), "mesh table", &geometry->mesh_vertex));
    SKG_TRY_CLEANUP(skg_alloc(parts + 1, sizeof(int64_t), "part table", &geometry->first_vertex));
    SKG_TRY_CLEANUP(skg_alloc(meshes, sizeof(int64_t), "mesh table", &geometry->versions));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof(int64_t), "part table", &geometry->mesh_of_part));
    memcpy(geometry->mesh_of_part, mesh_of_part, (size_t)parts * sizeof *mesh_of_part);
cleanup:
    for (int64_t m = 0; m < meshes; m++) skg_mesh_layout_release(&layouts[m]);
    return status;
}

int32_t skg_table_slots(int64_t bytes) {
    enum { BYTES = 1 << 22, LEAST = 4 };
    const int64_t count = BYTES / (bytes + 1);
    return (int32_t)(count < LEAST ? LEAST : count < SKG_TABLE_SLOTS ? count : SKG_TABLE_SLOTS);
}

skg_status skg_geometry_create(skg_context *context, int32_t precision, int64_t meshes,
                               skg_mesh_layout *layouts, int64_t parts, const int64_t *mesh_of_part,
                               skg_geometry *geometry) {
    int64_t *first_triangle = NULL;
    skg_status status = SKG_OK;
    *geometry = (skg_geometry){.meshes = meshes, .parts = parts, .precision = precision};
    SKG_TRY_CLEANUP(take_over(geometry, layouts, mesh_of_part));
    SKG_TRY_CLEANUP(skg_alloc(parts + 1, sizeof *first_triangle, "part table", &first_triangle));
    SKG_TRY_CLEANUP(number(geometry, first_triangle));
    geometry->slot_count = skg_table_slots(parts * (int64_t)skg_geometry_entry_size(geometry));
    for (int i = 0; i < geometry->slot_count; i++) {
        skg_table_slot *slot = &geometry->slots[i];
        SKG_TRY_CLEANUP(skg_alloc(parts, skg_geometry_entry_size(geometry), "part table", &slot->entries));
        place_parts(geometry, first_triangle, slot->entries);
        SKG_TRY_CLEANUP(
            skg_alloc(parts, sizeof(skg_contribution_double), "contribution table", &slot->contributions));
        slot->capacity = parts;
    }
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &geometry->part_table,
                                       parts * (int64_t)skg_geometry_entry_size(geometry), CL_MEM_READ_ONLY,
                                       "part table"));
    SKG_TRY_CLEANUP(upload_corners(context, geometry));
    SKG_TRY_CLEANUP(
        upload_blocks(context, parts, geometry->first_vertex, "vertex blocks", &geometry->vertex_blocks));
    SKG_TRY_CLEANUP(
        upload_blocks(context, parts, first_triangle, "triangle blocks", &geometry->triangle_blocks));
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &geometry->offsets,
                                       geometry->mesh_vertices * 3 * (int64_t)real_size(geometry),
                                       CL_MEM_READ_WRITE, "vertices")); /* skg_place writes there */
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &geometry->projected,
                                       geometry->vertices * 4 * (int64_t)real_size(geometry),
                                       CL_MEM_READ_WRITE, "projected vertices"));
    SKG_TRY_CLEANUP(skg_geometry_clear_bad(context, geometry, 1));
cleanup:
    skg_free(&first_triangle);
    if (status != SKG_OK) skg_geometry_release(geometry);
    return status;
}

void skg_geometry_release(skg_geometry *geometry) {
    skg_buffer *const buffers[] = {&geometry->offsets,       &geometry->corners,
                                   &geometry->part_table,    &geometry->contribution_table,
                                   &geometry->vertex_blocks, &geometry->triangle_blocks,
                                   &geometry->projected,     &geometry->bad};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
    for (int64_t m = 0; geometry->layouts && m < geometry->meshes; m++)
        skg_mesh_layout_release(&geometry->layouts[m]);
    skg_free(&geometry->layouts);
    skg_free(&geometry->mesh_of_part);
    skg_free(&geometry->mesh_triangle);
    skg_free(&geometry->mesh_vertex);
    skg_free(&geometry->versions);
    skg_free(&geometry->first_vertex);
    skg_geometry_release_tables(geometry);
}

skg_status skg_geometry_project(skg_context *context, skg_geometry *geometry, cl_kernel kernel,
                                skg_stage_log *log) {
    if (geometry->bad_stands) SKG_TRY(skg_geometry_reset_bad(context, geometry));
    geometry->projected_state = 0;
    const skg_raster_layout layout = {.parts = (SKG_INT)geometry->parts,
                                      .vertices = (SKG_INT)geometry->vertices};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(PROJECT, layout, layout),
        SKG_ARGUMENT(PROJECT, parts, geometry->part_table.memory),
        SKG_ARGUMENT(PROJECT, blocks, geometry->vertex_blocks.memory),
        SKG_ARGUMENT(PROJECT, vertices, geometry->offsets.memory),
        SKG_ARGUMENT(PROJECT, projected, geometry->projected.memory),
        SKG_ARGUMENT(PROJECT, bad_vertex, geometry->bad.memory),
        SKG_ARGUMENT(PROJECT, frame, geometry->frame),
    };
    const int on_gpu = context->device->info.gpu;
    const int64_t run = on_gpu ? 1 : SKG_CPU_RUN;
    const skg_work_size work = {1, {(geometry->vertices + run - 1) / run}, {on_gpu ? 64 : 1}};
    SKG_TRY(SKG_LAUNCH(context, kernel, "project", &work, arguments, log));
    geometry->projected_state = geometry->state;
    geometry->projections++;
    geometry->projected_by = kernel;
    return SKG_OK;
}

int skg_geometry_take_projection(skg_geometry *geometry, cl_kernel kernel) {
    const int stands = geometry->projected_state != 0 && geometry->projected_state == geometry->state &&
                       geometry->projected_by == kernel;
    if (stands) geometry->bad_stands = 0;
    return stands;
}

int64_t skg_geometry_bytes(const skg_geometry *geometry) {
    return geometry->offsets.bytes + geometry->corners.bytes + geometry->part_table.bytes +
           geometry->contribution_table.bytes + geometry->vertex_blocks.bytes +
           geometry->triangle_blocks.bytes + geometry->projected.bytes + geometry->bad.bytes;
}

void skg_geometry_find(const skg_geometry *geometry, int64_t vertex, int64_t *part, int64_t *mesh_vertex) {
    SKG_ASSERT(0 <= vertex && vertex < geometry->vertices);
    int64_t low = 0, high = geometry->parts; /* first_vertex[low] <= vertex < first_vertex[high] */
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (geometry->first_vertex[middle] <= vertex)
            low = middle;
        else
            high = middle;
    }
    const int32_t *source = geometry->layouts[geometry->mesh_of_part[low]].source;
    const int64_t local = vertex - geometry->first_vertex[low];
    *part = low;
    *mesh_vertex = source ? source[local] : local;
}
