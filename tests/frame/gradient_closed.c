/* Derivatives that are known in closed form: of pixels behind much, and of parts that touch. */
#include "gradient_closed.h"

#include "gradients.h"
#include "support/doubles.h"

#include <math.h>
#include <string.h>

/* A plan of one energy. */
static skg_plan *plan_of(const skg_view *view, int is_double, int32_t supersampling,
                         const skg_detector_blur *blur) {
    skg_plan_options options;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    options.precision = is_double && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    options.quantity = SKG_QUANTITY_ATTENUATION, options.overlaps = 0;
    options.supersampling = supersampling, options.blur = blur;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(run_context, scene, view, beam, &options, &plan));
    skg_spectrum_release(&beam);
    return plan;
}

/* The derivative of the image by a twist of a part, and the gradient by it where the loss is the sum of the pixels that are chosen. */
static double find_both(skg_plan *plan, int64_t part, const double twist[6], const double *chosen,
                        double *found) {
    static double poses[PARTS][6], twists[PARTS][6];
    double sum = 0;
    skg_direction moving;
    skg_gradient gradient;
    const skg_adjoint given = adjoint_of(chosen);
    memset(twists, 0, sizeof twists);
    memcpy(twists[part], twist, sizeof twists[part]);
    skg_direction_init(&moving);
    moving.poses = twists[0];
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &moving, DOUBLES(found), NULL));
    skg_gradient_init(&gradient);
    gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int k = 0; k < 6; k++) sum += poses[part][k] * twist[k];
    return sum;
}

/* --- much matter */

typedef struct {
    const char *name;
    int32_t supersampling;
    int is_blurred, from; /* from: the first column of pixels behind the wedge */
} deep_case;

static const deep_case deep_cases[] = {
    {.name = "one sample", .supersampling = 1},
    {.name = "samples", .supersampling = 2},
    {.name = "a blur", .supersampling = 1, .is_blurred = 1},
    {.name = "a blur over the edge of the matter", .supersampling = 1, .is_blurred = 1, .from = SIDE / 2},
};

/* In a parallel beam along z, a wedge whose attenuation grows from 4 to 78, by 1 a mm of x. If it moves by a mm, the intensities of all rays
 * behind it grow by a factor of e, whatever a pixel's mean is of. */
START_TEST(deep_pixels_have_their_derivatives) {
    static const double line[3] = {0.25, 0.5, 0.25}, alone = 1, twist[6] = {1}, step = 3.2;
    static double chosen[PIXELS], found[PIXELS];
    const deep_case *c = &deep_cases[_i / 2];
    if (!suite_full() && _i % 2 == 0) return; /* touching_parts_have_one_side has single, in cones */
    const int first = c->from ? c->from + 1 : 0;
    const double low = c->from ? -1 : -60; /* within the pixel before */
    skg_detector_blur blur;
    solid wedge = solid_box(1, 200, 1);
    skg_view view = run_view(SIDE, step);
    view.projection = SKG_PROJECTION_PARALLEL;
    for (int64_t v = 0; v < wedge.vertices; v++) {
        double *at = wedge.positions + 3 * v;
        at[0] = at[0] < 0 ? low : 40;
        at[2] = at[2] < 0 ? -1 : at[0] + 40;
    }
    skg_mesh *mesh = run_mesh(&wedge);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "wedge", mesh, 10, NULL, -1);
    skg_detector_blur_init(&blur);
    blur.columns = 3, blur.rows = 1, blur.along_row = line, blur.along_column = &alone;
    skg_plan *plan = plan_of(&view, _i % 2, c->supersampling, c->is_blurred ? &blur : NULL);
    for (int p = 0; p < PIXELS; p++) chosen[p] = p % SIDE >= first;
    const double sum = find_both(plan, 0, twist, chosen, found);
    /* Single: the attenuation that the image has is rounded, 2^-24 of 78. */
    const double bar = _i % 2 ? 1e-6 : 2e-5, right = -SIDE * (SIDE - first);
    ck_assert_msg(fabs(sum - right) <= bar * fabs(right), "%s: gradient %.9g, not %g", c->name, sum, right);
    for (int p = 0; p < PIXELS; p++)
        if (chosen[p] > 0)
            ck_assert_msg(fabs(found[p] + 1) <= bar, "%s, column %d: %.9g", c->name, p % SIDE, found[p]);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_mesh_release(&mesh);
    solid_free(&wedge);
}
END_TEST

/* --- parts that touch */

enum { BLOCKS = 4 };

/* A box: its size, where its middle is along the normal of the face at which blocks touch, mm; 1/cm. */
typedef struct {
    double size[3], at, mu;
    int32_t priority, within; /* within: the number of the box that it lies inside, from 1; 0: none */
} block;

