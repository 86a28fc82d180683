/* A slice through the scene, from a few projections with few pixels, by the library's own reconstruction. */
#ifndef CLI_LIVE_SLICE_H
#define CLI_LIVE_SLICE_H

#include "live/scene.h"

enum { LIVE_SLICE_SIZE = 128 };

typedef struct {
    float values[LIVE_SLICE_SIZE * LIVE_SLICE_SIZE]; /* 1/cm, rows from the top down */
    double voxel_mm;
    int across; /* the slice lies across x (0), y (1) or z (2), the one that is nearest to the axis of rotation */
    double at_mm;                       /* where, along this axis of the scene */
    int64_t projections, columns, rows; /* that were computed */
    double mean_kev;                    /* of the open beam */
    double turn_s;    /* from the first projection to the last one; 0: nothing moved meanwhile */
    double truncated; /* share of the rows that the detector cuts off */
    int is_cancelled;
} live_slice;

/* Why a switch changes nothing of the scene's slices, a constant; NULL: it does. */
const char *live_slice_without_spectrum(const live_scene *scene);
const char *live_slice_without_motion(const live_scene *scene);

/* Reconstructs a slice of the scene as a wish has it. A scene without a scan turns once about an axis along the detector's columns. progress: hears
 * of projections, and cancels. Returns 0 with a sentence, also where the library refuses the scan. */
int live_slice_make(const live_base *base, const live_wish *wish, const skg_live_asked *switches,
                    skg_progress *progress, live_slice *slice, char *sentence);

#endif
