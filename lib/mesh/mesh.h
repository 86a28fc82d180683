/* The inside of a mesh, and what a plan reads of it. Private. */
#ifndef SKG_MESH_PRIVATE_H
#define SKG_MESH_PRIVATE_H

#include "mesh/arrays.h"

#include <skiagraph/mesh.h>

/* Vertices first to end - 1, of one component; -1: of none. */
typedef struct {
    int64_t first, end;
    int32_t piece;
} skg_vertex_run;

struct skg_mesh {
    skg_refs refs;
    char *name;
    int64_t vertices, triangles;
    double *positions;   /* 3 * vertices, mm; valid unless positions_stale */
    float *offsets;      /* 3 * vertices, mm from origin: uploaded for single precision */
    double origin[3];    /* mm */
    int32_t *corners;    /* 3 * triangles, as given */
    int32_t *weld;       /* per vertex the first one at the same place; NULL: each is its own */
    int32_t orientation; /* 1; -1: the triangles face inward, and the plan changes the sign of their hits */
    int32_t closed;      /* as health.closed */
    int32_t as_wound;    /* 1: inconsistent winding stays */
    int positions_stale; /* 1: the offsets were changed in place, and a position is origin + offset */
    int64_t version;     /* of the positions, from 1 */
    float lowest[3];     /* bounds of the finite offsets, mm from origin */
    float highest[3];
    int64_t first_bad; /* first vertex that is not finite; -1: none */
    int64_t layers;    /* how many times over a ray may be inside at once */
    /* how often an edge runs in one direction: coincident copies weld into one component */
    int32_t multiplicity;
    int32_t pieces;       /* components that are joined by shared edges */
    int32_t pieces_share; /* 1: some of them share vertices */
    int32_t *piece;       /* [triangles] the number of each one's if they share vertices; otherwise NULL */
    /* vertices that follow each other and belong to one; NULL: there is one, or they share vertices */
    skg_vertex_run *runs;
    int64_t run_count;
    float *boxes;                 /* [pieces][6] with runs, their bounds as lowest and highest */
    int64_t winding;              /* the largest winding number along columns, when these were last swept */
    double twice_inside;          /* the share of these columns' way inside that is inside more than once */
    double unit_mm, file_unit_mm; /* as skg_mesh_unit.mm and .file_mm */
    int32_t unit_from;            /* enum skg_unit_from */
    skg_mesh_piece *groups;       /* named ones of the file, in the order of their triangles */
    int64_t group_count;
    skg_mesh_health health; /* volume, area, bounds and degenerate_triangles of version 1 */
};

/* Makes a mesh of the arrays (mm) and empties them, whether it succeeds or not. Checks everything that
 * skg_mesh_create promises except the strides and the unit. */
skg_status skg_mesh_adopt(skg_context *context, const char *name, skg_mesh_arrays *arrays, skg_mesh **mesh);

/* Warns if triangles were turned, or the mesh outward as a whole. */
void skg_mesh_warn_turned(const skg_context *context, const skg_mesh *mesh);

/* A mesh from a file, and what is to be warned of. */
typedef struct {
    skg_mesh *mesh;      /* NULL: it could not be loaded */
    int64_t left_out;    /* points and lines of the file */
    int64_t unused;      /* vertices of no triangle */
    int64_t trailing;    /* bytes behind the last triangle of a binary file */
    int64_t not_printed; /* objects that support others */
} skg_loaded;

/* skg_mesh_load in two steps: threads may share the first one for files that are shareable (STL, PLY and OBJ: Assimp's errors belong to no
 * thread), and the second one logs. The calling thread has the C locale (text.h). */
int skg_mesh_is_shareable(const char *path);
skg_status skg_mesh_load_silently(const char *path, const skg_mesh_reading *reading, skg_loaded *loaded);
void skg_mesh_load_warn(const skg_context *context, const char *path, const skg_loaded *loaded);

/* Sets bounds, first_bad and the boxes of the components for the present offsets. */
void skg_mesh_set_bounds(skg_mesh *mesh);

/* Fills health and orientation of a new mesh, and its weld map. */
skg_status skg_mesh_examine(skg_mesh *mesh);

/* Takes the components of a new mesh, and counts its layers.
 *
 * root           [triangles] a triangle of the same component, the same one for all of its triangles; components are
 *                joined by shared edges
 * multiplicity   how often an edge runs in one direction */
skg_status skg_mesh_set_pieces(skg_mesh *mesh, const int32_t *root, int32_t multiplicity);

/* Sets mesh->layers for the present positions: how many components may lie over each other, judged by their boxes, times
 * the multiplicity; or the largest winding number along columns, if that is more. Columns are swept at the first three moves and every
 * 64th version. */
