/* Priorities and clipping against arithmetic on intervals in long double: every part is convex, so that a
 * ray's chord is what the planes of its triangles leave of it; between the ends of all chords the rule is
 * applied as it reads. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 48, LIMIT = 40, CORNERS = 2000 };

static skg_context *context;
static const char *const matter[3] = {"Water", "Bone, Cortical (ICRU-44)", "Al"};
static skg_material *materials[3];
static const double energies[2] = {45, 80}, photons[2] = {1000, 700};

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
    for (int k = 0; k < 3; k++) ck_skg(skg_material_create_named(matter[k], &materials[k]));
}

static void close_context(void) {
    for (int k = 0; k < 3; k++) skg_material_release(&materials[k]);
    skg_context_release(&context);
}

/* A part of the oracle: planes n . x <= d, in the world (mm). */
typedef struct {
    int64_t inside;
    int32_t priority, matter;
    double centre[3];
    int64_t planes;
    long double normal[CORNERS][3], distance[CORNERS];
} body;

typedef struct {
    int64_t count;
    int32_t clip, energy_count;
    skg_view view;
    body bodies[LIMIT];
} setting;

static setting set;
static skg_scene *scene;
static skg_spectrum *beam;

static void list_planes(body *b, const skg_mesh *mesh) {
    static double positions[3 * CORNERS];
    static int32_t corners[3 * CORNERS];
    int64_t vertices = 0;
    ck_skg(skg_mesh_count(mesh, &vertices, &b->planes));
    ck_assert_int_le(vertices, CORNERS);
    ck_assert_int_le(b->planes, CORNERS);
    ck_skg(skg_mesh_positions_get(mesh, positions, 3));
    ck_skg(skg_mesh_triangles_get(mesh, corners, 3));
    for (int64_t t = 0; t < b->planes; t++) {
        long double at[3][3], u[3], v[3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                at[c][k] = (long double)positions[3 * corners[3 * t + c] + k] + (long double)b->centre[k];
        for (int k = 0; k < 3; k++) u[k] = at[1][k] - at[0][k], v[k] = at[2][k] - at[0][k];
        b->distance[t] = 0;
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            b->normal[t][k] = u[l] * v[m] - u[m] * v[l];
            b->distance[t] += b->normal[t][k] * at[0][k];
        }
    }
}

static void add_body(const char *label, skg_mesh *mesh, int64_t inside, int32_t priority, int32_t of,
                     const double centre[3]) {
    skg_part part;
    body *b = &set.bodies[set.count++];
    skg_part_init(&part);
    part.label = label, part.mesh = mesh, part.material = materials[of];
    part.inside = inside, part.priority = priority;
    *b = (body){.inside = inside, .priority = priority, .matter = of};
    for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = b->centre[k] = centre[k];
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    list_planes(b, mesh);
    skg_mesh_release(&mesh);
}

static void begin(int32_t energy_count, int32_t clip) {
    set.count = 0;
    set.clip = clip;
    set.energy_count = energy_count;
    skg_view_init(&set.view);
    set.view.columns = set.view.rows = SIDE;
    set.view.source[0] = 30, set.view.source[2] = -700;
    set.view.centre[2] = 250;
    set.view.column_step[0] = set.view.row_step[1] = 4.1;
    set.view.row_step[0] = 0.3;
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_spectrum_create_bins(energy_count, energies, photons, &beam));
}

static void end(void) {
    skg_scene_release(&scene);
    skg_spectrum_release(&beam);
}

/* --- the oracle */

static void ray_of(int row, int column, long double from[3], long double to[3]) {
    for (int k = 0; k < 3; k++) {
        to[k] = (long double)set.view.centre[k] +
                (column - 0.5L * (SIDE - 1)) * (long double)set.view.column_step[k] +
                (row - 0.5L * (SIDE - 1)) * (long double)set.view.row_step[k];
        from[k] = (long double)set.view.source[k];
    }
    if (set.view.projection == SKG_PROJECTION_POINT) return;
    long double along[3], square = 0, ahead = 0;
    for (int k = 0; k < 3; k++) along[k] = (long double)set.view.centre[k] - (long double)set.view.source[k];
    for (int k = 0; k < 3; k++) square += along[k] * along[k], ahead += along[k] * (to[k] - from[k]);
    for (int k = 0; k < 3; k++) from[k] = to[k] - along[k] * ahead / square;
}

