/* The inputs of a recipe: copies of what options point to, names of channels, the distinct meshes. Private. */
#ifndef SKG_INPUTS_H
#define SKG_INPUTS_H

#include "core/context.h"
#include "mesh/mesh.h"
#include "spectral/model.h"

#include <skiagraph/plan.h>

/* --- Copies of what a plan's options point to. */

/* All zero: none. */
typedef struct {
    int64_t count;
    struct skg_copy *copies;
} skg_copies;

/* Zeroed memory that is freed with the copies. what: for the message. */
skg_status skg_copies_alloc(skg_copies *copies, int64_t count, size_t size, const char *what,
                            void *pointer_address);

/* Copies a caller's struct over the defaults of its init function. name: of its type. */
skg_status skg_copies_struct(skg_copies *copies, const void *given, const char *name, size_t size,
                             void (*init_sized)(void *, int32_t), void *pointer_address);

/* Replaces the caller's array by a copy. */
skg_status skg_copies_array(skg_copies *copies, int64_t count, const char *what, const double **values);

/* Retains a material until the copies are released; NULL: nothing. */
skg_status skg_copies_material(skg_copies *copies, skg_material *material);

void skg_copies_release(skg_copies *copies);

/* --- Channels of a plan's images */

typedef struct {
    char text[64];
} skg_channel_name;

/* Names the channels of a model by the caller's bands; [channels], freed by the caller. */
skg_status skg_channel_names_create(const skg_plan_options *options, int32_t channels,
                                    skg_channel_name **names);

/* The unit of a quantity; static storage. */
const char *skg_channel_unit(int32_t quantity);

/* The value of a channel without parts and world, not weakened by falloff. exposure: the photons per pixel of the view over
 * those of the model. */
skg_status skg_channel_flat_field(const skg_plan_options *options, const skg_model *model,
                                  const skg_view *view, double exposure, int64_t channel, double *flat_field);

/* --- The distinct meshes of a scene: each is stored and uploaded once, however many parts use it. */

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
                                const skg_scene *scene, int32_t unite, const skg_context *context);

#endif
