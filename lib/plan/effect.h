/* An effect of a plan: one row of a table. Private.
 *
 * The rows stand by subject in effects_beam.c (the beam and what stands in it), effects_detector.c, effects_meshes.c and
 * effects_sampling.c. */
#ifndef SKG_EFFECT_H
#define SKG_EFFECT_H

#include "device/self_tests.h"
#include "plan/costs.h"
#include "stage/layers.h"

/* What a plan reports of an effect. */
typedef struct {
    int32_t on, reserved;
    double cost; /* estimated, in frames without any effect */
    char reason[256];
} skg_effect_state;

/* What reasons and costs follow from. */
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

typedef struct {
    const char *name;        /* as reported */
    skg_self_test self_test; /* of its kernels; 0, SKG_SELF_TEST_CORE: they are those of every plan */
    /* Replaces the caller's structs in the options by checked copies of the recipe's own. NULL: the options hold none. */
    skg_status (*copy)(skg_recipe *recipe);
    /* Fails if an option cannot be used. NULL: nothing to check. */
    skg_status (*check)(const skg_plan_options *options);
    /* Whether half precision is refused. NULL: it holds with this effect. */
    int (*refuses_half)(const skg_recipe *recipe);
    /* Calls skg_effect_set. */
    void (*find)(const skg_effect_facts *facts, skg_effect_state *state);
    /* Multiply-adds per pixel of a frame, if the effect is on. NULL: part of what is done anyway, or done once for a plan. */
    double (*cost)(const skg_effect_facts *facts);
} skg_effect_row;

/* The rows in the order in which they are reported. */
/* clang-format off */
#define SKG_EFFECT_ROWS(X) \
    X(energies) X(source) X(supersampling) X(world) X(response) X(falloff) X(compression) \
    X(nesting) X(leaky) X(repair) X(source_plane) X(overlaps) \
    X(noise) X(blur) X(electronic) X(quantisation) X(priority) \
    X(heel) X(bowtie) X(collimation) X(scatter) X(grid) X(oblique) X(escape) X(depths) X(dqe)
/* clang-format on */

#define SKG_EFFECT_DECLARE(row) extern const skg_effect_row skg_effect_##row;
SKG_EFFECT_ROWS(SKG_EFFECT_DECLARE)
#undef SKG_EFFECT_DECLARE

#define SKG_EFFECT_ONE(row) +1
enum { SKG_EFFECTS = SKG_EFFECT_ROWS(SKG_EFFECT_ONE) };
#undef SKG_EFFECT_ONE

/* Fails if the scatter that the options ask for cannot be computed of the scene. */
skg_status skg_scatter_check(const skg_recipe *recipe);

/* Sets whether an effect is on, and why. */
void skg_effect_set(skg_effect_state *state, int on, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