/* The chord as fractions of the ray; empty: from > to. */
static void chord(const body *b, const long double from[3], const long double to[3], long double span[2]) {
    span[0] = 0, span[1] = 1;
    for (int64_t p = 0; p < b->planes; p++) {
        long double start = -b->distance[p], change = 0;
        for (int k = 0; k < 3; k++) {
            start += b->normal[p][k] * from[k];
            change += b->normal[p][k] * (to[k] - from[k]);
        }
        if (change > 0) span[1] = fminl(span[1], -start / change);
        if (change < 0) span[0] = fmaxl(span[0], -start / change);
        if (change == 0 && start > 0) span[1] = -1;
    }
}

/* Whether a part counts where those of `in` are met. */
static int counts(const int *in, int64_t part) {
    const body *b = &set.bodies[part];
    if (!in[part]) return 0;
    for (int64_t q = 0; q < set.count; q++)
        if (in[q] && set.bodies[q].inside == b->inside && set.bodies[q].priority > b->priority) return 0;
    if (set.clip && b->inside >= 0 && !in[b->inside]) return 0;
    for (int64_t up = b->inside; up >= 0; up = set.bodies[up].inside)
        if (in[up] && !counts(in, up)) return 0;
    return 1;
}

/* mm of the ray on which each part counts. */
static void lengths_of(int row, int column, long double *mm) {
    long double from[3], to[3], span[LIMIT][2], ends[2 * LIMIT + 1], whole = 0;
    int64_t end_count = 0;
    ray_of(row, column, from, to);
    for (int k = 0; k < 3; k++) whole += (to[k] - from[k]) * (to[k] - from[k]);
    whole = sqrtl(whole);
    for (int64_t p = 0; p < set.count; p++) {
        mm[p] = 0;
        chord(&set.bodies[p], from, to, span[p]);
        for (int k = 0; k < 2; k++) {
            int64_t place = end_count++;
            for (; place > 0 && ends[place - 1] > span[p][k]; place--) ends[place] = ends[place - 1];
            ends[place] = span[p][k];
        }
    }
    for (int64_t e = 0; e + 1 < end_count; e++) {
        const long double middle = 0.5L * (ends[e] + ends[e + 1]);
        int in[LIMIT];
        for (int64_t p = 0; p < set.count; p++) in[p] = span[p][0] < middle && middle < span[p][1];
        for (int64_t p = 0; p < set.count; p++)
            if (counts(in, p)) mm[p] += (ends[e + 1] - ends[e]) * whole;
    }
}

static long double attenuation_of(const long double *mm) {
    long double behind = 0, before = 0;
    for (int e = 0; e < set.energy_count; e++) {
        long double exponent = 0;
        for (int64_t p = 0; p < set.count; p++) {
            const body *b = &set.bodies[p];
            double own = 0, other = 0;
            ck_skg(skg_material_attenuation_get(materials[b->matter], energies[e], &own));
            if (b->inside >= 0)
                ck_skg(skg_material_attenuation_get(materials[set.bodies[b->inside].matter], energies[e],
                                                    &other));
            exponent += 0.1L * ((long double)own - (long double)other) * mm[p];
        }
        behind += (long double)(photons[e] * energies[e]) * expl(-exponent);
        before += (long double)(photons[e] * energies[e]);
    }
    return -logl(behind / before);
}

/* --- the library against it */

typedef double picture[SIDE][SIDE];

static skg_plan *plan_for(int32_t precision, int32_t strategy) {
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.precision = precision, options.strategy = strategy, options.clip = set.clip;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.overlaps = 0; /* priorities do not need to know them */
    ck_skg(skg_plan_create(context, scene, &set.view, beam, &options, &plan));
    return plan;
}

static void take(skg_plan *plan, const skg_frame *frame, picture image) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_submit(plan, 1, frame, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
}

static int is_on(const skg_plan *plan, const char *name) {
    int64_t count = 0;
    ck_skg(skg_plan_effect_count(plan, &count));
    for (int64_t i = 0; i < count; i++) {
        skg_effect effect;
        skg_effect_init(&effect);
        ck_skg(skg_plan_effect_get(plan, i, &effect));
        if (strcmp(effect.name, name) == 0) return effect.on;
    }
    ck_abort_msg("no effect %s", name);
    return 0;
}

