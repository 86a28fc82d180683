/* A batch of projections in flight. Private. */
#ifndef SKG_SCAN_SLOT_H
#define SKG_SCAN_SLOT_H

#include "core/text.h"

#include <skiagraph/scan_run.h>
#include <skiagraph/scatter_series.h>

/* Plan, scan and options of a run; constant during the run. */
typedef struct {
    skg_plan *plan;
    skg_scan *scan;
    skg_scan_run_options options;
    int64_t projections;
    int64_t image_elements;     /* of all channels */
    int32_t is_logarithm;       /* 1: the quantity is attenuation */
    skg_scatter_series *series; /* that all frames take their scatter from; NULL: none */
} skg_scan_work;

typedef struct {
    int64_t count; /* projections; 0: nothing is in flight and nothing is finished */
    int64_t *indices;
    double *phases, *amplitudes;
    void *block;  /* the memory of the images */
    void *images; /* [batch][sub-frames] images; the means come to stand at the beginning */
    skg_job **jobs;
    int64_t job_count;
    skg_frame *frames; /* of a job */
    skg_view *views;
} skg_scan_slot;

skg_status skg_scan_work_init(skg_scan_work *work);

/* Makes the series, if the plan has scatter and frames that change smoothly. */
skg_status skg_scan_work_series(skg_scan_work *work);

/* Memory for batches of this size. Free also after a failure. */
skg_status skg_scan_slot_init(const skg_scan_work *work, skg_scan_slot *slot, int64_t batch);
void skg_scan_slot_free(skg_scan_slot *slot); /* cancels its jobs */

/* Starts the frames of projections. */
skg_status skg_scan_slot_submit(const skg_scan_work *work, skg_scan_slot *slot, const int64_t *indices,
                                int64_t count);

/* Waits for them, and takes the mean over sub-frames. SKG_RANGE as of skg_job_wait. */
skg_status skg_scan_slot_wait(const skg_scan_work *work, skg_scan_slot *slot);

#endif
