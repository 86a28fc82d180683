/* Effects of a plan: rows of a table, and what they cost. Private. */
#ifndef SKG_RULES_H
#define SKG_RULES_H

#include "core/core.h"
#include "device/self_tests.h"
#include "geometry/bounds.h"
#include "geometry/priority.h"
#include "plan/recipe.h"
#include "stage/readout.h"

#include <skiagraph/material.h>

/* --- Counts of operations per pixel, from which the costs of effects are estimated. */

/* Rough numbers of multiply-adds. */
enum {
    SKG_COST_EXPONENTIAL = 12, /* an exponential */
    SKG_COST_TRIANGLE = 100,   /* setting up a triangle */
    SKG_COST_DEVIATE = 100,    /* a random deviate with its random words */
    SKG_COST_RAY = 10,         /* the length of a ray */
    SKG_COST_REPAIRED = 30,    /* a pixel of a repair */
    SKG_COST_LISTED = 200,     /* a hit that is listed and sorted */
    SKG_COST_LOOKED_UP = 10    /* two rows of a table */
};

typedef struct {
    double listed;      /* hits of a pass, per pixel, that are listed for priorities */
    double passes;      /* rays of a pixel */
    double set_up;      /* multiply-adds per pixel for the triangles of a pass */
    double plain, pass; /* multiply-adds per pixel of a pass without effects, and of a pass */
} skg_cost_counts;

/* extents: [parts] at the recipe's view. */
skg_cost_counts skg_costs_count(const skg_recipe *recipe, const skg_extent *extents,
                                const skg_priority *priority);

/* Multiply-adds per pixel of the attenuation of one pass: planes, and exponentials for every channel. */
double skg_cost_of_attenuation(const skg_model *model, double nodes, double planes);

/* --- An effect of a plan: one row of a table. *
 * The rows stand by subject in effects_beam.c (the beam and what stands in it), effects_detector.c, effects_noise.c, effects_meshes.c and
 * effects_sampling.c. */

/* The report of an effect. */
typedef struct {
    int32_t on, reserved;
    double cost; /* estimated, in frames without any effect */
    char reason[256];
} skg_effect_state;

/* The facts from which reasons and costs follow. */
typedef struct {
    const skg_recipe *recipe;
    const skg_context *context;          /* its log takes warnings */
    const skg_layers *layers;            /* and their blurs */
    double sample_error;                 /* of adaptive sampling; 0: not adaptive */
    int64_t overlap_count, overlap_side; /* as in skg_outcome */
    int64_t near_source;                 /* parts that reach the plane where rays start */
    int64_t competing;                   /* parts whose hits are listed for priorities */
    skg_cost_counts counts;
} skg_effect_facts;

/* A row says everything that is known of an effect but for its stage. */
typedef struct {
    const char *name; /* as reported */
    /* Of the scene file, in the words of docs/scene-files.md; NULL: it follows from the scene, or programs alone set it. */
    const char *key;
    skg_self_test self_test; /* of its kernels; 0, SKG_SELF_TEST_CORE: they are those of every plan */
    /* Replaces the caller's structs in the options by checked copies of the recipe's own. NULL: the options hold none. */
    skg_status (*copy)(skg_recipe *recipe);
    /* Fails if an option cannot be used. NULL: nothing to check. */
    skg_status (*check)(const skg_plan_options *options);
    /* Whether half precision is refused, because the plan has the effect. NULL: it holds with it. */
    int (*refuses_half)(const skg_recipe *recipe);
    /* Fails with skg_effect_no_gradient if derivatives cannot be computed with the effect. by_view: those by source and detector. call: the
     * public function. NULL: they can. */
    skg_status (*refuses_gradient)(const char *call, const skg_recipe *recipe, int by_view);
    /* Adjoint of the effect: a function of lib/gradient, or a file of kernels/. NULL: derivatives are refused with it, or do not go through
     * it. */
    const char *adjoint;
    /* Leaves it out of the options. NULL: it cannot be left out, or is off by itself. */
    void (*leave_out)(skg_plan_options *options);
    int32_t predicted; /* 1: the prediction of scatter keeps it (lib/scatter/prediction.c) */
    int32_t reserved;
    /* Calls skg_effect_set. */
    void (*find)(const skg_effect_facts *facts, skg_effect_state *state);
    /* Multiply-adds per pixel of a frame, if the effect is on. NULL: part of what is done anyway, or done once for a plan. */
    double (*cost)(const skg_effect_facts *facts);
} skg_effect_row;

