/* The scenes that a device is tested with, and what they have to show. Private.
 *
 * Each self-test has the options that make a plan use certain kernels. The parts are boxes, so that each pixel's path
 * lengths are known from a formula. device/self_tests.h says when a self-test runs. */
#ifndef SKG_SELFTEST_H
#define SKG_SELFTEST_H

#include "device/device.h"
#include "device/self_tests.h"
#include "skg_shared.h"

#include <skiagraph/mesh.h>
#include <skiagraph/options.h>
#include <skiagraph/plan.h>
#include <skiagraph/scene.h>

/* --- boxes, of which a ray crosses a known length (boxes.c) --- */

typedef struct {
    double centre[3], half[3]; /* mm; half edges along its axes */
    double axes[9];            /* [axis][x, y, z], orthonormal and right-handed */
} skg_box;

/* A box whose axes are turned by three angles, so that no face lies along a ray. */
skg_box skg_box_turned(const double *centre, const double *half, const double *angles);

/* Corner `number` of 8 has the signs of its bits: bit 0 for the first axis, 1 for the second, 2 for the third. */
void skg_box_corner(const skg_box *box, int number, double *position);

/* Closed surfaces of boxes, in one mesh. split: the first box's first edge has a corner in its middle that only one of
 * its two faces knows. The shape is the same, but the mesh counts as leaky. */
skg_status skg_boxes_mesh(skg_context *context, const skg_box *boxes, int64_t count, int32_t split,
                          skg_mesh **mesh);

/* Where the way from one point to another enters and leaves a box, as fractions of it. 0: it misses the box. */
int skg_box_crossed(const skg_box *box, const double *from, const double *to, double *enters, double *leaves);

/* --- scenes (scene.c) --- */

enum {
    SKG_SELF_TEST_BOXES = 25,
    SKG_SELF_TEST_PARTS = SKG_FEW_PLANES, /* at most */
    SKG_SELF_TEST_PIXELS = 96,
    SKG_SELF_TEST_ENERGIES_MAX = SKG_SELF_TEST_PARTS,
    SKG_SELF_TEST_BOWTIE_ROWS = 4,
    SKG_SELF_TEST_DEPTH_COUNT = 3,
    SKG_SELF_TEST_FREQUENCIES = 65
};

typedef struct {
    double length; /* as a fraction of the longest path */
    double image;  /* as a fraction of the open beam */
} skg_tolerance;

skg_tolerance skg_self_test_tolerance(skg_self_test number);

typedef struct {
    skg_self_test number;
    int32_t parts;
    /* the last one is a part of its own, if there are two; of more, those before it are, too */
    skg_box boxes[SKG_SELF_TEST_BOXES + 1];
    skg_detector_blur blur;
    skg_bowtie bowtie;
    double angles[SKG_SELF_TEST_BOWTIE_ROWS]; /* of the bow-tie, degrees */
    skg_grid grid;
    skg_collimation jaws;
    skg_heel heel;
    skg_depth_blur depths;
    skg_detector_blur depth_blurs[SKG_SELF_TEST_DEPTH_COUNT];
    skg_dqe dqe;
    double per_mm[SKG_SELF_TEST_FREQUENCIES]; /* of the DQE */
    double dqe_values[SKG_SELF_TEST_FREQUENCIES];
    skg_spot spot;
    skg_material *filter;   /* of the bow-tie */
    skg_material *crystal;  /* of the scintillator */
    skg_response *response; /* of the same */
    skg_plan_options options;
    skg_view view;
    skg_scene *scene;
    skg_spectrum *beam;
} skg_self_test_scene;

/* Makes the scene of a test, with a detector of `pixels` rows and up to as many columns. Release it whatever this returns. */
skg_status skg_self_test_scene_create(skg_context *context, skg_self_test number, int64_t pixels,
                                      skg_self_test_scene *scene);
void skg_self_test_scene_release(skg_self_test_scene *scene);

/* A volume of cells of different attenuation in the last box (volume.c), linear between their centres if the test is. The caller releases
 * it. */
skg_status skg_self_test_volume(const skg_self_test_scene *scene, skg_volume **volume);

/* The attenuation of its cells along a way of unit length, 1/cm, without the volume that the boxes displace. */
double skg_self_test_cells(const skg_self_test_scene *scene, const double *source, const double *pixel);

/* The path lengths in mm of the ray to a place on the detector, in pixels: of part 0 within its surface, and what each part
 * adds to the image, at least two. */
void skg_self_test_lengths(const skg_self_test_scene *scene, double row, double column, double *surface,
                           double *net);

/* The intensity that the image has to show, keV per pixel, without blur and noise. shares: [SKG_SELF_TEST_ENERGIES_MAX] transmission of the
 * beam before it meets a part, by energy; open: result: the intensity of the open beam */