/* mm: lengths of some 100 mm, of depths of 1000 mm. */
static const double DOUBLE_LENGTH = 1024 * DBL_EPSILON * 100;

/* Double: sums are of units of 2^-50, and attenuations here below 30: 1e-9 leaves space for a thousand
 * roundings. Single: depths carry 2^-24 of some 0.3 of a ray of 950 mm, 2e-5 mm, some ten times at 0.5 / mm
 * of the strongest contrast: 1e-4; at silhouettes, where a length runs with the root of a coordinate of 2^-24
 * of 50 pixels, 1e-2 mm. */
static const double DOUBLE_TOLERANCE = 1e-9, SINGLE_TOLERANCE = 5e-3, SINGLE_RMS = 1e-4;

static void expect(picture expected) {
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) {
            long double mm[LIMIT];
            lengths_of(r, c, mm);
            expected[r][c] = (double)attenuation_of(mm);
        }
}

static void compare(picture image, picture expected, double tolerance, double rms) {
    double squares = 0;
    for (int r = 0; r < SIDE; r++)
        for (int c = 0; c < SIDE; c++) {
            const double difference = image[r][c] - expected[r][c];
            ck_assert_msg(fabs(difference) <= tolerance, "(%d, %d): %.12g instead of %.12g", c, r,
                          image[r][c], expected[r][c]);
            squares += difference * difference;
        }
    ck_assert_double_le(sqrt(squares / (SIDE * SIDE)), rms);
}

static void check(void) {
    static picture image, other, expected;
    expect(expected);
    skg_plan *plan = plan_for(SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    take(plan, NULL, image);
    compare(image, expected, DOUBLE_TOLERANCE, DOUBLE_TOLERANCE);
    skg_plan_release(&plan);
    for (int32_t strategy = SKG_STRATEGY_COPIES; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
        plan = plan_for(SKG_PRECISION_SINGLE, strategy);
        take(plan, NULL, strategy == SKG_STRATEGY_COPIES ? image : other);
        if (strategy == SKG_STRATEGY_COPIES)
            compare(image, expected, SINGLE_TOLERANCE, SINGLE_RMS);
        else
            ck_assert_mem_eq(image, other, sizeof image);
        skg_plan_release(&plan);
    }
}

static skg_mesh *sphere(double radius) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_sphere(radius, 32, &mesh));
    return mesh;
}

static skg_mesh *cuboid(double x, double y, double z) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cuboid(x, y, z, &mesh));
    return mesh;
}

/* Two spheres share a lens; the third has the priority of the second, and adds to it. */
static void add_three(const int32_t priorities[3]) {
    add_body("first", sphere(40), -1, priorities[0], 0, (double[]){-15, 0.3, 0});
    add_body("second", sphere(35), -1, priorities[1], 1, (double[]){20, 3, 10});
    add_body("third", sphere(30), -1, priorities[2], 2, (double[]){2, -20, -12});
}

