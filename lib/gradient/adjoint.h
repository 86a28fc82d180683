/* From d loss / d image to d loss / d intensities: the transpose of what the detector does. Private. */
#ifndef SKG_FRAME_ADJOINT_H
#define SKG_FRAME_ADJOINT_H

#include "gradient/work.h"

#include <skiagraph/gradient.h>

/* Reads and checks the caller's adjoint, skg_gradient_of(job)->given: into skg_gradient_of(job)->adjoint, [channels][rows][columns], or, of a buffer,
 * enqueues the read into skg_gradient_of(job)->raw. */
skg_status skg_adjoint_read(skg_job *job);

/* Takes over what was read of a buffer, and checks its values. Does nothing if the adjoint was in host memory. */
skg_status skg_adjoint_take(skg_job *job);

/* Turns the adjoint into derivatives by the intensities that the stage `attenuate` writes, [layers][channels][rows][columns].
 *
 * values    replaced
 * image     [channels][rows][columns] as shown; NULL unless skg_adjoint_needs_image
 * view      of the frame */
skg_status skg_adjoint_of_intensities(const skg_job *job, const skg_view *view, const double *image,
                                      double **values);

/* Turns derivatives of the intensities of one layer along a direction into those of the image, [channels][rows][columns], in place. */
skg_status skg_derivative_of_image(const skg_job *job, const skg_view *view, const double *image,
                                   double *values);

/* Whether the image itself is needed: where a logarithm is taken of what is finished. */
int skg_adjoint_needs_image(const skg_recipe *recipe);

/* Uploads derivatives by the intensities, [layers][channels][rows][columns], in the precision of the raster. */
skg_status skg_adjoint_send(skg_job *job, const double *adjoint);

#endif
