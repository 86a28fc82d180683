/* Volumes whose values change linearly between the centres of their cells: integrals along rays against closed forms and quadrature. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, COLUMNS = 5, ROWS = 4, SLICES = 6, CELLS = COLUMNS * ROWS * SLICES };
static const int size[3] = {COLUMNS, ROWS, SLICES};
static const double spacing[3] = {8, 11, 9}, scale = 0.01; /* mm; 1/cm of a whole number */

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static skg_view view;
static double values[CELLS];

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = 120, view.source[1] = -90, view.source[2] = -400;
    view.centre[0] = -30, view.centre[1] = 25, view.centre[2] = 150;
    view.column_step[0] = view.row_step[1] = 4.1;
    view.column_step[2] = 0.9;
}

static void close_context(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

/* whole: 1: cells of 16 bits */
static void add_volume(int32_t interpolation, int whole) {
    skg_volume_source source;
    skg_part part;
    double cells[CELLS];
    for (int c = 0; c < CELLS; c++) cells[c] = whole ? rint(values[c] / scale) : values[c];
    skg_volume_source_init(&source);
    source.columns = COLUMNS, source.rows = ROWS, source.slices = SLICES;
    source.values = SKG_VOLUME_MU, source.type = SKG_VOLUME_FLOAT64, source.cells = cells;
    source.interpolation = interpolation;
    for (int k = 0; k < 3; k++)
        source.affine[5 * k] = spacing[k], source.affine[4 * k + 3] = -0.5 * spacing[k] * (size[k] - 1);
    skg_part_init(&part);
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = "volume";
    skg_scene_release(&scene);
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
}

static void render(skg_context *on, int32_t strategy, double *image) {
    skg_plan_options options;
    skg_output output;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    skg_output_init(&output);
    options.quantity = SKG_QUANTITY_ATTENUATION, options.strategy = strategy;
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_create(on, scene, &view, beam, &options, &plan));
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
}

/* --- a ray in indices of cells: index at + t way, within the box from ends[0] to ends[1] */

typedef struct {
    double at[3], way[3], ends[2], mm;
} ray;

static ray ray_of(int pixel) {
    ray r = {.ends = {0, 1}};
    const double i = pixel % SIDE - 0.5 * (SIDE - 1), j = (double)(pixel / SIDE) - 0.5 * (SIDE - 1);
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double to = view.centre[k] + i * view.column_step[k] + j * view.row_step[k];
        square += (to - view.source[k]) * (to - view.source[k]);
        r.at[k] = view.source[k] / spacing[k] + 0.5 * (size[k] - 1);
        r.way[k] = (to - view.source[k]) / spacing[k];
        const double a = (-0.5 - r.at[k]) / r.way[k], b = (size[k] - 0.5 - r.at[k]) / r.way[k];
        r.ends[0] = fmax(r.ends[0], fmin(a, b)), r.ends[1] = fmin(r.ends[1], fmax(a, b));
    }
    r.mm = sqrt(square);
    if (!(r.ends[1] > r.ends[0])) r.ends[1] = r.ends[0];
    return r;
}

/* The integral of clamp(x, 0, most) by x, from 0. */
static double clamped(double x, double most) {
    return x < 0 ? 0 : x < most ? x * x / 2 : most * most / 2 + most * (x - most);
}

static void compare(const double *image, double (*integral)(const ray *), double bar) {
    double largest = 0;
    int used = 0;
    for (int p = 0; p < PIXELS; p++) largest = fmax(largest, image[p]);
    for (int p = 0; p < PIXELS; p++) {
        const ray r = ray_of(p);
        const double expected = integral(&r) * r.mm / 10; /* 1/cm */
        ck_assert_msg(fabs(image[p] - expected) <= bar * largest, "pixel %d: %.9g, not %.9g", p, image[p],
                      expected);
        used += expected > 0;
    }
    ck_assert_int_gt(used, PIXELS / 8);
}

/* --- a ramp */

static const double ramp[3] = {0.03, 0.05, 0.02};

static double of_ramp(const ray *r) {
    double sum = 0.07 * (r->ends[1] - r->ends[0]);
    for (int k = 0; k < 3; k++) {
        const double a = r->at[k] + r->ends[0] * r->way[k], b = r->at[k] + r->ends[1] * r->way[k];
        sum += ramp[k] * (clamped(b, size[k] - 1) - clamped(a, size[k] - 1)) / r->way[k];
    }
    return sum;
}

START_TEST(a_ramp_is_a_ramp) {
    static double image[PIXELS];
    for (int c = 0; c < CELLS; c++)
        values[c] =
            0.07 + ramp[0] * (c % COLUMNS) + ramp[1] * (c / COLUMNS % ROWS) + ramp[2] * (c / COLUMNS / ROWS);
    add_volume(SKG_VOLUME_LINEAR, 0);
    render(context, SKG_STRATEGY_AUTO, image);
    compare(image, of_ramp, 3e-6); /* crossings to 2^-23 of a cell, weights and sums of floats */
}
END_TEST

/* --- any values */

static void fill(void) {
    uint32_t state = 5;
    for (int c = 0; c < CELLS; c++) {
        state = state * 1664525u + 1013904223u;
        values[c] = scale * (double)(state >> 26);
    }
}

