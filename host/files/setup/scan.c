/* The section Scan. */
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <math.h>
#include <string.h>

/* Projections for which a plan is verified: one every 22.5 degrees of a full turn, so that flat parts along the axes
 * are seen edge-on. */
enum { SAMPLED_VIEWS = 16 };

static const double degree = SKG_PI / 180;

/* Angles of the section, degrees. */
typedef struct {
    double step, final;
    int32_t has_step, has_final, include_last, is_short;
    int64_t count; /* 0: not given */
} angles;

static skg_status read_number(const skg_json_object *object, const char *name, double unit, double *number,
                              int32_t *given) {
    const skg_json_node node = skg_json_member(object, name);
    if (given) *given = node.value != NULL;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_number(&node, number));
    *number *= unit;
    return SKG_OK;
}

static skg_status read_flag(const skg_json_object *object, const char *name, int32_t *flag) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_flag(&node, flag) : SKG_OK;
}

static skg_status read_count(const skg_json_object *object, const char *name, int64_t *count) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_integer(&node, 1, INT32_MAX, count) : SKG_OK;
}

static skg_status read_lengths(const skg_json_object *object, const char *name, const char *example,
                               int64_t count, double *mm) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_lengths(&node, example, count, mm) : SKG_OK;
}

/* The centre may have no unit, as files in use have [0, 0, 0]. */
static skg_status read_rotation(const skg_json_object *object, const skg_view *view, skg_scan_options *scan) {
    static const char *const example = "[0, 0, 0, \"mm\"]";
    const skg_json_node centre = skg_json_member(object, "CentreOfRotation");
    if (json_array_size(centre.value) == 3)
        SKG_TRY(skg_json_numbers(&centre, example, 3, scan->centre));
    else if (centre.value)
        SKG_TRY(skg_json_lengths(&centre, example, 3, scan->centre));
    const skg_json_node axis = skg_json_member(object, "RotationAxis");
    if (axis.value) return skg_json_direction(&axis, scan->axis);
    skg_scale_vector(1 / skg_length(view->row_step), view->row_step, scan->axis);
    return SKG_OK;
}

static skg_status read_detector(const skg_json_object *object, skg_scan_options *scan) {
    const skg_json_node tilt = skg_json_member(object, "DetectorTilt");
    SKG_TRY(read_lengths(object, "DetectorOffset", "[0.2, 0, \"mm\"]", 2, scan->detector_offset_mm));
    SKG_TRY(read_number(object, "DetectorSkew", degree, &scan->detector_skew_rad, NULL));
    if (!tilt.value) return SKG_OK;
    SKG_TRY(skg_json_numbers(&tilt, "[0.5, 0, 0]", 3, scan->detector_tilt_rad));
    for (int k = 0; k < 3; k++) scan->detector_tilt_rad[k] *= degree;
    return SKG_OK;
}

static skg_status read_errors(const skg_json_object *object, skg_scan_options *scan) {
    static const char *const vector = "[0.1, 0, 0, \"mm\"]", *const length = "[0.1, \"mm\"]";
    const skg_json_node drift = skg_json_member(object, "Drift"), jitter = skg_json_member(object, "Jitter");
    skg_json_object errors;
    if (drift.value) {
        SKG_TRY(skg_json_read_object(&drift, &skg_keys_drift, &errors));
        SKG_TRY(read_lengths(&errors, "Source", vector, 3, scan->source_drift_mm));
        SKG_TRY(read_lengths(&errors, "Detector", vector, 3, scan->detector_drift_mm));
    }
    if (!jitter.value) return SKG_OK;
    SKG_TRY(skg_json_read_object(&jitter, &skg_keys_jitter, &errors));
    SKG_TRY(read_lengths(&errors, "Source", length, 1, &scan->source_jitter_mm));
    SKG_TRY(read_lengths(&errors, "Detector", length, 1, &scan->detector_jitter_mm));
    SKG_TRY(read_number(&errors, "Angle", degree, &scan->angle_jitter_rad, NULL));
    const skg_json_node seed = skg_json_member(&errors, "Seed");
    return seed.value ? skg_json_integer(&seed, 0, INT64_MAX, &scan->jitter_seed) : SKG_OK;
}

