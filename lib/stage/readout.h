/* From intensities to the image: layers, scatter, blur, detector, flat field. Private. */
#ifndef SKG_READOUT_H
#define SKG_READOUT_H

#include "beam/counter_kernels.h"
#include "geometry/optics.h"
#include "stage/attenuate.h"

/* --- Stage `blur`: an image convolved with the detector's line spread functions or its point spread function. *
 * A pixel beyond the border takes the value of the nearest pixel on it. So a flat field that reaches the border continues
 * beyond it, and the blur leaves it unchanged. */

typedef struct skg_blur skg_blur;

/* Checks and copies the functions, scaled to sum 1. SKG_ERR_ARGUMENT: an even or no number of samples, a sample that is
 * not finite, no positive sum. */
skg_status skg_blur_create(skg_context *context, const skg_detector_blur *shape, skg_blur **blur);
void skg_blur_release(skg_blur **blur);

/* Enqueues the blur of `channels` images of columns x rows, from one place to another or in place; image->add: the result is
 * added to what is there. The workspace is allocated at the first call. */
skg_status skg_blur_run(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                        int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* Likewise enqueues what the blur makes of the variances of pixels that are independent of each other. */
skg_status skg_blur_run_variance(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                                 int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* The transpose of the blur of one image, on the host in double precision: adds to `to`, [rows][columns]. A pixel on the border
 * takes what belongs to the pixels beyond it. */
skg_status skg_blur_transpose(const skg_blur *blur, int64_t columns, int64_t rows, const double *from,
                              double *to);

/* The blur of one image on the host in double precision: adds to `to`. */
void skg_blur_apply(const skg_blur *blur, int64_t columns, int64_t rows, const double *from, double *to);

/* From how many samples a pixel is summed. */
int64_t skg_blur_samples(const skg_blur *blur);

/* The functions in words: "a point spread function of 5 x 5 samples"; valid as long as the blur. */
const char *skg_blur_kind(const skg_blur *blur);

/* Bytes on the device. */
int64_t skg_blur_bytes(const skg_blur *blur);

/* --- Blur of images, or of several layers that add up to them, each with a blur of its own: photons that interact in several depths of
 * a scintillator, or means and noise. */

typedef struct {
    int32_t count; /* of blurs; 0: images are not blurred */
    int32_t reserved;
    skg_blur *blurs[SKG_DEPTHS_MAX];
    skg_buffer images; /* [count][channels][rows][columns], if there are several layers */
} skg_layers;

/* Makes the blurs: of the whole image, or of each depth. blur, depths: the caller's; NULL: none. */
skg_status skg_layers_create(skg_context *context, const skg_detector_blur *blur,
                             const skg_depth_blur *depths, skg_layers *layers);

/* Adds the layer of the noise, whose power follows from the blur and the DQE. pixel_mm: along rows and along columns. */
skg_status skg_layers_add_noise(skg_context *context, const skg_detector_blur *blur, const skg_dqe *dqe,
                                const double pixel_mm[2], skg_layers *layers);

void skg_layers_release(skg_layers *layers);

/* Where the layers of an image go that the stage `attenuate` writes: to the image itself if one layer is used, otherwise to memory
 * that is allocated at the first call. used: how many layers, the first ones, the image has. */
skg_status skg_layers_place(skg_context *context, skg_layers *layers, int32_t used,
                            const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                            skg_image_place *place);

/* Enqueues the blur of what was written to `place`; the sum goes to the image. */
skg_status skg_layers_blur(skg_layers *layers, int32_t used, const skg_image_place *place,
                           const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                           skg_stage_log *log);

/* Likewise for the variances of independent pixels of `used` layers. apart: 1: one layer, which is blurred as the layer of the noise. */
skg_status skg_layers_blur_variance(skg_layers *layers, int32_t used, int32_t apart,
                                    const skg_image_place *place, const skg_image_place *image,
                                    int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log);

/* Bytes on the device. */
int64_t skg_layers_bytes(const skg_layers *layers);

/* --- Stage `pulses`: what a detector that counts makes of independent counts, in place of a blur. */

typedef struct skg_pulses skg_pulses;

/* Layers of its images (skg_layers_place): means and deviations. */
enum { SKG_PULSES_LAYERS = 2 };

/* kernels: copied. pile_up: enum skg_pile_up; dead: the share of the exposure that a dead time is */
skg_status skg_pulses_create(skg_context *context, const skg_counter_kernels *kernels, int32_t pile_up,
                             double dead, skg_pulses **pulses);
void skg_pulses_release(skg_pulses **pulses);

/* Enqueues the stage: from images of means, with deviations behind them if there is a key of noise, to images of counts. They may not
 * overlap. noise: NULL: none */
skg_status skg_pulses_run(skg_pulses *pulses, const skg_noise_args *noise, const skg_image_place *from,
                          const skg_image_place *image, int64_t columns, int64_t rows, skg_stage_log *log);

/* Likewise for variances of independent counts, without dead time. */
skg_status skg_pulses_run_variance(skg_pulses *pulses, const skg_image_place *from,
                                   const skg_image_place *image, int64_t columns, int64_t rows,
                                   skg_stage_log *log);

/* Bytes on the device. */
int64_t skg_pulses_bytes(const skg_pulses *pulses);

/* --- Stage `scattered`: adds scattered photons to an image, with their noise. */

/* The kernels of images of float and double, made on demand. All zero: none. */
typedef struct {
    cl_kernel kernels[2];
} skg_scattered;

/* Scatter that is added to an image: [channels][rows][columns] floats. variance: NULL: no noise. */
typedef struct {
    cl_mem mean, variance;
    int32_t channels;
    int32_t add;   /* 1: to what the image holds; 0: in its place */
    int32_t apart; /* 1: deviations go to images behind those of all channels */
    float scale;   /* of what is added */
} skg_scattered_image;

skg_status skg_scattered_run(skg_context *context, skg_scattered *stage, const skg_scattered_image *what,
                             const skg_noise_args *key, const skg_image_place *image, int64_t columns,
                             int64_t rows, skg_stage_log *log);
void skg_scattered_release(skg_scattered *stage);

/* --- Stage `detect`: what follows quantum noise and blur: electronic noise, quantisation, and the quantity that is shown.
 * *
 * Quantum noise itself is drawn where intensities are made (attenuate.h): there the photons of every node are known, so
 * that few photons can be drawn exactly. The sum of draws for several samples of the source has the distribution of one
 * draw of the sum. */

typedef struct {
    double electronic; /* standard deviation, keV per pixel; 0: none */
    double step;       /* keV per pixel; 0: values are not quantised */
    int32_t channels;
    int32_t over_flat_field; /* 1: values are divided by those of a flat field */
} skg_detection;

typedef struct skg_detector skg_detector;

/* factors: [channels] of values, after quantisation; copied. */
skg_status skg_detector_create(skg_context *context, const skg_detection *detection, const double *factors,
                               skg_detector **detector);
void skg_detector_release(skg_detector **detector);

/* Whether values are divided by those of a flat field. */
int skg_detector_wants_flat_field(const skg_detector *detector);

/* Enqueues the stage for an image of columns x rows, in place. of_mean: 1: without electronic noise and steps. factor: of this
 * frame, for all channels. flat_field: [channels][rows][columns] of the image's type, if the detector wants it. */
skg_status skg_detector_run(skg_detector *detector, const skg_noise_args *key, int32_t of_mean, double factor,
                            cl_mem flat_field, const skg_image_place *image, int64_t columns, int64_t rows,
                            skg_stage_log *log);

/* Likewise enqueues what the stage makes of the variances of pixels. mean: [channels][rows][columns] of the transmission, if
 * variances are those of its -ln; else NULL. */
skg_status skg_detector_run_variance(skg_detector *detector, const skg_noise_args *key, double factor,
                                     cl_mem flat_field, cl_mem mean, const skg_image_place *variance,
                                     int64_t columns, int64_t rows, skg_stage_log *log);

/* Bytes on the device. */
int64_t skg_detector_bytes(const skg_detector *detector);

/* The key of a frame's noise. */
skg_noise_args skg_noise_key(int64_t seed, int64_t index, int32_t parts);

/* --- The flat field of a view: what the beam gives without parts and noise. Noisy images are divided by it if a world or
 * falloff make it differ from pixel to pixel. */

typedef struct {
    int32_t known; /* 1: for this view and type */
    int32_t is_double;
    skg_view view;
    skg_buffer image; /* [channels][rows][columns] */
} skg_flat_field;

/* The inputs of a flat field. */
typedef struct {
    /* of source and pixel; NULL: the source is a point, and rays go to the pixels' centres */
    const skg_samples *samples;
    const skg_sums *sums; /* of a frame of the same shape; not read */
    skg_attenuator *attenuator;
    const skg_attenuation *attenuation;
    skg_layers *layers; /* and their blurs */
    skg_pulses *pulses; /* in their place; NULL: the detector does not count */
    cl_mem negative;    /* counters, which it leaves as they are */
    double exposure;    /* what intensities are multiplied by for the view */
} skg_flat_field_work;

/* Enqueues the flat field of a view as float or double, if it is not known. */
skg_status skg_flat_field_find(skg_flat_field *field, const skg_flat_field_work *work, const skg_view *view,
                               int32_t is_double, skg_staging *staging);

#endif
