/* Views: source, detector and projection, checked. */
#include "core/core.h"
#include "core/maths.h"
#include "scene/curve.h"

#include <skiagraph/scene.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Pixels of the longest side: products of two sides and of pixels with bits stay within 32 and 64 bit integers. */
enum { LARGEST_SIDE = 32768 };

/* Sines and relative distances below this are degenerate. Single precision fails to separate the pixels at much
 * larger ones. */
static const double DEGENERATE = 1e-9;

/* In mm, so 1000 km: far beyond any set-up, and cubes of it are far below the largest float. */
static const double LARGEST_LENGTH = 1e9;

/* The plane of the detector. */
typedef struct {
    double corner[3]; /* centre of pixel (0, 0), mm */
    double normal[3]; /* length 1 */
} detector_plane;

void skg_view_init_sized(void *view, int32_t size) {
    const skg_view defaults = {0};
    skg_struct_init(view, size, &defaults, sizeof defaults);
}

static skg_status check_vector(const char *what, const double *v) {
    if (!skg_all_finite(v, 3)) return skg_fail(SKG_ERR_SCENE, "the %s is not finite", what);
    for (int k = 0; k < 3; k++)
        if (fabs(v[k]) > LARGEST_LENGTH)
            return skg_fail(SKG_ERR_SCENE,
                            "the %s has an entry of %g mm, which is too large; %g is the limit", what, v[k],
                            LARGEST_LENGTH);
    return SKG_OK;
}

static skg_status check_numbers(const skg_view *view) {
    if (view->projection != SKG_PROJECTION_POINT && view->projection != SKG_PROJECTION_PARALLEL &&
        view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        return skg_fail(SKG_ERR_SCENE, "the view's projection is %" PRId32 "; SKG_PROJECTION_POINT is %d",
                        view->projection, SKG_PROJECTION_POINT);
    if (view->columns < 1 || view->rows < 1 || view->columns > LARGEST_SIDE || view->rows > LARGEST_SIDE)
        return skg_fail(SKG_ERR_SCENE,
                        "the detector has %" PRId64 " columns and %" PRId64
                        " rows; 1 to %d of each can be imaged",
                        view->columns, view->rows, LARGEST_SIDE);
    if (view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        SKG_TRY(check_vector("source's position", view->source));
    else if (!skg_all_finite(view->source, 3))
        return skg_fail(SKG_ERR_SCENE, "the beam's direction is not finite");
    SKG_TRY(check_vector("detector's position", view->centre));
    SKG_TRY(check_vector("detector's column step", view->column_step));
    SKG_TRY(check_vector("detector's row step", view->row_step));
    return SKG_OK;
}

static skg_status check_detector(const skg_view *view, detector_plane *plane) {
    const double *du = view->column_step, *dv = view->row_step;
    double width = skg_length(du), height = skg_length(dv);
    if (!(width > 0) || !(height > 0))
        return skg_fail(SKG_ERR_SCENE,
                        "the detector has no size: its pixels are %g mm wide and %g mm high; both have to be "
                        "above 0",
                        width, height);
    skg_cross(du, dv, plane->normal);
    double area = skg_length(plane->normal);
    if (!(area > DEGENERATE * width * height))
        return skg_fail(
            SKG_ERR_SCENE,
            "the detector's rows and columns run in the same direction (%g, %g, %g); up and right "
            "must not be parallel",
            du[0] / width, du[1] / width, du[2] / width);
    skg_scale_vector(1 / area, plane->normal, plane->normal);
    skg_add_scaled(view->centre, -0.5 * (double)(view->columns - 1), du, plane->corner);
    skg_add_scaled(plane->corner, -0.5 * (double)(view->rows - 1), dv, plane->corner);
    return SKG_OK;
}

/* The distance in mm of the farthest corner pixel from the source. */
static double farthest_corner(const skg_view *view, const detector_plane *plane) {
    double farthest = 0;
    for (int k = 0; k < 4; k++) {
        double corner[3];
        skg_add_scaled(plane->corner, k & 1 ? (double)(view->columns - 1) : 0, view->column_step, corner);
        skg_add_scaled(corner, k & 2 ? (double)(view->rows - 1) : 0, view->row_step, corner);
        skg_add_scaled(corner, -1, view->source, corner);
        farthest = fmax(farthest, skg_length(corner));
    }
    return farthest;
}

static skg_status check_point(const skg_view *view, const detector_plane *plane) {
    double way[3];
    skg_add_scaled(plane->corner, -1, view->source, way);
    double distance = fabs(skg_dot(plane->normal, way));
    if (!(distance > DEGENERATE * farthest_corner(view, plane)))
        return skg_fail(SKG_ERR_SCENE,
                        "the source (%g, %g, %g) mm lies on the detector or in its plane; move it out of the "
                        "plane",
                        view->source[0], view->source[1], view->source[2]);
    return SKG_OK;
}

/* The direction of a parallel beam, of length 1. Returns 0 if it has none. */
static int find_direction(const skg_view *view, double *direction) {
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        memcpy(direction, view->source, 3 * sizeof *direction);
    else
        skg_add_scaled(view->centre, -1, view->source, direction);
    /* A direction may have any length. It is scaled first, because its square may overflow. */
    double largest = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
    if (!(largest > 0)) return 0;
    skg_scale_vector(1 / largest, direction, direction);
    skg_scale_vector(1 / skg_length(direction), direction, direction);
    return 1;
}

static skg_status check_parallel(const skg_view *view, const detector_plane *plane) {
    double direction[3];
    if (!find_direction(view, direction))
        return skg_fail(SKG_ERR_SCENE,
                        view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY
                            ? "the beam's direction is (0, 0, 0); give it a length"
                            : "the source is at the detector's centre, so the parallel beam has "
                              "no direction; move it away");
    if (!(fabs(skg_dot(plane->normal, direction)) > DEGENERATE))
        return skg_fail(
            SKG_ERR_SCENE,
            "the detector stands edge-on to the beam, which runs along (%g, %g, %g); turn it towards the beam",
            direction[0], direction[1], direction[2]);
    return SKG_OK;
}

skg_status skg_view_check(const skg_view *view) {
    skg_view ours;
    detector_plane plane;
    skg_view_init(&ours);
    SKG_TRY(skg_struct_read(view, "skg_view", &ours, sizeof ours));
    SKG_TRY(check_numbers(&ours));
    SKG_TRY(check_detector(&ours, &plane));
    SKG_TRY(ours.projection == SKG_PROJECTION_POINT ? check_point(&ours, &plane)
                                                    : check_parallel(&ours, &plane));
    return ours.radius == 0 ? SKG_OK : skg_curvature_check(&ours);
}
