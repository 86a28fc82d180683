/* Drawn scenes for derivatives: 1 to 9 parts, nested, touching, at one place, of any priority, in any view. */
#ifndef SKG_TESTS_GRADIENTS_DRAWN_H
#define SKG_TESTS_GRADIENTS_DRAWN_H

#include "frame/gradients.h"

/* Draws what a case sets, and makes its scene (frame/gradients.h). */
setting drawn_make(uint64_t *seed);

/* Draws how everything moves. */
direction drawn_direction(const setting *set, uint64_t *seed);

/* Marks pixels in which a face counts that is seen as a line, or nearly: its derivative is that of the mean of the pixel, which differences
 * of images do not have. marked: [PIXELS] */
void drawn_mark_lines(const setting *set, const skg_view *view, uint8_t *marked);

#endif