static skg_status read_angles(const skg_json_object *object, angles *a, skg_scan_options *scan) {
    SKG_TRY(read_count(object, "NumberOfProjections", &a->count));
    SKG_TRY(read_number(object, "StartAngle", degree, &scan->start_rad, NULL));
    SKG_TRY(read_number(object, "AngleStep", 1, &a->step, &a->has_step));
    SKG_TRY(read_number(object, "FinalAngle", 1, &a->final, &a->has_final));
    SKG_TRY(read_flag(object, "IncludeLastAngle", &a->include_last));
    return read_flag(object, "Short", &a->is_short);
}

/* Whether projections differ in time. */
static int is_series(const skg_json_object *object) {
    return skg_json_member(object, "StartTime").value || skg_json_member(object, "Interval").value;
}

/* Without an end of the turn, several projections that nothing else tells apart go once around. */
static skg_status complete_turn(const skg_json_node *node, const skg_json_object *object,
                                const skg_scan_options *scan, angles *a) {
    const int by_count = a->count > 1 && !a->has_step;
    const int by_step = a->count == 0 && a->has_step && a->step != 0;
    if (a->has_final || a->is_short || !(by_count || by_step)) return SKG_OK;
    if (by_count && skg_json_member(object, "SourceTravel").value) return SKG_OK;
    if (by_count && is_series(object))
        return skg_json_remark(node, "has neither FinalAngle nor AngleStep: nothing turns");
    a->has_final = 1;
    a->final = scan->start_rad / degree + (by_step ? copysign(360, a->step) : 360);
    return skg_json_remark(node,
                           by_count ? "has neither FinalAngle nor AngleStep: the projections go once around, "
                                      "FinalAngle %g"
                                    : "has no FinalAngle: the projections go once around, FinalAngle %g",
                           a->final);
}

/* Warns if number, step and final angle contradict each other. */
static skg_status compare_angles(const skg_json_node *node, const skg_scan_options *scan, const angles *a) {
    const int64_t steps = a->count - (a->include_last ? 1 : 0);
    const double start = scan->start_rad / degree, end = start + (double)steps * a->step;
    /* a thousandth of a step, as files round what they write */
    if (a->count == 0 || !a->has_step || !a->has_final || fabs(end - a->final) <= 1e-3 * fabs(a->step))
        return SKG_OK;
    return skg_json_remark(
        node,
        "%lld projections with an AngleStep of %g end at %g degrees, but FinalAngle is %g; "
        "FinalAngle is without effect",
        (long long)a->count, a->step, end, a->final);
}

/* Number of projections and step from what is given. *last: the position at which the rotation ends. */
static skg_status decide_angles(const skg_json_node *node, const skg_view *view, angles *a,
                                skg_scan_options *scan, double *last) {
    double range = a->final * degree - scan->start_rad;
    if (a->is_short) {
        if (a->has_step || a->has_final)
            return skg_json_fail(node, SKG_ERR_FORMAT,
                                 "has Short, which decides the angles; remove AngleStep and FinalAngle");
        SKG_TRY(skg_json_at(node, skg_scan_short_range_get(view, scan, &range)));
        a->include_last = 1;
    }
    if (a->count == 0 && a->has_step && a->has_final && a->step != 0) {
        /* A step that reaches the final angle to within rounding reaches it. */
        const double steps = range / (a->step * degree), whole = floor(steps + 1e-9);
        const int reaches = fabs(steps - whole) <= 1e-9;
        if (steps >= 0 && steps < INT32_MAX)
            a->count = (int64_t)whole + (reaches && !a->include_last ? 0 : 1);
    }
    const int64_t intervals = a->count - (a->include_last ? 1 : 0);
    scan->projections = a->count > 0 ? a->count : 1;
    *last = (double)(scan->projections - 1);
    if (a->has_step) {
        scan->step_rad = a->step * degree;
    } else if (a->has_final || a->is_short) {
        *last = intervals > 0 ? (double)intervals : 1;
        scan->step_rad = range / *last;
    }
    return SKG_OK;
}

