/* Curved detectors: where the columns of a cylinder are seen from a source.
 *
 * Column t (an angle) stands on the cylinder at (r sin t, y, r (1 - cos t)) in the axes across, down and towards the cylinder's axis.
 * From a source at the distance D the projection onto the touching plane scales what is at this depth by s = D / (D - r (1 - cos t))
 * about the foot of the source. So a column is a line along the axis, whose pixels are equally far apart, s times their height. */
#include "scene/curve.h"

#include "core/maths.h"

#include <math.h>

/* Radians between the middle and the edge of the detector, at most: columns at a right angle are seen nowhere on the touching plane. */
static const double WIDEST = 75 * SKG_PI / 180;

/* The cosine between columns and rows that counts as 0. */
static const double SQUARE = 1e-9;

void skg_curvature_find(const skg_view *view, const double *source, skg_curvature *curve) {
    double way[3];
    const double width = skg_length(view->column_step), height = skg_length(view->row_step);
    *curve = (skg_curvature){.radius = view->radius,
                             .angle = width / view->radius,
                             .height = height,
                             .parallel = view->projection != SKG_PROJECTION_POINT};
    skg_scale_vector(1 / width, view->column_step, curve->across);
    skg_scale_vector(1 / height, view->row_step, curve->down);
    skg_cross(curve->across, curve->down, curve->normal);
    skg_scale_vector(1 / skg_length(curve->normal), curve->normal, curve->normal);
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(-1, view->source, way);
    else
        for (int k = 0; k < 3; k++) way[k] = (source ? source : view->source)[k] - view->centre[k];
    if (skg_dot(curve->normal, way) < 0) skg_scale_vector(-1, curve->normal, curve->normal);
    curve->distance = skg_dot(curve->normal, way);
    curve->side = skg_dot(curve->across, way);
    curve->along = skg_dot(curve->down, way);
    if (!curve->parallel) return;
    curve->tilt[0] = -curve->side / curve->distance;
    curve->tilt[1] = -curve->along / curve->distance;
    curve->steep = skg_length(way) / curve->distance;
    curve->side = curve->along = 0;
}

skg_curvature_line skg_curvature_line_at(const skg_curvature *curve, double angle) {
    const double r = curve->radius, on = r * sin(angle), half = sin(0.5 * angle), depth = 2 * r * half * half;
    skg_curvature_line line = {.scale = 1, .depth = depth};
    if (curve->parallel) {
        line.place = on + depth * curve->tilt[0];
        line.moved = depth * curve->tilt[1];
        line.facing = (cos(angle) + curve->tilt[0] * sin(angle)) / curve->steep;
        return line;
    }
    line.scale = curve->distance / (curve->distance - depth);
    line.place = curve->side + line.scale * (on - curve->side);
    line.facing = r + (curve->distance - r) * cos(angle) - curve->side * sin(angle);
    return line;
}

skg_status skg_curvature_check(const skg_view *view) {
    enum { ANGLES = 64 };
    skg_curvature curve;
    if (!(view->radius > 0 && view->radius <= 1e9))
        return skg_fail(
            SKG_ERR_SCENE,
            "the radius of the detector is %g mm; give one above 0 and up to 1e9, or 0 of a flat one",
            view->radius);
    const double cosine = skg_dot(view->column_step, view->row_step) /
                          (skg_length(view->column_step) * skg_length(view->row_step));
    if (!(fabs(cosine) <= SQUARE))
        return skg_fail(
            SKG_ERR_SCENE,
            "the rows of a curved detector run along its axis, across its columns; these are %.6g "
            "degrees apart",
            acos(cosine) * 180 / SKG_PI);
    skg_curvature_find(view, NULL, &curve);
    const double edge = 0.5 * curve.angle * (double)view->columns;
    if (!(edge <= WIDEST))
        return skg_fail(
            SKG_ERR_SCENE,
            "%.6g mm of columns on a radius of %.6g mm are %.6g degrees; a curved detector has up to "
            "%g",
            2 * edge * view->radius, view->radius, 2 * edge * 180 / SKG_PI, 2 * WIDEST * 180 / SKG_PI);
    for (int k = 0; k <= ANGLES; k++) {
        const double angle = edge * (2.0 * k / ANGLES - 1);
        const skg_curvature_line line = skg_curvature_line_at(&curve, angle);
        const double before = curve.parallel ? 1 : 1 - line.depth / curve.distance;
        const double faces = curve.parallel ? line.facing : line.facing / curve.distance;
        if (!(before > SQUARE && faces > SQUARE))
            return skg_fail(
                SKG_ERR_SCENE,
                "the curved detector turns away from the source %.3g degrees from its middle; give it a "
                "larger radius, fewer columns, or move it away from the source",
                angle * 180 / SKG_PI);
    }
    return SKG_OK;
}

void skg_view_pixel(const skg_view *view, double column, double row, double place[3]) {
    const double i = column - 0.5 * (double)(view->columns - 1), j = row - 0.5 * (double)(view->rows - 1);
    skg_add_scaled(view->centre, j, view->row_step, place);
    if (!(view->radius > 0)) {
        skg_add_scaled(place, i, view->column_step, place);
        return;
    }
    skg_curvature curve;
    skg_curvature_find(view, NULL, &curve);
    const double angle = i * curve.angle, half = sin(0.5 * angle);
    skg_add_scaled(place, curve.radius * sin(angle), curve.across, place);
    skg_add_scaled(place, 2 * curve.radius * half * half, curve.normal, place);
}
