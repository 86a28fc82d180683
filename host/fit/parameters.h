/* The parameters of a body that can be fitted. Private. */
#ifndef SKG_FIT_PARAMETERS_H
#define SKG_FIT_PARAMETERS_H

#include "body/types.h"

enum {
    FIT_TENDON, /* x, y, z */
    FIT_AZIMUTH = 3,
    FIT_ELEVATION,
    FIT_OFFSET,
    FIT_DIAPHRAGM, /* alpha_min, alpha_max, beta */
    FIT_LIVER = 9, /* the same */
    FIT_RIBS = 12,
    FIT_REACH,
    FIT_PARAMETERS
};

typedef struct {
    const char *name, *group, *unit;
    double low, high; /* the range that is searched; of plane-offset: shares of the diaphragm's height */
    double least, greatest; /* what a body accepts */
} skg_fit_kind;

extern const skg_fit_kind skg_fit_kinds[FIT_PARAMETERS];

/* The parameters that a linked body has. The plane of its tendon is set. */
void skg_fit_values_get(const skg_body *body, double *values);

/* Gives them to a body and finds its links again. values: of chosen parameters; others stay as they are, bit for bit. */
skg_status skg_fit_values_set(skg_body *body, const int32_t *chosen, const double *values);

/* The plane a x + b y + c z + d of azimuth, elevation and offset. */
void skg_fit_plane(const double *bounds, const double *values, double plane[4]);

#endif
