/* What a frame is to show. Private. */
#ifndef SKG_WORK_H
#define SKG_WORK_H

#include "stage/attenuate.h"

typedef struct {
    const skg_view *view;
    const double *const *poses; /* [parts] each NULL for the scene's; NULL: all the scene's */
    const skg_mesh *meshes;     /* [meshes] of the recipe, as the device has them; NULL: the scene's */
    const skg_frame *frame;     /* the caller's, for its overrides; NULL: none */
    int64_t lengths_of;         /* a part whose lengths are wanted, or -1: an image */
    int32_t
        kind; /* of lengths: SKG_LENGTHS_NET or SKG_LENGTHS_SURFACE; of a component of the scatter: which */
    int32_t shows; /* enum skg_output_kind */
    int32_t
        reuses; /* 1: sums that stand from the frame before, if it was the same one, are not drawn again */
    int64_t step, each;   /* of an image: which step is made, of so many passes; each: 0: all its passes */
    skg_noise_args noise; /* its key */
    skg_image_place place;
} skg_frame_work;

#endif