double skg_self_test_intensity(const skg_self_test_scene *scene, const double *shares, const double *net,
                               double *open);

/* --- bow-tie filter, grid, heel effect, detector (exposure.c) --- */

/* Electronic noise and steps, of an image that is divided by a flat field which falls with the distance. */
void skg_self_test_detector_choose(skg_plan_options *options);

/* Whether the noise has its mean and variance, and every value is a step. image, shown: [pixels * pixels], of the former as
 * a share of the flat field, of the latter in keV. open: keV of the open beam. */
void skg_self_test_detector_compare(const skg_view *view, const double *image, const double *shown,
                                    double open, skg_verdict *verdict);

/* A bow-tie filter, a grid whose focus is not at the source, and a scintillator that rays cross obliquely. */
skg_status skg_self_test_shades_choose(skg_self_test_scene *scene);

/* The transmission of filter, grid and scintillator for the energy of a pixel, from the formulas of skg_bowtie, skg_grid_transmission_get
 * and skg_response_create_scintillator. */
skg_status skg_self_test_shade(const skg_self_test_scene *scene, int64_t row, int64_t column, double *share);

/* A tube whose anode is beside the beam, oblique to the detector's rows. */
void skg_self_test_heel_choose(skg_self_test_scene *scene);

/* The transmission of the heel effect in a pixel by energy of the beam, from the tube's spectrum at the angle at which the pixel's ray
 * leaves the anode. shares: [SKG_SELF_TEST_ENERGIES_MAX] */
skg_status skg_self_test_heel(const skg_self_test_scene *scene, int64_t row, int64_t column, double *shares);

/* --- blurs and the power of noise (blurs.c) --- */

/* SKG_SELF_TEST_BLUR: two line spread functions. SKG_SELF_TEST_DEPTHS: three depths of a scintillator with blurs of their own.
 * SKG_SELF_TEST_APART: noise whose power rises with the frequency, in an image that is not blurred. SKG_SELF_TEST_VARIANCE: -ln of
 * an image with noise of all kinds, over a flat field that falls with the distance, and the blur of SKG_SELF_TEST_BLUR. */
skg_status skg_self_test_blurs_choose(skg_self_test_scene *scene);

/* Computes the blurred image. shown, wanted: [rows][columns] */
skg_status skg_self_test_blur(const skg_self_test_scene *scene, const double *shown, double *wanted);

/* Whether the noise of SKG_SELF_TEST_NOISE or SKG_SELF_TEST_APART has its mean, its variance, and its covariance with that of the
 * pixel beside it. open: keV of the open beam. */
void skg_self_test_noise_compare(const skg_self_test_scene *scene, const double *image, const double *shown,
                                 double open, skg_verdict *verdict);

/* Whether the variance of SKG_SELF_TEST_VARIANCE is right in every pixel. */
void skg_self_test_variance_compare(const skg_self_test_scene *scene, const double *variance,
                                    const double *shown, skg_verdict *verdict);

/* --- positions in memory of the device (place.c) --- */

/* Moves the part to where its boxes have to be, by positions of which some lie beyond the bounds that they are put on. The
 * buffer has to stay while frames run. */
skg_status skg_self_test_place(skg_context *context, const skg_self_test_scene *scene, skg_plan *plan,
                               skg_buffer *buffer);

/* --- the self-tests (run.c, which defines skg_self_tests); each fills an empty verdict --- */

/* Compares image and path lengths of a scene (image.c). */
skg_status skg_self_test_image(skg_context *context, skg_self_test number, skg_verdict *verdict);

/* Compares the path lengths of each strategy, in single precision, under a parallel beam (exact.c). */
skg_status skg_self_test_exact(skg_context *context, skg_verdict *verdict);

/* Compares the 3D view of two boxes of which one hides the other (picture.c). */
skg_status skg_self_test_picture(skg_context *context, skg_verdict *verdict);

/* Compares the scatter of a small cube with a formula, and that of a slab with another program's (scatter.c). */
skg_status skg_self_test_scatter(skg_context *context, skg_verdict *verdict);

/* Compares the gradient of a sum of attenuations by two parts, of which one displaces the other, and by the source with differences
 * of the formula, and the derivative along a direction with the gradient (gradient.c). SKG_SELF_TEST_CELLS: by the part that
 * displaces cells of a volume. */
skg_status skg_self_test_gradient(skg_context *context, skg_self_test number, skg_verdict *verdict);

/* Compares the gradient of a sum of attenuations by the densities of two parts, of which one is inside the other, with the formula
 * (gradient.c). */
skg_status skg_self_test_densities(skg_context *context, skg_verdict *verdict);

/* Compares images of counts, and variances, of a detector that counts with the formulas (pulses.c). */
skg_status skg_self_test_pulses(skg_context *context, skg_verdict *verdict);

#endif
