/* Decisions that are taken once for a plan. Private. */
#ifndef SKG_DECISIONS_H
#define SKG_DECISIONS_H

#include "device/device.h"
#include "mesh/mesh.h"
#include "plan/recipe.h"
#include "plan/results.h"
#include "scene/scene.h"
#include "spectral/model.h"
#include "stage/readout.h"

#include <skiagraph/plan.h>

/* --- The table of effects, and what all of its rows do for a plan. */

/* Row 0 <= index < SKG_EFFECTS. Static storage. */
const skg_effect_row *skg_effect_row_get(int64_t index);

/* Replaces what the options of effects point to by copies. After a failure the recipe can only be released. */
skg_status skg_effects_copy(skg_recipe *recipe);

/* Refuses options of effects that cannot be used. */
skg_status skg_effects_check(const skg_plan_options *options);

/* Writes the names of the effects of a recipe that half precision is refused with, "A, B and C", and returns how many there are. */
int skg_effects_refuse_half(const skg_recipe *recipe, size_t size, char *names);

/* Fails if an effect of a recipe has no derivatives. by_view: by source and detector. call: the public function */
skg_status skg_effects_check_gradient(const char *call, const skg_recipe *recipe, int by_view);

/* The material around the parts that photons scatter in; NULL: none. */
skg_material *skg_scatter_world(const skg_recipe *recipe);

/* Leaves out of the options what the prediction of scatter does without. */
void skg_effects_leave_out(skg_plan_options *options);

/* Fills the effects of an outcome whose overlaps and samples are known. layers: and their blurs. */
skg_status skg_effects_find(const skg_recipe *recipe, const skg_context *context, const skg_layers *layers,
                            skg_outcome *outcome);

/* --- The warning that nothing falls on the detector. */

/* Warns, once, if no part falls on the detector: in which direction and how far away the nearest shadow lies. extents:
 * [parts] as the camera sees them; fine: its pixels along each side of a pixel of the image. */
void skg_warn_unseen(const skg_context *context, const skg_scene *scene, const skg_camera *camera,
                     const skg_extent *extents, int32_t fine, skg_outcome *outcome);

/* --- Checks of a plan's options. */

/* Fails if a flag is neither 0 nor 1. name: of the option. */
skg_status skg_check_flag(const char *name, int32_t flag);

/* Fails unless a choice is 0 to last. choices: their names. */
skg_status skg_check_choice(const char *name, int32_t choice, int32_t last, const char *choices);

/* Refuses options of no effect that cannot be used on this device. */
skg_status skg_plan_options_check(const skg_plan_options *options, const skg_device_info *device);

/* --- Which strategy rasters a scene, and how the rays of a pixel are made. */

/* The facts by which a strategy is chosen. */
typedef struct {
    int32_t gpu;
    int32_t workers;        /* compute units */
    int64_t image_bytes;    /* of all accumulators, within the rectangles that their parts reach */
    int64_t triangles;      /* of a frame */
    double triangle_pixels; /* mean number of pixels of a triangle's box */
} skg_strategy_facts;

/* Triangles of a frame. */
int64_t skg_scene_triangles(const skg_scene *scene);

/* The strategy for these facts, and why in a few words (static storage). */
int32_t skg_strategy_choose(const skg_strategy_facts *facts, const char **why);

/* A scene, a view and what was asked for. */
typedef struct {
    const skg_device_info *device;
    const skg_scene *scene;
    const skg_view *view;
    int32_t precision;    /* SKG_PRECISION_... */
    int32_t wanted;       /* SKG_STRATEGY_... */
    int64_t accumulators; /* planes of the raster; what the parts add to them */
    const skg_contribution *contributions;
    const int64_t *first_contribution; /* [parts + 1] */
} skg_strategy_request;

/* The strategy that is asked for, that the precision needs, or that the facts call for. */
skg_status skg_strategy_decide(const skg_strategy_request *request, int32_t *strategy, const char **why);

/* The facts that decide how the rays of a pixel are made: not the device and not the strategy, because images have the same bits on
 * every one of them. */
typedef struct {
    int64_t shifts;        /* rays along each side of a pixel */
    int64_t columns, rows; /* of the image */
    int64_t accumulators;  /* planes of the raster */
    int64_t triangles;     /* of a frame */
    int32_t precision;     /* SKG_PRECISION_... */
    int32_t leaky;         /* 1: some mesh is leaky */
    int32_t curved;        /* 1: the detector is curved */
} skg_fine_request;

