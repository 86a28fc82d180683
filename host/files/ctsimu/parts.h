/* What the parts of the translation give each other. Private. */
#ifndef SKG_CTSIMU_PARTS_H
#define SKG_CTSIMU_PARTS_H

#include "ctsimu/frame.h"

#include <skiagraph/beam.h>
#include <skiagraph/material.h>

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
