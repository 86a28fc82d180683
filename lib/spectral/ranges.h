/* Which lengths of materials the rays of a view meet: a coarse L-buffer in double, on the host. Private. */
#ifndef SKG_RANGES_H
#define SKG_RANGES_H

#include "spectral/model.h"

typedef struct {
    int32_t planes, reserved;
    int64_t rays;
    double *lengths; /* [rays][planes] what a ray adds to the planes, mm times weight */
    double *low;  /* [planes] mm: range with a margin of a quarter, and a fiftieth of it below; 0 or less */
    double *high; /* [planes] mm */
    double *hits; /* [parts] mean per ray of the first view */
    double way;   /* of the world: what the longest ray without parts adds to its plane; 0: vacuum */
} skg_ranges;

/* Rays to 64 x 64 places over the view's detector, to 24 x 24 over that of each of `more` others, and to
 * 16 x 16 over each part's own rectangle, so that small parts are met; a part that a view does not show
 * counts with the longest edge of its box. model: its planes and contributions. */
skg_status skg_ranges_find(const skg_scene *scene, const skg_view *view, int64_t more, const skg_view *views,
                           const skg_model *model, skg_ranges *ranges);
void skg_ranges_release(skg_ranges *ranges);

#endif
