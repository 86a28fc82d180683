/* Stage `project`: the meshes of a scene on the device, the tables of its parts, and the projected vertices of a frame.
 * Private.
 *
 * All parts share one vertex buffer, one index buffer and one part table, so that the number of launches does not grow
 * with the number of parts, and a mesh that many parts use is stored once. */
#ifndef SKG_PROJECT_H
#define SKG_PROJECT_H

#include "stage/tables.h"

/* The arguments that kernels which take triangles have in common. */
#define SKG_TRIANGLE_ARGUMENTS(kernel, raster_layout, geometry)                                              \
    SKG_ARGUMENT(kernel, layout, raster_layout), SKG_TRIANGLE_BUFFERS(kernel, geometry)
#define SKG_TRIANGLE_BUFFERS(kernel, geometry)                                                               \
    SKG_ARGUMENT(kernel, corners, (geometry)->corners.memory),                                               \
        SKG_ARGUMENT(kernel, projected, (geometry)->projected.memory),                                       \
        SKG_ARGUMENT(kernel, parts, (geometry)->part_table.memory),                                          \
        SKG_ARGUMENT(kernel, blocks, (geometry)->triangle_blocks.memory)

/* Allocates everything and uploads what does not move.
 *
 * layouts        [meshes] taken over and emptied, whether it succeeds or not
 * mesh_of_part   [parts] */
skg_status skg_geometry_create(skg_context *context, int32_t precision, int64_t meshes,
                               skg_mesh_layout *layouts, int64_t parts, const int64_t *mesh_of_part,
                               skg_geometry *geometry);
void skg_geometry_release(skg_geometry *geometry);

/* Enqueues the upload of `count` vertices from number `first` on, of one mesh or of several: offsets from the origin of their
 * mesh in the order of its layout, float or double by the precision; of a fine one then what rounding them has lost. The
 * offsets must stay until the device has read them. */
skg_status skg_geometry_upload(skg_context *context, skg_geometry *geometry, int64_t first, int64_t count,
                               const void *offsets, skg_stage_log *log);

/* Uploads the corners of a mesh whose merged vertices may have parted, if there are any: from now on, each is a vertex of
 * its own. Waits for what is enqueued, once in the life of a geometry. */
skg_status skg_geometry_part_vertices(skg_context *context, skg_geometry *geometry, const skg_mesh *mesh,
                                      int64_t index);

/* Enqueues the upload of all meshes whose vertices have changed since they were last uploaded. meshes: [meshes]. A note
 * says where merged vertices of a leaky mesh have parted. */
skg_status skg_geometry_update(skg_geometry *geometry, skg_mesh *const *meshes, skg_staging *staging);

/* Enqueues that no vertex was bad in any of a job's frames. */
skg_status skg_geometry_clear_bad(skg_context *context, skg_geometry *geometry, int64_t frames);

/* Frames are independent: what is projected from now on is this one, or with `each` this one and those that follow it. Bad vertices are
 * found by the projection, which the frame then has to make again. */
void skg_geometry_begin_frame(skg_geometry *geometry, int64_t frame, int32_t each);

/* Enqueues that no vertex was bad in the frame, which begins anew. */
skg_status skg_geometry_reset_bad(skg_context *context, skg_geometry *geometry);

/* Enqueues one frame's projection, by its part table (skg_geometry_weigh). kernel: the raster's (skg_raster_projection) */
skg_status skg_geometry_project(skg_context *context, skg_geometry *geometry, cl_kernel kernel,
                                skg_stage_log *log);

/* As skg_geometry_reset_bad, for a frame that may take over the projection of the frame before, with its bad vertices; not from a frame of several
 * passes, whose bad vertices are those of all. */
skg_status skg_geometry_continue(skg_context *context, skg_geometry *geometry);

/* Takes over the projection of the vertices and tables that are on the device. 0: this kernel has made none. */
int skg_geometry_take_projection(skg_geometry *geometry, cl_kernel kernel);

/* Bytes on the device. */
int64_t skg_geometry_bytes(const skg_geometry *geometry);

/* Which part, and which vertex of its mesh in the caller's numbering, a number in `bad` means. */
void skg_geometry_find(const skg_geometry *geometry, int64_t vertex, int64_t *part, int64_t *mesh_vertex);

#endif
