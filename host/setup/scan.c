/* The section Scan. */
#include "core/maths.h"
#include "core/vector.h"
#include "setup/sections.h"

#include <math.h>
#include <string.h>

/* Projections for which a plan is verified: one every 22.5 degrees of a full turn, so that flat parts along the axes
 * are seen edge-on. */
enum { SAMPLED_VIEWS = 16 };

static const skg_json_key scan_keys[] = {
    {"NumberOfProjections", NULL, SKG_KEY_READ},
    {"AngleStep", NULL, SKG_KEY_READ},
    {"StartAngle", NULL, SKG_KEY_READ},
    {"FinalAngle", NULL, SKG_KEY_READ},
    {"IncludeLastAngle", NULL, SKG_KEY_READ},
    {"IncludeFinalAngle", "IncludeLastAngle", SKG_KEY_READ},
    {"Flat-Field Correction", NULL, SKG_KEY_READ},
    {"NumberOfWhiteImages", NULL, SKG_KEY_READ},
    {"CentreOfRotation", NULL, SKG_KEY_READ},
    {"CenterOfRotation", "CentreOfRotation", SKG_KEY_READ},
    {"RotationAxis", NULL, SKG_KEY_READ},
    {"OutFolder", NULL, SKG_KEY_READ},
    {"GifPath", NULL, SKG_KEY_IGNORED},
};

static skg_status read_angle(const skg_json_object *object, const char *name, double *degrees,
                             int32_t *given) {
    skg_json_node node = skg_json_member(object, name);
    *given = node.value != NULL;
    return *given ? skg_json_number(&node, degrees) : SKG_OK;
}

static skg_status read_flag(const skg_json_object *object, const char *name, int32_t *flag) {
    skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_flag(&node, flag) : SKG_OK;
}

static skg_status read_count(const skg_json_object *object, const char *name, int64_t *count) {
    skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_integer(&node, 1, INT32_MAX, count) : SKG_OK;
}

/* The centre may have no unit, as files in use have [0, 0, 0]. */
static skg_status read_rotation(const skg_json_object *object, const skg_view *view, skg_scan_section *scan) {
    static const char *const example = "[0, 0, 0, \"mm\"]";
    skg_json_node centre = skg_json_member(object, "CentreOfRotation");
    if (json_array_size(centre.value) == 3)
        SKG_TRY(skg_json_numbers(&centre, example, 3, scan->centre));
    else if (centre.value)
        SKG_TRY(skg_json_lengths(&centre, example, 3, scan->centre));
    skg_json_node axis = skg_json_member(object, "RotationAxis");
    if (axis.value) return skg_json_direction(&axis, scan->axis);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, scan->axis);
    return SKG_OK;
}

/* Turns source and detector back by an angle, which looks the same as samples turned by it. */
static void turn_view(skg_view *view, const skg_scan_section *scan, double degrees) {
    double turn[16];
    skg_pose_rotation(-degrees * (SKG_PI / 180), scan->axis, turn);
    double *points[] = {view->source, view->centre}, *steps[] = {view->column_step, view->row_step};
    for (int k = 0; k < 2; k++) {
        int is_point = k == 1 || view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY;
        if (is_point) skg_add_scaled(points[k], -1, scan->centre, points[k]);
        skg_pose_point(turn, points[k], points[k]);
        if (is_point) skg_add_scaled(points[k], 1, scan->centre, points[k]);
        skg_pose_point(turn, steps[k], steps[k]);
    }
}

/* Lists projections evenly over the whole rotation, for which a plan has to hold. */
static skg_status list_views(skg_scan_section *scan, const skg_view *first) {
    const double turns = scan->has_step && scan->projections > 0
                             ? scan->step * (double)(scan->projections - 1)
                         : scan->has_final ? scan->final - scan->start
                                           : 0;
    if (turns == 0) return SKG_OK;
    SKG_TRY(skg_alloc(SAMPLED_VIEWS, sizeof *scan->views, "views of a scan", &scan->views));
    scan->view_count = SAMPLED_VIEWS;
    for (int64_t v = 0; v < SAMPLED_VIEWS; v++) {
        scan->views[v] = *first;
        turn_view(&scan->views[v], scan, turns * (double)(v + 1) / SAMPLED_VIEWS);
    }
    return SKG_OK;
}

int64_t skg_scan_section_count(const skg_scan_section *scan) {
    if (scan->projections > 0) return scan->projections;
    if (!scan->has_step || !scan->has_final || scan->step == 0) return 0;
    /* A step that reaches the final angle to within rounding reaches it. */
    const double steps = (scan->final - scan->start) / scan->step, whole = floor(steps + 1e-9);
    if (!(steps >= 0 && steps < INT32_MAX)) return 0;
    const int reaches = fabs(steps - whole) <= 1e-9;
    return (int64_t)whole + (reaches && !scan->include_last ? 0 : 1);
}

skg_status skg_setup_read_scan(skg_setup_reader *reader, const skg_json_node *node) {
    skg_scan_section *scan = &reader->setup->scan;
    skg_json_object object;
    int32_t has_start = 0;
    SKG_TRY(skg_json_read_object(node, scan_keys, sizeof scan_keys / sizeof *scan_keys, &object));
    scan->present = 1;
    SKG_TRY(read_count(&object, "NumberOfProjections", &scan->projections));
    SKG_TRY(read_count(&object, "NumberOfWhiteImages", &scan->white_images));
    SKG_TRY(read_angle(&object, "StartAngle", &scan->start, &has_start));
    SKG_TRY(read_angle(&object, "AngleStep", &scan->step, &scan->has_step));
    SKG_TRY(read_angle(&object, "FinalAngle", &scan->final, &scan->has_final));
    SKG_TRY(read_flag(&object, "IncludeLastAngle", &scan->include_last));
    SKG_TRY(read_flag(&object, "Flat-Field Correction", &scan->flat_field));
    SKG_TRY(read_rotation(&object, &reader->setup->view, scan));
    skg_json_node folder = skg_json_member(&object, "OutFolder");
    if (folder.value) {
        const char *text = NULL;
        SKG_TRY(skg_json_text(&folder, &text));
        SKG_TRY(skg_setup_resolve(reader, text, &scan->folder));
    }
    if (scan->start != 0) turn_view(&reader->setup->view, scan, scan->start);
    return list_views(scan, &reader->setup->view);
}
