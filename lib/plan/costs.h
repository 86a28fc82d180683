/* Counts of operations per pixel, from which the costs of effects are estimated. Private. */
#ifndef SKG_COSTS_H
#define SKG_COSTS_H

#include "geometry/priority.h"
#include "plan/recipe.h"

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

#endif
