/* Warnings about open meshes, and when they come. */
#include "frame/soup.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static char warned[2000];

static void keep_warning(int32_t level, const char *message, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING && strstr(message, "is leaky"))
        snprintf(warned, sizeof warned, "%s", message);
}

/* The warning names the part, how many pixels, where, and what was done. */
START_TEST(what_is_warned_of) {
    static soup broken;
    static picture image, left_out;
    static const char *const done[] = {"left out", "mean of its nearest valid pixels", "traced again"};
    char expected[100];
    int row = -1, column = -1;
    fill_sphere(&broken);
    take(&broken, NULL, &(wish){.precision = SKG_PRECISION_DOUBLE}, &image);
    remove_triangle(&broken, triangle_at(&broken, 5, 3, -40));
    ck_skg(skg_context_log_set(context, keep_warning, NULL));
    for (int32_t repair = SKG_REPAIR_NONE; repair <= SKG_REPAIR_EXACT; repair++) {
        take(&broken, NULL, &(wish){.precision = SKG_PRECISION_DOUBLE, .repair = repair}, &left_out);
        if (repair == SKG_REPAIR_NONE)
            for (int k = SIDE * SIDE; k-- > 0;) /* mm: as in count_different. */
                if (fabs(left_out.mm[k / SIDE][k % SIDE] - image.mm[k / SIDE][k % SIDE]) > 1e-6)
                    row = k / SIDE, column = k % SIDE;
        snprintf(expected, sizeof expected, "part first is leaky: at %d pixels",
                 (int)left_out.report.bad_pixels);
        ck_assert_msg(strstr(warned, expected) != NULL, "%s", warned);
        snprintf(expected, sizeof expected, "first at (column, row) (%d, %d), (", column, row);
        ck_assert_msg(strstr(warned, expected) != NULL, "%s", warned);
        ck_assert_msg(strstr(warned, done[repair]) != NULL, "%s", warned);
    }
}
END_TEST

static int warnings;

static void count_warnings(int32_t level, const char *message, void *user) {
    (void)user;
    warnings += level == SKG_LOG_WARNING && strstr(message, "is leaky") != NULL;
}

/* Once for a part; again where it is ten times as bad as it was, not where it is better. */
START_TEST(what_is_warned_of_once) {
    static const double z[] = {0, 0, -800, 0, -800};
    static const int told_by[] = {1, 1, 2, 2, 2};
    static soup broken;
    static picture image;
    static const int64_t first = 0;
    skg_scene *scene = NULL;
    skg_plan *plan = NULL;
    skg_part part;
    skg_output output;
    int64_t few = 0;
    fill_sphere(&broken);
    remove_triangle(&broken, triangle_at(&broken, 5, 3, -40));
    ck_skg(skg_scene_create(context, &scene));
    skg_part_init(&part);
    part.mesh = mesh_of(&broken), part.material = water;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    ck_skg(skg_plan_create(context, scene, &view, beam, NULL, &plan));
    ck_skg(skg_context_log_set(context, count_warnings, NULL));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image.mm;
    for (int k = 0; k < 5; k++) {
        skg_frame frame;
        skg_job *job = NULL;
        double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z[k], 0, 0, 0, 1};
        skg_frame_init(&frame);
        frame.pose_count = 1, frame.pose_parts = &first, frame.poses = pose;
        ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        skg_plan_report_init(&image.report);
        ck_skg(skg_plan_report_get(plan, &image.report));
        if (k == 0) few = image.report.bad_pixels;
        ck_assert_int_gt(image.report.bad_pixels, z[k] < 0 ? 10 * few : 0); /* reported for every frame */
        ck_assert_int_eq(warnings, told_by[k]);
    }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, what_is_warned_of);
    tcase_add_test(tests, what_is_warned_of_once);
}

SKG_SUITE_MAIN("warnings of repair", add_tests)
