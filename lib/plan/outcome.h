/* What a plan reports: decisions, effects with reasons, overlaps, times, and which warnings were given already. Private. */
#ifndef SKG_OUTCOME_H
#define SKG_OUTCOME_H

#include "geometry/overlap.h"
#include "plan/recipe.h"

/* The effects that a plan knows, in the order in which they are reported. */
#define SKG_EFFECT_LIST(X)                                                                                   \
    X(SKG_EFFECT_ENERGIES, "several energies")                                                               \
    X(SKG_EFFECT_SOURCE, "extended source")                                                                  \
    X(SKG_EFFECT_SUPERSAMPLING, "supersampling")                                                             \
    X(SKG_EFFECT_WORLD, "world material")                                                                    \
    X(SKG_EFFECT_RESPONSE, "energy response")                                                                \
    X(SKG_EFFECT_FALLOFF, "falloff")                                                                         \
    X(SKG_EFFECT_COMPRESSION, "spectral compression")                                                        \
    X(SKG_EFFECT_NESTING, "nesting")                                                                         \
    X(SKG_EFFECT_LEAKY, "leaky meshes")                                                                      \
    X(SKG_EFFECT_REPAIR, "repair")                                                                           \
    X(SKG_EFFECT_SOURCE_PLANE, "source plane")                                                               \
    X(SKG_EFFECT_OVERLAPS, "overlap check")                                                                  \
    X(SKG_EFFECT_NOISE, "quantum noise")                                                                     \
    X(SKG_EFFECT_BLUR, "blur")                                                                               \
    X(SKG_EFFECT_ELECTRONIC, "electronic noise")                                                             \
    X(SKG_EFFECT_QUANTISATION, "quantisation")                                                               \
    X(SKG_EFFECT_PRIORITY, "priority")                                                                       \
    X(SKG_EFFECT_HEEL, "heel effect")                                                                        \
    X(SKG_EFFECT_BOWTIE, "bow-tie filter")                                                                   \
    X(SKG_EFFECT_GRID, "anti-scatter grid")                                                                  \
    X(SKG_EFFECT_OBLIQUE, "oblique scintillator")                                                            \
    X(SKG_EFFECT_ESCAPE, "K escape")                                                                         \
    X(SKG_EFFECT_DEPTHS, "blur by depths")                                                                   \
    X(SKG_EFFECT_DQE, "noise power")

enum {
#define SKG_EFFECT_ENUM(name, text) name,
    SKG_EFFECT_LIST(SKG_EFFECT_ENUM)
#undef SKG_EFFECT_ENUM
        SKG_EFFECTS
};

typedef struct {
    int32_t on, reserved;
    double cost; /* estimated, in frames without any effect */
    char reason[256];
} skg_effect_state;

/* Time of a stage in the last job. */
typedef struct {
    const char *name; /* static storage */
    double ns;
} skg_stage_time;
enum { SKG_MOST_STAGES = 32 };

typedef struct {
    skg_plan_report report;
    skg_effect_state effects[SKG_EFFECTS];
    int64_t overlap_side; /* columns along each side of the grid on which they were looked for */
    int64_t overlap_count;
    skg_overlap_pair *overlaps;
    int64_t stage_count;
    skg_stage_time stages[SKG_MOST_STAGES];
    int32_t warned_unseen;   /* 1: that nothing falls on the detector */
    int32_t warned_infinite; /* 1: that pixels were not finite */
    int32_t side; /* passes of a frame that a worker draws side by side; 0: all workers are at each pass */
    int32_t *
        warned_bad; /* [leaky parts] digits of the greatest number of bad pixels that was warned of; 0: none */
} skg_outcome;

/* Starts an outcome with what the recipe has decided. */
skg_status skg_outcome_create(const skg_recipe *recipe, skg_outcome *outcome);
void skg_outcome_release(skg_outcome *outcome);

/* Says whether an effect is on, and why. */
void skg_effect_set(skg_outcome *outcome, int effect, int on, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Takes over what another recipe has decided differently: planes and accumulators. */
void skg_outcome_renew(const skg_recipe *recipe, skg_outcome *outcome);

#endif
