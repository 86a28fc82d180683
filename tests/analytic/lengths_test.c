/* Path lengths of bodies with closed forms. A convex body is a set of half-spaces, and what lies within them
 * all is worked out here for each ray by hand; round bodies are held against their smooth forms within their
 * chords' error, and against their own triangles in long double. */
#include "suite.h"
#include "support/angles.h"
#include "support/verdict.h"

#include <math.h>
#include <string.h>

/* --- convex bodies: half-spaces n . x <= d --------------------------------------------------------------- */

typedef struct {
    double normal[3], distance;
} half_space;

/* Length within all half-spaces on the way from `from` to `to`. */
static double within(int count, const half_space *all, const double *from, const double *to) {
    long double first = 0, last = 1, length = 0;
    for (int n = 0; n < count; n++) {
        long double start = -(long double)all[n].distance, way = 0;
        for (int k = 0; k < 3; k++) {
            start += (long double)all[n].normal[k] * (long double)from[k];
            way += (long double)all[n].normal[k] * ((long double)to[k] - (long double)from[k]);
        }
        if (way == 0 && start > 0) return 0;
        if (way > 0) last = fminl(last, -start / way);
        if (way < 0) first = fmaxl(first, -start / way);
    }
    for (int k = 0; k < 3; k++)
        length += ((long double)to[k] - (long double)from[k]) * ((long double)to[k] - (long double)from[k]);
    return first < last ? (double)((last - first) * sqrtl(length)) : 0;
}

/* Ends of the ray to a pixel. */
static void ends(const skg_view *view, int64_t p, double *from, double *to) {
    const double c = (double)(p % view->columns) - (double)(view->columns - 1) / 2;
    const double r = (double)(p / view->columns) - (double)(view->rows - 1) / 2;
    for (int k = 0; k < 3; k++) {
        to[k] = view->centre[k] + c * view->column_step[k] + r * view->row_step[k];
        from[k] = view->projection == SKG_PROJECTION_POINT ? view->source[k]
                                                           : to[k] - (view->centre[k] - view->source[k]);
    }
}

/* The body as it stands in `mesh`, in both precisions. A side that runs along a ray counts either way: the
 * body is taken a hair (`hair` mm) smaller and larger there. */
static void check_convex(const char *what, skg_mesh *mesh, const skg_view *view, int count,
                         const half_space *all, double hair, double depth) {
    const int64_t pixels = view->rows * view->columns;
    double *low = calloc((size_t)pixels, sizeof *low), *high = calloc((size_t)pixels, sizeof *high);
    half_space smaller[64], larger[64];
    for (int n = 0; n < count; n++) {
        smaller[n] = larger[n] = all[n];
        smaller[n].distance -= hair;
        larger[n].distance += hair;
    }
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, what, mesh, 1, NULL, -1);
    for (int64_t p = 0; p < pixels; p++) {
        double from[3], to[3];
        ends(view, p, from, to);
        low[p] = within(count, hair > 0 ? smaller : all, from, to);
        high[p] = within(count, hair > 0 ? larger : all, from, to);
    }
    for (int32_t precision = SKG_PRECISION_SINGLE;
         precision <= (run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++) {
        skg_plan *plan = run_plan(scene, view, (run_choice){.precision = precision});
        double *got = run_lengths(plan, view);
        verdict v = {0};
        verdict_add(&v, pixels, got, low, high);
        for (int64_t p = 0; p < pixels && precision == SKG_PRECISION_SINGLE && depth > 0; p++)
            v.errors[p] *= v.longest / depth;
        verdict_check(&v, precision, what);
        verdict_free(&v);
        free(got);
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
    free(low);
    free(high);
}

static void box_sides(double x, double y, double z, half_space sides[6]) {
    const double half[3] = {x / 2, y / 2, z / 2};
    for (int n = 0; n < 6; n++) {
        sides[n] = (half_space){.distance = half[n / 2]};
        sides[n].normal[n / 2] = n % 2 ? -1 : 1;
    }
}

START_TEST(cube_and_slab) {
    skg_mesh *cube = NULL, *slab = NULL;
    half_space sides[6];
    ck_skg(skg_mesh_create_cube(100, &cube));
    ck_skg(skg_mesh_create_cuboid(2000, 1600, 7, &slab));
    skg_view view = run_view(96, 1.7);
    for (int tilted = 0; tilted < 2; tilted++) {
        view.source[0] = tilted * 130;
        view.source[1] = tilted * -77;
        view.column_step[2] = tilted * 0.6;
        box_sides(100, 100, 100, sides);
        check_convex("cube", cube, &view, 6, sides, 0, 0);
        box_sides(2000, 1600, 7, sides);
        /* Seen from a tilted detector the slab is 665 mm deep, and its corners' depths are floats. */
        const double depth = tilted ? 2000 * sin(atan2(0.6, 1.7)) : 0;
        check_convex("slab", slab, &view, 6, sides, 0, depth);
        view.projection = SKG_PROJECTION_PARALLEL;
        check_convex("slab, parallel", slab, &view, 6, sides, 0, depth);
        view.projection = SKG_PROJECTION_POINT;
    }
    skg_mesh_release(&cube);
    skg_mesh_release(&slab);
}
END_TEST

START_TEST(cylinder) {
    enum { SEGMENTS = 36 };
    half_space sides[SEGMENTS + 2];
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cylinder(40, 120, SEGMENTS, &mesh));
    /* The prism's own corners say where its sides stand. */
    double corners[3 * (2 * SEGMENTS + 2)], first = 0;
    int64_t vertices = 0, triangles = 0;
    ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
    ck_assert_int_le(vertices, 2 * SEGMENTS + 2);
    ck_skg(skg_mesh_positions_get(mesh, corners, 0));
    for (int64_t n = 0; n < vertices; n++)
        if (hypot(corners[3 * n], corners[3 * n + 1]) > 39) first = atan2(corners[3 * n + 1], corners[3 * n]);
    for (int n = 0; n < SEGMENTS; n++) {
        const double turn = first + 2 * pi * (n + 0.5) / SEGMENTS;
        sides[n] = (half_space){{cos(turn), sin(turn), 0}, 40 * cos(pi / SEGMENTS)};
    }
    sides[SEGMENTS] = (half_space){{0, 0, 1}, 60};
    sides[SEGMENTS + 1] = (half_space){{0, 0, -1}, 60};
    skg_view view = run_view(96, 1.7);
    check_convex("cylinder along the beam", mesh, &view, SEGMENTS + 2, sides, 0, 0);
    view.source[0] = 900; /* from the side, obliquely */
    view.source[2] = -300;
    view.centre[0] = -250;
    check_convex("cylinder across the beam", mesh, &view, SEGMENTS + 2, sides, 0, 0);
    view.projection = SKG_PROJECTION_PARALLEL;
    check_convex("cylinder across a parallel beam", mesh, &view, SEGMENTS + 2, sides, 0, 0);
    skg_mesh_release(&mesh);
}
END_TEST

