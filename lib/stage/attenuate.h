/* Stage `attenuate`: from the sums of a raster to what pixels show. Private. */
#ifndef SKG_ATTENUATE_H
#define SKG_ATTENUATE_H

#include "stage/attenuation.h"
#include "stage/raster.h"

typedef struct skg_attenuator skg_attenuator; /* the kernels, made on demand */
skg_status skg_attenuator_create(skg_context *context, skg_attenuator **attenuator);
void skg_attenuator_release(skg_attenuator **attenuator);

/* Where an image goes, in elements of float, or of double if output_double is 1. */
typedef struct {
    cl_mem memory;
    int32_t output_double;
    int32_t add; /* 1: intensities are added to what is there */
    int64_t offset, row_stride, channel_stride;
} skg_image_place;

/* The place in the form that kernels take, with the size of the image. */
static inline skg_image_args skg_image_of(const skg_image_place *place, int64_t columns, int64_t rows,
                                          int64_t channels) {
    return (skg_image_args){.offset = place->offset,
                            .row_stride = place->row_stride,
                            .channel_stride = place->channel_stride,
                            .columns = (SKG_INT)columns,
                            .rows = (SKG_INT)rows,
                            .channels = (SKG_INT)channels};
}

/* The sums that a frame has left, and how they become planes. */
typedef struct {
    const skg_raster *raster;
    int32_t pass; /* of the raster's passes */
    int32_t reserved;
    double scale; /* of the sums */
    /* accumulators that planes are mixed from (spectral/model.h); 0: accumulators are planes */
    int32_t mixed;
    int32_t fine; /* pixels of the raster along each side of a pixel of the image, which shows their sum */
    cl_mem lists; /* [mixed][planes] in the precision of the raster */
} skg_sums;

/* In a pixel that detects fewer photons than this, quantum noise is drawn photon by photon. */
#define SKG_FEW_PHOTONS 50.0

/* Enqueues one image.
 *
 * factor    of intensities; with noise, of photons. The draws of all samples add up to one draw of all photons.
 * share     the share of one ray in the photons of its pixel
 * least     exponents below it are counted in negative[0]; pixels outside the attenuation's range in negative[1],
 *           values that are not finite in negative[2], rays with a sum beyond its bound in negative[3]
 * noise     the key of the noise, of the first of the rays of a pixel; NULL without noise */
skg_status skg_attenuate(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                         const skg_attenuation *attenuation, double factor, double share, double least,
                         cl_mem negative, const skg_noise_args *noise, const skg_image_place *place,
                         skg_stage_log *log);

/* How the results of skg_attenuate_transpose lie in memory, in elements of the raster's precision: `planes` planes of
 * accumulators, then two of the rays. */
typedef struct {
    int64_t planes, stride, plane; /* planes of accumulators; elements of a row, of a plane */
    int64_t items;                 /* work-items, each of which has a largest weight of each plane */
} skg_weight_layout;
skg_weight_layout skg_attenuate_weight_layout(const skg_raster *raster, int32_t fine);

/* The request to skg_attenuate_transpose, and where it goes. */
typedef struct {
    double factor; /* of intensities */
    /* The loss is this channel of each pixel by itself; -1: its derivative by the image is `adjoint`, [channels][rows][columns] in the
     * precision of the raster */
    int32_t channel;
    /* 1: weights are derivatives by the mm of the planes that exponents are made of, and nothing else */
    int32_t of_planes;
    int32_t rays; /* SKG_RAYS_... */
    /* 1: all of a ray is divided by a power of two near its intensity, whose exponent is the third plane behind those of accumulators. For a
     * channel of intensities */
    int32_t relative;
    cl_mem adjoint;
    cl_mem wanted; /* [planes] int: 0: the weights of this plane of accumulators are not made */
    /* of the layout; with SKG_RAYS_PLANES the next two planes are, for each ray, the sum over planes of mm times
     * derivative by mm, and the derivative by the logarithm of the intensity */
    cl_mem weights;
    cl_mem most;    /* [planes][items] the largest magnitudes of the weights of accumulators */
    cl_mem of_rays; /* [SKG_RAY_SUMS][items] with SKG_RAYS_SUMS; else it may be any buffer */
} skg_transposition;

/* Enqueues the transpose of skg_attenuate: from the derivative of a loss by the image to those by the sums (kernels/gradient/weights.cl).
 * Noise is left out. */
skg_status skg_attenuate_transpose(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                                   const skg_attenuation *attenuation, const skg_transposition *asked,
                                   skg_stage_log *log);

/* Prefetches the program of skg_attenuate (skg_prefetch_begin) with sums of a raster with these options. sums: without a
 * raster; attenuation: its shape. */
skg_status skg_attenuate_prefetch(const skg_attenuator *attenuator, const skg_raster_options *options,
                                  const skg_sums *sums, const skg_attenuation *attenuation,
                                  const skg_image_place *place);

/* Enqueues the flat field: what is shown without parts and noise. sums: of a frame of the same shape; they are not
 * read. */
skg_status skg_attenuate_flat_field(skg_attenuator *attenuator, const skg_sums *sums,
                                    const skg_camera *camera, const skg_attenuation *attenuation,
                                    double factor, cl_mem negative, const skg_image_place *place,
                                    skg_stage_log *log);

/* Enqueues -ln of a finished mean, in place. sums: of the frame; they are not read. */
skg_status skg_attenuate_logarithm(skg_attenuator *attenuator, const skg_sums *sums,
                                   const skg_attenuation *attenuation, const skg_image_place *place,
                                   skg_stage_log *log);

#endif
