/* The self-test of positions on the device. */
#include "frame/plans.h"
#include "selftest/selftest.h"

#include <skiagraph/mesh.h>

#include <math.h>

/* The corners of the boxes from a point, as floats, and their bounds. */
static skg_status find_positions(skg_context *context, const skg_self_test_scene *scene, const double *origin,
                                 int64_t *vertices, float **positions, float *lowest, float *highest) {
    double *exact = NULL;
    skg_mesh *mesh = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_boxes_mesh(context, scene->boxes, SKG_SELF_TEST_BOXES, 0, &mesh));
    SKG_TRY_CLEANUP(skg_mesh_count(mesh, vertices, NULL));
    SKG_TRY_CLEANUP(skg_alloc(3 * *vertices, sizeof *exact, "device test", &exact));
    SKG_TRY_CLEANUP(skg_alloc(3 * *vertices, sizeof **positions, "device test", positions));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, exact, 0));
    for (int k = 0; k < 3; k++) lowest[k] = HUGE_VALF, highest[k] = -HUGE_VALF;
    for (int64_t n = 0; n < 3 * *vertices; n++) {
        (*positions)[n] = (float)(exact[n] - origin[n % 3]);
        lowest[n % 3] = fminf(lowest[n % 3], (*positions)[n]);
        highest[n % 3] = fmaxf(highest[n % 3], (*positions)[n]);
    }
cleanup:
    skg_free(&exact);
    skg_mesh_release(&mesh);
    return status;
}

skg_status skg_self_test_place(skg_context *context, const skg_self_test_scene *scene, skg_plan *plan,
                               skg_buffer *buffer) {
    int64_t vertices = 0;
    float *positions = NULL, *offsets = NULL, lowest[3], highest[3];
    const double *origin = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_mesh_offsets_get(plan->recipe->scene->parts[0].mesh, &offsets, &origin));
    SKG_TRY_CLEANUP(find_positions(context, scene, origin, &vertices, &positions, lowest, highest));
    for (int64_t n = 0; n < 3 * vertices; n++) {
        if (positions[n] <= lowest[n % 3]) positions[n] -= 7;
        if (positions[n] >= highest[n % 3]) positions[n] += 7;
    }
    SKG_TRY_CLEANUP(skg_buffer_create(context, 3 * vertices * (int64_t)sizeof *positions, positions,
                                      "positions of a device test", buffer));
    SKG_TRY_CLEANUP(skg_plan_positions_set_cl(plan, 0, buffer->memory, 0, lowest, highest, 0, NULL, NULL));
cleanup:
    skg_free(&positions);
    return status;
}
