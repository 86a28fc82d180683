/* Positions of vertices that come from the caller's device memory. */
#include "stage/place.h"

#include <skiagraph/plan.h>

/* Vertices of a closed mesh that the host has at one place stay together, so that the mesh stays closed. */
static skg_status list_taken(skg_context *context, const skg_mesh *mesh, const skg_mesh_layout *layout,
                             skg_buffer *buffer) {
    int32_t *taken = NULL;
    if (buffer->memory) return SKG_OK;
    SKG_TRY(skg_alloc(layout->vertices, sizeof *taken, "vertices", &taken));
    for (int64_t i = 0; i < layout->vertices; i++) {
        const int32_t v = layout->source ? layout->source[i] : (int32_t)i;
        taken[i] = mesh->closed && mesh->weld ? mesh->weld[v] : v;
    }
    const skg_status status =
        skg_buffer_create(context, layout->vertices * (int64_t)sizeof *taken, taken, "vertices", buffer);
    skg_free(&taken);
    return status;
}

static skg_status get_kernel(skg_placement *placement, skg_context *context, int32_t precision) {
    static const char *const files[] = {"place.cl"};
    const skg_kernel_options options = {.precision = precision, .bits = 32};
    cl_program program = NULL;
    if (placement->kernel) return SKG_OK;
    SKG_TRY(skg_kernels_get(context, &options, 1, files, NULL, &program));
    return skg_kernel_create(program, "skg_place", &placement->kernel);
}

static skg_status prepare(skg_placement *placement, skg_context *context, const skg_geometry *geometry) {
    if (!placement->meshes) {
        SKG_TRY(skg_alloc(geometry->meshes, sizeof *placement->meshes, "meshes", &placement->meshes));
        placement->count = geometry->meshes;
    }
    SKG_TRY(skg_buffer_reserve(context, &placement->outside, geometry->meshes * (int64_t)sizeof(cl_int),
                               CL_MEM_READ_WRITE, "vertex check"));
    return get_kernel(placement, context, geometry->precision);
}

/* Of a fine mesh, what rounding the vertices has lost becomes 0. */
static skg_status clear_lost(skg_context *context, const skg_geometry *geometry, int64_t index) {
    const skg_mesh_layout *layout = &geometry->layouts[index];
    const cl_float zero = 0;
    const size_t size = (size_t)layout->vertices * 3 * sizeof zero;
    const size_t first = ((size_t)geometry->mesh_vertex[index] + (size_t)layout->vertices) * 3 * sizeof zero;
    if (!layout->fine || size == 0) return SKG_OK;
    SKG_CL_TRY(clEnqueueFillBuffer(context->device->queue, geometry->offsets.memory, &zero, sizeof zero,
                                   first, size, 0, NULL, NULL));
    return SKG_OK;
}

static skg_status run(skg_placement *placement, skg_context *context, const skg_geometry *geometry,
                      int64_t index, const skg_place_source *source) {
    const cl_int none = INT32_MAX;
    const cl_long first = source->first;
    const int64_t vertices = geometry->layouts[index].vertices;
    skg_place_args args = {.vertices = (SKG_INT)vertices,
                           .mesh = (SKG_INT)index,
                           .mesh_vertex = (SKG_INT)geometry->mesh_vertex[index]};
    for (int k = 0; k < 3; k++) args.lowest[k] = source->lowest[k], args.highest[k] = source->highest[k];
    const skg_argument arguments[] = {
        SKG_ARGUMENT(PLACE, args, args),
        SKG_ARGUMENT(PLACE, given, source->memory),
        SKG_ARGUMENT(PLACE, first, first),
        SKG_ARGUMENT(PLACE, taken, placement->meshes[index].taken.memory),
        SKG_ARGUMENT(PLACE, vertices, geometry->offsets.memory),
        SKG_ARGUMENT(PLACE, outside, placement->outside.memory),
    };
    const skg_work_size work = {1, {vertices}, {context->device->info.gpu ? 64 : 16}};
    SKG_CL_TRY(clEnqueueFillBuffer(context->device->queue, placement->outside.memory, &none, sizeof none,
                                   (size_t)index * sizeof none, sizeof none, 0, NULL, NULL));
    return SKG_LAUNCH(context, placement->kernel, "place", &work, arguments, NULL);
}

skg_status skg_placement_place(skg_placement *placement, skg_context *context, skg_geometry *geometry,
                               const skg_mesh *mesh, int64_t index, const skg_place_source *source) {
    SKG_TRY(prepare(placement, context, geometry));
    skg_placed_mesh *placed = &placement->meshes[index];
    /* Of a leaky mesh, the host cannot see whether merged vertices are at one place in the caller's memory. */
    SKG_TRY(skg_geometry_part_vertices(context, geometry, mesh, index));
    SKG_TRY(list_taken(context, mesh, &geometry->layouts[index], &placed->taken));
    /* Positions of the caller are floats. */
    SKG_TRY(clear_lost(context, geometry, index));
    /* If the copy fails half way, the next frame uploads the positions of the host. */
    geometry->versions[index] = placed->version = 0;
    geometry->state++;
    if (mesh->vertices > 0) SKG_TRY(run(placement, context, geometry, index, source));
    for (int k = 0; k < 3; k++)
        placed->lowest[k] = source->lowest[k], placed->highest[k] = source->highest[k];
    geometry->versions[index] = placed->version = mesh->version;
    return SKG_OK;
}

const skg_placed_mesh *skg_placement_of(const skg_placement *placement, const skg_mesh *mesh, int64_t index) {
    if (!placement->meshes || placement->meshes[index].version != mesh->version) return NULL;
    return &placement->meshes[index];
}

void skg_placement_release(skg_placement *placement) {
    for (int64_t m = 0; m < placement->count; m++) skg_buffer_release(&placement->meshes[m].taken);
    skg_free(&placement->meshes);
    skg_buffer_release(&placement->outside);
    if (placement->kernel) clReleaseKernel(placement->kernel);
    *placement = (skg_placement){0};
}

int64_t skg_placement_bytes(const skg_placement *placement) {
    int64_t bytes = placement->outside.bytes;
    for (int64_t m = 0; m < placement->count; m++) bytes += placement->meshes[m].taken.bytes;
    return bytes;
}