START_TEST(overlapping_spheres) {
    for (int energy_count = 1; energy_count <= 2; energy_count++) {
        begin(energy_count, 0);
        add_three((int32_t[]){1, 0, 0});
        check();
        skg_plan *plan = plan_for(SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
        ck_assert_int_eq(is_on(plan, "priority"), 1);
        skg_plan_release(&plan);
        end();
    }
}
END_TEST

START_TEST(equal_priorities_add) {
    begin(1, 0);
    add_three((int32_t[]){3, 3, 3});
    check();
    skg_plan *plan = plan_for(SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    ck_assert_int_eq(is_on(plan, "priority"), 0);
    skg_plan_release(&plan);
    end();
}
END_TEST

/* A child leaves its parent, and has one of its own; a neighbour of the parent cuts into all of them. */
static void add_nest(void) {
    add_body("parent", sphere(40), -1, 0, 0, (double[]){-10, 1, 0});
    add_body("child", sphere(20), 0, 0, 1, (double[]){-35, 4, 8});
    add_body("grandchild", cuboid(15, 60, 9), 1, 0, 2, (double[]){-36, 2, 9});
    add_body("twin", sphere(15), 0, -4, 2, (double[]){-24, 12, 3});
    add_body("neighbour", sphere(33), -1, 2, 1, (double[]){14, 9, -6});
    add_body("guest", sphere(12), 4, 0, 0, (double[]){10, 9, -6});
}

START_TEST(protruding_spheres) {
    for (int32_t clip = 0; clip <= 1; clip++) {
        begin(2, clip);
        add_nest();
        check();
        end();
    }
}
END_TEST

/* The source lies within one of them. */
START_TEST(at_the_source) {
    for (int k = 0; k < 2; k++) {
        begin(1, 0);
        set.view.source[0] = 3, set.view.source[2] = -60;
        set.view.projection = k ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        add_body("first", sphere(50), -1, 1, 0, (double[]){0, 0.3, -45});
        add_body("second", sphere(45), -1, 4, 1, (double[]){20, 3, 10});
        add_body("third", cuboid(70, 200, 30), -1, 2, 2, (double[]){10, 20, -52});
        check();
        end();
    }
}
END_TEST

/* Forty slabs, each over the next: more than one word of a set. */
START_TEST(many) {
    static char labels[LIMIT][8];
    begin(1, 0);
    for (int k = 0; k < LIMIT; k++) {
        const int32_t priority = (k * 17) % LIMIT;
        snprintf(labels[k], sizeof labels[k], "%d", k);
        add_body(labels[k], cuboid(30 + k, 60 - k, 7), -1, priority, k % 3,
                 (double[]){0.11 * k, 0.2, 3.3 * k - 60});
    }
    check();
    end();
}
END_TEST

START_TEST(parts_that_move) {
    static picture image, expected;
    const int64_t id = 1;
    double pose[16] = {1, 0, 0, 20, 0, 1, 0, 3, 0, 0, 1, 10, 0, 0, 0, 1};
    skg_frame frame;
    begin(1, 0);
    add_three((int32_t[]){2, 1, 0});
    double away[16];
    memcpy(away, pose, sizeof away);
    away[3] = 900;
    ck_skg(skg_scene_part_pose_set(scene, 1, away));
    ck_skg(skg_scene_part_pose_set(scene, 2, away));
    skg_plan *plan = plan_for(SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    ck_assert_int_eq(is_on(plan, "priority"), 0);
    skg_frame_init(&frame);
    frame.pose_count = 1, frame.pose_parts = &id, frame.poses = pose;
    set.count = 2;
    take(plan, &frame, image);
    expect(expected);
    compare(image, expected, DOUBLE_TOLERANCE, DOUBLE_TOLERANCE);
    skg_plan_release(&plan);
    end();
}
END_TEST

/* Net lengths know of priorities, a surface's own do not. */
START_TEST(lengths) {
    static picture net, surface;
    begin(1, 1);
    add_nest();
    skg_plan *plan = plan_for(SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    for (int64_t p = 0; p < set.count; p++) {
        skg_output output;
        skg_job *job = NULL;
        skg_output_init(&output);
        output.type = SKG_TYPE_FLOAT64, output.data = net;
        output.kind = SKG_OUTPUT_LENGTHS;
        output.part = p;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        output.data = surface;
        output.lengths = SKG_LENGTHS_SURFACE;
        ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        for (int r = 0; r < SIDE; r++)
            for (int c = 0; c < SIDE; c++) {
                long double mm[LIMIT], from[3], to[3], span[2], whole = 0;
                lengths_of(r, c, mm);
                for (int64_t q = 0; q < set.count; q++)
                    if (set.bodies[q].inside == p) mm[p] -= mm[q];
                ck_assert_double_eq_tol(net[r][c], (double)mm[p], DOUBLE_LENGTH);
                ray_of(r, c, from, to);
                for (int k = 0; k < 3; k++) whole += (to[k] - from[k]) * (to[k] - from[k]);
                chord(&set.bodies[p], from, to, span);
                ck_assert_double_eq_tol(surface[r][c], (double)(fmaxl(span[1] - span[0], 0) * sqrtl(whole)),
                                        DOUBLE_LENGTH);
            }
    }
    skg_plan_release(&plan);
    end();
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, overlapping_spheres);
    tcase_add_test(tests, equal_priorities_add);
    tcase_add_test(tests, protruding_spheres);
    tcase_add_test(tests, at_the_source);
    tcase_add_test(tests, many);
    tcase_add_test(tests, parts_that_move);
    tcase_add_test(tests, lengths);
}

SKG_SUITE_MAIN("priority", add_tests)