typedef struct {
    const char *name;
    block blocks[BLOCKS];
    double face; /* where the face crosses the z axis; the detector stands at 200 */
    int64_t moving;
    double right; /* 1/cm: the change of the attenuation for a mm of the ray */
} touch_case;

#define BEHIND {90, 97, 150}, 75 /* begins at the face, and ends behind the detector */
static const touch_case touch_cases[] = {
    {.name = "hidden, the first",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 0, 0},
                {{92, 90, 15}, 7.5, 0.5, 0, 0},
                {{33, 31, 10}, 0, 0.1, 1, 0}},
     .moving = 0,
     .right = -0.3},
    {.name = "hidden, the second",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 0, 0},
                {{92, 90, 15}, 7.5, 0.5, 0, 0},
                {{33, 31, 10}, 0, 0.1, 1, 0}},
     .moving = 1,
     .right = 0.5},
    {.name = "one that wins, before the other",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}},
     .face = 150,
     .moving = 0,
     .right = 0},
    {.name = "the other",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}},
     .face = 150,
     .moving = 1,
     .right = -0.5},
    {.name = "one that wins, behind the other",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 0, 0}, {BEHIND, 0.5, 1, 0}},
     .face = 150,
     .moving = 1,
     .right = -0.5},
    {.name = "one that wins begins where the other does",
     .blocks = {{{60, 61, 150}, 75, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}},
     .face = 150,
     .moving = 0,
     .right = -0.3},
    {.name = "the other begins there",
     .blocks = {{{60, 61, 150}, 75, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}},
     .face = 150,
     .moving = 1,
     .right = 0},
    {.name = "one of two that end where the third begins, over the fourth",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 1, 0},
                {{92, 90, 15}, 7.5, 0.5, 1, 0},
                {{91, 93, 15}, -7.5, 0.7, 1, 0},
                {{70, 71, 25}, 0, 0.2, 0, 0}},
     .moving = 0,
     .right = 0},
    {.name = "the other one",
     .blocks = {{{90, 91, 15}, -7.5, 0.3, 1, 0},
                {{92, 90, 15}, 7.5, 0.5, 1, 0},
                {{91, 93, 15}, -7.5, 0.7, 1, 0},
                {{70, 71, 25}, 0, 0.2, 0, 0}},
     .moving = 2,
     .right = 0},
    {.name = "one of two that begin there and win",
     .blocks = {{{60, 61, 150}, 75, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}, {{62, 60, 150}, 75, 0.1, 1, 0}},
     .face = 150,
     .moving = 0,
     .right = -0.3},
    {.name = "the other one of the two",
     .blocks = {{{60, 61, 150}, 75, 0.3, 1, 0}, {BEHIND, 0.5, 0, 0}, {{62, 60, 150}, 75, 0.1, 1, 0}},
     .face = 150,
     .moving = 2,
     .right = -0.1},
};
enum { TOUCH_CASES = sizeof touch_cases / sizeof *touch_cases };

/* Where blocks are turned to, so that the depths of both faces are rounded: about y, then about x. */
static const double turns[][2] = {{0, 0}, {0.31, -0.22}, {0.93, 0.4}};
enum { TURNS = sizeof turns / sizeof *turns };

static void turn_blocks(const double turn[2], double pose[16]) {
    const double cy = cos(turn[0]), sy = sin(turn[0]), cx = cos(turn[1]), sx = sin(turn[1]);
    const double rows[16] = {cy, 0, sy, 0, sx * sy, cx, -sx * cy, 0, -cx * sy, sx, cx * cy, 0, 0, 0, 0, 1};
    memcpy(pose, rows, sizeof rows);
}

static void make_blocks(const touch_case *c, const double turned[16]) {
    static const char *const names[BLOCKS] = {"first", "second", "third", "fourth"};
    ck_skg(skg_scene_create(run_context, &scene));
    for (int b = 0; b < BLOCKS && c->blocks[b].mu > 0; b++) {
        const block *own = &c->blocks[b];
        solid s = solid_box(own->size[0], own->size[1], own->size[2]);
        skg_part part;
        skg_part_init(&part);
        part.mesh = run_mesh(&s);
        part.label = names[b], part.inside = own->within - 1, part.priority = own->priority;
        memcpy(part.pose, turned, sizeof part.pose);
        for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = own->at * turned[4 * k + 2];
        part.pose[11] += c->face;
        ck_skg(skg_material_create_mu(names[b], own->mu, &part.material));
        ck_skg(skg_scene_part_add(scene, &part, NULL));
        skg_material_release(&part.material);
        skg_mesh_release(&part.mesh);
        solid_free(&s);
    }
}

