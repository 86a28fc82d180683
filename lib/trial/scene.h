/* The small scenes that a device is tested with, and what they have to show. Private.
 *
 * Each test has the options that make a plan use certain kernels. The parts are boxes, so that each pixel's path
 * lengths are known from a formula. */
#ifndef SKG_TRIAL_SCENE_H
#define SKG_TRIAL_SCENE_H

#include "trial/boxes.h"

#include <skiagraph/options.h>
#include <skiagraph/scene.h>

/* In the order in which `skiagraph devices --test` lists them. */
typedef enum {
    SKG_TRIAL_CORE, /* what every plan needs: project, one raster, attenuate */
    SKG_TRIAL_COPIES,
    SKG_TRIAL_TILES,
    SKG_TRIAL_ATOMICS,
    SKG_TRIAL_DOUBLE,
    SKG_TRIAL_HALF,
    SKG_TRIAL_ENERGIES,
    SKG_TRIAL_SOURCE_PLANE,
    SKG_TRIAL_LEAKY,
    SKG_TRIAL_PRIORITY,
    SKG_TRIAL_NOISE,
    SKG_TRIAL_BLUR,
    SKG_TRIAL_PARALLEL, /* all strategies, with exact sums: exact.h */
    SKG_TRIAL_LENGTHS,
    SKG_TRIAL_DETECTOR, /* electronic noise, steps, flat field: exposure.h */
    SKG_TRIAL_SHADES,   /* bow-tie filter, grid, oblique scintillator: exposure.h */
    SKG_TRIAL_PLACE,    /* positions in memory of the device: place.h */
    SKG_TRIAL_PICTURE,  /* the 3D view: picture.h */
    SKG_TRIAL_RAYS,     /* several rays of a pixel in one pass */
    SKG_TRIAL_HEEL,     /* heel effect: exposure.h */
    SKG_TRIAL_DEPTHS,   /* several blurs, added: blurs.h */
    SKG_TRIAL_APART,    /* noise with a blur of its own, added: blurs.h */
    SKG_TRIAL_PASSES,   /* passes of a frame, each by a worker */
    SKG_TRIAL_SIDE,     /* the same, several side by side */
    SKG_TRIALS
} skg_trial_number;

enum {
    SKG_TRIAL_BOXES = 25,
    SKG_TRIAL_PIXELS = 96,
    SKG_TRIAL_ENERGIES_MAX = 3,
    SKG_TRIAL_BOWTIE_ROWS = 4,
    SKG_TRIAL_DEPTH_COUNT = 3,
    SKG_TRIAL_FREQUENCIES = 65
};

typedef struct {
    const char *name;    /* of the kernels: "strategy tiles" */
    double length_error; /* tolerance, as a fraction of the longest path */
    double image_error;  /* tolerance, as a fraction of the open beam */
} skg_trial;

/* Static storage. */
const skg_trial *skg_trial_get(skg_trial_number number);

/* The number of the test with this name; SKG_TRIALS: there is none. */
skg_trial_number skg_trial_find(const char *name);

typedef struct {
    skg_trial_number number;
    skg_box boxes[SKG_TRIAL_BOXES + 1]; /* the last one is a part of its own, if there are two */
    skg_detector_blur blur;
    skg_bowtie bowtie;
    double angles[SKG_TRIAL_BOWTIE_ROWS]; /* of the bow-tie, degrees */
    skg_grid grid;
    skg_heel heel;
    skg_depth_blur depths;
    skg_detector_blur depth_blurs[SKG_TRIAL_DEPTH_COUNT];
    skg_dqe dqe;
    double per_mm[SKG_TRIAL_FREQUENCIES]; /* of the DQE */
    double dqe_values[SKG_TRIAL_FREQUENCIES];
    skg_spot spot;
    skg_material *filter;   /* of the bow-tie */
    skg_material *crystal;  /* of the scintillator */
    skg_response *response; /* of the same */
    skg_plan_options options;
    skg_view view;
    skg_scene *scene;
    skg_spectrum *beam;
} skg_trial_scene;

/* Makes the scene of a test, with a detector of `pixels` rows and up to as many columns. Release it whatever this returns. */
skg_status skg_trial_scene_create(skg_context *context, skg_trial_number number, int64_t pixels,
                                  skg_trial_scene *scene);
void skg_trial_scene_release(skg_trial_scene *scene);

/* The path lengths in mm of the ray to a place on the detector, in pixels: of part 0 within its surface, and what each part
 * adds to the image. */
void skg_trial_lengths(const skg_trial_scene *scene, double row, double column, double *surface, double *net);

/* What the image has to show, keV per pixel, without blur and noise. shares: [SKG_TRIAL_ENERGIES_MAX] what is left of each energy
 * of the beam before it meets a part; open: of the beam that meets nothing. */
double skg_trial_intensity(const skg_trial_scene *scene, const double *shares, const double *net,
                           double *open);

#endif
