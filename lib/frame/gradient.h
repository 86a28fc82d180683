/* Gradients of a frame: the derivatives of a loss from those by its image. Private. */
#ifndef SKG_FRAME_GRADIENT_H
#define SKG_FRAME_GRADIENT_H

#include "frame/job.h"
#include "geometry/forces.h"

#include <skiagraph/gradient.h>

/* What a job computes instead of an image. */
struct skg_gradient_work {
    skg_gradient wanted;
    double
        *adjoint;  /* [layers][channels][rows][columns] by the intensities that the stage `attenuate` shows */
    double *poses; /* [parts][6] */
    double view[9];    /* by the source and by the twist of the detector */
    double *densities; /* [parts] */
    double *
        planes; /* [planes of the model][rows][row_stride] by the mm of a pass, if densities are wanted; freed by the caller */
    int32_t **corners; /* [meshes] as the device has them, read once; NULL: not read */
};

/* Refuses by name what has no gradient. call: the name of the public function. */
skg_status skg_gradient_check(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                              const skg_gradient *wanted);

/* Adds the share of one pass, whose sums are made, and waits for it.
 *
 * number   of the pass, below 0: the only one
 * factor   of its intensities */
skg_status skg_gradient_add_pass(skg_job *job, const skg_frame_work *work, int64_t number,
                                 const skg_pass *pass, const skg_sums *sums, double factor);

/* Reads the derivatives by the mm of the planes, which machine->gradient.weights holds. */
skg_status skg_gradient_keep_planes(skg_job *job, const skg_pass *pass);

/* Where the path lengths along all rays of a pass go, for the derivative by a density. */
skg_status skg_gradient_place_lengths(skg_job *job, const skg_pass *pass, skg_image_place *place);

/* Adds the share of a part's density in a pass, from its path lengths; waits for them. */
skg_status skg_gradient_add_density(skg_job *job, const skg_pass *pass, int64_t part);

#endif
