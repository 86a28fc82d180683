/* One plan whose frames call for more rasters than it keeps: none that is in use is replaced. */
#include "suite.h"
#include "support/run.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 12, PARENTS = 20 };

/* A box without its last triangle. */
static skg_mesh *leaky_box(double side) {
    solid s = solid_box(side, side, side);
    s.triangles--;
    skg_mesh *mesh = run_mesh(&s);
    solid_free(&s);
    return mesh;
}

/* Leaky parents with 0, 1, ... leaky children: the lengths of each need a raster with another number of planes. */
static skg_scene *make_scene(int64_t parents[PARENTS]) {
    skg_mesh *outer = leaky_box(60), *inner = leaky_box(6);
    skg_scene *scene = NULL;
    char label[40];
    ck_skg(skg_scene_create(run_context, &scene));
    for (int p = 0; p < PARENTS; p++) {
        snprintf(label, sizeof label, "parent %d", p);
        parents[p] = run_part(scene, label, outer, 0.2, NULL, -1);
        for (int c = 0; c < p; c++) {
            const double pose[16] = {1, 0, 0, 2.0 * c - 20, 0, 1, 0, 1.5 * c - 15,
                                     0, 0, 1, c - 10.0,     0, 0, 0, 1};
            snprintf(label, sizeof label, "child %d of %d", c, p);
            run_part(scene, label, inner, 0.5, pose, parents[p]);
        }
    }
    skg_mesh_release(&outer);
    skg_mesh_release(&inner);
    return scene;
}

static void take(skg_plan *plan, int64_t part, float *pixels) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.data = pixels;
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = part;
    ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

START_TEST(more_rasters_than_are_kept) {
    static float pixels[SIDE * SIDE], alone[SIDE * SIDE];
    int64_t parents[PARENTS];
    const skg_view view = run_view(SIDE, 5);
    skg_scene *scene = make_scene(parents);
    skg_plan *plan = run_plan(scene, &view, (run_choice){0});
    for (int round = 0; round < 2; round++)
        for (int p = 0; p < PARENTS; p++) {
            take(plan, parents[p], pixels);
            if (p % 5 != 4) continue;
            skg_plan *fresh = run_plan(scene, &view, (run_choice){0});
            take(fresh, parents[p], alone);
            ck_assert_mem_eq(pixels, alone, sizeof pixels);
            skg_plan_release(&fresh);
        }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, more_rasters_than_are_kept);
}

SKG_SUITE_MAIN("rasters", add_tests)