skg_status skg_mesh_count_layers(skg_mesh *mesh);

/* The layers of positions that the host does not know: all components may lie over each other. */
static inline int64_t skg_mesh_layers_unseen(const skg_mesh *mesh) {
    const int64_t all = (int64_t)mesh->pieces * mesh->multiplicity;
    return all > mesh->layers ? all : mesh->layers;
}

/* Numbers the pieces that are connected through welded vertices, in the order of their first triangles.
 *
 * number   [triangles] result: the piece of each triangle; may be NULL */
skg_status skg_mesh_components(const skg_mesh *mesh, int32_t *number, int64_t *count);

/* Volume (times orientation), area, bounds and degenerate triangles for the present positions. */
void skg_mesh_measure(const skg_mesh *mesh, skg_mesh_health *health);

/* Measures a mesh for its present positions, and turns the orientation of a closed one whose volume is negative: its triangles face
 * inward, or its positions were mirrored. */
void skg_mesh_turn_outward(skg_mesh *mesh);

/* A coordinate of the present position of a vertex, mm. */
static inline double skg_mesh_coordinate(const skg_mesh *mesh, int64_t vertex, int axis) {
    return mesh->positions_stale ? mesh->origin[axis] + (double)mesh->offsets[3 * vertex + axis]
                                 : mesh->positions[3 * vertex + axis];
}

/* All three. */
static inline void skg_mesh_vertex(const skg_mesh *mesh, int64_t vertex, double position[3]) {
    for (int k = 0; k < 3; k++) position[k] = skg_mesh_coordinate(mesh, vertex, k);
}

/* Bounds of the offsets (mm from the origin) over the finite vertices. *first_bad is the first vertex that is not
 * finite, or -1. Both are kept up to date whenever positions change, so this call costs nothing. */
void skg_mesh_bounds(const skg_mesh *mesh, float lowest[3], float highest[3], int64_t *first_bad);

/* A mesh of fewer triangles stays in the cache of a processor in any order (4096 corners and vertices: 100 KiB). */
enum { SKG_MESH_SMALL = 4096 };

/* The corners (3 * triangles) in an order that suits the device: along a space-filling curve if neighbours in
 * the caller's order are far apart, otherwise the caller's order. Each triangle keeps the order of its corners.
 * *sorted is 1 if the triangles were reordered. */
skg_status skg_mesh_sorted_corners(const skg_mesh *mesh, int32_t *corners, int32_t *sorted);

/* The flat faces of a mesh, such as a block's: in these other parts may touch it, and rays may run along them. Faces whose
 * triangles are scattered over the list, and smaller ones than a thousandth of the surface, are not found.
 *
 * vertices   [SKG_MESH_PLANES][3] result: of a triangle of each; may be NULL
 * returns how many; at most SKG_MESH_PLANES */
enum { SKG_MESH_PLANES = 64 };
int32_t skg_mesh_flat_faces(const skg_mesh *mesh, int32_t (*vertices)[3]);

/* The vertices and triangles of a mesh as a device has them. Vertices at the same place are merged. Those of a closed
 * mesh stay together (skg_mesh_positions_set). Those of a leaky one may part, so the layout lists their copies as well. */
typedef struct {
    int64_t vertices;  /* of the device */
    int64_t copies;    /* further ones, which are merged into them and may part */
    int64_t triangles; /* of the mesh */
    /* [vertices + copies] the mesh's number of each; NULL: as the mesh numbers them, none merged */
    int32_t *source;
    int32_t *corners; /* [triangles][3] */
    int32_t thin;     /* 1: the mesh is much thinner than wide */
    int32_t flat;     /* 1: the mesh has a flat face, and the scene other such meshes; set by the caller */
    int32_t plane_count;
    int32_t (*planes)[3]; /* [plane_count] of a flat mesh: vertices of its flat faces */
    int32_t fine; /* 1: the device has also what rounding them to floats has lost; set by the caller */
} skg_mesh_layout;

/* Merges vertices if that saves an eighth of them, and puts triangles and vertices in an order in which neighbours in
 * memory are neighbours in space, unless they are in such an order. Release it by skg_mesh_layout_release. */
skg_status skg_mesh_layout_create(const skg_mesh *mesh, skg_mesh_layout *layout);
void skg_mesh_layout_release(skg_mesh_layout *layout);

/* Makes the copies of a layout vertices of their own, at the end, with corners that name them. layout->corners: NULL. */
skg_status skg_mesh_layout_part(const skg_mesh *mesh, skg_mesh_layout *layout);

/* The first vertex that was at the same place as another one when the mesh was made and is not any more; -1: none. */
int64_t skg_mesh_parted(const skg_mesh *mesh);

#endif
