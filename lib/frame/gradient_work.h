/* Gradients of a frame: the derivatives of a loss from those by its image. Private. */
#ifndef SKG_GRADIENT_WORK_H
#define SKG_GRADIENT_WORK_H

#include "frame/job.h"
#include "geometry/forces.h"

#include <skiagraph/gradient.h>

/* What a job computes instead of an image. */
struct skg_gradient_work {
    skg_gradient wanted;
    /* [layers][channels][rows][columns] by the intensities that the stage `attenuate` shows */
    double *adjoint;
    double *poses;          /* [parts][6] */
    double *densities;      /* [parts] */
    uint8_t *needs_lengths; /* [parts] 1: its density takes the path lengths through it */
    double view[9];         /* by the source and by the twist of the detector */
    /* [planes of the model][rows][row_stride] by the mm of a pass, if densities are wanted; freed by the caller */
    double *planes;
    int64_t node_count;
    double *attenuations; /* [parts][nodes] */
    /* the planes of rays of all nodes of the model, by the exponent of each, if attenuations are wanted; freed by the caller */
    double *nodes;
    int32_t forward; /* 1: the derivative of the image along `direction` instead */
    int32_t reserved;
    skg_direction direction;
    double *derivative; /* [channels][rows][columns] of the intensities */
    int64_t saturated;  /* faces whose slopes were cut off */
};

#endif
