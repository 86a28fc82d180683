/* The recipe of a plan: what its frames are made from and how, decided once. Private.
 *
 * A recipe is constant once made, so that work under way can keep the one that it was submitted with. A change of
 * materials, of the view or of the samples makes another recipe, which borrows from the first what it has in common. */
#ifndef SKG_RECIPE_H
#define SKG_RECIPE_H

#include "core/context.h"
#include "geometry/optics.h"
#include "mesh/mesh.h"
#include "spectral/model.h"

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

/* --- What the channels of a plan's images are. */

typedef struct {
    char text[64];
} skg_channel_name;

/* Names the channels of a model by the caller's bands; [channels], freed by the caller. */
skg_status skg_channel_names_create(const skg_plan_options *options, int32_t channels,
                                    skg_channel_name **names);

/* The unit of a quantity; static storage. */
const char *skg_channel_unit(int32_t quantity);

/* What a channel shows without parts and world, not weakened by falloff. exposure: the photons per pixel of the view over
 * those of the model. */
double skg_channel_flat_field(const skg_plan_options *options, const skg_model *model, const skg_view *view,
                              double exposure, int64_t channel);

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
                                const skg_scene *scene, const skg_context *context);

typedef struct skg_recipe skg_recipe;
struct skg_recipe {
    skg_refs refs;
    skg_recipe *origin; /* retained: it owns what this recipe borrows; NULL: this recipe borrows nothing */
    int32_t owns_model; /* 1: the model is this recipe's own */
    int32_t linear;     /* 1: mean intensities alone, without noise, the stage `detect` and logarithms */

    skg_scene *scene;       /* retained */
    skg_spectrum *spectrum; /* retained; photons per pixel of the view that the plan was made for */
    double exposure; /* of that view (geometry/optics.h), if the caller's spectrum is absolute; else 0 */
    skg_plan_options options; /* its handles retained, its arrays copied; blur is NULL: see below */
    skg_view view;            /* of frames without a view of their own */
    int64_t structure;        /* of the scene; if it has another one the plan is stale */
    int64_t materials;        /* of the scene when the model was made */
    skg_copies copies;        /* what options points to */

    skg_plan_meshes meshes;
    skg_model model;
    skg_channel_name *channel_names; /* [channels] */
    skg_samples samples;             /* of source and pixel */
    int32_t is_blurred;
    int32_t mixed; /* accumulators that the planes of images are mixed from; 0: they are not mixed */
    int32_t priority_possible;   /* 1: priorities differ, or children are clipped */
    int32_t strategy;            /* SKG_STRATEGY_..., never AUTO */
    int32_t leaky_strategy;      /* of the rasters of leaky parts */
    int32_t absolute;            /* 1: the caller's spectrum is absolute */
    const char *strategy_reason; /* static storage */
    const char *fine_reason;     /* of samples.fine; static storage */
    int64_t leaky_count;
    int64_t *leaky; /* [leaky_count] numbers of the parts whose meshes are not closed */
};

/* Checks everything and decides, but for the nodes of the model, which skg_recipe_complete waits for. context: the device
 * that frames will run on. options may be NULL. */
skg_status skg_recipe_create(const skg_context *context, skg_scene *scene, const skg_view *view,
                             skg_spectrum *spectrum, const skg_plan_options *options, skg_recipe **recipe);

/* Completes a recipe that was created. The context is that of its creation. */
skg_status skg_recipe_complete(skg_recipe *recipe, const skg_context *context);
skg_recipe *skg_recipe_retain(const skg_recipe *recipe);
void skg_recipe_release(skg_recipe **recipe);

/* Another recipe that borrows everything. The caller may change view, samples and linear before anyone else sees it. */
skg_status skg_recipe_copy(const skg_recipe *recipe, skg_recipe **copy);

/* Another recipe, for the scene's materials as they are now. SKG_STALE if the model's energies were chosen for the old
 * ones. */
skg_status skg_recipe_renew(const skg_recipe *recipe, skg_recipe **renewed);

/* The photons per pixel of a view over those of `spectrum`. */
double skg_recipe_exposure(const skg_recipe *recipe, const skg_view *view);

/* Whether images are means over several passes: of samples of the source, or of a pixel. */
int skg_recipe_averages(const skg_recipe *recipe);

/* The most pixels that passes have along each side of a pixel of the image, for any materials of the parts. */
int64_t skg_recipe_max_fine(const skg_recipe *recipe);

/* How many accumulator planes the raster of an image has. */
int64_t skg_recipe_accumulators(const skg_recipe *recipe);

/* SKG_PRECISION_SINGLE or SKG_PRECISION_DOUBLE: of vertices, tables and kernels. Half precision computes in single. */
int32_t skg_recipe_kernel_precision(const skg_recipe *recipe);

/* The last bit of the device's numbers relative to 1. */
double skg_recipe_last_bit(const skg_recipe *recipe);

/* SKG_STALE if a view has another size than the recipe's, or with an absolute beam, a distance where the recipe's has none. */
skg_status skg_recipe_check_view(const skg_recipe *recipe, const skg_view *view);

#endif
