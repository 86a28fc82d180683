/** @file
 * Triangle meshes.
 *
 * A mesh keeps the caller's numbering: vertex i and triangle i are always those that were given. Positions
 * are in mm in the caller's frame. The mesh stores them as doubles, and as float offsets from an origin of
 * its own, which is what a plan in single precision uploads. A mesh has a version number, which grows when
 * its vertices move, and a health (skg_mesh_health): is it closed, does it point outward, how large is it.
 *
 * Meshes that nobody changes may be shared by threads. Functions take a context for its log only; it may be
 * NULL.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_MESH_H
#define SKIAGRAPH_MESH_H

#include <skiagraph/context.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Vertices and triangles. */
typedef struct skg_mesh skg_mesh;

/** Vertices and triangles of a mesh to be made. The arrays are the caller's. */
typedef struct {
    /** Set by skg_mesh_source_init. */
    int32_t size;
    /** 0, the default: triangles that are wound otherwise than their neighbours are turned (skg_mesh_health.turned); 1: they stay, and
     * the mesh is leaky. */
    int32_t as_wound;
    /** Number of vertices. */
    int64_t vertices;
    /** Rows of x, y, z in units of unit_mm. */
    const double *positions;
    /** Positions in single precision instead; one of positions and floats is NULL. */
    const float *floats;
    /** Elements from one row to the next, at least 3; 0: 3. */
    int64_t position_stride;
    /** Number of triangles. */
    int64_t triangles;
    /** Rows of three vertex numbers, counted from 0. */
    const int32_t *corners;
    /** Elements from one row to the next, at least 3; 0: 3. */
    int64_t triangle_stride;
    /** mm per unit: 1, the default, for mm, 10 for cm, 1000 for m; finite, above 0. */
    double unit_mm;
} skg_mesh_source;

SKG_INIT(skg_mesh_source)

/** Makes a mesh from arrays, which are copied.
 *
 *     name      for messages; NULL or "": "mesh"
 *     mesh      result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT, SKG_ERR_MEMORY; SKG_ERR_MESH if there are no triangles, or for the first corner that
 *               is out of range or vertex that is not finite
 *
 * Triangles that are wound otherwise than their neighbours are turned: their second and third corner are exchanged, and a warning
 * says how many and where the first is. Edges of more than two triangles join no neighbours. If a closed mesh points inward as a
 * whole, it is turned outward and a warning says so (skg_mesh_health.flipped). The caller's numbering stays. */
SKG_API skg_status skg_mesh_create(skg_context *context, const char *name, const skg_mesh_source *source,
                                   skg_mesh **mesh);

/** How a file is read. */
typedef struct {
    /** Set by skg_mesh_reading_init. */
    int32_t size;
    /** As in skg_mesh_source. */
    int32_t as_wound;
    /** mm per unit of the file, finite; 0, the default: the unit that the file or its format names (skg_mesh_unit), otherwise 1 */
    double unit_mm;
    /** NULL, the default: everything; or the name of a group or an object of an OBJ file, of an object of a 3MF file, or of a node of
     * another format: only its triangles, and the vertices that they use. */
    const char *group;
} skg_mesh_reading;

SKG_INIT(skg_mesh_reading)

/** As skg_mesh_load, with more wishes. */
SKG_API skg_status skg_mesh_load_as(skg_context *context, const char *path, const skg_mesh_reading *reading,
                                    skg_mesh **mesh);

/** Reads a mesh from a file: STL (text or binary), PLY, OBJ, 3MF, or another format that Assimp reads.
 *
 *     unit_mm   mm per unit of the file; 0: the unit that the file or its format names, otherwise mm
 *     mesh      result, named like the file without its folder; the caller releases it
 *     errors    SKG_ERR_FILE (cannot be read), SKG_ERR_FORMAT (truncated, or no mesh), SKG_ERR_MESH
 *
 * Several objects in one file become one mesh. A face with more than three corners is cut into a fan from its
 * first corner, which does not change path lengths if the face is plane. Points and lines are left out with a
 * warning. The order of the file is kept: vertex i is the i-th "v" line of an OBJ file, the i-th vertex of a
 * PLY or OFF file (doubles stay doubles), the i-th corner of an STL file. In other formats Assimp decides the order,
 * and positions are floats. Numbers in text are read alike in every locale.
 *
 * The file, and every file that it refers to, is a regular file of at most 64 GiB: pipes and devices are refused. A file
 * that is an archive, such as .3mf, unpacks to at most 1 GiB, and no part of it to more than 1032 times its bytes. A file places
 * its parts (objects, nodes) at most 100,000 times, and none in itself; it takes at most 64 times its bytes of memory, or 1 GiB.
 * 3MF, glTF, COLLADA, AMF and X3D are held to that before they are opened, other formats once Assimp has opened them. Assimp, in the build of Debian, ends the process where it meets
 * some kinds of damage; parts and relationships of archives are checked before. Load damaged files of other formats than STL, OBJ,
 * OFF and PLY in a process of its own, such as the command's. */
