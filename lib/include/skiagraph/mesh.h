/* Triangle meshes.
 *
 * A mesh keeps the caller's numbering: vertex i and triangle i are those given, always. Positions are in mm,
 * in the caller's frame; inside they are doubles, and float offsets from an origin of the mesh's own, which
 * is what a plan of single precision uploads. Every mesh carries its health (closed? outward?) and a version
 * number that grows whenever its vertices move. Meshes that nobody writes may be shared by threads.
 *
 * Calls that take a context take it for its warnings only; it may be NULL. */
#ifndef SKIAGRAPH_MESH_H
#define SKIAGRAPH_MESH_H

#include <skiagraph/context.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_mesh skg_mesh;

/* A mesh from arrays, which are copied. name: for messages; "" or NULL for "mesh".
 * positions: `vertices` rows of x, y, z, `position_stride` elements from row to row (>= 3, or 0 for 3), in
 * units of unit_mm mm (finite, > 0: 1 for mm, 10 for cm, 1000 for m). corners: `triangles` rows of three
 * vertex numbers from 0, `triangle_stride` elements from row to row (>= 3, or 0 for 3). A closed mesh that is
 * inverted as a whole is turned outward, with a warning (health.flipped); the caller's numbering stays.
 * Errors: SKG_ERR_ARGUMENT, SKG_ERR_MESH (no triangles, index out of range, NaN or infinite vertex: the first
 * one is named), SKG_ERR_MEMORY. The caller releases the mesh. */
SKG_API skg_status skg_mesh_create(skg_context *context, const char *name, int64_t vertices,
                                   const double *positions, int64_t position_stride, int64_t triangles,
                                   const int32_t *corners, int64_t triangle_stride, double unit_mm,
                                   skg_mesh **mesh);
SKG_API skg_status skg_mesh_create_float(skg_context *context, const char *name, int64_t vertices,
                                         const float *positions, int64_t position_stride, int64_t triangles,
                                         const int32_t *corners, int64_t triangle_stride, double unit_mm,
                                         skg_mesh **mesh);

/* A mesh from a file: STL (ascii, binary), PLY, OBJ, and what else Assimp reads; several objects in a file
 * become one mesh. Faces of more than three corners are cut into a fan from the first, which leaves the path
 * lengths of any plane face what they are; points and lines are left out, with a warning. The file's own
 * order is kept: vertex i is the i-th "v" line of an OBJ file, the i-th vertex of a PLY file (doubles stay
 * doubles), corner i of an STL file. In other formats it is Assimp's, in floats. Numbers in text are read
 * alike in every locale. unit_mm as above. The mesh is named by the file, without its folder. Errors:
 * SKG_ERR_FILE (cannot be read), SKG_ERR_FORMAT (truncated, not a mesh), SKG_ERR_MESH. */
SKG_API skg_status skg_mesh_load(skg_context *context, const char *path, double unit_mm, skg_mesh **mesh);

/* Writes a mesh as binary PLY (floats where they hold every position exactly, else doubles: skg_mesh_load
 * gives back the same bits), or as binary STL (floats) where path ends in .stl; positions in mm, corners as
 * given. Whole or not at all. Errors: SKG_ERR_OUTPUT; SKG_ERR_MESH (a vertex is not finite). */
SKG_API skg_status skg_mesh_save(const skg_mesh *mesh, const char *path);

/* Makers: closed, outward, centred at the origin; lengths in mm, > 0.
 * sphere: segments >= 3 around and segments/2 (at least 2) from pole to pole, poles on z; vertices on the
 * sphere. cylinder: axis z, segments >= 3 around; vertices on the circle. step_wedge: `steps` >= 1 steps
 * along x, each length_x/steps long; step k is (k+1)/steps of height_z high, y across. */
SKG_API skg_status skg_mesh_create_cube(double edge, skg_mesh **mesh);
SKG_API skg_status skg_mesh_create_cuboid(double length_x, double length_y, double length_z, skg_mesh **mesh);
SKG_API skg_status skg_mesh_create_sphere(double radius, int64_t segments, skg_mesh **mesh);
SKG_API skg_status skg_mesh_create_cylinder(double radius, double height, int64_t segments, skg_mesh **mesh);
SKG_API skg_status skg_mesh_create_step_wedge(double length_x, double length_y, double height_z,
                                              int64_t steps, skg_mesh **mesh);

