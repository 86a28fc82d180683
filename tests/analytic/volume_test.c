/* Volumes of cells against arithmetic in long double: every cell is a box in its own axes, of which a ray has a chord, and what
 * displaces it is a box, too. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 40, COLUMNS = 7, ROWS = 5, SLICES = 6, CELLS = COLUMNS * ROWS * SLICES };

static skg_context *context;
static skg_scene *scene;
static skg_spectrum *beam;
static skg_view view;
static double values[CELLS]; /* 1/cm */
/* Cells of some 9 mm, turned, sheared and mirrored. */
static const double affine[16] = {8, 1, 0.5, -31, -1.5, -9, 1, 24, 0.3, 0.7, 10, -22, 0, 0, 0, 1};
static double pose[16] = {0.96, -0.28, 0, 5, 0.28, 0.96, 0, -3, 0, 0, 1, 4, 0, 0, 0, 1};

static void open_context(void) {
    static const double energy = 60, photons = 1000;
    uint32_t state = 1;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_spectrum_create_bins(1, &energy, &photons, &beam));
    for (int k = 0; k < CELLS; k++) {
        state = state * 1664525u + 1013904223u;
        values[k] = (double)(state >> 8) * 0x1p-24;
    }
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[0] = 30, view.source[1] = -20, view.source[2] = -700;
    view.centre[2] = 250;
    view.column_step[0] = view.row_step[1] = 3.1;
    view.row_step[0] = 0.3;
}

