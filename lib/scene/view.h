/* What is checked and derived of a view. Private. */
#ifndef SKG_VIEW_H
#define SKG_VIEW_H

#include "core/core.h"

#include <skiagraph/scene.h>

/* Direction of a parallel beam, length 1; 0 where it has none. */
int skg_view_direction(const skg_view *view, double *direction);

#endif
