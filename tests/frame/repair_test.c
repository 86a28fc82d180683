/* Open meshes against the closed ones that they were made from: what is reported, what is left out, and both
 * repairs. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 200, LIMIT = 4000 };
static const double RADIUS = 40;

static skg_context *context;
static skg_material *water;
static skg_spectrum *beam;
static skg_view view;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 0.55;
}

static void close_context(void) {
    skg_material_release(&water);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
}

/* A sphere whose triangles may be changed. */
typedef struct {
    int64_t vertices, triangles;
    double positions[3 * LIMIT];
    int32_t corners[3 * LIMIT];
} soup;

static void fill_sphere(soup *s) {
    skg_mesh *sphere = NULL;
    ck_skg(skg_mesh_create_sphere(RADIUS, 24, &sphere));
    ck_skg(skg_mesh_count(sphere, &s->vertices, &s->triangles));
    ck_assert_int_lt(s->vertices, LIMIT - 8);
    ck_assert_int_lt(s->triangles, LIMIT - 8);
    ck_skg(skg_mesh_positions_get(sphere, s->positions, 3));
    ck_skg(skg_mesh_triangles_get(sphere, s->corners, 3));
    skg_mesh_release(&sphere);
}

static skg_mesh *mesh_of(const soup *s) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create(context, "sphere", s->vertices, s->positions, 3, s->triangles, s->corners, 3, 1,
                           &mesh));
    return mesh;
}

/* The triangle whose middle is nearest a place. */
static int64_t triangle_at(const soup *s, double x, double y, double z) {
    const double place[3] = {x, y, z};
    double best = HUGE_VAL;
    int64_t found = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        double square = 0;
        for (int k = 0; k < 3; k++) {
            double middle = 0;
            for (int c = 0; c < 3; c++) middle += s->positions[3 * s->corners[3 * t + c] + k] / 3;
            square += (middle - place[k]) * (middle - place[k]);
        }
        if (square < best) best = square, found = t;
    }
    return found;
}

static void remove_triangle(soup *s, int64_t t) {
    s->triangles--;
    memmove(s->corners + 3 * t, s->corners + 3 * (t + 1),
            (size_t)(s->triangles - t) * 3 * sizeof *s->corners);
}

static void flip_triangle(soup *s, int64_t t) {
    const int32_t swap = s->corners[3 * t];
    s->corners[3 * t] = s->corners[3 * t + 1];
    s->corners[3 * t + 1] = swap;
}

typedef struct {
    double mm[SIDE][SIDE];
    skg_plan_report report;
} picture;

/* What is asked for but the mesh. */
typedef struct {
    int32_t repair, strategy, precision, images;
    double z[2]; /* of the two parts */
} wish;

/* Lengths of the one part, or the attenuation of two. */
static void take(const soup *a, const soup *b, const wish *w, picture *result) {
    const soup *soups[2] = {a, b};
    skg_scene *scene = NULL;
    skg_plan *plan = NULL;
    skg_job *job = NULL;
    skg_plan_options options;
    skg_output output;
    ck_skg(skg_scene_create(context, &scene));
    for (int i = 0; i < (b ? 2 : 1); i++) {
        skg_part part;
        skg_part_init(&part);
        part.mesh = mesh_of(soups[i]), part.material = water;
        part.label = i ? "second" : "first";
        part.pose[11] = w->z[i];
        ck_skg(skg_scene_part_add(scene, &part, NULL));
        skg_mesh_release(&part.mesh);
    }
    skg_plan_options_init(&options);
    ck_assert_int_eq(options.repair, SKG_REPAIR_NEIGHBOURS);
    options.repair = w->repair, options.strategy = w->strategy, options.precision = w->precision;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_plan_create(context, scene, &view, beam, &options, &plan));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = result->mm;
    if (b) {
        ck_skg(skg_plan_image(plan, &output));
    } else {
        output.kind = SKG_OUTPUT_LENGTHS;
        ck_skg(skg_plan_submit(plan, 1, NULL, &output, &job));
        ck_skg(skg_job_wait(&job));
    }
    skg_plan_report_init(&result->report);
    ck_skg(skg_plan_report_get(plan, &result->report));
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}

static double worst(const picture *a, const picture *b) {
    double largest = 0;
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) largest = fmax(largest, fabs(a->mm[r][c] - b->mm[r][c]));
    return largest;
}