static void close_context(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

static skg_volume *make_volume(void) {
    skg_volume *volume = NULL;
    skg_volume_source source;
    skg_volume_source_init(&source);
    source.values = SKG_VOLUME_MU, source.type = SKG_VOLUME_FLOAT64;
    source.columns = COLUMNS, source.rows = ROWS, source.slices = SLICES;
    source.cells = values;
    memcpy(source.affine, affine, sizeof affine);
    ck_skg(skg_volume_create(&source, &volume));
    return volume;
}

static void add_volume(int64_t inside, int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    part.volume = make_volume(), part.label = "volume";
    part.inside = inside, part.priority = priority;
    memcpy(part.pose, pose, sizeof pose);
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
}

/* A block of 1 x 1 x 1 at a pose, mu in 1/cm. */
static void add_block(const char *label, const double *at, double mu, int64_t inside, int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    part.label = label, part.inside = inside, part.priority = priority;
    memcpy(part.pose, at, sizeof part.pose);
    ck_skg(skg_mesh_create_cuboid(1, 1, 1, &part.mesh));
    ck_skg(skg_material_create_mu(label, mu, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
}

/* --- the oracle */

typedef struct {
    long double from[3], to[3];
} line;

/* Where a column lies from the middle, along the column step and towards z = 0, where the source is or the axis of the cylinder. */
static void place_of(int column, long double *across, long double *ahead) {
    const long double from_middle = (column - 0.5L * (SIDE - 1)) * (long double)view.column_step[0];
    *across = from_middle, *ahead = 0;
    if (!(view.radius > 0)) return;
    *across = (long double)view.radius * sinl(from_middle / (long double)view.radius);
    *ahead = (long double)view.radius * (1 - cosl(from_middle / (long double)view.radius));
}

static line ray_of(int row, int column) {
    line ray;
    long double along[3], square = 0, ahead = 0, bent[3] = {0};
    place_of(column, &bent[0], &bent[2]);
    for (int k = 0; k < 3; k++) {
        ray.to[k] = (long double)view.centre[k] + (k == 2 ? -bent[k] : bent[k]) +
                    (row - 0.5L * (SIDE - 1)) * (long double)view.row_step[k];
        ray.from[k] = (long double)view.source[k];
        along[k] = (long double)view.centre[k] - (long double)view.source[k];
    }
    if (view.projection == SKG_PROJECTION_POINT) return ray;
    if (view.projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
        for (int k = 0; k < 3; k++) ray.from[k] = ray.to[k] - 1e4L * (long double)view.source[k];
        return ray;
    }
    for (int k = 0; k < 3; k++) square += along[k] * along[k], ahead += along[k] * (ray.to[k] - ray.from[k]);
    for (int k = 0; k < 3; k++) ray.from[k] = ray.to[k] - along[k] * ahead / square;
    return ray;
}

/* The coordinates of a point in the axes of a matrix. */
static void into(const double *m, const long double p[3], long double q[3]) {
    long double a[3][3], b[3], d;
    for (int r = 0; r < 3; r++) {
        b[r] = p[r] - (long double)m[4 * r + 3];
        for (int c = 0; c < 3; c++) a[r][c] = (long double)m[4 * r + c];
    }
    d = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
        a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    for (int k = 0; k < 3; k++) {
        long double e[3][3];
        memcpy(e, a, sizeof e);
        for (int r = 0; r < 3; r++) e[r][k] = b[r];
        q[k] = (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
               d;
    }
}

/* The shares of a line between which it is in the box of a unit around a place; none: from > to. */
static void span_of(const line *ray, const double place[3], long double span[2]) {
    span[0] = 0, span[1] = 1;
    for (int k = 0; k < 3; k++) {
        const long double way = ray->to[k] - ray->from[k], low = (long double)place[k] - 0.5L - ray->from[k];
        if (way == 0) {
            if (low > 0 || low + 1 < 0) span[1] = -1;
            continue;
        }
        const long double a = low / way, b = (low + 1) / way;
        span[0] = fmaxl(span[0], fminl(a, b)), span[1] = fminl(span[1], fmaxl(a, b));
    }
}

static long double overlap(const long double a[2], const long double b[2]) {
    return fmaxl(0, fminl(a[1], b[1]) - fmaxl(a[0], b[0]));
}

static void multiply(const double *a, const double *b, double *product) {
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            product[4 * r + c] = 0;
            for (int k = 0; k < 4; k++) product[4 * r + c] += a[4 * r + k] * b[4 * k + c];
        }
}

/* Cells, without what lies in a block and, of that, mu; the rest of an outer block around both. NULL: there is none. wins: the
 * volume displaces the block, not the block the volume */
typedef struct {
    const double *block, *outer;
    double block_mu, outer_mu;
    int wins, reserved;
} truth;

static long double attenuation_of(const truth *t, int row, int column) {
    static const double middle[3] = {0, 0, 0};
    const line ray = ray_of(row, column);
    double whole[16];
    line own;
    long double sum = 0, block[2] = {1, 0}, outer[2] = {1, 0},
                cells = 0, /* an interval from 1 to 0: nowhere */
        inside = 0;
    const double *const boxes[2] = {t->block, t->outer};
    for (int b = 0; b < 2; b++) {
        if (!boxes[b]) continue;
        into(boxes[b], ray.from, own.from);
        into(boxes[b], ray.to, own.to);
        span_of(&own, middle, b ? outer : block);
    }
    multiply(pose, affine, whole);
    into(whole, ray.from, own.from);
    into(whole, ray.to, own.to);
    for (int k = 0; k < CELLS; k++) {
        const double place[3] = {k % COLUMNS, k / COLUMNS % ROWS, k / COLUMNS / ROWS};
        long double span[2];
        span_of(&own, place, span);
        if (!(span[1] > span[0])) continue;
        const long double length = span[1] - span[0], shared = overlap(span, block);
        cells += length, inside += shared;
        sum += (long double)values[k] * (t->wins ? length : length - shared);
    }
    const long double of_block = fmaxl(block[1] - block[0], 0) - (t->wins ? inside : 0);
    sum += (long double)t->block_mu * of_block;
    if (t->outer)
        sum += (long double)t->outer_mu * (fmaxl(outer[1] - outer[0], 0) - cells -
                                           (t->wins ? of_block : fmaxl(block[1] - block[0], 0) - inside));
    long double square = 0;
    for (int k = 0; k < 3; k++) square += (ray.to[k] - ray.from[k]) * (ray.to[k] - ray.from[k]);
    return sum * sqrtl(square) / 10;
}

/* Compares an image with the truth. In single precision places of faces of meshes are rounded; cells alone meet 1e-6. */
static void compare(const truth *t, const char *what, double bar) {
    static double image[SIDE * SIDE];
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    for (int precision = SKG_PRECISION_SINGLE; precision <= SKG_PRECISION_DOUBLE; precision++) {
        double worst = 0, most = 0;
        /* Cones in single and parallel beams in double: the rest for ./check --full. */
        if (!suite_full() && (precision == SKG_PRECISION_DOUBLE) == (view.projection == SKG_PROJECTION_POINT))
            continue;
        options.precision = precision;
        ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
        ck_skg(skg_plan_image(plan, &output));
        for (int k = 0; k < SIDE * SIDE; k++) {
            const double expected = (double)attenuation_of(t, k / SIDE, k % SIDE);
            worst = fmax(worst, fabs(image[k] - expected)), most = fmax(most, expected);
        }
        ck_assert_double_gt(most, 1);
        ck_assert_msg(worst <= bar * most, "%s, precision %d: worst %g of %g", what, precision, worst, most);
        skg_plan_release(&plan);
    }
}

/* The fourth and fifth: the source in the volume, and the detector through it. From the sixth on the detector is curved; in the last three it
 * goes through the volume, where the rays of the last one start, too, aslant to the columns. */
enum { FLAT_VIEWS = 5, VIEWS = 11 };
static void set_projection(int which) {
    static const int32_t projections[VIEWS] = {SKG_PROJECTION_POINT,
                                               SKG_PROJECTION_PARALLEL,
                                               SKG_PROJECTION_PARALLEL_FROM_INFINITY,
                                               SKG_PROJECTION_POINT,
                                               SKG_PROJECTION_PARALLEL,
                                               SKG_PROJECTION_POINT,
                                               SKG_PROJECTION_PARALLEL,
                                               SKG_PROJECTION_PARALLEL_FROM_INFINITY,
                                               SKG_PROJECTION_POINT,
                                               SKG_PROJECTION_PARALLEL,
                                               SKG_PROJECTION_PARALLEL};
    static const double radii[VIEWS] = {0, 0, 0, 0, 0, 950, 120, 90, 70, 80, 100};
    view.projection = projections[which];
    view.radius = radii[which];
    if (which >= FLAT_VIEWS) view.row_step[0] = 0;
    if (which == 7) view.source[0] = 0.2, view.source[1] = -0.1, view.source[2] = 3;
    if (which == 8 || which == 9) view.centre[2] = 12;
    if (which == 10) view.source[0] = 10, view.source[1] = -8, view.source[2] = -20, view.centre[2] = 40;
    if (which == 3) view.source[0] = 1, view.source[1] = 2, view.source[2] = 3;
    if (which == 4) view.centre[2] = 12;
    if (which == 2) view.source[0] = 0.2, view.source[1] = -0.1, view.source[2] = 3;
}

START_TEST(cells_are_boxes) {
    const truth alone = {.wins = 1};
    set_projection(_i);
    add_volume(-1, 0);
    /* Crossings are floats, 2^-24 of a cell, of 20 that a ray meets. */
    compare(&alone, "cells", 1e-6);
}
END_TEST

/* Every cell as a mesh of its own, in double precision. */
START_TEST(a_curved_detector_sees_cells_as_meshes) {
    static double images[2][SIDE * SIDE];
    double most = 0, whole[16];
    skg_plan_options options;
    skg_output output;
    skg_output_init(&output);
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION, options.precision = SKG_PRECISION_DOUBLE;
    output.type = SKG_TYPE_FLOAT64;
    set_projection(FLAT_VIEWS);
    multiply(pose, affine, whole);
    for (int meshes = 0; meshes < 2; meshes++) {
        skg_plan *plan = NULL;
        if (!meshes) add_volume(-1, 0);
        for (int k = 0; meshes && k < CELLS; k++) {
            double place[16] = {1, 0, 0, k % COLUMNS,        0, 1, 0, k / COLUMNS % ROWS,
                                0, 0, 1, k / COLUMNS / ROWS, 0, 0, 0, 1},
                   at[16];
            char label[16];
            snprintf(label, sizeof label, "cell %d", k);
            multiply(whole, place, at);
            add_block(label, at, values[k], -1, 0);
        }
        output.data = images[meshes];
        ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
        ck_skg(skg_plan_image(plan, &output));
        skg_plan_release(&plan);
        skg_scene_release(&scene);
        ck_skg(skg_scene_create(context, &scene));
    }
    for (int k = 0; k < SIDE * SIDE; k++) most = fmax(most, images[1][k]);
    ck_assert_double_gt(most, 1);
    for (int k = 0; k < SIDE * SIDE; k++) /* as above: crossings of cells are floats */
        ck_assert_double_eq_tol(images[0][k], images[1][k], 1e-6 * most);
}
END_TEST

static const double block[16] = {20, 6, 0, 2, -6, 14, 3, 4, 2, 1, 90, 5, 0, 0, 0, 1};
static const double outer[16] = {300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0, 0, 0, 1};

/* Faces of meshes: docs/numerics.md. */
static const double MESHES = 3e-5;

START_TEST(a_part_inside_displaces_cells) {
    const truth t = {.block = block, .block_mu = 2};
    set_projection(_i);
    add_volume(-1, 0);
    add_block("rod", block, 2, 0, 0);
    compare(&t, "rod inside", MESHES);
}
END_TEST

START_TEST(the_higher_priority_displaces_cells_or_is_displaced) {
    const truth t = {.block = block, .block_mu = 2, .wins = _i};
    add_volume(-1, _i ? 2 : 0);
    add_block("rod", block, 2, -1, 1);
    compare(&t, _i ? "volume over rod" : "rod over volume", MESHES);
}
END_TEST

START_TEST(a_volume_displaces_what_it_lies_inside) {
    const truth t = {.block = block, .block_mu = 2, .outer = outer, .outer_mu = 0.05};
    add_block("bath", outer, 0.05, -1, 0);
    add_volume(0, 0);
    add_block("rod", block, 2, _i ? 0 : 1, _i);
    if (!_i) ck_skg(skg_scene_part_pose_set(scene, 2, block));
    /* As a child of the volume the rod protrudes from it, and takes nothing from the bath there. */
    if (_i) compare(&t, "rod over volume in a bath", MESHES);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_loop_test(tests, cells_are_boxes, 0, VIEWS);
    tcase_add_loop_test(tests, a_part_inside_displaces_cells, 0, FLAT_VIEWS + 2);
    tcase_add_test(tests, a_curved_detector_sees_cells_as_meshes);
    tcase_add_loop_test(tests, the_higher_priority_displaces_cells_or_is_displaced, 0, 2);
    tcase_add_loop_test(tests, a_volume_displaces_what_it_lies_inside, 1, 2);
}

SKG_SUITE_MAIN("volume", add_tests)
