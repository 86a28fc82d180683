/* The section Detector. */
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <math.h>
#include <string.h>

/* Size and Spacing may both be given if they agree; if they do not, that is a fault, and Spacing holds. */
static skg_status compare_size(const skg_json_node *node, const skg_view *view, const double *spacing) {
    /* Exporters write six digits. */
    const double alike = 1e-5, pixels[2] = {(double)view->columns, (double)view->rows};
    double size[2];
    SKG_TRY(skg_json_lengths(node, "[width, height, \"mm\"]", 2, size));
    for (int k = 0; k < 2; k++)
        if (!(fabs(size[k] - pixels[k] * spacing[k]) <= alike * fabs(size[k])))
            return skg_json_fault(
                node, SKG_ERR_FORMAT,
                "Size is %g x %g mm, but Spacing and NumberOfPixels make %g x %g mm; give one "
                "of them (read leniently, Spacing holds)",
                size[0], size[1], pixels[0] * spacing[0], pixels[1] * spacing[1]);
    return SKG_OK;
}

/* Width and height of a pixel in mm, from Spacing or Size. */
static skg_status read_spacing(const skg_json_object *detector, const skg_view *view, double *spacing) {
    skg_json_node given = skg_json_member(detector, "Spacing"), size = skg_json_member(detector, "Size");
    if (!given.value && !size.value)
        return skg_json_fail(detector->node, SKG_ERR_FORMAT,
                             "Size is missing; give \"Size\": [400, 400, \"mm\"] or \"Spacing\": [0.5, 0.5, "
                             "\"mm\"]");
    const skg_json_node *node = given.value ? &given : &size;
    SKG_TRY(skg_json_lengths(node, "[width, height, \"mm\"]", 2, spacing));
    if (!(spacing[0] > 0 && spacing[1] > 0))
        return skg_json_fail(node, SKG_ERR_SCENE,
                             "the detector has no size: %g mm wide and %g mm high; both have to be above 0",
                             spacing[0], spacing[1]);
    if (given.value && size.value) return compare_size(&size, view, spacing);
    if (size.value) spacing[0] /= (double)view->columns, spacing[1] /= (double)view->rows;
    return SKG_OK;
}

static skg_status read_pixels(const skg_json_object *detector, skg_view *view) {
    skg_json_node node;
    double pixels[2];
    SKG_TRY(skg_json_need(detector, "NumberOfPixels", "[columns, rows]", &node));
    SKG_TRY(skg_json_numbers(&node, "[columns, rows]", 2, pixels));
    for (int64_t k = 0; k < 2; k++) {
        skg_json_node element = skg_json_element(&node, k);
        int64_t *count = k == 0 ? &view->columns : &view->rows;
        /* skg_view_check reports the limits of a view. */
        SKG_TRY(skg_json_integer(&element, INT32_MIN, INT32_MAX, count));
    }
    return SKG_OK;
}

/* The directions in which the column and the row number grow. */
static skg_status read_axes(const skg_json_object *detector, const skg_view *view, double *right,
                            double *up) {
    skg_json_node node;
    SKG_TRY(skg_json_need(detector, "UpVector", "[0, 0, -1]", &node));
    SKG_TRY(skg_json_direction(&node, up));
    skg_json_node right_node = skg_json_member(detector, "RightVector");
    if (right_node.value) return skg_json_direction(&right_node, right);
    double towards_source[3];
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(-1, view->source, towards_source);
    else
        skg_add_scaled(view->source, -1, view->centre, towards_source);
    skg_cross(up, towards_source, right);
    const double distance = skg_length(towards_source);
    if (!(distance > 0 &&
          distance < HUGE_VAL)) { /* the source is wrong; skg_view_check says how, for any right */
        const int has_x = fabs(up[2]) > fabs(up[0]);
        const double other[3] = {has_x, 0, !has_x};
        skg_cross(up, other, right);
        skg_scale_vector(1 / skg_length(right), right, right);
        return SKG_OK;
    }
    double length = skg_length(right);
    if (!(length > 1e-9 * distance)) /* sine of the angle between both; rounding is 1e-16 */
        return skg_json_fail(&node, SKG_ERR_SCENE,
                             "points along the beam, so it does not define where right is; give RightVector");
    skg_scale_vector(1 / length, right, right);
    return SKG_OK;
}

static skg_status read_oversampling(const skg_json_object *detector, int32_t *rays) {
    skg_json_node node = skg_json_member(detector, "Oversampling");
    int64_t side = 1;
    if (node.value) SKG_TRY(skg_json_integer(&node, 1, 16, &side));
    *rays = (int32_t)side;
    return SKG_OK;
}

static skg_status read_object(const skg_json_node *node, skg_json_object *detector) {
    *detector = (skg_json_object){node, &skg_keys_detector};
    return node->value ? skg_json_read_object(node, &skg_keys_detector, detector) : SKG_OK;
}

skg_status skg_setup_is_fitted(const skg_json_node *node, int32_t *fitted) {
    skg_json_object detector;
    SKG_TRY(read_object(node, &detector));
    *fitted = skg_json_member(&detector, "Position").value == NULL;
    return SKG_OK;
}

