/* A body of its own for each thread, posed with given parameters and compared with the targets. Private. */
#ifndef SKG_FIT_BODY_H
#define SKG_FIT_BODY_H

#include "distance/tree.h"
#include "fit/parameters.h"
#include "setup/types.h"

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

#endif
