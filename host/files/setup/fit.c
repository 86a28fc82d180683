/* Source and detector that a scene leaves out: placed and sized by its parts. */
#include "core/context.h"
#include "core/maths.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>

/* Pixels along the longer side of a detector that gives no NumberOfPixels, and the fewest along the shorter. */
enum { LONGER_SIDE = 512, SHORTEST_SIDE = 32 };

/* The projection of the parts covers this share of the detector, so that their edges can be seen. */
static const double COVERED = 0.95;

/* The distance from the source to the centre of the parts, if the scene gives a side only: at least this, and at
 * least so many half diagonals of the parts that the source is well outside of them. */
static const double SOURCE_MM = 1000, SOURCE_HALF_DIAGONALS = 4;

/* The distance from the centre of the parts to the detector, as a share of that to the source. */
static const double DETECTOR_SHARE = 0.5;

typedef void (*visitor)(void *user, const double x[3]);

/* Visits every vertex of every part in the world. */
static skg_status visit_vertices(const skg_scene *scene, visitor visit, void *user) {
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_scene_part_data *part = &scene->parts[p];
        int64_t vertices = 0, triangles = 0;
        double *positions = NULL;
        SKG_TRY(skg_mesh_count(part->mesh, &vertices, &triangles));
        SKG_TRY(skg_alloc(vertices, 3 * sizeof *positions, part->label, &positions));
        skg_status status = skg_mesh_positions_get(part->mesh, positions, 3);
        for (int64_t i = 0; status == SKG_OK && i < vertices; i++) {
            double x[3];
            skg_pose_point(part->pose, positions + 3 * i, x);
            visit(user, x);
        }
        skg_free(&positions);
        SKG_TRY(status);
    }
    return SKG_OK;
}

static void widen(void *user, const double x[3]) {
    double *bounds = user;
    for (int k = 0; k < 3; k++) {
        bounds[k] = fmin(bounds[k], x[k]);
        bounds[3 + k] = fmax(bounds[3 + k], x[k]);
    }
}

skg_status skg_setup_bounds(const skg_scene *scene, double *bounds) {
    for (int k = 0; k < 3; k++) bounds[k] = HUGE_VAL, bounds[3 + k] = -HUGE_VAL;
    return visit_vertices(scene, widen, bounds);
}

/* A beam along `axis`, and how far the parts reach. */
typedef struct {
    const skg_view *view;
    double origin[3]; /* the source; of a beam from infinity, the centre of the parts */
    double axis[3], right[3], up[3];
    double min_depth, max_depth; /* along the axis from the origin */
    double plane;                /* depth of the detector; 0: not decided so far */
    double half[2];              /* half extents on the detector along right and up */
} beam_frame;

static void measure_depth(void *user, const double x[3]) {
    beam_frame *frame = user;
    double way[3];
    skg_add_scaled(x, -1, frame->origin, way);
    const double depth = skg_dot(way, frame->axis);
    frame->min_depth = fmin(frame->min_depth, depth);
    frame->max_depth = fmax(frame->max_depth, depth);
}

static void measure_shadow(void *user, const double x[3]) {
    beam_frame *frame = user;
    double way[3];
    skg_add_scaled(x, -1, frame->origin, way);
    const double spread =
        frame->view->projection == SKG_PROJECTION_POINT ? frame->plane / skg_dot(way, frame->axis) : 1;
    frame->half[0] = fmax(frame->half[0], spread * fabs(skg_dot(way, frame->right)));
    frame->half[1] = fmax(frame->half[1], spread * fabs(skg_dot(way, frame->up)));
}

/* Where the beam comes from and goes. Places the source where the scene gives a side only. */
static skg_status aim(skg_setup_reader *reader, const skg_json_node *node, const double bounds[6],
                      beam_frame *frame) {
    skg_view *view = &reader->setup->view;
    double centre[3], diagonal[3];
    for (int k = 0; k < 3; k++) {
        centre[k] = reader->has_isocentre ? reader->isocentre[k] : 0.5 * (bounds[k] + bounds[3 + k]);
        diagonal[k] = bounds[3 + k] - bounds[k];
    }
    if (reader->has_side)
        skg_add_scaled(centre,
                       reader->source_mm > 0
                           ? reader->source_mm
                           : fmax(SOURCE_MM, SOURCE_HALF_DIAGONALS * 0.5 * skg_length(diagonal)),
                       reader->side, view->source);
    frame->view = view;
    const int from_infinity = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    skg_add_scaled(from_infinity ? centre : view->source, 0, centre, frame->origin);
    if (from_infinity)
        skg_add_scaled(view->source, 0, centre, frame->axis);
    else
        skg_add_scaled(centre, -1, view->source, frame->axis);
    const double distance = skg_length(frame->axis);
    if (!(distance > 0 && distance < HUGE_VAL))
        return skg_json_fail(
            node, SKG_ERR_SCENE,
            "the source is at the centre of the parts, so no detector can be fitted; move the "
            "source, or give Detector.Position");
    skg_scale_vector(1 / distance, frame->axis, frame->axis);
    frame->min_depth = HUGE_VAL, frame->max_depth = -HUGE_VAL;
    SKG_TRY(visit_vertices(reader->setup->scene, measure_depth, frame));
    if (view->projection == SKG_PROJECTION_POINT && !(frame->min_depth > 1e-3 * distance))
        return skg_json_fail(
            node, SKG_ERR_SCENE,
            "the parts reach to the source or behind it, so no detector can be fitted; move the "
            "source, or give Detector.Position");
    /* Behind the last part, with a little room. */
    const double depth = frame->max_depth - frame->min_depth;
    frame->plane = fmax(from_infinity ? 0 : (1 + DETECTOR_SHARE) * distance, frame->max_depth + 0.05 * depth);
    if (from_infinity && frame->plane == frame->max_depth)
        frame->plane += 1; /* a flat part, across the beam */
    if (reader->detector_mm > 0) frame->plane = reader->detector_mm;
    if (!from_infinity && !(frame->plane > distance))
        return skg_json_fail(node, SKG_ERR_SCENE,
                             "SDD is %g mm, but the isocentre is %g mm from the source; give a larger one",
                             frame->plane, distance);
    return SKG_OK;
}

