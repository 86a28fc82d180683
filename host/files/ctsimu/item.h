/* Values of a scenario with their paths, units and drifts. Private. */
#ifndef SKG_CTSIMU_ITEM_H
#define SKG_CTSIMU_ITEM_H

#include "ctsimu/ctsimu.h"

enum { SKG_ITEM_PATH = 192 };

/* What is translated. */
typedef struct {
    skg_json_file *file;
    skg_ctsimu_find find;
    void *user;
    json_t *drifts_read; /* array of the drifts that are simulated */
    int64_t frames;      /* number of projections */
} skg_ctsimu;

/* A value and its path, "samples[0].position.center.u". NULL in the file is as good as absent. */
typedef struct {
    skg_ctsimu *scenario;
    json_t *value; /* NULL: absent */
    char path[SKG_ITEM_PATH];
} skg_item;

/* Units that a value may have. */
typedef enum {
    SKG_UNIT_NONE,
    SKG_UNIT_MM,
    SKG_UNIT_RAD,
    SKG_UNIT_S,
    SKG_UNIT_KV,
    SKG_UNIT_MA,
    SKG_UNIT_G_CM3
} skg_item_unit;

skg_item skg_item_root(skg_ctsimu *scenario);

/* The value at "detector.columns" below an item; a part "gray_value|grey_value" names two spellings. */
skg_item skg_item_at(const skg_item *item, const char *keys);
skg_item skg_item_element(const skg_item *array, int64_t index);

/* As of skg_json_fail and skg_json_remark. */
skg_status skg_item_fail(const skg_item *item, skg_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
skg_status skg_item_remark(const skg_item *item, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The value of a parameter ({"value": ..., "unit": ...}, or the bare value) in our unit. An absent one leaves the number
 * as it is. */
skg_status skg_item_number(const skg_item *item, skg_item_unit unit, double *number);
skg_status skg_item_text(const skg_item *item, const char **text);
skg_status skg_item_flag(const skg_item *item, int32_t *flag);
skg_status skg_item_integer(const skg_item *item, int64_t least, int64_t most, int64_t *integer);

/* Whether a parameter has a value. */
int skg_item_given(const skg_item *item);

/* The path of the file that a parameter names; NULL: it names none. A file that cannot be read fails. */
skg_status skg_item_file(const skg_item *item, const char **path);

/* A parameter in each projection: value, and with all drifts or those that the reconstruction knows. */
typedef struct {
    double value;
    double *all, *known; /* [frames] sums of the drifts; NULL: there are none */
} skg_parameter;

/* fallback: its value if it is absent. Free also after a failure. */
skg_status skg_parameter_read(const skg_item *item, skg_item_unit unit, double fallback,
                              skg_parameter *parameter);
void skg_parameter_free(skg_parameter *parameter);

static inline double skg_parameter_at(const skg_parameter *parameter, int64_t frame, int known_only) {
    const double *drift = known_only ? parameter->known : parameter->all;
    return parameter->value + (drift ? drift[frame] : 0);
}

#endif
