/* The recipe of a plan: what its frames are made from and how, decided once. Private.
 *
 * A recipe is constant once made, so that work under way can keep the one that it was submitted with. A change of
 * materials, of the view or of the samples makes another recipe, which borrows from the first what it has in common. */
#ifndef SKG_RECIPE_H
#define SKG_RECIPE_H

#include "core/context.h"
#include "geometry/optics.h"
#include "plan/inputs.h"
#include "spectral/model.h"

typedef struct skg_recipe skg_recipe;
struct skg_recipe {
    skg_refs refs;
    skg_recipe *origin; /* retained: it owns what this recipe borrows; NULL: this recipe borrows nothing */
    int32_t owns_model; /* 1: the model is this recipe's own */
    int32_t linear;     /* 1: mean intensities alone, without noise, the stage `detect` and logarithms */

    skg_scene *scene;       /* retained */
    skg_spectrum *spectrum; /* retained; photons per pixel of the view that the plan was made for */
    double exposure; /* of that view (geometry/optics.h), if the caller's spectrum is absolute; else 0 */
    /* its handles retained, its arrays copied; of a blur it says only that there is one */
    skg_plan_options options;
    skg_view view;     /* of frames without a view of their own */
    int64_t structure; /* of the scene; if it has another one the plan is stale */
    int64_t materials; /* of the scene when the model was made */
    skg_copies copies; /* what options points to */

    skg_plan_meshes meshes;
    skg_model model;
    skg_channel_name *channel_names; /* [channels] */
    skg_samples samples;             /* of source and pixel */
    int32_t is_blurred;
    double blur_pixel_mm[2]; /* pixels that the blur is of; 0: any */
    int32_t mixed; /* accumulators that the planes of images are mixed from; 0: they are not mixed */
    int32_t priority_possible;   /* 1: priorities differ, or children are clipped */
    int32_t strategy;            /* SKG_STRATEGY_..., never AUTO */
    int32_t leaky_strategy;      /* of the rasters of leaky parts */
    int32_t absolute;            /* 1: the caller's spectrum is absolute */
    const char *strategy_reason; /* static storage */
    const char *fine_reason;     /* of samples.fine; static storage */
    int64_t volume_count;        /* parts that are volumes of cells */
    int64_t leaky_count;
    int64_t *leaky; /* [leaky_count] numbers of the parts whose meshes are not closed */
};

/* The most volumes of cells that photons are followed through. */
enum { SKG_SCATTER_VOLUMES_MAX = 4 };

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

#endif
