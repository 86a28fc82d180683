/* Where rays start and end: samples of the focal spot and of the pixel. Private. */
#ifndef SKG_SAMPLES_H
#define SKG_SAMPLES_H

#include "core/core.h"

#include <skiagraph/plan.h>

/* Samples of one plan; all zero with spot_count and shifts 1: a point and the pixel's centre. */
typedef struct {
    skg_spot spot;      /* shape SKG_SPOT_POINT where there is none */
    int64_t spot_count; /* samples of the source */
    int64_t shifts;     /* per side of a pixel */
} skg_samples;

/* Checks and reads spot (NULL: a point) and supersampling. spot_count is 1 where it is still to be found out.
 */
skg_status skg_samples_make(const skg_spot *spot, int32_t supersampling, skg_samples *samples);

/* Passes of a frame. */
int64_t skg_samples_count(const skg_samples *samples);

/* Sample 0 <= index < count of a view: a point of the source, and the shift of the pixels in columns and
 * rows. Those of the pixel run fastest. */
void skg_samples_at(const skg_samples *samples, const skg_view *view, int64_t index, double source[3],
                    double shift[2]);

#endif
