/* The scene of the tests of noise: a slab in a parallel beam, its photons by formulas, and what is checked of images. */
#ifndef SKG_NOISE_SCENE_H
#define SKG_NOISE_SCENE_H

#include "suite.h"

#include <skiagraph/skiagraph.h>

enum { SIDE = 128, PIXELS = SIDE * SIDE };

/* A slab of 50 mm that covers the detector, in a parallel beam: all pixels alike. */
enum { THICKNESS = 50 };

extern skg_context *context;
extern skg_scene *scene;
extern skg_material *tissue, *iodide;
extern skg_response *scintillator;
extern skg_view view;
extern const double two_kev[2];

typedef struct {
    double mean, variance;
} moments;

/* Sums over the energies: photons that arrive, are detected, what they add, and its square. */
typedef struct {
    double detected, mean, variance, fourth; /* fourth: cumulant, sum of detected times added^4 */
} truth;

void open_scene(void);
void close_scene(void);
skg_spectrum *energies(int64_t count, const double *kev, const double *photons);
skg_plan_options noisy(void);

/* `count` frames of an own index and this seed: [count][PIXELS]. */
void take(const skg_spectrum *spectrum, const skg_plan_options *options, int64_t seed, int64_t count,
          double *images);
moments moments_of(int64_t count, const double *values);
truth sum_energies(int64_t count, const double *kev, const double *photons, const skg_plan_options *options);

/* Mean and variance within four standard errors. */
void check_moments(int64_t count, const double *values, const truth *t);
void check_two_energies(const double *photons, const skg_plan_options *options);

#endif