SKG_API skg_status skg_mesh_load(skg_context *context, const char *path, double unit_mm, skg_mesh **mesh);

/** Writes a mesh to a file, whole or not at all. Positions are in mm, corners as given.
 *
 *     path     ".stl": binary STL, in floats. ".ply": binary PLY, in floats if they hold every position
 *              exactly and in doubles if not, so that skg_mesh_load gives back the same bits
 *     errors   SKG_ERR_OUTPUT; SKG_ERR_ARGUMENT if the extension is another; SKG_ERR_MESH if a vertex is not
 *              finite */
SKG_API skg_status skg_mesh_save(const skg_mesh *mesh, const char *path);

/** Makes a cube, centred at the origin, closed, outward. Edge in mm, above 0. */
SKG_API skg_status skg_mesh_create_cube(double edge, skg_mesh **mesh);

/** Makes a cuboid, centred at the origin, closed, outward. Edges in mm, above 0. */
SKG_API skg_status skg_mesh_create_cuboid(double length_x, double length_y, double length_z, skg_mesh **mesh);

/** Makes a sphere, centred at the origin, closed, outward. Vertices lie on the sphere, its poles on z.
 *
 *     radius     mm, above 0
 *     segments   around the axis, at least 3; half as many, at least 2, from pole to pole */
SKG_API skg_status skg_mesh_create_sphere(double radius, int64_t segments, skg_mesh **mesh);

/** Makes a cylinder along z, centred at the origin, closed, outward. Vertices lie on the circles.
 *
 *     radius, height   mm, above 0
 *     segments         around the axis, at least 3 */
SKG_API skg_status skg_mesh_create_cylinder(double radius, double height, int64_t segments, skg_mesh **mesh);

/** Makes a step wedge, centred at the origin, closed, outward.
 *
 *     length_x, length_y, height_z   mm, above 0
 *     steps                          at least 1, along x, each length_x / steps long; step k, counted from 0,
 *                                    is (k + 1) / steps of height_z high */
SKG_API skg_status skg_mesh_create_step_wedge(double length_x, double length_y, double height_z,
                                              int64_t steps, skg_mesh **mesh);

/** Makes a step wedge with steps of any height; otherwise as skg_mesh_create_step_wedge.
 *
 *     heights   [steps] mm, rising */
SKG_API skg_status skg_mesh_create_steps(double length_x, double length_y, int64_t steps,
                                         const double *heights, skg_mesh **mesh);

/** Adds an owner to a mesh. */
SKG_API skg_status skg_mesh_retain(skg_mesh *mesh);

/** Removes an owner; the last one frees the mesh. */
SKG_API void skg_mesh_release(skg_mesh **mesh);

/** Numbers of vertices and triangles, as given. */
SKG_API skg_status skg_mesh_count(const skg_mesh *mesh, int64_t *vertices, int64_t *triangles);

/** Copies the positions out, in mm. position_stride as in skg_mesh_create. */
SKG_API skg_status skg_mesh_positions_get(const skg_mesh *mesh, double *positions, int64_t position_stride);

/** Copies the corners out. triangle_stride as in skg_mesh_create. */
SKG_API skg_status skg_mesh_triangles_get(const skg_mesh *mesh, int32_t *corners, int64_t triangle_stride);

/** Gives every vertex a new position. The next frame uploads them. On a device, vertices with equal positions are one
 * vertex; if those of a leaky mesh part, a plan uploads all of its vertices from then on, and a note says so.
 *
 *     positions   one row per vertex, mm; position_stride as in skg_mesh_create
 *     errors      SKG_ERR_MESH, and the mesh stays as it was, if a position is not finite, or if vertices of
 *                 a closed mesh that had equal positions no longer have: the mesh would open
 *
 * In the health, what depends on topology stays (closed, winding); volume, area, bounds and degenerate
 * triangles follow the positions. Where they mirror a closed mesh, so that its triangles face inward, or outward again, it is
 * turned as skg_mesh_create turns it (skg_mesh_health.flipped). A mesh that is not closed stays as it is wound. */
SKG_API skg_status skg_mesh_positions_set(skg_mesh *mesh, const double *positions, int64_t position_stride);

/** Gets the memory of the float offsets, to move vertices without a copy. Write there, then call
 * skg_mesh_offsets_moved.
 *
 *     offsets   result: rows of x, y, z in mm from *origin; valid as long as the mesh
 *     origin    result: [3] mm; valid as long as the mesh. skg_mesh_positions_set may change the values */