/* The direction in which rows grow: the given one, otherwise down, or -y where the beam goes along z; perpendicular to
 * the beam. */
static skg_status orient(const skg_json_object *detector, int32_t mirrored, beam_frame *frame) {
    const skg_json_node given = skg_json_member(detector, "UpVector");
    double up[3] = {0, 0, -1};
    if (given.value)
        SKG_TRY(skg_json_direction(&given, up));
    else if (fabs(frame->axis[2]) > 0.99)
        up[1] = -1, up[2] = 0;
    skg_add_scaled(up, -skg_dot(up, frame->axis), frame->axis, frame->up);
    const double length = skg_length(frame->up);
    if (!(length > 1e-6)) /* sine of the angle between both; rounding is 1e-16 */
        return skg_json_fail(&given, SKG_ERR_SCENE, "points along the beam; give another direction");
    skg_scale_vector(1 / length, frame->up, frame->up);
    skg_cross(frame->up, frame->axis, frame->right); /* the picture is as seen from the source */
    if (mirrored) skg_scale_vector(-1, frame->right, frame->right);
    return SKG_OK;
}

/* Square pixels that cover the parts. columns 0: their number is chosen as well. */
static double choose_pixels(skg_view *view, const double half[2]) {
    const double longer = fmax(half[0], half[1]);
    if (view->columns == 0) {
        const double columns = ceil(LONGER_SIDE * half[0] / longer),
                     rows = ceil(LONGER_SIDE * half[1] / longer);
        view->columns = (int64_t)fmax(SHORTEST_SIDE, columns);
        view->rows = (int64_t)fmax(SHORTEST_SIDE, rows);
    }
    return 2 / COVERED * fmax(half[0] / (double)view->columns, half[1] / (double)view->rows);
}

skg_status skg_setup_fit_view(skg_setup_reader *reader, const skg_json_object *detector,
                              const double *spacing) {
    static const char *const placed[] = {"RightVector", "Size", "Spacing"};
    skg_view *view = &reader->setup->view;
    double bounds[6];
    beam_frame frame = {.view = view};
    for (int k = 0; k < 3; k++) {
        const skg_json_node node = skg_json_member(detector, placed[k]);
        if (node.value && !(k > 0 && spacing))
            return skg_json_fail(
                &node, SKG_ERR_FORMAT,
                "belongs to a detector with a Position, or to one at an SDD beside From; give one of them as well, or leave out %s: "
                "the detector is then fitted to the parts",
                placed[k]);
    }
    SKG_TRY(skg_setup_bounds(reader->setup->scene, bounds));
    SKG_TRY(aim(reader, detector->node, bounds, &frame));
    SKG_TRY(orient(detector, reader->seen_from_detector, &frame));
    SKG_TRY(visit_vertices(reader->setup->scene, measure_shadow, &frame));
    if (!(fmax(frame.half[0], frame.half[1]) > 0))
        return skg_json_fail(detector->node, SKG_ERR_SCENE,
                             "the parts have no extent, so no detector can be fitted");
    const double pixel = spacing ? spacing[0] : choose_pixels(view, frame.half);
    skg_add_scaled(frame.origin, frame.plane, frame.axis, view->centre);
    skg_scale_vector(pixel, frame.right, view->column_step);
    skg_scale_vector(spacing ? spacing[1] : pixel, frame.up, view->row_step);
    skg_logger_say(&reader->log, SKG_LOG_NOTE,
                   "the detector is fitted to the parts: %" PRId64 " x %" PRId64
                   " pixels of %.4g mm, centre at (%.4g, %.4g, %.4g) mm",
                   view->columns, view->rows, pixel, view->centre[0], view->centre[1], view->centre[2]);
    return SKG_OK;
}
