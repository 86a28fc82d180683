/* Gradients of a frame: the derivatives of a loss from those by its image, or of an image along a direction. Private. */
#ifndef SKG_GRADIENT_WORK_H
#define SKG_GRADIENT_WORK_H

#include "frame/jobs.h"
#include "gradient/device.h"

#include <skiagraph/gradient.h>

/* The interface has attenuation coefficients in 1/cm, lengths are in mm. */
static const double SKG_PER_MM = 0.1; /* of 1 / cm */

/* The derivative of an image along a direction. */
typedef struct {
    skg_direction direction; /* its arrays are the job's */
    double *image;           /* [channels][rows][columns], in the caller's memory or in `images` */
    int64_t saturated;       /* faces whose slopes were cut off */
    /* Of the rays of a pass: how fast the mm of each plane of the model change by densities, and the exponent of each
     * node by attenuation coefficients; [planes or nodes][rows][columns]. NULL: not at all. */
    double *plane_changes, *node_changes;
} skg_derivative_work;

/* The work of a job that computes derivatives instead of an image; the job owns it. Its frames are the passes of one frame. */
typedef struct {
    const char *call;            /* the name of the public function */
    skg_gradient_memory *memory; /* the plan's */
    skg_gradient wanted;
    skg_adjoint given;      /* the caller's */
    void *raw;              /* what is read of given.buffer; NULL: given.data was read */
    skg_view of_frame;      /* the view of the frame */
    skg_frame_output shown; /* the image, if it is needed: to.data is `image` */
    double *image;          /* [channels][rows][columns] or NULL */
    cl_event ready;         /* `raw` and `image` are read */
    /* [layers][channels][rows][columns] by the intensities that the stage `attenuate` shows */
    double *adjoint;
    float *rounded;         /* staged: the same on its way to the device, unless that takes doubles */
    double *poses;          /* [parts][6] */
    double *densities;      /* [parts] */
    uint8_t *needs_lengths; /* [parts] 1: its density takes the path lengths through it */
    double view[9];         /* by the source and by the twist of the detector */
    /* [planes of the model][rows][row_stride] by the mm of a pass, if densities are wanted */
    double *planes;
    int64_t node_count;
    double *attenuations; /* [parts][nodes] */
    /* the planes of rays of all nodes of the model, by the exponent of each, if attenuations are wanted */
    double *nodes;
    int64_t direction_count;         /* above 0: the derivatives of the image along directions instead */
    skg_derivative_work *directions; /* [direction_count] */
    skg_frame_output results;        /* the caller's; its frames are the directions */
    double *images;     /* [directions][channels][rows][columns]; NULL: they are made where they go */
    int64_t *saturated; /* the caller's: [directions], or NULL */
} skg_gradient_work;

/* The work of a job of gradients or derivatives. */
static inline skg_gradient_work *skg_gradient_of(const skg_job *job) {
    return job->state;
}

void skg_gradient_work_release(skg_gradient_work **work);

#endif