static int64_t count_different(const picture *a, const picture *b) {
    int64_t count = 0;
    for (int r = 0; r < SIDE; r++) /* mm: more than rounding in double. */
        for (int c = 0; c < SIDE; c++) count += fabs(a->mm[r][c] - b->mm[r][c]) > 1e-6;
    return count;
}

/* Terms are rounded to 2^-50 of the longest sum, lengths of rays are 1,200 mm: 1e-9 mm is a thousand
 * roundings. */
static const double DOUBLE_TOLERANCE = 1e-9;

/* The soup with and without repair against the closed one. change: mm by which neighbours may differ. */
static void check_repairs(const soup *broken, const soup *closed, double change) {
    static picture truth, left_out, neighbours, exact;
    wish w = {.precision = SKG_PRECISION_DOUBLE};
    take(closed, NULL, &w, &truth);
    ck_assert_int_eq(truth.report.leaky_parts, 0);
    w.repair = SKG_REPAIR_NONE;
    take(broken, NULL, &w, &left_out);
    ck_assert_int_gt(left_out.report.bad_pixels, 10);
    ck_assert_int_eq(left_out.report.repaired_pixels, 0);
    ck_assert_int_eq(count_different(&left_out, &truth), left_out.report.bad_pixels);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(broken, NULL, &w, &neighbours);
    ck_assert_int_eq(neighbours.report.bad_pixels, left_out.report.bad_pixels);
    ck_assert_int_eq(neighbours.report.repaired_pixels, left_out.report.bad_pixels);
    ck_assert_double_le(worst(&neighbours, &truth), change);
    w.repair = SKG_REPAIR_EXACT;
    take(broken, NULL, &w, &exact);
    ck_assert_int_eq(exact.report.repaired_pixels, left_out.report.bad_pixels);
    ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
}

/* Within half the radius a sphere's length changes by 2 rho / sqrt(R^2 - rho^2) <= 1.155 mm per mm; a
 * triangle of this one has edges below 11 mm, so the nearest pixels outside it lie within 11 mm, and a
 * square's corners sqrt(2) further. */
static const double NEIGHBOURS_CHANGE = 1.155 * 1.4142 * 11;

START_TEST(a_missing_triangle) {
    static soup closed, broken;
    fill_sphere(&closed);
    broken = closed;
    remove_triangle(&broken, triangle_at(&broken, 5, 3, -40));
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

START_TEST(a_flipped_triangle) {
    static soup closed, broken;
    fill_sphere(&closed);
    broken = closed;
    flip_triangle(&broken, triangle_at(&broken, -4, 8, 40));
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

/* An edge is halved on one side only, 2 mm beside its middle: the gap is the triangle that closes it. */
START_TEST(a_t_junction) {
    static soup closed, broken;
    fill_sphere(&broken);
    const int64_t t = triangle_at(&broken, 9, 2, -38);
    const int32_t a = broken.corners[3 * t], b = broken.corners[3 * t + 1], c = broken.corners[3 * t + 2];
    const int32_t middle = (int32_t)broken.vertices++;
    for (int k = 0; k < 3; k++) {
        const double *p = broken.positions;
        broken.positions[3 * middle + k] = 0.4 * p[3 * a + k] + 0.4 * p[3 * b + k] + 0.2 * p[3 * c + k];
    }
    const int32_t halves[6] = {a, middle, c, middle, b, c}, gap[3] = {a, b, middle};
    memcpy(broken.corners + 3 * t, halves, 3 * sizeof *halves);
    memcpy(broken.corners + 3 * broken.triangles++, halves + 3, 3 * sizeof *halves);
    closed = broken;
    memcpy(closed.corners + 3 * closed.triangles++, gap, sizeof gap);
    check_repairs(&broken, &closed, NEIGHBOURS_CHANGE);
}
END_TEST

/* Everything above a plane is cut off: many triangles, one plane loop, seen from the side and from within. */
START_TEST(a_cut) {
    static soup closed, broken;
    static picture truth, exact;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_EXACT};
    fill_sphere(&broken);
    for (int64_t v = 0; v < broken.vertices;
         v++) { /* rings of the sphere are plane: flatten what is above one */
        double *z = &broken.positions[3 * v + 2];
        if (*z > 15) *z = 20;
    }
    closed = broken;
    for (int64_t t = broken.triangles; t-- > 0;) {
        int above = 0;
        for (int c = 0; c < 3; c++) above += broken.positions[3 * broken.corners[3 * t + c] + 2] > 15;
        if (above == 3) remove_triangle(&broken, t);
    }
    const double places[] = {0, -1000}; /* the second: the source within */
    for (int k = 0; k < 2; k++) {
        w.z[0] = places[k];
        take(&closed, NULL, &w, &truth);
        take(&broken, NULL, &w, &exact);
        ck_assert_int_gt(exact.report.bad_pixels, SIDE);
        ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
    }
}
END_TEST

/* One enters through its hole where the other leaves through its own: one count for both would cancel. */
START_TEST(holes_that_coincide) {
    static soup closed, near, far;
    static picture truth, one, two, exact, neighbours;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_EXACT, .z = {-60, 60}};
    double mu = 0;
    fill_sphere(&closed);
    near = far = closed;
    remove_triangle(&near, triangle_at(&near, 4, 4, -40));
    remove_triangle(&far, triangle_at(&far, 4, 4, 40));
    take(&closed, &closed, &w, &truth);
    take(&near, &closed, &w, &one);
    take(&closed, &far, &w, &two);
    take(&near, &far, &w, &exact);
    ck_assert_int_gt(one.report.bad_pixels, 10);
    ck_assert_int_gt(two.report.bad_pixels, 10);
    ck_assert_int_eq(exact.report.bad_pixels, one.report.bad_pixels + two.report.bad_pixels);
    ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(&near, &far, &w, &neighbours);
    ck_skg(skg_material_attenuation_get(water, 60, &mu));
    ck_assert_double_le(worst(&neighbours, &truth), 2 * 0.1 * mu * NEIGHBOURS_CHANGE);
}
END_TEST

