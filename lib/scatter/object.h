/* What stands in the beam, as cells. Private. */
#ifndef SKG_SCATTER_OBJECT_H
#define SKG_SCATTER_OBJECT_H

#include "plan/recipe.h"
#include "scatter/cells.h"

/* A frame's scene. */
typedef struct {
    const skg_recipe *recipe;
    const skg_view *view;
    const double *const *poses; /* [parts] each NULL for the scene's; NULL: all the scene's */
    const double *density;      /* [parts] over that of the material; NULL: 1 */
    const double *fill;         /* [parts] share of the part that is there; NULL: 1 */
    uint64_t seed;              /* added to that of the options */
} skg_scatter_work;

/* The pose of a part. */
const double *skg_scatter_pose(const skg_scatter_work *work, int64_t part);

typedef struct {
    skg_scatter_physics physics;    /* of the materials of parts and world */
    double world[SKG_SCATTER_RANK]; /* coefficients of the world; 0: vacuum */
    skg_cells cells;
} skg_scatter_object;

/* Makes both. Free the object also after a failure. */
skg_status skg_scatter_object_make(const skg_scatter_work *work, skg_scatter_object *object);
void skg_scatter_object_free(skg_scatter_object *object);

#endif
