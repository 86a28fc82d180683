/* Curved detectors: columns at equal angles on a cylinder. Private. */
#ifndef SKG_CURVE_H
#define SKG_CURVE_H

#include "core/core.h"

#include <skiagraph/scene.h>

/* A curved detector as a source sees it. Columns are seen on the plane that touches the cylinder in the middle of the detector, as
 * lines along the cylinder's axis. */
typedef struct {
    double radius; /* mm; 0: the detector is flat, and nothing else counts */
    double across[3], down[3],
        normal[3];        /* unit vectors: columns grow, rows grow, from the middle towards the axis */
    double angle, height; /* from one column to the next; mm from one row to the next */
    double distance;      /* mm from the touching plane to the source */
    /* mm from the detector's middle to the foot of the source, along `across` and `down` */
    double side, along;
    /* parallel beam: mm along `across` and `down` that rays go for each mm towards the plane */
    double tilt[2];
    double steep; /* parallel beam: mm of a ray for each mm towards the plane */
    int32_t parallel, reserved;
} skg_curvature;

/* A column on the touching plane. */
typedef struct {
    double place; /* mm from the detector's middle along `across` */
    double scale; /* of distances from the foot of the source along `down`; parallel beam: 1 */
    double moved; /* parallel beam: mm by which rows are moved along `down` */
    double depth; /* mm from the touching plane to the column's pixels */
    /* mm from the plane that touches the cylinder at the column to the source; parallel beam: the cosine of incidence */
    double facing;
} skg_curvature_line;

/* The curve of a view whose radius is above 0. source: another point to look from; NULL: that of the view. The detector's columns and
 * rows have a length, and are not parallel. */
void skg_curvature_find(const skg_view *view, const double *source, skg_curvature *curve);

/* The line at an angle from the middle, in radians. */
skg_curvature_line skg_curvature_line_at(const skg_curvature *curve, double angle);

/* Fails with SKG_ERR_SCENE unless every column of the view faces the source. */
skg_status skg_curvature_check(const skg_view *view);

/* The centre of a pixel, mm, of a flat detector, too; column and row may be any numbers. */
void skg_view_pixel(const skg_view *view, double column, double row, double place[3]);

#endif
