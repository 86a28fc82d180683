/* The public call of the 3D view. */
#include "core/context.h"
#include "core/maths.h"
#include "core/text.h"
#include "device/self_tests.h"
#include "show/drawing.h"

#include <skiagraph/scene_picture.h>

#include <inttypes.h>
#include <math.h>

/* Grey of the detector without an image. */
static const uint8_t PLAIN = 176;

void skg_look_init_sized(void *look, int32_t size) {
    const skg_look defaults = {.columns = 1024, .rows = 768};
    skg_struct_init(look, size, &defaults, sizeof defaults);
}

static skg_status read_look(const skg_look *theirs, skg_look *look) {
    skg_look_init(look);
    if (theirs) SKG_TRY(skg_struct_read(theirs, "skg_look", look, sizeof *look));
    if (look->columns < 1 || look->rows < 1 || look->columns > SKG_LOOK_PIXELS_MAX ||
        look->rows > SKG_LOOK_PIXELS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "the picture has %" PRId64 " columns and %" PRId64
                        " rows; 1 to %d of each can be drawn",
                        look->columns, look->rows, SKG_LOOK_PIXELS_MAX);
    if (look->path_count < 0 || (look->path_count > 0 && !look->path))
        return skg_fail(SKG_ERR_ARGUMENT, "the look has %" PRId64 " points of a path, and %s",
                        look->path_count, look->path ? "a count cannot be negative" : "path is NULL");
    for (int64_t i = 0; i < look->path_count; i++)
        if (!skg_all_finite(look->path + 3 * i, 3))
            return skg_fail(SKG_ERR_ARGUMENT, "point %" PRId64 " of the look's path is not finite", i);
    if ((look->target && !skg_all_finite(look->target, 3)) || (look->cut && !skg_all_finite(look->cut, 4)))
        return skg_fail(SKG_ERR_ARGUMENT, "the look's %s is not finite",
                        look->target && !skg_all_finite(look->target, 3) ? "target" : "cut");
    if (look->target && !(look->distance > 0 && look->distance < HUGE_VAL))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "the eye is %g mm from the look's target; set distance to more than 0",
                        look->distance);
    if (!look->bounds) return SKG_OK;
    for (int k = 0; k < 3; k++)
        if (!skg_all_finite(look->bounds, 6) || look->bounds[k] > look->bounds[3 + k])
            return skg_fail(SKG_ERR_ARGUMENT, "the look's bounds along %c are %g to %g mm", "xyz"[k],
                            look -> bounds[k], look -> bounds[3 + k]);
    return SKG_OK;
}

/* The box of the parts that are drawn, mm. */
static skg_status find_box(const skg_scene *scene, const skg_look *look, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = HUGE_VAL, high[k] = -HUGE_VAL;
    for (int64_t i = 0; i < scene->count; i++)
        if (look->colours[4 * i + 3] > 0)
            skg_show_part_bounds(scene->parts[i].mesh, skg_show_pose_of(scene, look, i), low, high);
    if (scene->count == 0)
        return skg_fail(SKG_ERR_SCENE, "the scene has no parts; add one with skg_scene_part_add");
    for (int k = 0; look->bounds && k < 3; k++) low[k] = look->bounds[k], high[k] = look->bounds[3 + k];
    if (!(low[0] <= high[0]))
        return skg_fail(SKG_ERR_SCENE, "the picture would be empty: every part of the scene is left out");
    return SKG_OK;
}

/* Checks everything and finds colours, box and eye. colours is to be freed, also after a failure. */
static skg_status prepare(const skg_scene *scene, const skg_view *view, skg_look *look, uint8_t **colours,
                          double low[3], double high[3], skg_show_camera *camera) {
    double corners[4][3];
    SKG_TRY(skg_show_beam_corners(view, look, corners));
    if (!look->colours) {
        SKG_TRY(skg_alloc(scene->count, 4, "colours of parts", colours));
        SKG_TRY(skg_look_colours_get(scene, *colours));
        look->colours = *colours;
    }
    for (int64_t i = 0; look->poses && i < scene->count; i++)
        if (!skg_all_finite(look->poses + 16 * i, 16))
            return skg_fail(SKG_ERR_ARGUMENT, "the look's pose of part %s is not finite",
                            scene->parts[i].label);
    SKG_TRY(find_box(scene, look, low, high));
    return skg_show_camera_make(view, look, low, high, camera);
}

/* Checks the caller's view, whose program may know fewer fields. */
static skg_status read_view(const skg_view *view, skg_view *ours) {
    skg_view_init(ours);
    SKG_TRY(skg_view_check(view));
    return skg_struct_read(view, "skg_view", ours, sizeof *ours);
}

static skg_status draw(skg_context *context, const skg_scene *scene, const skg_view *view,
                       const skg_look *look, uint8_t *rgba) {
    SKG_PLAIN;
    SKG_TRY(skg_context_enter(context));
    SKG_TRY(skg_self_test_need(context, SKG_SELF_TEST_PICTURE));
    SKG_NEEDS_OF("skg_scene_picture", scene);
    SKG_NEEDS_OF("skg_scene_picture", view);
    SKG_NEEDS_OF("skg_scene_picture", rgba);
    skg_look ours;
    skg_view seen;
    uint8_t *colours = NULL;
    double low[3], high[3];
    skg_show_camera camera;
    skg_show_model model = {0};
    SKG_TRY(read_look(look, &ours));
    SKG_TRY(read_view(view, &seen));
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(prepare(scene, &seen, &ours, &colours, low, high, &camera));
    for (int k = 0; k < 3; k++) model.centre[k] = camera.centre[k];
    SKG_TRY_CLEANUP(skg_show_parts_add(&model, scene, &ours, &camera));
    SKG_TRY_CLEANUP(skg_show_markers_add(&model, &seen, &ours, &camera, low, high));
    SKG_TRY_CLEANUP(skg_show_draw(context, &model, &camera, &ours, ours.image ? seen.columns : 1,
                                  ours.image ? seen.rows : 1, ours.image ? ours.image : &PLAIN, rgba));
cleanup:
    skg_show_model_free(&model);
    skg_free(&colours);
    return status;
}

skg_status skg_scene_picture(skg_context *context, const skg_scene *scene, const skg_view *view,
                             const skg_look *look, uint8_t *rgba) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, draw(context, scene, view, look, rgba));
}

skg_status skg_scene_places_get(const skg_scene *scene, const skg_view *view, const skg_look *look,
                                int64_t count, const double *points, double *places) {
    SKG_PLAIN;
    SKG_NEEDS(scene);
    SKG_NEEDS(view);
    if (count > 0) {
        SKG_NEEDS(points);
        SKG_NEEDS(places);
    }
    skg_look ours;
    skg_view seen;
    uint8_t *colours = NULL;
    double low[3], high[3];
    skg_show_camera camera;
    SKG_TRY(read_look(look, &ours));
    SKG_TRY(read_view(view, &seen));
    const skg_status status = prepare(scene, &seen, &ours, &colours, low, high, &camera);
    skg_free(&colours);
    for (int64_t i = 0; status == SKG_OK && i < count; i++)
        skg_show_camera_place(&camera, &ours, points + 3 * i, places + 2 * i);
    return status;
}
