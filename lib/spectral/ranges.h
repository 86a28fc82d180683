/* The lengths of materials that the rays of a view meet: a coarse L-buffer in double, made on the host. Private. */
#ifndef SKG_RANGES_H
#define SKG_RANGES_H

#include "spectral/model.h"
#include "spectral/tracer.h"

typedef struct {
    int32_t planes, reserved; /* planes, then shades, which the caller fills */
    int64_t rays;
    double *lengths; /* [rays][planes] what a ray adds to the planes, mm times weight */
    double
        *low; /* [planes] mm, 0 or less; with a margin of a quarter, and a fiftieth of the range below it */
    double *high; /* [planes] mm */
    double *hits; /* [parts] mean per ray of the first view */
    double way;   /* what the longest ray without parts adds to the plane of the world; 0: vacuum */
} skg_ranges;

/* Traces rays to 64 x 64 points of the view's detector, to 24 x 24 of that of each of `more` other views, and to
 * 16 x 16 points of each part's own rectangle, so that small parts are met. A part that a view does not show
 * counts with the longest edge of its box. Of the model, planes and contributions are used. */
skg_status skg_ranges_find(const skg_scene *scene, const skg_view *view, int64_t more, const skg_view *views,
                           const skg_model *model, skg_ranges *ranges);
void skg_ranges_release(skg_ranges *ranges);

/* What the longest path may exceed the longest that was traced by. */
#define SKG_TRACED_MARGIN 1.25

/* One part along the rays of a view. */
typedef struct {
    int64_t part;
    const double *lengths; /* [SKG_TRACED_SIDE][SKG_TRACED_SIDE] mm */
    double longest;        /* mm, the longest that was found */
    double deepest;        /* mm, its extent along the rays, at most */
    double farthest;       /* mm from the source, at most */
    int32_t met;           /* surfaces on a ray, at most */
} skg_trace;
typedef void skg_take_trace(void *user, const skg_trace *trace);

/* Traces rays over the view's detector through each part that contributes to a plane and is seen.
 *
 * wanted   [parts] 1: this part is traced; NULL: all are */
skg_status skg_ranges_trace(const skg_scene *scene, const skg_view *view, const skg_model *model,
                            const unsigned char *wanted, skg_take_trace *take, void *user);

#endif
