/* The ends of rays: samples of the focal spot and of the pixel. Private. */
#ifndef SKG_SAMPLES_H
#define SKG_SAMPLES_H

#include "core/core.h"

#include <skiagraph/plan.h>

/* The samples of a plan. With spot_count and shifts 1, and zero otherwise: a point, and the centres of the pixels. */
typedef struct {
    skg_spot spot;      /* of shape SKG_SPOT_POINT if there is none */
    int64_t spot_count; /* samples of the source */
    int64_t shifts;     /* samples along each side of a pixel */
} skg_samples;

/* Reads and checks spot (NULL: a point) and supersampling. spot_count is 1 if it has to be found adaptively. */
skg_status skg_samples_make(const skg_spot *spot, int32_t supersampling, skg_samples *samples);

/* The passes of a frame. */
int64_t skg_samples_count(const skg_samples *samples);

/* Sample 0 <= index < count of a view: a point of the source, and the shift from the centre of the pixels in
 * columns and rows. The samples of the pixel run fastest. */
void skg_samples_at(const skg_samples *samples, const skg_view *view, int64_t index, double source[3],
                    double shift[2]);

#endif
