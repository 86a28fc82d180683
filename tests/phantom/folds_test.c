/* The generated thorax: no part folds over itself. By facets, and by lengths, which are below 0 where more
 * facets face away from the source than towards it. */
#include "phantom/contacts.h"
#include "suite.h"
#include "support/run.h"

#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

#include <stdlib.h>

static const double least_mm = -1e-4; /* rounding of lengths of up to 600 mm leaves 1e-5 */

static skg_thorax *make(int simple, int64_t triangles, int64_t *parts) {
    skg_thorax_options options;
    skg_thorax *thorax = NULL;
    skg_thorax_options_init(&options);
    options.simple = simple;
    options.triangles = triangles;
    ck_skg(skg_thorax_create(&options, &thorax));
    ck_skg(skg_thorax_part_count(thorax, parts));
    return thorax;
}

static skg_thorax_part part_of(const skg_thorax *thorax, int64_t i) {
    skg_thorax_part part;
    skg_thorax_part_init(&part);
    ck_skg(skg_thorax_part_get(thorax, i, &part));
    return part;
}

static int64_t folds_of(const skg_mesh_arrays *arrays) {
    int64_t folds = -1;
    char *fold = calloc((size_t)arrays->triangles, 1);
    ck_skg(skg_shape_folds(arrays, NULL, &folds, fold));
    free(fold);
    return folds;
}

START_TEST(no_facet_meets_another) {
    const int64_t sizes[] = {10000, 42000, 80000};
    int64_t parts;
    skg_thorax *thorax = make(_i / 3, sizes[_i % 3], &parts);
    for (int64_t i = 0; i < parts; i++) {
        const skg_thorax_part part = part_of(thorax, i);
        skg_mesh_arrays a = {0};
        ck_skg(skg_mesh_count(part.mesh, &a.vertices, &a.triangles));
        ck_skg(skg_alloc(3 * a.vertices, sizeof *a.positions, "test", &a.positions));
        ck_skg(skg_alloc(3 * a.triangles, sizeof *a.corners, "test", &a.corners));
        ck_skg(skg_mesh_positions_get(part.mesh, a.positions, 0));
        ck_skg(skg_mesh_triangles_get(part.mesh, a.corners, 0));
        const int64_t folds = folds_of(&a);
        ck_assert_msg(folds == 0, "%s: %d of %d facets meet others", part.label, (int)folds,
                      (int)a.triangles);
        skg_mesh_arrays_free(&a);
    }
    skg_thorax_release(&thorax);
}
END_TEST

static skg_view view_from(int direction) {
    static const double source[3][3] = {{0, -1500, -20}, {-1500, 30, 10}, {-700, -1000, 300}};
    static const double centre[3][3] = {{0, 300, -20}, {300, 30, 10}, {140, 200, -60}};
    static const double across[3][3] = {{2, 0, 0}, {0, -2, 0}, {1.6, -1.2, 0}};
    skg_view view;
    skg_view_init(&view);
    view.columns = 320, view.rows = 340;
    for (int k = 0; k < 3; k++) {
        view.source[k] = source[direction][k], view.centre[k] = centre[direction][k];
        view.column_step[k] = across[direction][k], view.row_step[k] = k == 2 ? -2 : 0;
    }
    return view;
}

START_TEST(no_length_is_below_0) {
    int64_t parts;
    skg_thorax *thorax = make(_i / 6, _i % 6 < 3 ? 42000 : 80000, &parts);
    skg_scene *scene = NULL;
    const skg_view view = view_from(_i % 3);
    float *lengths = calloc((size_t)(view.rows * view.columns), sizeof *lengths);
    run_open();
    ck_skg(skg_scene_create(run_context, &scene));
    for (int64_t i = 0; i < parts; i++) {
        const skg_thorax_part part = part_of(thorax, i);
        run_part(scene, part.label, part.mesh, 0.02, NULL, part.inside);
    }
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    for (int64_t i = 0; i < parts; i++) {
        skg_output output;
        skg_job *job = NULL;
        float least = 0, most = 0;
        skg_output_init(&output);
        output.data = lengths;
        output.kind = SKG_OUTPUT_LENGTHS;
        output.part = i;
        output.lengths = SKG_LENGTHS_SURFACE;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        for (int64_t p = 0; p < view.rows * view.columns; p++) {
            least = lengths[p] < least ? lengths[p] : least;
            most = lengths[p] > most ? lengths[p] : most;
        }
        ck_assert_msg((double)least >= least_mm && most > 0, "%s: %g to %g mm", part_of(thorax, i).label,
                      (double)least, (double)most);
    }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    run_close();
    skg_thorax_release(&thorax);
    free(lengths);
}
END_TEST

/* A fold is found and smoothed away: an octahedron with its top drawn out through a lower side. */
START_TEST(unfolds) {
    double positions[] = {9, 0, 0, 0, 9, 0, -9, 0, 0, 0, -9, 0, 20, 1, -5, 0, 0, -9};
    int32_t corners[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
    const skg_mesh_arrays a = {.vertices = 6, .positions = positions, .triangles = 8, .corners = corners};
    ck_assert_int_gt(folds_of(&a), 0);
    ck_skg(skg_shape_unfold("octahedron", &a));
    ck_assert_int_eq(folds_of(&a), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, no_facet_meets_another, 0, 6);
    tcase_add_loop_test(tests, no_length_is_below_0, 0, 12);
    tcase_add_test(tests, unfolds);
}

SKG_SUITE_MAIN("folds", add_tests)