/* --- the paper's cube at 10 cm: parallel beam, 301 x 1 pixels of 0.3 mm; a cube of 3 cm with split faces
 * around a cylinder of 20 sides. The middle ray runs through a vertex of the cube's faces and along edges of
 * both. ------------ */

static solid split(const solid *s) {
    solid finer = {12 * s->triangles, 4 * s->triangles, calloc((size_t)(36 * s->triangles), sizeof(double)),
                   calloc((size_t)(12 * s->triangles), sizeof(int32_t))};
    static const int parts[4][3][2] = {{{0, 0}, {0, 1}, {0, 2}},
                                       {{0, 1}, {1, 1}, {1, 2}},
                                       {{0, 2}, {1, 2}, {2, 2}},
                                       {{0, 1}, {1, 2}, {0, 2}}};
    for (int64_t n = 0; n < 12 * s->triangles; n++) {
        const int32_t *corners = s->corners + 3 * (n / 12);
        const int *ends_of = parts[n / 3 % 4][n % 3];
        for (int k = 0; k < 3; k++)
            finer.positions[3 * n + k] =
                (s->positions[3 * corners[ends_of[0]] + k] + s->positions[3 * corners[ends_of[1]] + k]) / 2;
        finer.corners[n] = (int32_t)n;
    }
    return finer;
}

START_TEST(the_papers_cube) {
    enum { SECTORS = 20 };
    skg_view view;
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL;
    view.columns = 301;
    view.rows = 1;
    view.source[2] = -100;
    view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 0.3;
    half_space sides[SECTORS + 2];
    solid cube = solid_box(30, 30, 30);
    for (int n = 0; n < 4; n++) {
        solid finer = split(&cube);
        solid_free(&cube);
        cube = finer;
    }
    skg_mesh *mesh = run_mesh(&cube);
    box_sides(30, 30, 30, sides);
    /* Sides at 15 mm are 50 pixels of 0.3 mm off: in the rays' planes but for rounding. */
    check_convex("the paper's cube", mesh, &view, 6, sides, 1e-9, 0);
    skg_mesh_release(&mesh);
    /* The cylinder: radius 10, along y; corners at z = +-10. */
    solid bar = {2 * SECTORS + 2, 4 * SECTORS, calloc(3 * (2 * SECTORS + 2), sizeof(double)),
                 calloc(12 * SECTORS, sizeof(int32_t))};
    int32_t *at = bar.corners;
    for (int n = 0; n < SECTORS; n++) {
        const double turn = 2 * pi * n / SECTORS;
        const int next = (n + 1) % SECTORS;
        for (int top = 0; top < 2; top++) {
            double *p = bar.positions + 3 * (2 * n + top);
            p[0] = n % (SECTORS / 2) ? 10 * sin(turn) : 0;
            p[1] = top ? 15 : -15;
            p[2] = 10 * cos(turn);
        }
        const int32_t corners[12] = {2 * n,    2 * next,        2 * n + 1,   2 * n + 1,
                                     2 * next, 2 * next + 1,    2 * SECTORS, 2 * next,
                                     2 * n,    2 * SECTORS + 1, 2 * n + 1,   2 * next + 1};
        memcpy(at, corners, sizeof corners);
        at += 12;
        sides[n] =
            (half_space){{sin(turn + pi / SECTORS), 0, cos(turn + pi / SECTORS)}, 10 * cos(pi / SECTORS)};
    }
    bar.positions[6 * SECTORS + 1] = -15;
    bar.positions[6 * SECTORS + 4] = 15;
    sides[SECTORS] = (half_space){{0, 1, 0}, 15};
    sides[SECTORS + 1] = (half_space){{0, -1, 0}, 15};
    mesh = run_mesh(&bar);
    check_convex("the paper's cylinder", mesh, &view, SECTORS + 2, sides, 0, 0);
    skg_mesh_release(&mesh);
    solid_free(&bar);
    solid_free(&cube);
}
END_TEST

