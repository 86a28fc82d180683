/* The field that jaws leave. */
#include "geometry/optics.h"

#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>

/* A ray that is this near to an edge, in pixels, lies on it: far above the rounding of doubles, far below what shows. */
static const double ON_EDGE = 1e-9;

void skg_collimation_init_sized(void *collimation, int32_t size) {
    const skg_collimation defaults = {0};
    skg_struct_init(collimation, size, &defaults, sizeof defaults);
}

skg_status skg_collimation_check(const skg_collimation *collimation) {
    const char *const axes[2] = {"column", "row"};
    if (collimation->kind < SKG_COLLIMATION_OPEN || collimation->kind > SKG_COLLIMATION_DETECTOR)
        return skg_fail(SKG_ERR_ARGUMENT, "kind %" PRId32 " of a collimation is unknown; SKG_COLLIMATION_...",
                        collimation->kind);
    if (collimation->kind == SKG_COLLIMATION_DETECTOR && !isfinite(collimation->margin_mm))
        return skg_fail(SKG_ERR_SCENE, "the margin of the collimated field is not finite; give mm");
    if (collimation->kind != SKG_COLLIMATION_RECTANGLE) return SKG_OK;
    if (!(collimation->distance_mm > 0 && isfinite(collimation->distance_mm)))
        return skg_fail(SKG_ERR_SCENE,
                        "the jaws stand %g mm from the source; give a distance above 0 and at most that of "
                        "the detector",
                        collimation->distance_mm);
    for (int a = 0; a < 2; a++)
        if (!(isfinite(collimation->low[a]) && isfinite(collimation->high[a]) &&
              collimation->low[a] < collimation->high[a]))
            return skg_fail(
                SKG_ERR_SCENE,
                "the jaws leave %g to %g mm open along the %s step; the second has to exceed the first",
                collimation->low[a], collimation->high[a], axes[a]);
    return SKG_OK;
}

int skg_collimation_limits(const skg_collimation *collimation) {
    if (!collimation || collimation->kind == SKG_COLLIMATION_OPEN) return 0;
    return collimation->kind == SKG_COLLIMATION_RECTANGLE || collimation->margin_mm < 0;
}

/* The detector's rectangle, on its plane. */
static skg_status take_detector(double margin, const skg_view *view, skg_field *field) {
    const double half[2] = {0.5 * (double)view->columns * skg_length(view->column_step) + margin,
                            0.5 * (double)view->rows * skg_length(view->row_step) + margin};
    for (int a = 0; a < 2; a++) {
        if (!(half[a] > 0))
            return skg_fail(
                SKG_ERR_SCENE,
                "a margin of %g mm leaves nothing of the detector, which is %g mm wide and %g mm high",
                margin, 2 * (half[0] - margin), 2 * (half[1] - margin));
        field->low[a] = -half[a];
        field->high[a] = half[a];
    }
    return SKG_OK;
}

/* Moves the centre of the field from the detector to the plane of the jaws. */
static skg_status move_to_jaws(const skg_collimation *collimation, const skg_view *view, skg_field *field) {
    double ray[3], normal[3];
    skg_add_scaled(view->centre, -1, view->source, ray);
    skg_cross(field->column, field->row, normal);
    const double detector = fabs(skg_dot(ray, normal)) / skg_length(normal);
    if (collimation->distance_mm > detector * (1 + 1e-12))
        return skg_fail(
            SKG_ERR_SCENE,
            "the jaws stand %g mm from the source, behind the detector at %g mm; place them before it",
            collimation->distance_mm, detector);
    skg_add_scaled(view->source, collimation->distance_mm / detector, ray, field->centre);
    return SKG_OK;
}

skg_status skg_field_make(const skg_collimation *collimation, const skg_view *view, skg_field *field) {
    const int32_t kind = collimation ? collimation->kind : SKG_COLLIMATION_OPEN;
    *field = (skg_field){0};
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, field->column);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, field->row);
    skg_scale_vector(1, view->centre, field->centre);
    if (kind != SKG_COLLIMATION_RECTANGLE)
        return take_detector(kind == SKG_COLLIMATION_DETECTOR ? collimation->margin_mm : 0, view, field);
    for (int a = 0; a < 2; a++) {
        field->low[a] = collimation->low[a];
        field->high[a] = collimation->high[a];
    }
    return view->projection == SKG_PROJECTION_POINT ? move_to_jaws(collimation, view, field) : SKG_OK;
}