SKG_API skg_status skg_mesh_offsets_get(skg_mesh *mesh, float **offsets, const double **origin);

/** Says that the float offsets were written. The next frame uploads them. Errors: SKG_ERR_MESH if vertices of
 * a closed mesh that had equal positions no longer have; the version grows all the same. A vertex that is not
 * finite is found by the frame that meets it. Triangles are not measured, for speed: offsets that mirror a closed mesh make its
 * lengths and its volume negative, until skg_mesh_positions_set is given the positions. */
SKG_API skg_status skg_mesh_offsets_moved(skg_mesh *mesh);

/** Gets the version: 1 at first, one more with each skg_mesh_positions_set and skg_mesh_offsets_moved. */
SKG_API skg_status skg_mesh_version_get(const skg_mesh *mesh, int64_t *version);

/** The health of a mesh. The library fills it; prepare with skg_mesh_health_init. Vertices with equal
 * positions, bit for bit, count as one vertex here: they are welded. */
typedef struct {
    /** Set by skg_mesh_health_init. */
    int32_t size;
    /** 1: for every pair of vertices there are as many edges (a, b) as (b, a). Then the signed hits of every
     * ray cancel exactly. A mesh that is not closed is called leaky. */
    int32_t closed;
    /** 1: no two triangles run along a shared edge in the same direction. */
    int32_t consistent;
    /** 1: closed, and its volume is positive, as given or after it was turned outward. */
    int32_t outward;
    /** 1: it pointed inward as a whole and was turned outward. */
    int32_t flipped;
    /** 0 */
    int32_t reserved;
    /** Number of vertices, as given. */
    int64_t vertices;
    /** Number of triangles, as given. */
    int64_t triangles;
    /** Number of vertices after welding. */
    int64_t welded_vertices;
    /** Number of directed edges without their opposite. */
    int64_t open_edges;
    /** The caller's number of a vertex on the first open edge; -1 if closed. */
    int64_t first_open_vertex;
    /** Where that vertex is, mm. */
    double first_open_position[3];
    /** Number of triangles with two corners at the same vertex, or without area. */
    int64_t degenerate_triangles;
    /** Number of triangles with area that repeat an earlier one, rotated or inverted. The common wall of two bodies of a closed mesh,
     * where two triangles face each other, is none. */
    int64_t duplicate_triangles;
    /** Number of edges that more than two triangles share. */
    int64_t nonmanifold_edges;
    /** Number of pieces that are connected through shared vertices. */
    int64_t components;
    /** mm3, signed, after turning; meaningful if closed. */
    double volume;
    /** mm2 */
    double area;
    /** Least x, y, z, then greatest x, y, z, mm. */
    double bounds[6];
    /** Number of directed edges, as in open_edges, of edges that belong to two triangles which both ran along them in the same
     * direction, as given. */
    int64_t same_way_edges;
    /** Number of triangles that were turned, because they were wound otherwise than their neighbours. */
    int64_t turned;
    /** Number of the first of them; -1: none. */
    int64_t first_turned;
    /** Middle of the first turned triangle, mm. */
    double first_turned_position[3];
    /** Number of patches that are one-sided, as a Moebius strip is: they stay as they are. */
    int64_t one_sided;
    /** Number of points and lines of the file that a mesh has not. */
    int64_t left_out;
    /** Number of bytes of a binary STL file behind its last triangle, which were not read. */
    int64_t trailing_bytes;
} skg_mesh_health;

SKG_INIT(skg_mesh_health)

/** Gets the health of a mesh. */
SKG_API skg_status skg_mesh_health_get(const skg_mesh *mesh, skg_mesh_health *health);

/** How the components of a closed mesh lie in each other. The library fills it; prepare with
 * skg_mesh_nesting_init.
 *
 * Components are pieces that are connected through shared vertices. One that lies in the open faces outward and
 * adds its length to that of a ray. One inside another is a cavity: it faces inward and subtracts. A component
 * whose orientation contradicts its place is called inverted: an inward one in the open gives negative lengths,
 * an outward one inside another counts twice. */