/* --- round bodies ---------------------------------------------------------------------------------------- */

/* Chord of a sphere by a ray at `off` from its centre. */
static double chord(double radius, double off) {
    return off < radius ? 2 * sqrt(radius * radius - off * off) : 0;
}

/* Smooth form of the body at (x, y) under a beam along z. */
typedef double form(double x, double y);
static double sphere_form(double x, double y) {
    return chord(50, hypot(x, y));
}
static double shell_form(double x, double y) {
    return chord(50, hypot(x, y)) - chord(45, hypot(x, y));
}
static double torus_form(double x, double y) {
    return chord(15, fabs(hypot(x, y) - 35));
}

/* Chords stay within `sagitta` = radius (1 - cos(pi / around)) (twice, for two angles) of the surface: the
 * form is taken at the four places that far off, and so far longer or shorter. Where the form is steep its
 * range is wide. */
static void check_round(const char *what, const solid *s, form *of, double sagitta) {
    skg_view view = run_view(101, 1.1);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.source[2] = 1;
    const int64_t pixels = view.rows * view.columns;
    uint64_t seed = 5;
    double *low = calloc((size_t)pixels, sizeof *low), *high = calloc((size_t)pixels, sizeof *high);
    for (int64_t p = 0; p < pixels; p++) {
        const double x = ((double)(p % 101) - 50) * 1.1, y = ((double)(p / 101) - 50) * 1.1;
        const double at = hypot(x, y) > 0 ? 1 / hypot(x, y) : 0;
        low[p] = HUGE_VAL;
        high[p] = -HUGE_VAL;
        for (int n = -1; n <= 1; n++) {
            const double value = of(x + n * sagitta * x * at, y + n * sagitta * y * at);
            low[p] = fmin(low[p], value - 4 * sagitta);
            high[p] = fmax(high[p], value + 4 * sagitta);
        }
        low[p] = fmax(low[p], 0);
    }
    for (int32_t precision = SKG_PRECISION_SINGLE;
         precision <= (run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++) {
        double *got = run_solid(s, NULL, &view, (run_choice){.precision = precision});
        for (int64_t p = 0; p < pixels; p++)
            ck_assert_msg(got[p] >= low[p] && got[p] <= high[p],
                          "%s: %.9g, not from %.9g to %.9g at pixel %d", what, got[p], low[p], high[p],
                          (int)p);
        caster *c = caster_create(s, NULL);
        verdict v = {0};
        v.single = precision == SKG_PRECISION_SINGLE;
        verdict_cast(&v, c, &view, got, window_of(s, NULL, &view), 400, 0, &seed);
        verdict_check(&v, precision, what);
        verdict_free(&v);
        caster_free(c);
        free(got);
    }
    free(low);
    free(high);
}

START_TEST(sphere_shell_and_torus) {
    const int around = suite_full() ? 200 : 80; /* the caster takes its square; bars follow the bend */
    const double bend = 2 * (1 - cos(pi / around));
    solid sphere = solid_sphere(50, around, around / 2), shell = solid_shell(50, 45, around, around / 2),
          torus = solid_torus(35, 15, around, around / 2);
    check_round("sphere", &sphere, sphere_form, 50 * bend);
    check_round("shell", &shell, shell_form, 50 * bend);
    check_round("torus", &torus, torus_form,
                50 * 4 * bend); /* half as many around the tube: four times the bend */
    solid_free(&sphere);
    solid_free(&shell);
    solid_free(&torus);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, cube_and_slab);
    tcase_add_test(tests, cylinder);
    tcase_add_test(tests, the_papers_cube);
    tcase_add_test(tests, sphere_shell_and_torus);
}

SKG_SUITE_MAIN("lengths", add_tests)
