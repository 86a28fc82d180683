/* Sinograms of a cylinder and of nested ellipsoids (the paper's section 4.3): against exact lengths through the same
 * polyhedra, and against the Radon transform of the round bodies, whose error falls as they are refined. */
#include "suite.h"

#include "support/caster.h"
#include "support/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 801, VIEWS = 12, RAYS = COLUMNS * VIEWS, LIMIT = 3 };

#define PI 3.14159265358979323846

/* Each body lies in the one before it. */
typedef struct {
    double radii[3], per_cm;
    int is_cylinder;
} body;

static const body cylinder[] = {{{40, 40, 60}, 0.3, 1}};
static const body nested[] = {{{60, 45, 50}, 0.2, 0}, {{30, 25, 20}, 0.35, 0}, {{8, 8, 8}, 0.75, 0}};

/* -ln(I/I0) of all rays: by the library, through the polyhedra, and through the round bodies. */
typedef struct {
    double ours[RAYS], exact[RAYS], smooth[RAYS];
} sinogram;

static sinogram rays;

/* The polyhedra of the sinogram, and how much more each attenuates than the one around it, per mm. */
static struct {
    solid shape;
    caster *rays;
    double per_mm;
} polyhedra[LIMIT];
static int polyhedron_count;
static skg_view views[VIEWS];

/* One row of pixels; no vertex lies in its plane. */
static skg_view make_fan(void) {
    skg_view view;
    skg_view_init(&view);
    view.columns = COLUMNS;
    view.rows = 1;
    view.source[1] = -500;
    view.centre[1] = 300;
    view.source[2] = view.centre[2] = 0.37;
    view.column_step[0] = -0.26;
    view.row_step[2] = -0.26;
    return view;
}

/* A prism around z. */
static solid make_prism(double radius, double half, int sides) {
    solid s = {.vertices = 2 * sides + 2, .triangles = 4 * sides};
    s.positions = malloc((size_t)s.vertices * 3 * sizeof *s.positions);
    s.corners = malloc((size_t)s.triangles * 3 * sizeof *s.corners);
    ck_assert(s.positions && s.corners);
    const int32_t top = 2 * sides, bottom = top + 1;
    for (int32_t k = 0; k < sides; k++) {
        const double angle = 2 * PI * (k + 0.3) / sides, x = radius * cos(angle), y = radius * sin(angle);
        const double both[6] = {x, y, half, x, y, -half};
        const int32_t a = 2 * k, b = 2 * ((k + 1) % sides);
        const int32_t faces[12] = {a, a + 1, b, b, a + 1, b + 1, top, a, b, bottom, b + 1, a + 1};
        memcpy(s.positions + 6 * k, both, sizeof both);
        memcpy(s.corners + 12 * k, faces, sizeof faces);
    }
    const double poles[6] = {0, 0, half, 0, 0, -half};
    memcpy(s.positions + 6 * sides, poles, sizeof poles);
    return s;
}

/* Vertices lie on the body's surface. */
static solid make_solid(const body *b, int sides) {
    if (b->is_cylinder) return make_prism(b->radii[0], b->radii[2], sides);
    solid s = solid_sphere(1, sides, sides / 2);
    const double scale[12] = {b->radii[0], 0, 0, 0, 0, b->radii[1], 0, 0, 0, 0, b->radii[2], 0};
    solid_move(&s, scale);
    return s;
}

/* The length of a ray in a body. */
static double length_in(const body *b, const double *from, const double *to) {
    double dd = 0, dp = 0, pp = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        const double d = (to[k] - from[k]) / b->radii[k], p = from[k] / b->radii[k];
        length += (to[k] - from[k]) * (to[k] - from[k]);
        if (b->is_cylinder && k == 2) continue;
        dd += d * d, dp += d * p, pp += p * p;
    }
    const double inside = dp * dp - dd * (pp - 1);
    return inside > 0 ? 2 * sqrt(inside) / dd * sqrt(length) : 0;
}

static void judge(const body *b, double mu, caster *c) {
    for (int ray = 0; ray < RAYS; ray++) {
        const skg_view *view = &views[ray / COLUMNS];
        const int column = ray % COLUMNS;
        double pixel[3];
        for (int k = 0; k < 3; k++)
            pixel[k] = view->centre[k] + (column - 0.5 * (COLUMNS - 1)) * view->column_step[k];
        rays.exact[ray] += mu / 10 * (double)caster_length(c, view, column, 0);
        rays.smooth[ray] += mu / 10 * length_in(b, view->source, pixel);
    }
}

/* The last place of a float from 256 to 512, as far as columns and rows are from the middles of the bodies, in pixels. */
static const double last_place = 0x1p-15;

/* By how much a ray changes that is shifted by two last places along columns or rows: the most of four ways. */
static double shifted(int ray) {
    const skg_view *view = &views[ray / COLUMNS];
    const long double column = ray % COLUMNS;
    double most = 0;
    for (int way = 0; way < 4; way++) {
        const long double by = (long double)((way & 1 ? 2 : -2) * last_place);
        double sum = 0;
        for (int p = 0; p < polyhedron_count; p++)
            sum += polyhedra[p].per_mm * (double)caster_length(polyhedra[p].rays, view,
                                                               column + (way & 2 ? by : 0), way & 2 ? 0 : by);
        most = fmax(most, fabs(sum - rays.exact[ray]));
    }
    return most;
}

