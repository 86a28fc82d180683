/* A scan as it is kept. Private. */
#ifndef SKG_TRAJECTORY_TYPES_H
#define SKG_TRAJECTORY_TYPES_H

#include "core/core.h"

#include <skiagraph/scan.h>

enum { SKG_POSE_NUMBERS = 12, SKG_SCAN_MAX = 10000000 };

struct skg_scan {
    skg_refs refs;
    skg_scan_options options; /* axis of length 1 */
    skg_view view;            /* with the detector displaced */
    double *poses;            /* [options.projections][12], or NULL: the options decide */
    struct skg_scan *whole;   /* of a subset: the scan whose projections it has; otherwise NULL */
    int64_t *indices;         /* [options.projections] their numbers in it */
};

/* Whether a scan, or that of which it is a subset, is a table of poses. */
static inline int skg_scan_is_table(const skg_scan *scan) {
    while (scan->whole) scan = scan->whole;
    return scan->poses != NULL;
}

/* Displaces, tilts and skews the detector of a view. */
void skg_scan_displace_detector(const skg_scan_options *options, skg_view *view);

/* Turns source and detector by an angle about an axis of length 1 through a point. is_detector_fixed: the source
 * only. */
void skg_scan_turn(const double *axis, const double *centre, double angle, int is_detector_fixed,
                   skg_view *view);

/* The jitter of a projection's angle. */
double skg_scan_angle_error(const skg_scan_options *options, int64_t index);

/* Adds travel and drift at a position, in projections, and the jitter of a projection. */
void skg_scan_disturb(const skg_scan_options *options, double position, int64_t index, skg_view *view);

skg_status skg_scan_check_options(const skg_scan_options *options);

#endif
