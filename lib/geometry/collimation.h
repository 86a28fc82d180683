/* The field of a beam behind its collimator. Private. */
#ifndef SKG_COLLIMATION_H
#define SKG_COLLIMATION_H

#include "geometry/camera.h"

#include <skiagraph/collimation.h>

/* The field of a view's beam: a rectangle in a plane parallel to the detector. */
typedef struct {
    double centre[3];         /* mm, world: where the ray from the source's middle to the detector's centre
                                 crosses the plane; of a parallel beam the detector's centre */
    double column[3], row[3]; /* unit vectors along the detector's column and row steps */
    double low[2], high[2];   /* mm from the centre along them */
} skg_field;

/* Fails with SKG_ERR_ARGUMENT or SKG_ERR_SCENE unless the numbers of a collimation are usable in some view. */
skg_status skg_collimation_check(const skg_collimation *collimation);

/* Whether a collimation stops rays to pixels of its own detector. NULL: it does not. */
int skg_collimation_limits(const skg_collimation *collimation);

/* Finds the field of a view.
 *
 * collimation   NULL or open: the detector's own rectangle (outer edges of the pixels), on the detector's plane
 * errors        SKG_ERR_SCENE if the jaws lie behind the detector, or the margin leaves nothing of its rectangle */
skg_status skg_field_make(const skg_collimation *collimation, const skg_view *view, skg_field *field);

/* Finds the pixels of a camera whose rays pass the field: the columns from window[0] to before window[1] and the rows from
 * window[2] to before window[3], none if an end is not above its first.
 *
 * errors   SKG_ERR_SCENE if the camera's source does not lie before the jaws */
skg_status skg_field_window(const skg_field *field, const skg_camera *camera, int32_t window[4]);

#endif
