/* How many pixels the library finds unbalanced. */
#include "hard/balance.h"

#include "suite.h"

solid stray(const skg_view *view, double column, double row, double pixels) {
    solid s = {3, 1, calloc(9, sizeof(double)), calloc(3, sizeof(int32_t))};
    static const double at[3][2] = {{-0.5, -0.4}, {0.5, -0.3}, {0.1, 0.5}};
    for (int n = 0; n < 3; n++) {
        s.corners[n] = n;
        for (int k = 0; k < 3; k++) {
            const double pixel =
                view->centre[k] +
                (column + pixels * at[n][0] - (double)(view->columns - 1) / 2) * view->column_step[k] +
                (row + pixels * at[n][1] - (double)(view->rows - 1) / 2) * view->row_step[k];
            const double from = view->projection == SKG_PROJECTION_POINT
                                    ? view->source[k]
                                    : pixel + view->source[k] - view->centre[k];
            s.positions[3 * n + k] = (from + pixel) / 2;
        }
    }
    return s;
}

int64_t count_bad(const solid *body, const double *pose, const skg_view *view, double at, double pixels,
                  run_choice choice) {
    skg_plan_report report;
    solid open = solid_copy(body), extra = stray(view, at, at, pixels);
    if (pose) solid_move(&open, pose);
    solid_add(&open, &extra);
    skg_scene *scene = run_scene(&open, NULL);
    skg_plan *plan = run_plan(scene, view, choice);
    free(run_image(plan, view));
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    ck_assert_int_eq(report.leaky_parts, 1);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    solid_free(&extra);
    solid_free(&open);
    return report.bad_pixels;
}
