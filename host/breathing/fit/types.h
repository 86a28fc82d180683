/* What a fit holds. Private. */
#ifndef SKG_FIT_TYPES_H
#define SKG_FIT_TYPES_H

#include "core/context.h"
#include "core/digest.h"
#include "evolution/search.h"
#include "fit/body.h"

#include <skiagraph/fit.h>

struct skg_fit {
    skg_context *context; /* retained */
    const skg_setup *setup;
    skg_fit_options options;
    int coupling; /* SKG_COUPLING_ with which the body is posed */
    int32_t chosen[BODY_PARAMETERS];
    double start[BODY_PARAMETERS], low[BODY_PARAMETERS], high[BODY_PARAMETERS];
    double bounds[6]; /* of the diaphragm */
    int64_t goal_count;
    skg_goal *goals;
    skg_fit_target *targets; /* [goal_count] */
    int began;
    int64_t model_count;
    skg_fit_body *models; /* one for each thread */
    skg_search search;
    int finished;
    double sigma[BODY_PARAMETERS];
    double covariance[BODY_PARAMETERS * BODY_PARAMETERS]; /* [chosen][chosen] */
};

/* Number of chosen parameters. */
int64_t skg_fit_dimensions(const skg_fit *fit);

/* The parameters at a point of the search; those that are not chosen have their start. */
void skg_fit_values_at(const skg_fit *fit, const double *point, double *values);

/* The point of the search with the chosen parameters, which are moved into their ranges. */
void skg_fit_point_of(const skg_fit *fit, const double *values, double *point);

/* The least root mean square error so far, mm. */
double skg_fit_error(const skg_fit *fit);

/* Makes models and search, once. SKG_ERR_ARGUMENT: there is no target, or no parameter. */
skg_status skg_fit_begin(skg_fit *fit);

#endif