/* A box of 60 mm with windows of 20 mm in two opposite faces: rays through both meet nothing, and balance.
 * Faces are 3 x 3 squares of 20 mm; vertices are those of a grid of 4 x 4 x 4. */
static void fill_windowed(soup *s, int windows) {
    *s = (soup){.vertices = 64};
    for (int v = 0; v < 64; v++)
        for (int k = 0; k < 3; k++) s->positions[3 * v + k] = -30 + 20.0 * (v >> 2 * k & 3);
    for (int face = 0; face < 54; face++) {
        const int axis = face / 18, side = face / 9 % 2, i = face % 3, j = face / 3 % 3;
        const int u = 1 << 2 * ((axis + 1) % 3), v = 1 << 2 * ((axis + 2) % 3);
        const int32_t at = (int32_t)((side ? 3 << 2 * axis : 0) + i * u + j * v);
        const int32_t along = (int32_t)(side ? u : v), across = (int32_t)(side ? v : u);
        const int32_t two[6] = {at, at + along, at + u + v, at, at + u + v, at + across};
        if (windows && axis == 2 && i == 1 && j == 1) continue;
        memcpy(s->corners + 3 * s->triangles, two, sizeof two);
        s->triangles += 2;
    }
}

/* What counting cannot see: "neighbours" and "none" leave the hole black, "exact" has the full box. */
START_TEST(in_through_one_hole_and_out_through_another) {
    static soup closed, broken;
    static picture truth, left_out, neighbours, exact;
    fill_windowed(&closed, 0);
    fill_windowed(&broken, 1);
    for (int32_t projection = 0; projection < 2; projection++) {
        wish w = {.precision = SKG_PRECISION_DOUBLE};
        view.projection = projection ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        take(&closed, NULL, &w, &truth);
        ck_assert_int_eq(truth.report.leaky_parts, 0);
        ck_assert_double_gt(truth.mm[SIDE / 2][SIDE / 2], 59.9);
        take(&broken, NULL, &w, &left_out);
        w.repair = SKG_REPAIR_NEIGHBOURS;
        take(&broken, NULL, &w, &neighbours);
        w.repair = SKG_REPAIR_EXACT;
        take(&broken, NULL, &w, &exact);
        ck_assert_double_eq(left_out.mm[SIDE / 2][SIDE / 2], 0);
        ck_assert_double_eq(neighbours.mm[SIDE / 2][SIDE / 2], 0);
        ck_assert_double_le(worst(&exact, &truth), DOUBLE_TOLERANCE);
        for (int32_t strategy = SKG_STRATEGY_COPIES; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
            w.strategy = strategy;
            take(&broken, NULL, &w, &left_out);
            ck_assert_mem_eq(left_out.mm, exact.mm, sizeof exact.mm);
        }
        /* Single: the most that a ray may err by anywhere, along the box's sides. */
        wish single = {.repair = SKG_REPAIR_EXACT};
        take(&closed, NULL, &single, &truth);
        take(&broken, NULL, &single, &exact);
        /* mm, see above */
        ck_assert_double_le(worst(&exact, &truth), 1e-3);
    }
}
END_TEST