static double value_at(const ray *r, double t) {
    double sum = 0, share[3];
    int lower[3];
    for (int k = 0; k < 3; k++) {
        const double at = fmin(fmax(r->at[k] + t * r->way[k], 0), size[k] - 1);
        lower[k] = (int)fmin(floor(at), size[k] - 2);
        share[k] = at - lower[k];
    }
    for (int corner = 0; corner < 8; corner++) {
        double own = 1;
        int at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = lower[k] + (corner >> k & 1);
            own *= corner >> k & 1 ? share[k] : 1 - share[k];
        }
        sum += own * values[(at[2] * ROWS + at[1]) * COLUMNS + at[0]];
    }
    return sum;
}

static double by_midpoints(const ray *r) {
    enum { STEPS = 4000 };
    double sum = 0;
    for (int k = 0; k < STEPS; k++)
        sum += value_at(r, r->ends[0] + (r->ends[1] - r->ends[0]) * (k + 0.5) / STEPS);
    return sum * (r->ends[1] - r->ends[0]) / STEPS;
}

/* Cells of 32 and of 16 bits. */
START_TEST(values_are_linear_between_centres) {
    static double image[PIXELS];
    fill();
    add_volume(SKG_VOLUME_LINEAR, 0);
    render(context, SKG_STRATEGY_AUTO, image);
    compare(image, by_midpoints, 5e-6); /* as above, and midpoints */
}
END_TEST

/* Whole numbers have cells of 16 bits, and are those of 32 bits a hundred times. */
START_TEST(narrow_cells_are_as_wide_ones) {
    static double wide[PIXELS], narrow[PIXELS];
    double largest = 0;
    fill();
    add_volume(SKG_VOLUME_LINEAR, 0);
    render(context, SKG_STRATEGY_AUTO, wide);
    add_volume(SKG_VOLUME_LINEAR, 1);
    render(context, SKG_STRATEGY_AUTO, narrow);
    for (int p = 0; p < PIXELS; p++) largest = fmax(largest, wide[p]);
    for (int p = 0; p < PIXELS; p++) /* roundings of weights, which are floats */
        ck_assert_double_eq_tol(scale * narrow[p], wide[p], 3e-6 * largest);
}
END_TEST

START_TEST(every_strategy_has_the_same_bits) {
    static const int32_t strategies[3] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_ATOMICS, SKG_STRATEGY_TILES};
    static double first[PIXELS], image[PIXELS];
    fill();
    add_volume(SKG_VOLUME_LINEAR, 0);
    for (int k = 0; k < 4; k++) {
        skg_context *alone = NULL;
        if (k == 3) {
            ck_skg(skg_context_create("device=cpu threads=1", &alone));
            add_volume(SKG_VOLUME_LINEAR, 0);
        }
        render(alone ? alone : context, strategies[k % 3], k ? image : first);
        if (k) ck_assert_mem_eq(image, first, sizeof first);
        skg_context_release(&alone);
    }
}
END_TEST

static void put_block(void) {
    skg_part part;
    skg_part_init(&part);
    part.label = "block", part.inside = 0, part.pose[3] = 3, part.pose[11] = -4;
    ck_skg(skg_mesh_create_cuboid(14, 18, 11, &part.mesh));
    ck_skg(skg_material_create_mu("block", 2, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
}

/* Where all cells have one value, both ways are one, also where a mesh displaces them. Others are not, and have no derivatives. */
START_TEST(meshes_displace_what_is_between) {
    static double images[2][PIXELS], poses[2][6];
    double largest = 0;
    for (int c = 0; c < CELLS; c++) values[c] = 0.4;
    for (int k = 0; k < 2; k++) {
        add_volume(k ? SKG_VOLUME_LINEAR : SKG_VOLUME_CELLS, 0);
        put_block();
        render(context, SKG_STRATEGY_AUTO, images[k]);
    }
    for (int p = 0; p < PIXELS; p++) largest = fmax(largest, images[0][p]);
    for (int p = 0; p < PIXELS; p++) /* crossings to 2^-23 of a cell */
        ck_assert_double_eq_tol(images[1][p], images[0][p], 3e-6 * largest);
    skg_plan *plan = NULL;
    skg_adjoint given;
    skg_gradient gradient;
    skg_adjoint_init(&given);
    skg_gradient_init(&gradient);
    given.channels = 1, given.rows = given.columns = SIDE, given.data = images[0], gradient.poses = poses[0];
    ck_skg(skg_plan_create(context, scene, &view, beam, NULL, &plan));
    ck_skg_fails(skg_plan_gradient(plan, NULL, &given, &gradient), SKG_ERR_UNSUPPORTED,
                 "linear between its cells");
    skg_plan_release(&plan);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, a_ramp_is_a_ramp);
    tcase_add_test(tests, values_are_linear_between_centres);
    tcase_add_test(tests, narrow_cells_are_as_wide_ones);
    tcase_add_test(tests, every_strategy_has_the_same_bits);
    tcase_add_test(tests, meshes_displace_what_is_between);
}

SKG_SUITE_MAIN("volume_linear", add_tests)
