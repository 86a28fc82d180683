/* Surfaces that fold over themselves. Private. */
#ifndef SKG_FOLD_H
#define SKG_FOLD_H

#include "core/core.h"
#include "mesh/mesh.h"

/* Finds the facets of a closed surface that meet facets other than their neighbours. *count: how many. fold: 1 or 0
 * per triangle. moved: only facets with a vertex marked here are tested; NULL: all. */
skg_status skg_shape_folds(const skg_mesh_arrays *arrays, const char *moved, int64_t *count, char *fold);

/* Smooths a surface where it folds over itself, until it does not, in at most 60 passes. */
skg_status skg_shape_unfold(const char *name, const skg_mesh_arrays *arrays);

#endif