/* The rows in the order in which they are reported. */
/* clang-format off */
#define SKG_EFFECT_ROWS(X) \
    X(energies) X(source) X(off_focal) X(supersampling) X(world) X(response) X(falloff) X(compression) \
    X(nesting) X(leaky) X(repair) X(source_plane) X(overlaps) \
    X(noise) X(blur) X(electronic) X(quantisation) X(priority) X(volumes) \
    X(heel) X(bowtie) X(collimation) X(scatter) X(fluorescence) X(annihilation) X(molecules) X(grid) X(oblique) X(curved) X(escape) X(deposition) X(depths) X(dqe) \
    X(counting) X(cloud) X(pixel_lines) X(anti_coincidence) X(pile_up)
/* clang-format on */

#define SKG_EFFECT_DECLARE(row) extern const skg_effect_row skg_effect_##row;
SKG_EFFECT_ROWS(SKG_EFFECT_DECLARE)
#undef SKG_EFFECT_DECLARE

#define SKG_EFFECT_ONE(row) +1
enum { SKG_EFFECTS = SKG_EFFECT_ROWS(SKG_EFFECT_ONE) };
#undef SKG_EFFECT_ONE

/* Fails if the scatter that the options ask for cannot be computed of the scene. */
skg_status skg_scatter_check(const skg_recipe *recipe);

/* Fails if the pixels of the view are not those of the detector that counts. */
skg_status skg_counting_check(const skg_recipe *recipe);

/* Pulses of the flat field in a dead time. The detector counts, with pile-up. */
double skg_open_pulses(const skg_plan_options *options, const skg_model *model, double exposure);

/* The record of each window of the flat field. The detector counts. */
skg_status skg_open_recorded(const skg_plan_options *options, const skg_model *model, double exposure,
                             double recorded[SKG_THRESHOLDS_MAX]);

/* Fails if dead times leave nothing of the flat field. */
skg_status skg_counting_check_flat(const skg_recipe *recipe);

/* Whether a view has the pixels that the table of counts was made for; status: what is said otherwise. */
skg_status skg_counting_check_pixels(const skg_recipe *recipe, const skg_view *view, skg_status status);

/* Adds the pixels that the caller's blur is of, if it says so, to pixel_mm, which is 0 or those of others. */
skg_status skg_blur_take_pixels(const skg_detector_blur *blurs, int64_t index, double pixel_mm[2]);

/* Whether blur and noise power are of the pixels of a view: of the plan's own and of those of its options; of another, whose refusal
 * is `status`. */
skg_status skg_blur_check(const skg_recipe *recipe);
skg_status skg_blur_check_pixels(const skg_recipe *recipe, const skg_view *view, skg_status status);

/* Fails if the detector is curved and something is called for that is computed for flat ones alone; if another view is
 * curved and the plan's is not, or the other way round, whose refusal is `status`. */
skg_status skg_curved_check(const skg_recipe *recipe);
skg_status skg_curved_check_view(const skg_recipe *recipe, const skg_view *view, skg_status status);

/* Fails if volumes of cells stand beside what is not computed with them. */
skg_status skg_volumes_check(const skg_recipe *recipe);

/* Fails with SKG_ERR_UNSUPPORTED: "CALL: WHAT has no gradient; MEND". */
skg_status skg_effect_no_gradient(const char *call, const char *what, const char *mend);

/* Fails likewise for an effect without derivatives by source and detector alone. */
skg_status skg_effect_no_view_gradient(const char *call, const char *what);

/* Sets whether an effect is on, and why. */
void skg_effect_set(skg_effect_state *state, int on, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