/* ColumnStep and RowStep, instead of the directions and sizes of a pixel. *given: 0 where there is neither. */
static skg_status read_steps(const skg_json_object *detector, skg_view *view, int32_t *given) {
    static const char *const others[] = {"UpVector", "RightVector", "Size", "Spacing"};
    static const char *const example = "[0.5, 0, 0, \"mm\"]";
    skg_json_node column = skg_json_member(detector, "ColumnStep"),
                  row = skg_json_member(detector, "RowStep");
    *given = column.value || row.value;
    if (!*given) return SKG_OK;
    for (int k = 0; k < 4; k++) {
        const skg_json_node other = skg_json_member(detector, others[k]);
        if (other.value)
            return skg_json_fail(&other, SKG_ERR_FORMAT,
                                 "ColumnStep and RowStep say it already; leave %s out", others[k]);
    }
    SKG_TRY(skg_json_need(detector, "ColumnStep", example, &column));
    SKG_TRY(skg_json_need(detector, "RowStep", "[0, 0, -0.5, \"mm\"]", &row));
    SKG_TRY(skg_json_lengths(&column, example, 3, view->column_step));
    return skg_json_lengths(&row, "[0, 0, -0.5, \"mm\"]", 3, view->row_step);
}

static skg_status place(const skg_json_object *detector, const skg_json_node *position, skg_view *view) {
    double right[3], up[3], spacing[2];
    int32_t steps = 0;
    SKG_TRY(skg_json_lengths(position, "[0, 500, 0, \"mm\"]", 3, view->centre));
    SKG_TRY(read_pixels(detector, view));
    if (view->columns < 1 || view->rows < 1) { /* before Size is divided by them */
        skg_status status = skg_view_check(view);
        return skg_json_at(detector->node, status);
    }
    SKG_TRY(read_steps(detector, view, &steps));
    if (steps) return SKG_OK;
    SKG_TRY(read_spacing(detector, view, spacing));
    SKG_TRY(read_axes(detector, view, right, up));
    skg_scale_vector(spacing[0], right, view->column_step);
    skg_scale_vector(spacing[1], up, view->row_step);
    return SKG_OK;
}

/* The number of pixels may be given. */
static skg_status fit(skg_setup_reader *reader, const skg_json_object *detector) {
    skg_view *view = &reader->setup->view;
    view->columns = view->rows = 0;
    if (skg_json_member(detector, "NumberOfPixels").value) {
        SKG_TRY(read_pixels(detector, view));
        if (view->columns < 1 || view->rows < 1) {
            skg_status status = skg_view_check(view);
            return skg_json_at(detector->node, status);
        }
    }
    double spacing[2];
    const int sized = skg_json_member(detector, "Size").value || skg_json_member(detector, "Spacing").value;
    if (!sized || !(reader->detector_mm > 0)) return skg_setup_fit_view(reader, detector, NULL);
    if (view->columns < 1) SKG_TRY(read_pixels(detector, view));
    SKG_TRY(read_spacing(detector, view, spacing));
    return skg_setup_fit_view(reader, detector, spacing);
}

/* The cylinder on which the columns stand. Its pixels keep their sizes. */
static skg_status read_curved(const skg_json_object *detector, skg_view *view) {
    static const char *const axes[] = {"columns"};
    const skg_json_node node = skg_json_member(detector, "Curved");
    skg_json_object curved;
    skg_json_node radius;
    int64_t axis = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_read_object(&node, &skg_keys_curved, &curved));
    SKG_TRY(skg_json_need(&curved, "Radius", "[1000, \"mm\"]", &radius));
    SKG_TRY(skg_json_lengths(&radius, "[1000, \"mm\"]", 1, &view->radius));
    if (!(view->radius > 0))
        return skg_json_fail(&radius, SKG_ERR_SCENE,
                             "a cylinder of radius %g mm; give one above 0, or leave Curved out",
                             view->radius);
    const skg_json_node along = skg_json_member(&curved, "Axis");
    return along.value ? skg_json_choice(&along, "Axis", axes, 1, &axis) : SKG_OK;
}

skg_status skg_setup_read_detector(skg_setup_reader *reader, const skg_json_node *node) {
    skg_view *view = &reader->setup->view;
    skg_json_object detector;
    SKG_TRY(read_object(node, &detector));
    const skg_json_node position = skg_json_member(&detector, "Position");
    if (!position.value)
        SKG_TRY(fit(reader, &detector));
    else if (reader->has_side)
        return skg_json_fail(
            &position, SKG_ERR_FORMAT,
            "Source.From is a side, from which source and detector are placed together; leave out "
            "Detector.Position, or give Source.Position");
    else
        SKG_TRY(place(&detector, &position, view));
    SKG_TRY(read_curved(&detector, view));
    SKG_TRY(read_oversampling(&detector, &reader->setup->supersampling));
    SKG_TRY(skg_setup_read_counting(reader, &detector));
    SKG_TRY(skg_setup_read_response(reader, &detector));
    SKG_TRY(skg_setup_read_grid(reader, &detector));
    SKG_TRY(skg_setup_read_blur(reader, &detector));
    SKG_TRY(skg_setup_read_grey_values(reader, &detector));
    SKG_TRY(skg_setup_read_binning(reader, &detector));
    skg_status status = skg_view_check(view);
    SKG_TRY(skg_json_at(node, status));
    return SKG_OK;
}
