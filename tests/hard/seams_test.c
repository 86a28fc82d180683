/* Parts that touch give the picture of what they make up together, also where rays run along their common faces: no ray misses
 * both, and none meets both. */
#include "suite.h"
#include "support/cuts.h"
#include "support/run.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { SIZE = 65, PIECES = 48, SCENES = 32 };

static const int32_t strategies[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};

/* 4 units in the last place of the largest coordinate and 3e-5 of the longest path, as docs/numerics.md has it; in double
 * precision 2^-34 pixels, and what positions of doubles leave of 1e-11. */
static int64_t wrong_pixels(const cut_scene *s, const double *image, int32_t precision) {
    const int is_double = precision == SKG_PRECISION_DOUBLE;
    const double shift = is_double ? 0x1p-34 : 4 * (double)FLT_EPSILON * SIZE;
    return cut_judge(s, image, shift * s->magnified, is_double ? 1e-9 : 3e-5).wrong;
}

static void check_cut(uint64_t number, int32_t precision) {
    cut_scene *s = cut_make(number, SIZE, PIECES);
    skg_scene *scene = NULL;
    ck_skg(cut_scene_create(run_context, s, &scene));
    for (size_t k = 0; k < sizeof strategies / sizeof *strategies; k++) {
        const run_choice choice = {
            .precision = precision, .strategy = strategies[k], .quantity = SKG_QUANTITY_ATTENUATION};
        skg_plan *plan = run_plan(scene, &s->view, choice);
        double *image = run_image(plan, &s->view);
        const int64_t wrong = wrong_pixels(s, image, precision);
        ck_assert_msg(wrong == 0, "scene %d of %d parts, precision %d, strategy %d: %d pixels are wrong",
                      (int)number, (int)s->parts, (int)precision, (int)strategies[k], (int)wrong);
        free(image);
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
    cut_free(s);
}

/* Point and parallel beams; cuts through pixel centres and anywhere; one material, two, and nested
 * shells; blocks within the picture and ten times as large. */
START_TEST(pieces_give_the_whole) {
    for (uint64_t number = 0; number < SCENES; number++)
        for (int32_t precision = 0; precision <= run_has_double(); precision++) check_cut(number, precision);
}
END_TEST

/* The first scene that people build: two blocks that meet in the middle column of a detector with an odd number of them.
 * Along the middle row the paths have a mirror image, so that the values of the two neighbours are the same. */
static void check_blocks(int64_t columns, double pitch, double depth, double turn, int32_t precision) {
    const skg_view view = run_view(columns, pitch);
    const solid block = solid_box(20, 40, 30);
    const double c = cos(turn), d = sin(turn);
    skg_scene *scene = NULL;
    skg_mesh *mesh = run_mesh(&block);
    ck_skg(skg_scene_create(run_context, &scene));
    for (int side = -1; side <= 1; side += 2) {
        const double pose[16] = {c, -d, 0, side * 10 * c, d, c, 0, side * 10 * d, 0, 0, 1, depth, 0, 0, 0, 1};
        run_part(scene, side < 0 ? "left" : "right", mesh, 1, pose, -1);
    }
    skg_plan *plan =
        run_plan(scene, &view, (run_choice){.precision = precision, .quantity = SKG_QUANTITY_ATTENUATION});
    double *image = run_image(plan, &view);
    const double *middle = image + (columns / 2) * columns + columns / 2;
    /* The ray to the centre is the shortest of all: 30 mm of 1 per cm. */
    ck_assert_msg(fabs(*middle - 3) < 3 * 3e-5,
                  "%d columns, turned by %g, precision %d: %.9g beside %.9g and %.9g", (int)columns, turn,
                  (int)precision, *middle, middle[-1], middle[1]);
    free(image);
    skg_plan_release(&plan);
    skg_mesh_release(&mesh);
    skg_scene_release(&scene);
}

START_TEST(two_blocks) {
    static const double turns[] = {0, 0.7853981633974483, 0.6435011087932844, 1.5707963267948966, 0.3};
    for (int32_t precision = 0; precision <= run_has_double(); precision++)
        for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
            check_blocks(65, 1, 0, turns[k], precision);
            check_blocks(255, 0.3, 41.7, turns[k], precision);
            check_blocks(101, 0.7, -333.3, turns[k], precision);
        }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, pieces_give_the_whole);
    tcase_add_test(tests, two_blocks);
}

SKG_SUITE_MAIN("seams", add_tests)
