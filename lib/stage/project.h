/* Stage `project`: the meshes of a scene on the device, the tables of its parts, and the projected vertices
 * of a frame. One vertex, index and part table for everything: launches do not grow with the number of parts,
 * and a mesh in many parts is stored once. Private. */
#ifndef SKG_PROJECT_H
#define SKG_PROJECT_H

#include "geometry/camera.h"
#include "spectral/contribution.h"
#include "stage/kernels.h"

typedef struct {
    int64_t vertices, triangles;
    const int32_t *corners; /* [triangles][3] vertex numbers of this mesh; read during the call */
} skg_geometry_mesh;

/* A part in one frame. */
typedef struct {
    const double *pose;   /* 4x4, row by row */
    const double *origin; /* of its mesh's offsets, mm */
    int32_t flipped;      /* its mesh is drawn with triangles turned round */
    double reference;     /* path parameter that its depths are measured from: the middle of those that lie on
                        paths, so     that no term is larger than their extent. Above 0 with a point source */
    double depth;         /* extent of its path parameters, from nearest to farthest */
    int32_t weights;      /* how many planes; 0: the part is not drawn, but keeps its place */
    const skg_contribution *weight;
} skg_geometry_part;

/* Host copies of the part and write tables, kept until the device has read them: writes do not wait for
 * frames in flight. */
enum { SKG_TABLE_SLOTS = 4 };
typedef struct {
    void *entries; /* skg_part_float or _double [parts] */
    void *writes;  /* skg_write_float or _double [write_count] */
    int64_t write_count, write_room;
    cl_event read; /* of the last write from here; NULL: none */
} skg_table_slot;

typedef struct {
    int64_t meshes, parts;
    int64_t vertices, triangles; /* over all parts */
    int64_t mesh_vertices;       /* over all meshes */
    int32_t precision;           /* SKG_PRECISION_SINGLE: offsets and tables in float; SKG_PRECISION_DOUBLE */
    int32_t reserved;
    int64_t *mesh_vertex;  /* [meshes + 1] first vertex of each mesh in the vertex buffer */
    int64_t *first_vertex; /* [parts + 1] in the numbering over all parts */
    int32_t slot;          /* of the tables that the device has */
    int32_t uploaded;      /* it has any */
    skg_table_slot slots[SKG_TABLE_SLOTS];
    cl_kernel kernel;
    skg_kernel_options kernel_options;
    skg_buffer offsets, corners, part_table, write_table, vertex_blocks, triangle_blocks;
    skg_buffer projected; /* x, y, z, t of each vertex over all parts */
    skg_buffer bad;       /* int: the lowest vertex over all parts that was not finite since the last upload;
                          INT32_MAX: none */
} skg_geometry;

/* Allocates everything and uploads what does not move. mesh_of_part: [parts]. */
skg_status skg_geometry_create(skg_context *context, int32_t precision, int64_t meshes,
                               const skg_geometry_mesh *mesh, int64_t parts, const int64_t *mesh_of_part,
                               skg_geometry *geometry);
void skg_geometry_release(skg_geometry *geometry);

/* Uploads the vertices of a mesh: offsets from its origin, [vertices][3], float or double as the precision
 * is. Nothing is waited for: the offsets must stay until they are read. */
skg_status skg_geometry_upload(skg_context *context, skg_geometry *geometry, int64_t mesh,
                               const void *offsets, skg_stage_log *log);

/* Enqueues one frame's part table and projection. part: [parts]; scale: of the accumulators (multiplies
 * weights). */
skg_status skg_geometry_project(skg_context *context, skg_geometry *geometry,
                                const skg_kernel_options *options, const skg_camera *camera,
                                const skg_geometry_part *part, double scale, skg_stage_log *log);

/* Enqueues another part table for a frame that is projected: the same parts with other weights. */
skg_status skg_geometry_weigh(skg_context *context, skg_geometry *geometry, const skg_camera *camera,
                              const skg_geometry_part *part, double scale);

/* Bytes on the device. */
int64_t skg_geometry_bytes(const skg_geometry *geometry);

/* Which part and which vertex of its mesh a number in `bad` means. */
void skg_geometry_find(const skg_geometry *geometry, int64_t vertex, int64_t *part, int64_t *mesh_vertex);

#endif
