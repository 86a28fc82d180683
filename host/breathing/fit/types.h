/* State of a fit: parameters of a body, bodies posed with them and compared with the targets. Private. */
#ifndef SKG_FIT_TYPES_H
#define SKG_FIT_TYPES_H

#include "body/parameters.h"
#include "body/types.h"
#include "core/context.h"
#include "core/digest.h"
#include "distance/nearest.h"
#include "evolution/search.h"
#include "setup/types.h"

#include <skiagraph/fit.h>

/* Reading and setting the parameters of a body. */

/* The parameters that a linked body has. The plane of its tendon is set. */
void skg_fit_values_get(const skg_body *body, double *values);

/* Gives them to a body and finds its links again. values: of chosen parameters; others stay as they are, bit for bit. */
skg_status skg_fit_values_set(skg_body *body, const int32_t *chosen, const double *values);

/* The plane a x + b y + c z + d of azimuth, elevation and offset. */
void skg_fit_plane(const double *bounds, const double *values, double plane[4]);

/* A body of its own for each thread, posed with given parameters and compared with the targets. */

/* A surface that a part has to reach. */
typedef struct {
    int64_t part;
    skg_breath_state state; /* of its phase */
    skg_mesh *mesh;         /* retained */
    skg_tree tree;          /* of the mesh */
    int64_t count;          /* samples of the part: its vertices, or every step-th one */
    int64_t step;
    double *weights; /* [count] shares of the area, whose sum is 1 */
} skg_goal;

typedef struct {
    skg_body *body;
    int64_t parts;
    int64_t *organ;    /* [parts] number in the body; -1: not needed */
    skg_mesh **meshes; /* [parts] copies */
} skg_fit_body;

/* Makes the body of a scene, with copies of its meshes: all organs, or with goals only those that they depend on. Warnings
 * are dropped unless there is a context. */
skg_status skg_fit_body_create(skg_context *context, const skg_setup *setup, const skg_goal *goals,
                               int64_t count, skg_fit_body *model);
void skg_fit_body_free(skg_fit_body *model);

/* Finds the samples of a goal and their weights. */
skg_status skg_goal_prepare(const skg_setup *setup, skg_goal *goal);
void skg_goal_free(skg_goal *goal);

/* Poses the body for a goal, with the parameters that it has. */
skg_status skg_fit_body_pose(skg_fit_body *model, const skg_goal *goal);

/* The distances of a goal's samples, as the body is posed now, mm. */
void skg_fit_body_distances(const skg_fit_body *model, const skg_goal *goal, double *distances);

/* The mean over all goals of the mean square distance, mm2. */
skg_status skg_fit_body_error(skg_fit_body *model, const skg_goal *goals, int64_t count, double *square);

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
