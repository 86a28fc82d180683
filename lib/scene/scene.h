/* The inside of a scene. Private. */
#ifndef SKG_SCENE_PRIVATE_H
#define SKG_SCENE_PRIVATE_H

#include "core/core.h"
#include "scene/part_index.h"
#include "scene/pose.h"
#include "scene/volume.h"

#include <skiagraph/scene.h>

typedef struct {
    skg_mesh *mesh;         /* retained */
    skg_material *material; /* retained */
    skg_volume *volume;     /* retained; NULL: none. Mesh and material are those of its box */
    char *label;
    /* The parent; -1: the world. In a scene file a parent may follow its child; there are no circles. */
    int64_t inside;
    double pose[16];
    int32_t priority, reserved;
} skg_scene_part_data;

struct skg_scene {
    skg_refs refs;
    skg_context *context; /* retained; NULL: warnings are dropped */
    skg_scene_part_data *parts;
    int64_t count, capacity;
    skg_part_index labels; /* parts by label */
    /* Parts by mesh and the pose with which they were added; only the first of parts that are alike. */
    skg_part_index places;
    /* Each of these grows with every change of its kind. A plan made for an older structure (a part added, or
     * put inside another) is stale. */
    int64_t structure, materials, poses;
    int64_t volumes; /* parts that are volumes */
};

/* The number of parts that are volumes. */
int64_t skg_scene_volumes(const skg_scene *scene);

/* How many curves the volumes before a part have. */
int64_t skg_scene_curves(const skg_scene *scene, int64_t part);

/* Puts part `id` inside another one or into the world (-1). SKG_ERR_SCENE if that would make a circle. */
skg_status skg_scene_set_inside(skg_scene *scene, int64_t id, int64_t inside);

#endif
