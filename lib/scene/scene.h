/* The inside of a scene. Private. */
#ifndef SKG_SCENE_PRIVATE_H
#define SKG_SCENE_PRIVATE_H

#include "core/core.h"
#include "scene/part_index.h"

#include <skiagraph/scene.h>

typedef struct {
    skg_mesh *mesh;         /* retained */
    skg_material *material; /* retained */
    char *label;
    int64_t inside; /* -1: in the world. From a scene file it may be a later part, never in a circle. */
    double pose[16];
    int32_t priority, reserved;
} skg_scene_part_data;

struct skg_scene {
    skg_refs refs;
    skg_context *context; /* retained; NULL: warnings are dropped */
    skg_scene_part_data *parts;
    int64_t count, capacity;
    skg_part_index labels; /* by label */
    skg_part_index places; /* by mesh and the pose it came with; of parts alike, the first */
    int64_t structure; /* grows with every part added or put inside another: a plan of an older one is stale
                        */
    int64_t materials; /* grows with every material that changes */
    int64_t poses;     /* grows with every pose that changes */
};

/* Puts part `id` inside another, or into the world (-1). A circle is refused: SKG_ERR_SCENE. */
skg_status skg_scene_set_inside(skg_scene *scene, int64_t id, int64_t inside);

/* SKG_ERR_SCENE, naming the part, where a pose (4x4, row by row) is not finite, not affine or singular. */
skg_status skg_scene_check_pose(const char *label, const double *pose);

#endif
