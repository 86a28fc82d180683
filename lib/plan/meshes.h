/* The distinct meshes of a scene: each is stored and uploaded once, however many parts it has. Private to
 * lib/plan. */
#ifndef SKG_PLAN_MESHES_H
#define SKG_PLAN_MESHES_H

#include "mesh/mesh.h"
#include "scene/scene.h"

typedef struct {
    skg_mesh *mesh;  /* the scene's */
    int64_t version; /* as uploaded; 0: never */
} skg_plan_mesh;

typedef struct {
    int64_t count;
    skg_plan_mesh *meshes;
    int64_t *of_part; /* [parts of the scene] */
} skg_plan_meshes;

skg_status skg_plan_meshes_create(const skg_scene *scene, skg_plan_meshes *meshes);
void skg_plan_meshes_release(skg_plan_meshes *meshes);

/* SKG_ERR_MESH naming part and vertex where a mesh has one that is not finite. */
skg_status skg_plan_meshes_check(const skg_plan_meshes *meshes, const skg_scene *scene);

/* The vertices of a mesh as the device wants them: offsets from its origin, [vertices][3], float or double.
 */
void skg_plan_mesh_offsets(const skg_mesh *mesh, int32_t is_double, void *offsets);

#endif