/* The cosine of the ray to a pixel and the normal of the face. */
static double cosine_of(const skg_view *view, const double turned[16], int pixel) {
    const double across = pixel % SIDE - (SIDE - 1) / 2.0, down = pixel / SIDE - (SIDE - 1) / 2.0;
    const int parallel = view->projection == SKG_PROJECTION_PARALLEL;
    double along = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        const double at = across * view->column_step[k] + down * view->row_step[k];
        const double way = view->centre[k] - view->source[k] + (parallel ? 0 : at);
        along += way * turned[4 * k + 2], length += way * way;
    }
    return along / sqrt(length);
}

/* A block moves by a mm along the normal. Where one displaces the other the image has a kink; the derivative is that of the side to which a gap
 * opens, or the one that displaces is the larger; of three that meet, that on which they overlap. */
START_TEST(touching_parts_have_one_side) {
    static double chosen[PIXELS], found[PIXELS];
    const touch_case *c = &touch_cases[_i / 4 % TOUCH_CASES];
    const double *turn = turns[_i / 4 / TOUCH_CASES];
    double turned[16], twist[6] = {0}, sum = 0, all = 0;
    if (!suite_full() && (_i % 4 == 1 || _i % 4 == 2)) return; /* cones in single, parallel beams in double */
    skg_view view = run_view(SIDE, 0.9);
    view.source[0] = 3, view.source[1] = -2;
    if (_i % 2) view.projection = SKG_PROJECTION_PARALLEL;
    turn_blocks(turn, turned);
    make_blocks(c, turned);
    skg_plan *plan = plan_of(&view, _i / 2 % 2, 1, NULL);
    for (int k = 0; k < 3; k++) twist[k] = turned[4 * k + 2];
    for (int p = 0; p < PIXELS; p++)
        chosen[p] = abs(2 * (p % SIDE) - SIDE + 1) < 12 && abs(2 * (p / SIDE) - SIDE + 1) < 12;
    const double got = find_both(plan, c->moving, twist, chosen, found);
    for (int p = 0; p < PIXELS; p++) {
        const double right = c->right / 10 / cosine_of(&view, turned, p);
        if (chosen[p] == 0) continue;
        sum += right, all += fabs(right);
        /* single: the normals of faces by corners that are rounded */
        ck_assert_msg(fabs(found[p] - right) <= 2e-5, "%s, turn %d, pixel %d: %.9g, not %.9g", c->name,
                      _i / 4 / TOUCH_CASES, p, found[p], right);
    }
    /* the same */
    ck_assert_msg(fabs(got - sum) <= 2e-5 * fmax(all, 1), "%s, turn %d: gradient %.9g, not %.9g", c->name,
                  _i / 4 / TOUCH_CASES, got, sum);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

/* --- little matter within much */

/* A slab of air, a thousand times thinner than the tissue around it: what it contributes is the difference of both, but the derivative by its
 * density is its own attenuation. */
START_TEST(thin_matter_has_its_density) {
    static double chosen[PIXELS];
    const touch_case slab = {.blocks = {{{190, 191, 60}, 0, 0.2, 0, 0}, {{90, 91, 10}, 3, 2e-4, 0, 1}}};
    double turned[16], densities[PARTS], air = 0, tissue = 0;
    skg_gradient gradient;
    skg_view view = run_view(SIDE, 0.9);
    view.source[0] = 3, view.source[1] = -2;
    turn_blocks(turns[1], turned);
    make_blocks(&slab, turned);
    skg_plan *plan = plan_of(&view, _i % 2, 1, NULL);
    for (int p = 0; p < PIXELS; p++) {
        chosen[p] = p % 7 == 0 && p / SIDE > 7 && p / SIDE < 16;
        air += chosen[p] * 2e-5 * 10 / cosine_of(&view, turned, p);
        tissue += chosen[p] * 0.02 * (60 - 10) / cosine_of(&view, turned, p);
    }
    const skg_adjoint given = adjoint_of(chosen);
    skg_gradient_init(&gradient);
    gradient.densities = densities;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    /* docs/numerics.md, Accuracy */
    ck_assert_msg(fabs(densities[1] - air) <= 2e-5 * air, "air %.9g, not %.9g", densities[1], air);
    ck_assert_msg(fabs(densities[0] - tissue) <= 2e-5 * tissue, "tissue %.9g, not %.9g", densities[0],
                  tissue);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

void add_closed_tests(TCase *tests) {
    tcase_add_loop_test(tests, deep_pixels_have_their_derivatives, 0,
                        2 * sizeof deep_cases / sizeof *deep_cases);
    tcase_add_loop_test(tests, touching_parts_have_one_side, 0, 4 * TURNS * TOUCH_CASES);
    tcase_add_loop_test(tests, thin_matter_has_its_density, 0, suite_turns(2, 1));
}