SKG_API skg_status skg_mesh_retain(skg_mesh *mesh);
SKG_API void skg_mesh_release(skg_mesh **mesh);

/* Numbers of vertices and triangles, as given. */
SKG_API skg_status skg_mesh_count(const skg_mesh *mesh, int64_t *vertices, int64_t *triangles);

/* Copies positions (mm) or corners out; strides as in skg_mesh_create. */
SKG_API skg_status skg_mesh_positions_get(const skg_mesh *mesh, double *positions, int64_t position_stride);
SKG_API skg_status skg_mesh_triangles_get(const skg_mesh *mesh, int32_t *corners, int64_t triangle_stride);

/* Gives every vertex a new position (mm); same count and strides as in skg_mesh_create. The next frame
 * uploads them. The health keeps what topology says (closed, winding); volume, area, bounds and degenerate
 * triangles follow. SKG_ERR_MESH, and the mesh stays as it was: a position is not finite, or vertices of a
 * closed mesh that were welded by their equal positions would part, which would open it. */
SKG_API skg_status skg_mesh_positions_set(skg_mesh *mesh, const double *positions, int64_t position_stride);

/* The way without a copy: the float offsets (rows of x, y, z, in mm, from *origin) that the upload reads.
 * Write there, then call skg_mesh_offsets_moved. The pointers are valid as long as the mesh; *origin may change with
 * skg_mesh_positions_set. skg_mesh_offsets_moved fails with SKG_ERR_MESH when welded vertices of a closed mesh have
 * parted (the version grows all the same); a vertex that is not finite is found by the frame that meets it.
 */
SKG_API skg_status skg_mesh_offsets_get(skg_mesh *mesh, float **offsets, const double **origin);
SKG_API skg_status skg_mesh_offsets_moved(skg_mesh *mesh);

/* Grows by one with each write or skg_mesh_offsets_moved; starts at 1. */
SKG_API skg_status skg_mesh_version_get(const skg_mesh *mesh, int64_t *version);

/* Health. Vertices whose positions are equal bit for bit are one vertex here (welded).
 * closed: for every pair of vertices as many edges (a,b) as (b,a); then every ray's signed hits cancel
 * exactly. */
typedef struct {
    int32_t size;
    int32_t closed;              /* 1 or 0 */
    int32_t consistent;          /* 1: no two triangles run along a shared edge in the same direction */
    int32_t outward;             /* 1: closed, and its volume was positive as given or the mesh was flipped */
    int32_t flipped;             /* 1: inverted as a whole, turned outward */
    int32_t reserved;            /* 0 */
    int64_t vertices, triangles; /* as given */
    int64_t welded_vertices;     /* after welding */
    int64_t open_edges;          /* directed edges without their opposite */
    int64_t first_open_vertex;   /* caller's number of a vertex on the first one; -1 when closed */
    double first_open_position[3]; /* mm */
    int64_t degenerate_triangles;  /* two corners are the same vertex, or no area */
    int64_t duplicate_triangles; /* of those with three vertices: repeat an earlier one, turned or inverted */
    int64_t nonmanifold_edges;   /* edges of more than two triangles */
    int64_t components;          /* connected through shared vertices */
    double volume;               /* mm3, signed as seen after flipping; meaningful when closed */
    double area;                 /* mm2 */
    double bounds[6];            /* mm: min x, y, z, max x, y, z */
} skg_mesh_health;

SKG_API void skg_mesh_health_init(skg_mesh_health *health);
SKG_API skg_status skg_mesh_health_get(const skg_mesh *mesh, skg_mesh_health *health);

/* The name given, or the file's name without its folder. Valid as long as the mesh. */
SKG_API skg_status skg_mesh_name_get(const skg_mesh *mesh, const char **name);

#ifdef __cplusplus
}
#endif
#endif
