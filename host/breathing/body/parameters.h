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
    BODY_DOMES, /* left, right, back */
    BODY_MUSCLE = 17,
    BODY_RIB_ANGLE,
    BODY_RIB_FALL,
    BODY_FOLLOWS,
    BODY_HELD,
    BODY_PARAMETERS
};

/* How a parameter was chosen. */
enum { BODY_BY_GROUP = 1, BODY_BY_NAME };

typedef struct {
    const char *name, *group, *unit;
    double low, high; /* the range that is searched; of plane-offset: shares of the diaphragm's height */
    double least, greatest; /* what a body accepts */
    unsigned couplings;     /* bit 1 << SKG_COUPLING_: where it has an effect */
    int by_default;         /* 1: a fit that chooses none searches it with the anatomical coupling */
} skg_parameter_kind;

extern const skg_parameter_kind skg_parameter_kinds[BODY_PARAMETERS];

/* Sets chosen[p] of the parameter with this name, or of those of the group, to how it was chosen. SKG_ERR_ARGUMENT with the
 * known names. */
skg_status skg_parameters_choose(const char *word, int32_t *chosen);

/* The number of the parameter with this name. SKG_ERR_ARGUMENT with the known names. */
skg_status skg_parameter_find(const char *name, int *parameter);

/* SKG_ERR_ARGUMENT: the range is empty, or leaves what a body accepts. */
skg_status skg_parameter_check_range(int parameter, double low, double high);

/* Whether a parameter has an effect with a coupling. */
int skg_parameter_is_of(int parameter, int coupling);

/* SKG_ERR_ARGUMENT: it has none. The message lists those that have. */
skg_status skg_parameter_check_coupling(int parameter, int coupling);

#endif
