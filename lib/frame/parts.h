/* What the parts of one pass contribute and where they lie. Private. */
#ifndef SKG_FRAME_PARTS_H
#define SKG_FRAME_PARTS_H

#include "frame/work.h"
#include "plan/recipe.h"
#include "stage/pass.h"

/* Fills a pass, but for its raster. number: of the passes that samples of source and pixel need; below 0: the point source and
 * the pixels' centres. The pass borrows memory; release it with skg_pass_release, also after a failure. */
skg_status skg_pass_fill(const skg_recipe *recipe, const skg_frame_work *work, int64_t number,
                         const skg_pass_memory *memory, skg_pass *pass);

/* Widens the extents of the raster's planes, [planes][4], all 0 before, to what those of their parts cover. */
void skg_pass_extents(const skg_pass *pass, cl_int *extents);

#endif
