/* Reading and setting the parameters of a body. Private. */
#ifndef SKG_FIT_PARAMETERS_H
#define SKG_FIT_PARAMETERS_H

#include "body/parameters.h"
#include "body/types.h"

/* The parameters that a linked body has. The plane of its tendon is set. */
void skg_fit_values_get(const skg_body *body, double *values);

/* Gives them to a body and finds its links again. values: of chosen parameters; others stay as they are, bit for bit. */
skg_status skg_fit_values_set(skg_body *body, const int32_t *chosen, const double *values);

/* The plane a x + b y + c z + d of azimuth, elevation and offset. */
void skg_fit_plane(const double *bounds, const double *values, double plane[4]);

#endif
