/* Warns if nothing falls on the detector. */
#include "plan/decisions.h"

#include <math.h>

/* By how many pixels a stretch misses the detector along one axis: negative before it, positive beyond it, 0 on it. */
static double miss(double low, double high, int64_t count) {
    if (high < -0.5) return high + 0.5;
    const double last = (double)count - 0.5;
    return low > last ? low - last : 0;
}

static const char *direction(double across, double down) {
    if (fabs(across) >= fabs(down)) return across < 0 ? "before its first column" : "beyond its last column";
    return down < 0 ? "before its first row" : "beyond its last row";
}

void skg_warn_unseen(const skg_context *context, const skg_scene *scene, const skg_camera *camera,
                     const skg_extent *extents, int32_t fine, skg_outcome *outcome) {
    double nearest = HUGE_VAL, across = 0, down = 0;
    int64_t part = -1;
    if (outcome->warned_unseen) return;
    for (int64_t p = 0; p < scene->count; p++) {
        if (extents[p].on_detector) return;
        const skg_scale_part *at = &extents[p].scale;
        if (!extents[p].on_way) continue; /* behind the source or the detector */
        const double i = miss(at->low_column, at->high_column, camera->columns);
        const double j = miss(at->low_row, at->high_row, camera->rows);
        if (i == 0 && j == 0) return; /* a flat part that faces the beam: it has no depth, but it is met */
        if (hypot(i, j) < nearest) nearest = hypot(i, j), across = i, down = j, part = p;
    }
    outcome->warned_unseen = 1;
    if (part < 0) {
        skg_log(context, SKG_LOG_WARNING,
                "nothing falls on the detector: all parts lie behind the source or behind the detector");
        return;
    }
    const double *step = fabs(across) >= fabs(down) ? camera->column : camera->row;
    const int curved = skg_camera_is_curved(camera); /* the camera's rows are the detector's columns */
    const double pixels = fmax(fabs(across), fabs(down));
    skg_log(
        context, SKG_LOG_WARNING,
        "nothing falls on the detector: the shadow of %s, which comes nearest, lies %.4g pixels (%.4g mm on the "
        "detector) %s",
        scene->parts[part].label, pixels / fine,
        pixels * sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]),
        curved ? direction(down, across) : direction(across, down));
}
