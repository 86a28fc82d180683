/* Faces that contain rays, of parts that compete by priority: moving such a face changes the mean of a pixel by what the part wins along it,
 * less what it takes from others. Boxes give both exactly. */
#include "gradient_closed.h"
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>

enum { BODY, PLATE, CORE, BOXES };

static const double pitch = 4;

/* A box of a scene: its size and place in mm, a turn about y and then about x in radians, and its attenuation in 1/mm. */
typedef struct {
    double size[3], at[3], turn_y, turn_x, mu;
    int64_t inside;
    int32_t priority;
} box;

/* A case: the part that it moves, and the change of the sum of the right half of the image, in mm of depth times mm of height, times 1/mm. */
typedef struct {
    const char *name;
    box boxes[BOXES];
    int64_t moving;
    double change;
} edge_case;

/* In all of them the body is 33 mm deep and 17.9 mm high, and the plate is 10 mm thick. */
#define BODY_BOX                                                                                             \
    { .size = {21.3, 17.9, 33}, .mu = 0.1, .inside = -1 }
static const edge_case cases[] = {
    {.name = "the body loses inside the plate",
     .boxes = {BODY_BOX, {.size = {61, 57, 10}, .at = {0, 0, 3}, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = BODY,
     .change = 17.9 * (33 - 10) * 0.1},
    {.name = "the plate takes from the body",
     .boxes = {BODY_BOX, {.size = {9, 11.3, 10}, .at = {0, 0, 3}, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = PLATE,
     .change = 11.3 * 10 * (0.3 - 0.1)},
    {.name = "the plate stands out of the body",
     .boxes = {BODY_BOX, {.size = {9, 11.3, 10}, .at = {0, 0, 14.5}, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = PLATE,
     .change = 11.3 * (10 * 0.3 - 7 * 0.1)},
    {.name = "the plate displaces nothing",
     .boxes = {BODY_BOX, {.size = {9, 11.3, 10}, .at = {0, 0, 30}, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = PLATE,
     .change = 11.3 * 10 * 0.3},
    {.name = "a plate that is turned across the face",
     .boxes =
         {BODY_BOX,
          {.size = {91, 97, 10}, .at = {1, 0, 2}, .turn_y = 0.2, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = BODY,
     .change = 17.9 * (33 - 10 / 0.9800665778412416) * 0.1}, /* cos 0.2 */
    {.name = "a plate that is turned along the face",
     .boxes =
         {BODY_BOX,
          {.size = {91, 97, 10}, .at = {1, 0, 2}, .turn_x = 0.3, .mu = 0.3, .inside = -1, .priority = 1}},
     .moving = BODY,
     .change = 17.9 * (33 - 10 / 0.955336489125606) * 0.1}, /* cos 0.3 */
    {.name = "the plate is a hole",
     .boxes = {BODY_BOX, {.size = {9, 11.3, 10}, .at = {0, 0, 3}, .mu = 0, .inside = -1, .priority = 1}},
     .moving = PLATE,
     .change = 11.3 * 10 * -0.1},
    {.name = "what is inside the body falls with it",
     .boxes = {BODY_BOX,
               {.size = {9, 11.3, 10}, .at = {0, 0, 3}, .mu = 0.3, .inside = -1, .priority = 1},
               {.size = {17, 15.7, 4}, .at = {0, 0, 2}, .mu = 0.5, .inside = BODY}},
     .moving = PLATE,
     .change = 11.3 * (10 * 0.3 - 6 * 0.1 - 4 * 0.5)},
    {.name = "a face of what falls",
     .boxes = {BODY_BOX,
               {.size = {61, 57, 10}, .at = {0, 0, 3}, .mu = 0.3, .inside = -1, .priority = 1},
               {.size = {12, 15.7, 8}, .at = {0, 0, -5}, .mu = 0.5, .inside = BODY}},
     .moving = CORE,
     .change = 15.7 * (8 - 1) * (0.5 - 0.1)},
};

static void place(const box *b, double pose[16]) {
    const double cy = cos(b->turn_y), sy = sin(b->turn_y), cx = cos(b->turn_x), sx = sin(b->turn_x);
    const double turn[3][3] = {{cy, 0, sy}, {sx * sy, cx, -sx * cy}, {-cx * sy, sx, cx * cy}};
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) pose[4 * r + c] = turn[r][c];
        pose[4 * r + 3] = b->at[r];
    }
    for (int c = 0; c < 4; c++) pose[12 + c] = c == 3;
}

/* Makes the scene of the boxes that have a size. */
static void make_boxes(const box *boxes) {
    ck_skg(skg_scene_create(run_context, &scene));
    for (int b = 0; b < BOXES && boxes[b].size[0] > 0; b++) {
        static const char *const names[BOXES] = {"body", "plate", "core"};
        solid s = solid_box(boxes[b].size[0], boxes[b].size[1], boxes[b].size[2]);
        skg_part part;
        skg_part_init(&part);
        part.mesh = run_mesh(&s);
        part.label = names[b], part.inside = boxes[b].inside, part.priority = boxes[b].priority;
        place(&boxes[b], part.pose);
        ck_skg(skg_material_create_mu(names[b], 10 * boxes[b].mu, &part.material)); /* per cm */
        ck_skg(skg_scene_part_add(scene, &part, NULL));
        skg_material_release(&part.material);
        skg_mesh_release(&part.mesh);
        solid_free(&s);
    }
}

static skg_plan *plan_boxes(const skg_view *view, int is_double) {
    return run_plan(
        scene, view,
        (run_choice){.precision = is_double && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
}

/* The sum of the right half of the image, which holds the right faces alone: its gradient, and the derivative of the image. */
START_TEST(sides_count_where_their_part_wins) {
    static double adjoint[PIXELS], found[PIXELS];
    const edge_case *c = &cases[_i / 2];
    if (!suite_full() && _i % 2 == 0) return; /* gradient_closed.c has cones in single */
    double poses[BOXES][6], twists[BOXES][6] = {{0}}, sum = 0;
    const double expected = c->change / (pitch * pitch);
    skg_gradient gradient;
    skg_direction moving;
    skg_view view = run_view(SIDE, pitch);
    view.projection = SKG_PROJECTION_PARALLEL;
    make_boxes(c->boxes);
    skg_plan *plan = plan_boxes(&view, _i % 2);
    for (int p = 0; p < PIXELS; p++) adjoint[p] = p % SIDE >= SIDE / 2;
    const skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    /* mu of the materials in single precision */
    ck_assert_msg(fabs(poses[c->moving][0] - expected) <= 1e-5 * fabs(expected),
                  "%s: gradient %.9g, not %.9g", c->name, poses[c->moving][0], expected);
    skg_direction_init(&moving);
    twists[c->moving][0] = 1;
    moving.poses = twists[0];
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &moving, DOUBLES(found), NULL));
    for (int p = 0; p < PIXELS; p++) sum += adjoint[p] * found[p];
    /* the same */
    ck_assert_msg(fabs(sum - expected) <= 1e-5 * fabs(expected), "%s: derivative %.9g, not %.9g", c->name,
                  sum, expected);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

/* --- a cone beam */

static int is_inside(const box *b, const double at[3]) {
    double pose[16];
    place(b, pose);
    for (int axis = 0; axis < 3; axis++) {
        double along = 0;
        for (int k = 0; k < 3; k++) along += pose[4 * k + axis] * (at[k] - b->at[k]);
        if (fabs(along) > b->size[axis] / 2) return 0; /* no tolerance */
    }
    return b->size[0] > 0;
}

/* The attenuation at a point: the plate displaces the body and the core in it. */
static double mu_at(const box *boxes, const double at[3]) {
    if (is_inside(&boxes[PLATE], at)) return boxes[PLATE].mu;
    if (is_inside(&boxes[BODY], at)) return is_inside(&boxes[CORE], at) ? boxes[CORE].mu : boxes[BODY].mu;
    return 0;
}

/* The change of the sum of the right half where the source stands at z = -1000 in the plane of the right face, and the detector at
 * z = 200: a cube of matter at depth z covers as many pixels as its magnification says, and rays cross it obliquely. */
static double change_in_cone(const edge_case *c) {
    enum { DEPTHS = 8000, HEIGHTS = 50 };
    const box *b = &c->boxes[c->moving];
    const double step[2] = {b->size[1] / HEIGHTS, b->size[2] / DEPTHS}, right = b->at[0] + b->size[0] / 2;
    double sum = 0;
    for (int h = 0; h < HEIGHTS; h++)
        for (int d = 0; d < DEPTHS; d++) {
            const double y = (h + 0.5) * step[0] - b->size[1] / 2;
            const double z = b->at[2] + (d + 0.5) * step[1] - b->size[2] / 2, far = 1000 + z;
            const double left[3] = {right - 1e-9, y, z}, beyond[3] = {right + 1e-9, y, z};
            sum += (mu_at(c->boxes, left) - mu_at(c->boxes, beyond)) * pow(1200 / far, 2) * hypot(1, y / far);
        }
    return sum * step[0] * step[1] / (pitch * pitch);
}

START_TEST(sides_in_a_cone_beam) {
    static double adjoint[PIXELS];
    const edge_case *c = &cases[_i];
    double poses[BOXES][6];
    skg_gradient gradient;
    skg_view view = run_view(SIDE, pitch);
    view.source[0] = c->boxes[c->moving].size[0] / 2 + c->boxes[c->moving].at[0];
    const double expected = change_in_cone(c);
    make_boxes(c->boxes);
    skg_plan *plan = plan_boxes(&view, suite_full()); /* single: the same bar */
    for (int p = 0; p < PIXELS; p++) adjoint[p] = p % SIDE >= SIDE / 2;
    const skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    /* Steps of 4 um in depth, of which 1 to 10 mm count; the obliquity is that of the pixels' centres. */
    ck_assert_msg(fabs(poses[c->moving][0] - expected) <= 1e-3 * fabs(expected), "%s: %.6g, not %.6g",
                  c->name, poses[c->moving][0], expected);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, sides_count_where_their_part_wins, 0, 2 * sizeof cases / sizeof *cases);
    tcase_add_loop_test(tests, sides_in_a_cone_beam, 0, sizeof cases / sizeof *cases);
    add_closed_tests(tests);
}

SKG_SUITE_MAIN("faces that contain rays", add_tests)
