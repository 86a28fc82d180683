/* Boxes of which a ray meets a known length: the solids that devices are tested with. Private. */
#ifndef SKG_BOXES_H
#define SKG_BOXES_H

#include "core/context.h"

#include <skiagraph/mesh.h>

typedef struct {
    double centre[3], half[3]; /* mm; half edges along its axes */
    double axes[9];            /* [axis][x, y, z], orthonormal and right-handed */
} skg_box;

/* A box whose axes are turned by three angles, so that no face lies along a ray. */
skg_box skg_box_turned(const double *centre, const double *half, const double *angles);

/* Corner `number` of 8 has the signs of its bits: bit 0 for the first axis, 1 for the second, 2 for the third. */
void skg_box_corner(const skg_box *box, int number, double *position);

/* Closed surfaces of boxes, in one mesh. split: the first box's first edge has a corner in its middle that only one of
 * its two faces knows. The shape is the same, but the mesh counts as leaky. */
skg_status skg_boxes_mesh(skg_context *context, const skg_box *boxes, int64_t count, int32_t split,
                          skg_mesh **mesh);

/* Where the way from one point to another enters and leaves a box, as fractions of it. 0: it misses the box. */
int skg_box_crossed(const skg_box *box, const double *from, const double *to, double *enters, double *leaves);

#endif