static void forget_polyhedra(void) {
    for (; polyhedron_count > 0; polyhedron_count--) {
        caster_free(polyhedra[polyhedron_count - 1].rays);
        solid_free(&polyhedra[polyhedron_count - 1].shape);
    }
}

static void find_views(void) {
    skg_scan_options options;
    skg_scan *scan = NULL;
    const skg_view view = make_fan();
    skg_scan_options_init(&options);
    options.projections = VIEWS;
    options.start_rad = 0.1;
    options.step_rad = 2 * PI / VIEWS;
    ck_skg(skg_scan_create(&view, &options, &scan));
    for (int v = 0; v < VIEWS; v++) {
        skg_view_init(&views[v]);
        ck_skg(skg_scan_view_get(scan, v, &views[v]));
        /* Planes at different heights between the rings of vertices, so that the rms has them all. */
        views[v].source[2] += 2.3 * v;
        views[v].centre[2] += 2.3 * v;
    }
    skg_scan_release(&scan);
}

static void make_sinogram(const body *bodies, int count, int sides, int32_t precision) {
    skg_scene *scene = NULL;
    int64_t inside = -1;
    memset(&rays, 0, sizeof rays);
    find_views();
    forget_polyhedra();
    ck_skg(skg_scene_create(run_context, &scene));
    for (int b = 0; b < count; b++) {
        solid s = make_solid(&bodies[b], sides);
        skg_mesh *mesh = run_mesh(&s);
        char label[16];
        snprintf(label, sizeof label, "body %d", b);
        inside = run_part(scene, label, mesh, bodies[b].per_cm, NULL, inside);
        skg_mesh_release(&mesh);
        const double more = bodies[b].per_cm - (b > 0 ? bodies[b - 1].per_cm : 0);
        polyhedra[b].shape = s;
        polyhedra[b].rays = caster_create(&polyhedra[b].shape, NULL);
        polyhedra[b].per_mm = more / 10;
        polyhedron_count = b + 1;
        judge(&bodies[b], more, polyhedra[b].rays);
    }
    skg_plan *plan = run_plan(scene, &views[0],
                              (run_choice){.precision = precision, .quantity = SKG_QUANTITY_ATTENUATION});
    for (int v = 0; v < VIEWS; v++) {
        ck_skg(skg_plan_view_set(plan, &views[v]));
        double *image = run_image(plan, &views[v]);
        memcpy(rays.ours + v * COLUMNS, image, COLUMNS * sizeof *image);
        free(image);
    }
    skg_plan_release(&plan);
    skg_scene_release(&scene);
}

/* The bar is 1e-6 of the largest value. In double every ray keeps it. In single the projected vertices are floats: where the
 * ray grazes a facet, the last places of their columns and rows make more than that. There a ray has the length of one that is
 * shifted by at most two of them. That is at most one ray of a thousand, and the rms keeps the bar. */
static void check_exact(int is_double) {
    double largest = 0, worst = 0, squares = 0;
    int beyond = 0, wrong = 0;
    for (int ray = 0; ray < RAYS; ray++) largest = fmax(largest, rays.exact[ray]);
    for (int ray = 0; ray < RAYS; ray++) {
        const double error = fabs(rays.ours[ray] - rays.exact[ray]) / largest;
        worst = fmax(worst, error);
        squares += error * error;
        if (!(error > 1e-6)) continue;
        beyond++;
        wrong += error > shifted(ray) / largest;
    }
    printf("%s: largest error %.2g of the maximum, rms %.2g, %d of %d rays beyond 1e-6\n",
           is_double ? "double" : "single", worst, sqrt(squares / RAYS), beyond, RAYS);
    ck_assert_double_le(sqrt(squares / RAYS), 1e-6); /* as said */
    ck_assert_int_eq(wrong, 0);
    ck_assert_int_le(beyond, is_double ? 0 : RAYS / 1000);
}

static double find_rms(void) {
    double sum = 0;
    for (int ray = 0; ray < RAYS; ray++) sum += pow(rays.ours[ray] - rays.smooth[ray], 2);
    return sqrt(sum / RAYS);
}

/* An inscribed polyhedron of n sides is too small by a share of n^-2, and so are lengths in the middle. Near the edge of
 * the shadow, where the length grows as the square root of the distance, the error is larger; over the width n^-2 it is
 * n^-1, so that its square sums to n^-4 as well, and between both to n^-4 ln n. The order is therefore 2, less 0.1 for
 * the logarithm from 32 to 128. That edge is narrower than a pixel, which samples it by chance: 0.2 either way. */
static void check_order(const body *bodies, int count) {
    double rms[LIMIT];
    for (int k = 0; k < LIMIT; k++) {
        make_sinogram(bodies, count, 32 << k, SKG_PRECISION_SINGLE);
        check_exact(0);
        rms[k] = find_rms();
    }
    if (run_has_double()) {
        make_sinogram(bodies, count, 128, SKG_PRECISION_DOUBLE);
        check_exact(1);
    }
    forget_polyhedra();
    const double order = log2(rms[0] / rms[2]) / 2;
    printf("rms %.3g, %.3g, %.3g: order %.3f\n", rms[0], rms[1], rms[2], order);
    ck_assert_double_ge(order, 1.8); /* as said */
    ck_assert_double_le(order, 2.2); /* as said */
}

START_TEST(a_cylinder) {
    check_order(cylinder, 1);
}
END_TEST

START_TEST(nested_ellipsoids) {
    check_order(nested, 3);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, a_cylinder);
    tcase_add_test(tests, nested_ellipsoids);
}

SKG_SUITE_MAIN("sinogram", add_tests)