/* Carries a point from the middle of the source to the plane of the detector. */
static void carry(const skg_view *view, double at[3]) {
    double normal[3], ray[3], axis[3];
    skg_cross(view->column_step, view->row_step, normal);
    skg_add_scaled(at, -1, view->source, ray);
    skg_add_scaled(view->centre, -1, view->source, axis);
    skg_add_scaled(view->source, skg_dot(axis, normal) / skg_dot(ray, normal), ray, at);
}

/* Of a curved detector: its own corners. */
static skg_status find_curved_corners(const skg_collimation *collimation, const skg_view *view,
                                      double *corners) {
    if (skg_collimation_limits(collimation))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "the field of jaws before a curved detector is not computed; leave the collimation out");
    for (int corner = 0; corner < 4; corner++)
        skg_view_pixel(view, corner == 1 || corner == 2 ? (double)view->columns - 0.5 : -0.5,
                       corner >= 2 ? (double)view->rows - 0.5 : -0.5, corners + 3 * corner);
    return SKG_OK;
}

skg_status skg_collimation_corners_get(const skg_collimation *collimation, const skg_view *view,
                                       int32_t on_jaws, double *corners) {
    skg_collimation ours;
    skg_field field;
    skg_view seen;
    skg_collimation_init(&ours);
    SKG_PLAIN;
    SKG_NEEDS(view);
    SKG_NEEDS(corners);
    SKG_TRY(skg_view_check(view));
    skg_view_init(&seen);
    SKG_TRY(skg_struct_read(view, "skg_view", &seen, sizeof seen));
    if (collimation) SKG_TRY(skg_struct_read(collimation, "skg_collimation", &ours, sizeof ours));
    SKG_TRY(skg_collimation_check(&ours));
    if (seen.radius > 0) return find_curved_corners(&ours, &seen, corners);
    SKG_TRY(skg_field_make(&ours, view, &field));
    for (int corner = 0; corner < 4; corner++) {
        const double column = corner == 1 || corner == 2 ? field.high[0] : field.low[0];
        const double row = corner >= 2 ? field.high[1] : field.low[1];
        double *at = corners + 3 * corner;
        skg_add_scaled(field.centre, column, field.column, at);
        skg_add_scaled(at, row, field.row, at);
        if (!on_jaws && view->projection == SKG_PROJECTION_POINT) carry(view, at);
    }
    return SKG_OK;
}

/* The first pixel 0 <= i <= count that is not below an edge. */
static int32_t first_from(double edge, int64_t count) {
    const double first = ceil(edge - ON_EDGE);
    return (int32_t)(first > 0 ? (first < (double)count ? first : (double)count) : 0);
}

skg_status skg_field_window(const skg_field *field, const skg_camera *camera, int32_t window[4]) {
    const int64_t count[2] = {camera->columns, camera->rows};
    double low[3], high[3], pixel_low[3], pixel_high[3];
    /* The plane is parallel to the detector, so two opposite corners give the edges in pixels. */
    for (int k = 0; k < 3; k++) {
        low[k] = field->centre[k] + field->low[0] * field->column[k] + field->low[1] * field->row[k];
        high[k] = field->centre[k] + field->high[0] * field->column[k] + field->high[1] * field->row[k];
    }
    skg_camera_see(camera, low, pixel_low);
    skg_camera_see(camera, high, pixel_high);
    if (!camera->parallel && !(pixel_low[2] > 0))
        return skg_fail(SKG_ERR_SCENE,
                        "a sample of the focal spot lies on the jaws or behind them; place the jaws farther "
                        "from the source");
    for (int a = 0; a < 2; a++) {
        const double depth = camera->parallel ? 1 : pixel_low[2];
        window[2 * a] = first_from(pixel_low[a] / depth, count[a]);
        window[2 * a + 1] = first_from(pixel_high[a] / depth, count[a]);
    }
    return SKG_OK;
}
