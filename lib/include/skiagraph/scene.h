/** @file
 * Scenes: parts, each a mesh with its material, where it stands, and what it lies inside. Scene files are
 * read by setup.h.
 *
 * Positions are in mm. A pose is a 4 x 4 affine matrix of doubles, row by row (pose[4 * r + c]), that takes
 * the coordinates of the mesh to those of the world: x_world = pose (x, y, z, 1). A pose may mirror; one that
 * is singular is refused.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCENE_H
#define SKIAGRAPH_SCENE_H

#include <skiagraph/beam.h>
#include <skiagraph/context.h>
#include <skiagraph/material.h>
#include <skiagraph/mesh.h>
#include <skiagraph/types.h>
#include <skiagraph/volume.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Parts in the world. */
typedef struct skg_scene skg_scene;

/** A part. Prepare with skg_part_init: inside nothing, identity pose.
 *
 * A part displaces the part that it lies inside. Where two parts overlap and neither lies inside the other,
 * their lengths are added, unless priority decides. */
typedef struct {
    /** Set by skg_part_init. */
    int32_t size;
    /** Decides where closed parts with the same parent, or in the world, overlap: the part with the highest
     * priority displaces the others there, with all that lies inside them. Parts of equal priority are added.
     * Leaky parts take no part in this. If parts that may meet have different priorities, submitting a frame
     * waits until their hits are counted. 0 by default. */
    int32_t priority;
    /** Number of the part that this one lies inside; -1, the default: none. In a scene that was read from a
     * file it may be larger than the part's own number. */
    int64_t inside;
    /** Retained by the scene. */
    skg_mesh *mesh;
    /** Retained by the scene. */
    skg_material *material;
    /** Unique in the scene; copied. NULL: the mesh's name. */
    const char *label;
    /** From the mesh to the world. */
    double pose[16];
    /** A volume of cells, instead of mesh and material, which are NULL. skg_scene_part_get gives its box as the mesh; do not move
     * the vertices of that. Retained by the scene. NULL, the default: none. */
    skg_volume *volume;
} skg_part;

SKG_INIT(skg_part)

/** Makes an empty scene. The context receives warnings and may be NULL. The caller releases the scene. */
SKG_API skg_status skg_scene_create(skg_context *context, skg_scene **scene);

/** Adds an owner to a scene. */
SKG_API skg_status skg_scene_retain(skg_scene *scene);

/** Removes an owner; the last one frees the scene and releases its meshes and materials. */
SKG_API void skg_scene_release(skg_scene **scene);

/** Adds a part to a scene.
 *
 *     id       result: the part's number, counted from 0; may be NULL
 *     errors   SKG_ERR_SCENE if the label is taken, the pose is singular, or the part lies inside itself or a
 *              part that is not there */
SKG_API skg_status skg_scene_part_add(skg_scene *scene, const skg_part *part, int64_t *id);

/** Number of parts in a scene. */
SKG_API skg_status skg_scene_part_count(const skg_scene *scene, int64_t *count);

/** Gets part 0 <= id < count. Its pointers are valid as long as the scene and are not retained for the
 * caller. */
SKG_API skg_status skg_scene_part_get(const skg_scene *scene, int64_t id, skg_part *part);

/** Gets the label of part 0 <= id < count, valid as long as the scene. */
SKG_API skg_status skg_scene_part_label_get(const skg_scene *scene, int64_t id, const char **label);

/** Finds a part by its label: the one with exactly this label, or else the only one that differs in case
 * alone. Errors: SKG_ERR_SCENE with the nearest label. */
SKG_API skg_status skg_scene_part_find(const skg_scene *scene, const char *label, int64_t *id);

/** Sets the pose of a part. Plans use it from the next frame on. */
SKG_API skg_status skg_scene_part_pose_set(skg_scene *scene, int64_t id, const double *pose);

/** Sets the material of a part and retains it. Plans use it from the next frame on; a plan that compresses
 * several energies (skg_plan_options.tolerance above 0) becomes stale. */
SKG_API skg_status skg_scene_part_material_set(skg_scene *scene, int64_t id, skg_material *material);

/** Checks that a view can be imaged. Errors: SKG_ERR_SCENE with the reason: no pixels, a step that is zero or
 * parallel to the other, a source in the detector's plane, a beam along the detector, a number that is not
 * finite. */
SKG_API skg_status skg_view_check(const skg_view *view);

#ifdef __cplusplus
}
#endif
#endif
