/* The parameters of a body that can be fitted: names, units and ranges. Private. */
#ifndef SKG_BODY_PARAMETERS_H
#define SKG_BODY_PARAMETERS_H

#include <skiagraph/error.h>

#include <stdint.h>

enum {
    BODY_TENDON, /* x, y, z */
    BODY_AZIMUTH = 3,
    BODY_ELEVATION,
    BODY_OFFSET,
    BODY_DIAPHRAGM, /* alpha_min, alpha_max, beta */
    BODY_LIVER = 9, /* the same */
    BODY_RIBS = 12,
    BODY_REACH,
    BODY_PARAMETERS
};

typedef struct {
    const char *name, *group, *unit;
    double low, high; /* the range that is searched; of plane-offset: shares of the diaphragm's height */
    double least, greatest; /* what a body accepts */
} skg_parameter_kind;

extern const skg_parameter_kind skg_parameter_kinds[BODY_PARAMETERS];

/* Sets chosen[p] of the parameter with this name, or of those of the group. SKG_ERR_ARGUMENT with the known names. */
skg_status skg_parameters_choose(const char *word, int32_t *chosen);

/* The number of the parameter with this name. SKG_ERR_ARGUMENT with the known names. */
skg_status skg_parameter_find(const char *name, int *parameter);

/* SKG_ERR_ARGUMENT: the range is empty, or leaves what a body accepts. */
skg_status skg_parameter_check_range(int parameter, double low, double high);

#endif