/* Lists projections evenly over the whole motion, for which a plan has to hold. */
static skg_status list_views(skg_scan_section *section, double last) {
    if (!(last > 0)) return SKG_OK;
    SKG_TRY(skg_alloc(SAMPLED_VIEWS, sizeof *section->views, "views of a scan", &section->views));
    section->view_count = SAMPLED_VIEWS;
    for (int64_t v = 0; v < SAMPLED_VIEWS; v++) {
        skg_view_init(&section->views[v]);
        SKG_TRY(skg_scan_view_at(section->scan, last * (double)(v + 1) / SAMPLED_VIEWS, &section->views[v]));
    }
    return SKG_OK;
}

/* Steps of a table are those of the image's pixels: it may be one that a scan wrote. */
static skg_status check_steps(const skg_setup *setup, const skg_json_node *node, const skg_scan *scan) {
    skg_view first;
    if (setup->bins[0] * setup->bins[1] == 1) return SKG_OK;
    skg_view_init(&first);
    SKG_TRY(skg_scan_view_get(scan, 0, &first));
    const double has = skg_length(first.column_step), wanted = skg_length(setup->view.column_step);
    if (fabs(has - wanted) <= 0.1 * wanted) return SKG_OK;
    return skg_json_fail(
        node, SKG_ERR_FORMAT,
        "has columns %g mm apart; with Binning a table has the steps of the image's pixels, %g mm", has,
        wanted);
}

/* A table says so if its beam is parallel. */
static skg_status check_beam(const skg_view *own, const char *path, const skg_scan *scan) {
    skg_view of_table;
    skg_view_init(&of_table);
    SKG_TRY(skg_scan_view_get(scan, 0, &of_table));
    if (of_table.projection == own->projection) return SKG_OK;
    return skg_fail(SKG_ERR_SCENE, "%s: the poses are of a parallel beam%s, which the Source is not; %s",
                    path,
                    of_table.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY ? " from infinity" : "",
                    of_table.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY
                        ? "give it the Shape ParallelBeam and a Direction"
                        : "give it the Shape ParallelBeam and a Position");
}

/* A table of poses: a file, or the rows themselves. */
static skg_status make_table(skg_setup_reader *reader, const skg_json_node *node,
                             const skg_scan_options *options, skg_scan **scan) {
    const skg_view *view = &reader->setup->view;
    const char *text = NULL, *path = NULL;
    double *poses = NULL;
    int64_t count = 0;
    if (!json_is_array(node->value)) {
        SKG_TRY(skg_json_text(node, &text));
        SKG_TRY(skg_setup_find_file(reader, text, &path));
        SKG_TRY(skg_json_at(node, skg_scan_load_table(view, options, path, scan)));
        SKG_TRY(skg_json_at(node, check_beam(view, path, *scan)));
        return check_steps(reader->setup, node, *scan);
    }
    skg_status status = skg_setup_read_rows(node, 12, "rows of 12 numbers", &count, &poses);
    if (status == SKG_OK)
        status = skg_json_at(node, skg_scan_create_table(view, options, count, poses, scan));
    skg_free(&poses);
    return status == SKG_OK ? check_steps(reader->setup, node, *scan) : status;
}

/* The poses as a reconstruction knows them. */
static skg_status make_known(skg_setup_reader *reader, const skg_json_node *node,
                             const skg_scan_options *options) {
    skg_scan_section *section = &reader->setup->scan;
    int64_t count = 0, known = 0;
    SKG_TRY(make_table(reader, node, options, &section->known));
    SKG_TRY(skg_scan_projection_count(section->scan, &count));
    SKG_TRY(skg_scan_projection_count(section->known, &known));
    if (known == count) return SKG_OK;
    return skg_json_fail(node, SKG_ERR_FORMAT, "has %lld poses, but the scan has %lld projections",
                         (long long)known, (long long)count);
}

