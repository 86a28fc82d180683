/* The kinds of jobs that compute derivatives, of one frame, whose steps are its passes. Private. */
#ifndef SKG_GRADIENT_KIND_H
#define SKG_GRADIENT_KIND_H

#include "gradient/work.h"

extern const skg_job_kind skg_job_gradient;   /* derivatives of a loss by everything */
extern const skg_job_kind skg_job_directions; /* derivatives of an image along directions */

#endif