typedef struct {
    /** Set by skg_mesh_nesting_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of components; 0 if the mesh is leaky, and then all else is 0, too. */
    int64_t components;
    /** Number of inverted components. skg_mesh_create_oriented turns them. */
    int64_t inverted;
    /** Number of the first inverted component, in the order of their first triangles; -1: none. */
    int64_t first_inverted;
    /** Number of triangles of the first inverted component. */
    int64_t inverted_triangles;
    /** 1: it faces inward in the open; 0: outward, inside another. */
    int32_t inverted_inward;
    /** 0 */
    int32_t reserved_2;
    /** A point inside of it, mm. */
    double inverted_place[3];
    /** Number of cavities that lie inside another component for the most part but leave it somewhere. There,
     * lengths are negative, and turning cannot mend it. */
    int64_t leaving;
    /** Number of the cavity that leaves its solid farthest; -1: none. */
    int64_t first_leaving;
    /** The length of its longest stretch outside, along z, mm. */
    double leaving_length;
    /** The middle of that stretch, mm. */
    double leaving_place[3];
    /** Number of components that overlap a larger one without lying in it: there, lengths add. */
    int64_t overlapping;
    /** Number of the component that overlaps most; -1: none. */
    int64_t first_overlapping;
    /** The length of its longest stretch inside others, along z, mm. */
    double overlapping_length;
    /** The middle of that stretch, mm. */
    double overlapping_place[3];
} skg_mesh_nesting;

SKG_INIT(skg_mesh_nesting)

/** Finds components whose orientation contradicts their nesting, by winding numbers along 64 x 64 lines through
 * each component. Of a mesh with more than 1000 components, the 1000 largest by volume are examined.
 *
 *     nesting   result
 *     errors    SKG_ERR_ARGUMENT, SKG_ERR_MEMORY */
SKG_API skg_status skg_mesh_nesting_get(const skg_mesh *mesh, skg_mesh_nesting *nesting);

/** Writes what is wrong with the nesting of a mesh in a sentence, such as "1 of 3 components is inverted: number 2
 * (312 triangles, near (1, 2, 3) mm) faces inward in the open, where lengths become negative".
 *
 *     nesting   from skg_mesh_nesting_get
 *     length    bytes of `text`, at least 1; a longer sentence is cut, 512 are enough
 *     text      result: ends with a 0; empty if nothing is wrong */
SKG_API skg_status skg_mesh_nesting_describe(const skg_mesh_nesting *nesting, int64_t length, char *text);

/** Makes a mesh in which inverted components are turned. Vertices and the order of triangles stay; the second
 * and third corner of turned triangles are exchanged.
 *
 *     context    receives a warning about a cavity that leaves its solid; may be NULL
 *     oriented   result; the caller releases it */
SKG_API skg_status skg_mesh_create_oriented(skg_context *context, const skg_mesh *mesh, skg_mesh **oriented);

/** Where the unit of a mesh comes from. */
enum skg_unit_from {
    /** Nobody named one: mm. */
    SKG_UNIT_ASSUMED = 0,
    /** The file or its format: 3MF and AMF (`unit`), COLLADA (`<unit meter>`), X3D (metres unless it says otherwise), glTF
     * (metres), FBX (its scale factor). */
    SKG_UNIT_FILE = 1,
    /** The caller. */
    SKG_UNIT_NAMED = 2
};

/** The unit that the numbers of a mesh were in. The library fills it; prepare with skg_mesh_unit_init. */
typedef struct {
    /** Set by skg_mesh_unit_init. */
    int32_t size;
    /** enum skg_unit_from */
    int32_t from;
    /** mm per unit */
    double mm;
    /** mm per unit that the file names, even where the caller named another one; 0: none */
    double file_mm;
    /** Name of the unit: "nm", "um", "mm", "cm", "dm", "m", "inch", "ft", ..., or such as "2.5 mm". */
    char name[32];
} skg_mesh_unit;

SKG_INIT(skg_mesh_unit)

/** Gets the unit of a mesh. */
SKG_API skg_status skg_mesh_unit_get(const skg_mesh *mesh, skg_mesh_unit *unit);

/** Gets the millimetres in a unit of length.
 *
 * @param name  "mm", "inch", "metre", ..., as `Unit` of scene files spells it, without regard to case
 * @param mm    result
 * @return SKG_ERR_FORMAT for another word
 * @since 0.1.0
 */
SKG_API skg_status skg_length_unit_get(const char *name, double *mm);

/** Gets the number of named pieces of the mesh's file: groups and objects of OBJ, objects of 3MF, nodes of other formats. */
SKG_API skg_status skg_mesh_group_count(const skg_mesh *mesh, int64_t *count);

/** Gets one of them. Several may have the same name.
 *
 *     group       from 0 on
 *     name        result: valid as long as the mesh; NULL: none; may be NULL
 *     first       result: its first triangle; may be NULL
 *     triangles   result: their number; may be NULL */
SKG_API skg_status skg_mesh_group_get(const skg_mesh *mesh, int64_t group, const char **name, int64_t *first,
                                      int64_t *triangles);

/** Gets the mesh's name, valid as long as the mesh. */
SKG_API skg_status skg_mesh_name_get(const skg_mesh *mesh, const char **name);

#ifdef __cplusplus
}
#endif
#endif
