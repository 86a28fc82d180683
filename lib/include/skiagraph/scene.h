/* Scenes: parts (a mesh, its material, what it lies inside, where it stands), and views. Scene files:
 * setup.h.
 *
 * Positions are in mm. A pose is a 4x4 affine matrix in double, row by row (pose[4*r + c]), that takes mesh
 * coordinates to the world: x_world = pose * (x, y, z, 1). Mirrored poses are fine; singular ones are
 * refused. */
#ifndef SKIAGRAPH_SCENE_H
#define SKIAGRAPH_SCENE_H

#include <skiagraph/beam.h>
#include <skiagraph/context.h>
#include <skiagraph/material.h>
#include <skiagraph/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_scene skg_scene;

/* One part. Prepare with skg_part_init: identity pose, no parent.
 * Priority: where closed parts with one parent (or in the world) overlap, those of the highest priority have
 * the interval of the ray to themselves; the others fall, and with them what lies inside them. Equal ones
 * add. Open parts neither win nor lose. Submitting a frame in which such parts may meet waits until their
 * hits are counted. */
typedef struct {
    int32_t size;
    int32_t priority; /* 0 by default; see above */
    int64_t inside;   /* number of the part that this one displaces, or -1: it stands in the world. In a scene
                         from a file it may be larger than the part's own. */
    skg_mesh *mesh;   /* retained by the scene */
    skg_material *material; /* retained by the scene */
    const char *label;      /* unique in the scene; NULL: the mesh's name; copied */
    double pose[16];
} skg_part;

SKG_API void skg_part_init(skg_part *part);

/* An empty scene. context: for warnings; may be NULL. */
SKG_API skg_status skg_scene_create(skg_context *context, skg_scene **scene);
SKG_API skg_status skg_scene_retain(skg_scene *scene);
SKG_API void skg_scene_release(skg_scene **scene);

/* Adds a part; its number, counted from 0, goes to *id (NULL: not wanted). Errors: SKG_ERR_SCENE (duplicate
 * label, inside itself or a part that is not there, singular pose). */
SKG_API skg_status skg_scene_add(skg_scene *scene, const skg_part *part, int64_t *id);

SKG_API skg_status skg_scene_part_count(const skg_scene *scene, int64_t *parts);

/* Reads part 0 <= id < parts; its pointers are valid as long as the scene and are not retained for the
 * caller. */
SKG_API skg_status skg_scene_part_get(const skg_scene *scene, int64_t id, skg_part *part);

/* The number of the part with this label, or else of the only one that is equal but for case. SKG_ERR_SCENE
 * with the nearest label where there is none. */
SKG_API skg_status skg_scene_find(const skg_scene *scene, const char *label, int64_t *id);

/* A new pose; plans use it from the next frame on. */
SKG_API skg_status skg_scene_pose_set(skg_scene *scene, int64_t id, const double *pose);

/* Another material (retained), as a lung's of new density. Plans use it from the next frame on; a plan that
 * compresses several energies (tolerance above 0) is stale then. */
SKG_API skg_status skg_scene_material_set(skg_scene *scene, int64_t id, skg_material *material);

/* Where rays start. */
enum {
    SKG_PROJECTION_POINT = 0, /* from the point `source` */
    SKG_PROJECTION_PARALLEL =
        1, /* along detector centre - source, from the plane through `source` across it */
    SKG_PROJECTION_PARALLEL_FROM_INFINITY = 2 /* along `source`, which is a direction, from infinitely far */
};

/* Source and detector. Pixel (row r, column c) has its centre at
 *     centre + (c - (columns-1)/2) column_step + (r - (rows-1)/2) row_step.
 * A length is measured from the source (or its plane) to that centre; a pixel behind that plane sees nothing.
 * No entry may exceed 1e9 mm. */
typedef struct {
    int32_t size;
    int32_t
        projection; /* SKG_PROJECTION_POINT, SKG_PROJECTION_PARALLEL, SKG_PROJECTION_PARALLEL_FROM_INFINITY */
    int64_t columns, rows; /* 1 to 32768 each */
    double source[3];      /* mm; a direction of any length for SKG_PROJECTION_PARALLEL_FROM_INFINITY */
    double centre[3];      /* mm */
    double column_step[3]; /* mm per column */
    double row_step[3];    /* mm per row */
} skg_view;

SKG_API void skg_view_init(skg_view *view);

/* Whether a view can be imaged: SKG_ERR_SCENE with the reason (no pixels, steps parallel or zero, source in
 * the detector's plane, beam along the detector, not finite). */
SKG_API skg_status skg_view_check(const skg_view *view);

#ifdef __cplusplus
}
#endif
#endif
