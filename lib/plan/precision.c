/* The bound of what rounding may change in an image. */
#include "core/text.h"
#include "geometry/bounds.h"
#include "plan/decisions.h"
#include "spectral/verification.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* By how much of their depth the lengths of parts that touch may be wrong: two hundred-thousandths in single precision, a millionth in
 * double. Rounded positions may be more. Where a group reaches the plane of the source, a ray may miss both parts, or meet both. */
static double share_of(const skg_touching_group *group, int near_source, int is_double) {
    const double least = is_double ? 1e-6 : 2e-5;
    return near_source ? 1 : fmin(fmax(least, 4 * group->noise / skg_touching_shift(group, is_double)), 1);
}

/* The properties of the parts that find_seams needs. */
typedef struct {
    skg_mesh_layout *layouts; /* [parts] of flat ones, their planes alone */
    skg_touching *boxes;
    skg_touching_group *groups;
    skg_extent *extents;
    int32_t *group_of;
} seam_work;

static skg_status list_flat(const skg_scene *scene, seam_work *w, int64_t *count) {
    int32_t planes[SKG_MESH_PLANES][3];
    for (int64_t p = 0; p < scene->count; p++) {
        skg_mesh_layout *layout = &w->layouts[p];
        w->group_of[p] = -1;
        layout->plane_count = skg_mesh_flat_faces(scene->parts[p].mesh, planes);
        if (layout->plane_count == 0) continue;
        SKG_TRY(skg_alloc(layout->plane_count, sizeof *planes, "flat faces", &layout->planes));
        memcpy(layout->planes, planes, (size_t)layout->plane_count * sizeof *planes);
        w->boxes[(*count)++] = (skg_touching){
            .part = (int32_t)p, .mesh = scene->parts[p].mesh, .layout = layout, .pose = scene->parts[p].pose};
    }
    return SKG_OK;
}

/* seams: [parts] 0: the part touches no other. */
static skg_status find_seams(const skg_recipe *recipe, seam_work *w, double *seams) {
    const skg_scene *scene = recipe->scene;
    const int is_double = recipe->options.precision == SKG_PRECISION_DOUBLE;
    skg_camera camera;
    int64_t count = 0;
    SKG_TRY(skg_camera_make(&recipe->view, NULL, 0, 0, &camera));
    SKG_TRY(list_flat(scene, w, &count));
    skg_touching_find(count, w->boxes, w->group_of);
    for (int64_t p = 0; p < scene->count; p++) {
        if (w->group_of[p] < 0) continue;
        const skg_mesh *mesh = scene->parts[p].mesh;
        const double *pose = scene->parts[p].pose;
        skg_extent_find(&camera, mesh, pose, skg_recipe_last_bit(recipe), &w->extents[p]);
        const skg_scale_part *at = &w->extents[p].scale;
        skg_touching_join(&w->groups[w->group_of[p]], (const double[2]){at->low_column, at->high_column},
                          (const double[2]){at->low_row, at->high_row},
                          skg_touching_noise(&camera, mesh, pose, at));
    }
    for (int64_t p = 0; p < scene->count; p++) {
        if (w->group_of[p] < 0 || w->groups[w->group_of[p]].members < 2) continue;
        skg_touching_group *group = &w->groups[w->group_of[p]];
        skg_touching_measure(&camera, group);
        seams[p] = share_of(group, w->extents[p].near_source, is_double);
    }
    return SKG_OK;
}

skg_status skg_plan_precision_bound(const skg_recipe *recipe, double *bound) {
    static const char what[] = "bound of the precision";
    const int64_t parts = recipe->scene->count;
    seam_work w = {.layouts = NULL};
    double *seams = NULL;
    skg_rounding found;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.layouts, what, &w.layouts));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.boxes, what, &w.boxes));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.groups, what, &w.groups));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.extents, what, &w.extents));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.group_of, what, &w.group_of));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *seams, what, &seams));
    if (parts > 1) SKG_TRY_CLEANUP(find_seams(recipe, &w, seams));
    SKG_TRY_CLEANUP(
        skg_rounding_find(recipe->scene, &recipe->view, &recipe->model, &recipe->options, seams, &found));
    *bound = found.bound;
cleanup:
    for (int64_t p = 0; w.layouts && p < parts; p++) skg_free(&w.layouts[p].planes);
    skg_free(&w.layouts);
    skg_free(&w.boxes);
    skg_free(&w.groups);
    skg_free(&w.extents);
    skg_free(&w.group_of);
    skg_free(&seams);
    return status;
}

static skg_status warn_half(const skg_recipe *recipe, const skg_context *context) {
    double bound = 0;
    SKG_TRY(skg_plan_precision_bound(recipe, &bound));
    skg_log(
        context, SKG_LOG_WARNING,
        "precision half: intensities of this scene may be wrong by %.2g %%, since distances from the source are "
        "rounded to 11 bits; it is for comparison with 16-bit buffers; take single otherwise",
        100 * bound);
    return SKG_OK;
}

skg_status skg_plan_precision_warn(const skg_recipe *recipe, const skg_context *context) {
    skg_rounding found;
    char more[64] = "";
    if (recipe->options.precision == SKG_PRECISION_HALF) return warn_half(recipe, context);
    if (recipe->options.precision == SKG_PRECISION_DOUBLE) return SKG_OK;
    SKG_TRY(skg_rounding_find_thin(recipe->scene, &recipe->view, &recipe->model, &recipe->options, &found));
    if (found.thin_count == 0) return SKG_OK;
    if (found.thin_count > 1)
        snprintf(more, sizeof more, " (and %" PRId64 " more %s)", found.thin_count - 1,
                 skg_plural(found.thin_count - 1, "part", "parts"));
    skg_log(
        context, SKG_LOG_WARNING,
        "part %s%s is thin and lies along the rays: in precision single its path of up to %.3g mm may be wrong by %.2g "
        "mm, %.2g %% of it; take precision double",
        recipe->scene->parts[found.thin].label, more, found.thin_longest, found.thin_error,
        100 * found.thin_error / found.thin_longest);
    return SKG_OK;
}
