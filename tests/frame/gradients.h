/* Shared code of tests of gradients: a scene of a few parts, directions in which it moves, and its gradient. */
#ifndef SKG_TESTS_GRADIENT_H
#define SKG_TESTS_GRADIENT_H

#include "suite.h"
#include "support/random.h"
#include "support/run.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, CHANNELS_MAX = 2, PARTS = 9, WAYS = 6 * PARTS + 9 + 2 * PARTS };

/* Settings of a case; 0: not used. */
typedef struct {
    const char *name;
    int32_t quantity, colours, parallel, infinity, nested, priority, hole, world, falloff, supersampling,
        spot, blur, bands, noise, heel, parts_only;
    double tolerance;
} setting;

/* A direction in which everything moves: a twist of each part, the source, a twist of the detector, and vertices. */
typedef struct {
    double poses[PARTS][6], source[3], detector[6], vertices[PARTS], densities[PARTS];
} direction;

/* A gradient of everything. */
typedef struct {
    double poses[PARTS][6], source[3], detector[6], densities[PARTS], *vertices[PARTS];
} result;

extern skg_scene *scene;
extern skg_mesh *meshes[PARTS];
extern int64_t parts;

/* Makes the scene of a setting, its view, and a plan. */
void make_scene(const setting *set);
skg_view make_view(const setting *set);
skg_plan *make_plan(const setting *set, const skg_view *view, int32_t precision, int32_t strategy);

/* Memory for a gradient of the scene, and without it the scene; release does both. */
void allocate(result *r);
void forget(result *r);
void release_scene(void);
void release(result *r);

/* The image with everything moved by a step along a direction. */
void render(skg_plan *plan, const skg_view *view, const direction *d, double step, double *image);

/* The derivative of every pixel along a direction, by differences; NAN where hits change within the step: there the differences
 * at two steps disagree, or those to both sides are not nearer to each other at half the step. */
void differentiate(skg_plan *plan, const skg_view *view, const direction *d, int64_t count, double *slope);

/* The gradient of the scene as it stands, and its derivative along a direction. */
void make_gradient(skg_plan *plan, const setting *set, const double *adjoint, result *r);
double along(const result *r, const direction *d);

/* The derivative of the image along a direction. */
void make_derivative(skg_plan *plan, const direction *d, double *derivative);

/* d loss / d image: a number between -0.5 and 0.5 for every value. */
void fill_adjoint(int64_t count, double *adjoint);
skg_adjoint adjoint_of(const double *values);

#endif
