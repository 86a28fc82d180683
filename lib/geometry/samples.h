/* The ends of rays: samples of the focal spot and of the pixel. Private. */
#ifndef SKG_SAMPLES_H
#define SKG_SAMPLES_H

#include "geometry/camera.h"

#include <skiagraph/plan.h>

/* The samples of a plan. With spot_count and shifts 1, and zero otherwise: a point, and the centres of the pixels. */
typedef struct {
    skg_spot spot;      /* of shape SKG_SPOT_POINT if there is none */
    int64_t spot_count; /* samples of the source */
    int64_t shifts;     /* samples along each side of a pixel */
    int64_t fine;       /* of these, how many one pass has pixels for: 1, or `shifts` */
} skg_samples;

/* Reads and checks spot (NULL: a point) and supersampling. spot_count is 1 if it has to be found adaptively. */
skg_status skg_samples_make(const skg_spot *spot, int32_t supersampling, skg_samples *samples);

/* Rays of a pixel. */
int64_t skg_samples_count(const skg_samples *samples);

/* Passes of a frame. Each makes fine x fine rays of a pixel, on a detector of as many times finer pixels. */
int64_t skg_samples_passes(const skg_samples *samples);

/* Sample 0 <= index < count of a view: a point of the source, and the shift from the centre of the pixels in
 * columns and rows. The samples of the pixel run fastest. */
void skg_samples_at(const skg_samples *samples, const skg_view *view, int64_t index, double source[3],
                    double shift[2]);

/* The view on the detector of a pass: the same place, fine times the columns and rows. */
void skg_samples_view(const skg_samples *samples, const skg_view *view, skg_view *fine);

/* Makes the camera of pass 0 <= pass < passes. SKG_ERR_SCENE if the view is degenerate. */
skg_status skg_samples_camera(const skg_samples *samples, const skg_view *view, int64_t pass,
                              skg_camera *camera);

#endif
