/* The distinct meshes of a scene: each is stored and uploaded once, however many parts use it. Private. */
#ifndef SKG_PLAN_MESHES_H
#define SKG_PLAN_MESHES_H

#include "mesh/mesh.h"
#include "scene/scene.h"

typedef struct {
    int64_t count;
    skg_mesh **meshes; /* [count] the scene's */
    int64_t *of_part;  /* [parts] the number of each part's mesh */
} skg_plan_meshes;

skg_status skg_plan_meshes_create(const skg_scene *scene, skg_plan_meshes *meshes);
void skg_plan_meshes_release(skg_plan_meshes *meshes);

/* SKG_ERR_MESH, naming part and vertex, if a mesh has a vertex that is not finite. */
skg_status skg_plan_meshes_check(const skg_plan_meshes *meshes, const skg_scene *scene);

/* Warns of meshes whose components contradict their nesting. nestings: [count] of skg_nesting_find. */
skg_status skg_plan_meshes_warn(const skg_plan_meshes *meshes, const skg_mesh_nesting *nestings,
                                const skg_scene *scene, const skg_context *context);

#endif
