/* Types and functions that the files of the translation share: values, coordinate systems, geometry. Private. */
#ifndef SKG_CTSIMU_PARTS_H
#define SKG_CTSIMU_PARTS_H

#include "ctsimu/ctsimu.h"

#include <skiagraph/beam.h>
#include <skiagraph/material.h>

/* Values of a scenario with their paths, units and drifts. */

enum { SKG_ITEM_PATH = 192 };

/* State of a translation. */
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

/* Coordinate systems of source, detector, stage and samples in each projection. */

/* A coordinate system: origin, mm, and three axes of length 1 in the columns of `axes`, row by row. */
typedef struct {
    double centre[3];
    double axes[9];
} skg_system;

/* Which axes a vector's components belong to. */
typedef enum { SKG_AXES_WORLD, SKG_AXES_LOCAL, SKG_AXES_SAMPLE } skg_vector_axes;

typedef struct {
    skg_vector_axes axes;
    skg_parameter components[3];
} skg_scene_vector;

typedef struct {
    int32_t is_rotation, is_known;
    skg_scene_vector axis, pivot;
    skg_parameter amount;
} skg_deviation;

/* An object of the scene: where it is, its orientation, and how it deviates. */
typedef struct {
    int32_t is_on_stage; /* 1: in the axes of the stage */
    skg_scene_vector centre, u, w;
    int64_t deviation_count;
    skg_deviation *deviations;
} skg_placement;

/* Reads geometry.source and its like, or the position of a sample. Free also after a failure. */
skg_status skg_placement_read(const skg_item *item, skg_placement *placement);
void skg_placement_free(skg_placement *placement);

/* The system of an object in a projection.
 *
 * turn    rotation about its own w, rad: of the stage
 * stage   of an object on the stage, otherwise NULL
 * known   1: without the deviations and drifts that the reconstruction does not know
 * system  in the axes of the world, or of the stage for an object on it */
void skg_placement_at(const skg_placement *placement, int64_t frame, double turn, const skg_system *stage,
                      int known, skg_system *system);

/* A point or direction of the world in the axes of a system. */
void skg_system_point(const skg_system *system, const double *point, double *local);
void skg_system_direction(const skg_system *system, const double *direction, double *local);

/* Systems of the scan's objects in each projection. */
typedef struct {
    skg_placement source, detector, stage;
    double *angles;             /* [frames] of the stage, rad */
    skg_system *stages, *known; /* [frames] */
    double pitch[2];            /* of the detector's pixels, mm */
    int64_t columns, rows;
    int32_t is_parallel;
    double distance_mm; /* from the source to the plane of the detector in projection 0 */
} skg_ctsimu_geometry;

/* Each takes what it needs of the scenario and puts keys into `scene`. */
skg_status skg_ctsimu_read_geometry(skg_ctsimu *scenario, skg_ctsimu_geometry *geometry);
void skg_ctsimu_geometry_free(skg_ctsimu_geometry *geometry);

/* Source and detector of the first projection, and the key Scan. */
skg_status skg_ctsimu_put_views(skg_ctsimu *scenario, const skg_ctsimu_geometry *geometry, json_t *scene);
skg_status skg_ctsimu_put_acquisition(skg_ctsimu *scenario, json_t *scene);
skg_status skg_ctsimu_put_samples(skg_ctsimu *scenario, const skg_ctsimu_geometry *geometry, json_t *scene);
skg_status skg_ctsimu_put_world(skg_ctsimu *scenario, json_t *scene);

/* The beam, which the detector's front filters weaken, too, and the detector's response to it. */
skg_status skg_ctsimu_put_beam(skg_ctsimu *scenario, const skg_ctsimu_geometry *geometry, json_t *scene);
skg_status skg_ctsimu_put_detector(skg_ctsimu *scenario, const skg_ctsimu_geometry *geometry, json_t *scene);

/* The material with the id that stands in an item; NULL for vacuum. The caller releases it. */
skg_status skg_ctsimu_material(const skg_item *id, skg_material **material);

/* Material and Density of a sample, or of the world, for a material; NULL: vacuum. */
skg_status skg_ctsimu_put_material(const skg_material *material, json_t *object);

/* Remarks about what is not simulated, and about keys that the format does not have. */
skg_status skg_ctsimu_remark_rest(skg_ctsimu *scenario);

/* An array of numbers; NULL: no memory. */
json_t *skg_ctsimu_numbers(int64_t count, const double *numbers);

/* Puts a value that may be NULL for want of memory. */
skg_status skg_ctsimu_put(json_t *object, const char *key, json_t *value);

#endif