static skg_status make_scan(skg_setup_reader *reader, const skg_json_node *node, const skg_json_node *table,
                            angles *a, skg_scan_options *options) {
    skg_setup *setup = reader->setup;
    double last = 0;
    if (table->value) {
        int64_t count = 0;
        if (a->has_step) options->step_rad = a->step * degree;
        SKG_TRY(make_table(reader, table, options, &setup->scan.scan));
        SKG_TRY(skg_scan_projection_count(setup->scan.scan, &count));
        if (a->count > 0 && a->count != count)
            return skg_json_fail(table, SKG_ERR_FORMAT, "has %lld poses, but NumberOfProjections is %lld",
                                 (long long)count, (long long)a->count);
        setup->scan.has_count = 1;
        last = (double)(count - 1);
    } else {
        SKG_TRY(decide_angles(node, &setup->view, a, options, &last));
        setup->scan.has_count = a->count > 0;
        SKG_TRY(skg_json_at(node, skg_scan_create(&setup->view, options, &setup->scan.scan)));
        if (options->step_rad == 0 && !(skg_length(options->source_travel_mm) > 0)) last = 0;
    }
    SKG_TRY(list_views(&setup->scan, last));
    return skg_scan_view_get(setup->scan.scan, 0, &setup->view);
}

skg_status skg_setup_read_scan(skg_setup_reader *reader, const skg_json_node *node) {
    skg_scan_section *scan = &reader->setup->scan;
    skg_scan_options options;
    skg_json_object object;
    angles a = {0};
    skg_scan_options_init(&options);
    SKG_TRY(skg_json_read_object(node, &skg_keys_scan, &object));
    SKG_TRY(read_rotation(&object, &reader->setup->view, &options));
    SKG_TRY(read_angles(&object, &a, &options));
    SKG_TRY(read_lengths(&object, "Pitch", "[20, \"mm\"]", 1, &options.pitch_mm));
    SKG_TRY(read_lengths(&object, "SourceTravel", "[200, 0, 0, \"mm\"]", 3, options.source_travel_mm));
    SKG_TRY(read_flag(&object, "FixedDetector", &options.detector_fixed));
    SKG_TRY(read_detector(&object, &options));
    SKG_TRY(read_errors(&object, &options));
    SKG_TRY(read_number(&object, "StartTime", 1, &options.start_s, NULL));
    SKG_TRY(read_number(&object, "Interval", 1, &options.interval_s, NULL));
    SKG_TRY(read_number(&object, "Exposure", 1, &options.exposure_s, NULL));
    SKG_TRY(read_count(&object, "NumberOfWhiteImages", &scan->white_images));
    SKG_TRY(read_flag(&object, "Flat-Field Correction", &scan->flat_field));
    const skg_json_node folder = skg_json_member(&object, "OutFolder"),
                        table = skg_json_member(&object, "Table"),
                        known = skg_json_member(&object, "KnownTable");
    if (folder.value) {
        const char *text = NULL;
        SKG_TRY(skg_json_text(&folder, &text));
        SKG_TRY(skg_setup_resolve(reader, text, &scan->folder));
    }
    if (!table.value) SKG_TRY(complete_turn(node, &object, &options, &a));
    if (!table.value) SKG_TRY(compare_angles(node, &options, &a));
    SKG_TRY(make_scan(reader, node, &table, &a, &options));
    if (known.value) SKG_TRY(make_known(reader, &known, &options));
    return skg_setup_read_record(reader, &object);
}

void skg_scan_section_free(skg_scan_section *section) {
    skg_scan_release(&section->scan);
    skg_free(&section->folder);
    skg_free(&section->views);
    skg_scan_release(&section->known);
    skg_free(&section->intensities);
    skg_free(&section->moving);
    skg_free(&section->poses);
}