/* How many pixels the passes have along each side of a pixel of the image: `shifts`, so that one pass makes all rays of a
 * point of the source, or 1, with a pass for each ray. why: in a few words (static storage). */
int64_t skg_fine_choose(const skg_fine_request *request, const char **why);

/* The most accumulators that so many planes are mixed from (spectral/model.h). The request's own number does not count. */
int32_t skg_max_mixed(const skg_fine_request *request, int32_t planes);

/* The facts that decide how many passes of a frame are drawn together. */
typedef struct {
    int32_t strategy;    /* SKG_STRATEGY_... */
    int32_t workers;     /* compute units */
    int64_t passes;      /* of a frame */
    int64_t image_bytes; /* of all accumulator planes of a pass */
    int64_t triangles;   /* of a pass */
} skg_passes_request;

enum { SKG_SIDE_MAX = 4 }; /* most passes that a worker draws side by side */

/* How many passes are drawn together, each by one worker in accumulators of its own: a multiple of the workers, or 1, with all
 * workers at each pass. side: of these, how many a worker draws side by side. */
int32_t skg_passes_choose(const skg_passes_request *request, int32_t *side);

/* Chooses the number of frames of a job, each of one pass, that are drawn at once; request->passes is the number of frames. A multiple of
 * the workers, or 1: frames are drawn one after another, with all workers at each. */
int32_t skg_frames_choose(const skg_passes_request *request, int32_t *side);

/* The largest number that skg_frames_choose returns. */
int32_t skg_frames_most(int32_t workers);

/* --- Statements of a plan about its precision */

/* The bound of the relative error that the precision makes. */
skg_status skg_plan_precision_bound(const skg_recipe *recipe, double *bound);

/* Warns of half precision, with its bound, and of parts that are too thin for single precision. */
skg_status skg_plan_precision_warn(const skg_recipe *recipe, const skg_context *context);

/* --- Stages of a recipe's frames behind the raster: from planes to images, and the detector */

/* The shape of the attenuation of images: everything but its tables. */
void skg_decide_attenuation(const skg_recipe *recipe, skg_attenuation *shape);

/* The stage `detect`. *wanted: 0 if there is nothing left for it to do. factors: [channels]. SKG_ERR_BEAM if a ratio is
 * asked for and a channel records nothing of the flat field. */
skg_status skg_decide_detection(const skg_recipe *recipe, skg_detection *detection, double *factors,
                                int32_t *wanted);

/* Whether logarithms are taken of finished means, behind noise and blur. */
int skg_decide_late_logarithm(const skg_recipe *recipe);

/* --- Warnings of a plan whose images are right and may not be what the caller meant. */

/* Warns of bands that record nothing of the beam, and of a source inside a part, where the plan was made. */
void skg_plan_warn_doubts(const skg_recipe *recipe, const skg_context *context);

/* --- The check for parts that overlap or leave their parent. */

/* The findings of the check. */
typedef struct {
    int64_t side; /* columns along each side of the grid */
    int64_t pair_count;
    skg_overlap_pair *pairs;
    skg_mesh_nesting *nestings; /* [meshes]; NULL: the options do not ask for the check */
} skg_plan_overlaps;

/* Finds overlaps and inverted components, if the options ask for it. Release what was found also after a failure. */
skg_status skg_plan_overlaps_find(const skg_recipe *recipe, skg_plan_overlaps *found);
void skg_plan_overlaps_release(skg_plan_overlaps *found);

/* Moves the pairs to the outcome, and warns of what was found, except for overlaps that priorities or clipping settle. */
skg_status skg_plan_overlaps_take(const skg_recipe *recipe, const skg_context *context,
                                  skg_plan_overlaps *found, skg_outcome *outcome);

/* SKG_ERR_UNSUPPORTED if a beam of a view comes from infinity through a world that does not cancel in what the image shows. */
skg_status skg_decide_world(const skg_recipe *recipe, const skg_view *view);

/* Fails likewise for a view; SKG_STALE if it has another size than the recipe's, or with an absolute beam, a distance where the recipe's
 * has none. */
skg_status skg_decide_view(const skg_recipe *recipe, const skg_view *view);

#endif