/* The mean over the border of the smallest square with a valid pixel, by brute force. */
static double neighbours_of(const picture *truth, const picture *left_out, int row, int column) {
    for (int reach = 0;; reach++) {
        double sum = 0;
        int valid = 0;
        for (int r = row - reach; r <= row + reach; r++)
            for (int c = column - reach; c <= column + reach; c++) {
                if (r < 0 || c < 0 || r >= SIDE || c >= SIDE) continue;
                /* mm: as in count_different. */
                if (fabs(left_out->mm[r][c] - truth->mm[r][c]) > 1e-6) continue;
                sum += left_out->mm[r][c];
                valid++;
            }
        if (valid) return sum / valid;
    }
}

START_TEST(neighbours_are_the_means_of_squares) {
    static soup closed, broken;
    static picture truth, left_out, repaired;
    wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_NONE};
    view.projection =
        SKG_PROJECTION_PARALLEL; /* every ray as long: a mean of path parameters is one of lengths */
    fill_sphere(&closed);
    broken = closed;
    for (int k = 0; k < 9; k++) remove_triangle(&broken, triangle_at(&broken, 20.0 - 5 * k, 3, -40));
    take(&closed, NULL, &w, &truth);
    take(&broken, NULL, &w, &left_out);
    w.repair = SKG_REPAIR_NEIGHBOURS;
    take(&broken, NULL, &w, &repaired);
    ck_assert_int_gt(repaired.report.repaired_pixels, 200);
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++)
            ck_assert_double_eq_tol(repaired.mm[r][c], neighbours_of(&truth, &left_out, r, c),
                                    DOUBLE_TOLERANCE);
}
END_TEST

START_TEST(strategies_agree) {
    static soup broken;
    static picture first, other;
    fill_sphere(&broken);
    for (int k = 0; k < 5; k++) remove_triangle(&broken, triangle_at(&broken, 10.0 - 5 * k, 3, 7 * k - 20));
    for (int32_t repair = SKG_REPAIR_NONE; repair <= SKG_REPAIR_EXACT; repair++)
        for (int32_t strategy = SKG_STRATEGY_COPIES; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
            const wish w = {.repair = repair, .strategy = strategy};
            picture *taken = strategy == SKG_STRATEGY_COPIES ? &first : &other;
            take(&broken, NULL, &w, taken);
            ck_assert_int_gt(taken->report.bad_pixels, 0);
            if (taken == &other) ck_assert_mem_eq(first.mm, other.mm, sizeof first.mm);
        }
}
END_TEST

/* A sheet before the whole detector: no valid pixel anywhere, and nothing is made up. */
START_TEST(no_valid_pixel) {
    static const soup sheet = {.vertices = 4,
                               .triangles = 2,
                               .positions = {-200, -200, 0, 200, -200, 0, 200, 200, 0, -200, 200, 0},
                               .corners = {0, 1, 2, 0, 2, 3}};
    static picture left;
    const wish w = {.precision = SKG_PRECISION_DOUBLE, .repair = SKG_REPAIR_NEIGHBOURS};
    take(&sheet, NULL, &w, &left);
    ck_assert_int_eq(left.report.bad_pixels, SIDE * SIDE);
    ck_assert_int_eq(left.report.repaired_pixels, 0);
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) ck_assert_double_eq(left.mm[r][c], 0);
}
END_TEST

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
        ck_skg(skg_plan_submit(plan, 1, &frame, &output, &job));
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
    tcase_add_test(tests, a_missing_triangle);
    tcase_add_test(tests, a_flipped_triangle);
    tcase_add_test(tests, a_t_junction);
    tcase_add_test(tests, a_cut);
    tcase_add_test(tests, holes_that_coincide);
    tcase_add_test(tests, in_through_one_hole_and_out_through_another);
    tcase_add_test(tests, neighbours_are_the_means_of_squares);
    tcase_add_test(tests, strategies_agree);
    tcase_add_test(tests, no_valid_pixel);
    tcase_add_test(tests, what_is_warned_of);
    tcase_add_test(tests, what_is_warned_of_once);
}

SKG_SUITE_MAIN("repair", add_tests)
