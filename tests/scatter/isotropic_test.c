/* All orders of isotropic scattering, against the exact solution of a half space: S. Chandrasekhar, Radiative Transfer (Oxford
 * University Press, 1950), chapters IV and V. */
#include "isotropic.h"
#include "subject.h"
#include "suite.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* A free path of 10 mm; a block of 40 x 40 x 30 of them stands for the half space; the detector is 3,000 of them away. */
static const double PER_MM = 0.1, BLOCK[3] = {400, 400, 300}, AWAY = 30000, SIDE_MM = 2000;
enum { SIDE = 4, STEPS = 400, HISTORIES = 1 << 14 };

/* Chandrasekhar's function by iteration of 1 / H(u) = sqrt(1 - albedo) + albedo / 2 times the integral of v H(v) / (u + v). */
typedef struct {
    double albedo, values[STEPS]; /* at (i + 0.5) / STEPS */
} reflector;

static double value_at(const reflector *r, double u) {
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double v = (i + 0.5) / STEPS;
        sum += v * r->values[i] / (u + v) / STEPS;
    }
    return 1 / (sqrt(1 - r->albedo) + r->albedo / 2 * sum);
}

static void solve(reflector *r) {
    for (int i = 0; i < STEPS; i++) r->values[i] = 1;
    for (int turn = 0; turn < 200; turn++) {
        double next[STEPS];
        for (int i = 0; i < STEPS; i++) next[i] = value_at(r, (i + 0.5) / STEPS);
        for (int i = 0; i < STEPS; i++) r->values[i] = next[i];
    }
}

/* Of photons that arrive at a cosine, those that are reflected to another one, per sr, once and in all. */
static void reflect(const reflector *r, double in, double out, double per_sr[2]) {
    per_sr[0] = r->albedo / (4 * PI) * out / (in + out);
    per_sr[1] = per_sr[0] * value_at(r, in) * value_at(r, out);
}

/* A beam of 1 mm that meets the middle of the block's lower face, and a detector that looks at it from below. degrees: from the
 * face's normal, of the beam and of the detector; their sum is above 90. */
static subject open_block(double beam, double detector) {
    subject s;
    skg_mesh *mesh = NULL;
    const double a = beam * PI / 180, b = detector * PI / 180;
    const double way[3] = {sin(a), 0, cos(a)}, out[3] = {sin(b), 0, -cos(b)}, along[3] = {cos(b), 0, sin(b)};
    subject_open(&s);
    ck_skg(skg_mesh_create_cuboid(BLOCK[0], BLOCK[1], BLOCK[2], &mesh));
    subject_add(&s, mesh, "Water, Liquid", 0, 0, BLOCK[2] / 2, -1);
    s.view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    s.view.columns = s.view.rows = SIDE;
    double meets =
        0; /* where the beam's line through the face's middle crosses the detector's plane, mm along its rows */
    for (int k = 0; k < 3; k++) {
        s.view.source[k] = way[k];
        s.view.centre[k] = AWAY * out[k];
        s.view.column_step[k] = SIDE_MM / SIDE * along[k];
        s.view.row_step[k] = k == 1 ? SIDE_MM / SIDE : 0;
        meets += way[k] * along[k] * AWAY / (way[0] * out[0] + way[2] * out[2]);
    }
    s.jaws.kind = SKG_COLLIMATION_RECTANGLE;
    s.jaws.low[0] = meets - 0.5, s.jaws.high[0] = meets + 0.5, s.jaws.low[1] = -0.5, s.jaws.high[1] = 0.5;
    s.jaws.distance_mm = 1;
    s.options.quantity = SKG_QUANTITY_PHOTONS;
    return s;
}

/* The exact shares of a detector, which fills few degrees. */
static void expect(double albedo, double beam, double detector, double shares[2]) {
    reflector r = {.albedo = albedo};
    const double b = detector * PI / 180, pitch = SIDE_MM / SIDE;
    solve(&r);
    shares[0] = shares[1] = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double u = (i % SIDE - (SIDE - 1) / 2.0) * pitch, v = (i / SIDE - (SIDE - 1) / 2.0) * pitch;
        const double square = AWAY * AWAY + u * u + v * v, down = AWAY * cos(b) - u * sin(b);
        double per_sr[2];
        reflect(&r, cos(beam * PI / 180), down / sqrt(square), per_sr);
        for (int k = 0; k < 2; k++) shares[k] += per_sr[k] * pitch * pitch * AWAY / (square * sqrt(square));
    }
}

START_TEST(a_half_space_reflects_as_the_exact_solution) {
    static const double albedos[] = {0.3, 0.6, 0.8}, angles[][2] = {{60, 50}, {30, 70}, {75, 75}};
    for (int g = 0; g < suite_turns(sizeof angles / sizeof *angles, 1); g++) {
        subject s = open_block(angles[g][0], angles[g][1]);
        subject_plan(&s);
        for (size_t a = 0; a < sizeof albedos / sizeof *albedos; a++) {
            double orders[3], shares[2], sigma = 0;
            ck_skg(isotropic_run(run_context, s.plan, albedos[a], PER_MM, HISTORIES, orders, &sigma));
            expect(albedos[a], angles[g][0], angles[g][1], shares);
            const double all = orders[0] + orders[1] + orders[2];
            printf(
                "albedo %g, %g and %g degrees: first order %.5f, all %.5f +- %.5f of the exact solution, %.3f of it higher "
                "orders\n",
                albedos[a], angles[g][0], angles[g][1], orders[0] / shares[0], all / shares[1],
                sigma / shares[1], 1 - orders[0] / all);
            fflush(stdout); /* before an assertion ends the process */
            /* A free path is .03 % of the distance. */
            ck_assert_double_eq_tol(orders[0] / shares[0], 1, 2e-3);
            ck_assert_double_eq_tol(all / shares[1], 1, 4 * sigma / shares[1] + 2e-3);
        }
        subject_close(&s);
    }
}
END_TEST

/* Photons that nothing absorbs leave a cube upwards or downwards, alike: a beam along the detector's plane through the middle of a
 * cube brings half of those that interact to a detector that is far wider than the cube and lies on it. No photon is lost or made
 * over whole histories. */
START_TEST(half_of_all_photons_go_up) {
    static const double CUBE = 10, WIDE = 2e5, SLOPE = 1e-3, paths[] = {2, 0.5, 4};
    const double above = CUBE / 2 + 0.01;
    for (int p = 0; p < suite_turns(sizeof paths / sizeof *paths, 2); p++) {
        subject s;
        double orders[3], sigma = 0;
        subject_open(&s);
        subject_add_box(&s, CUBE, CUBE, CUBE, "Water, Liquid");
        s.view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
        s.view.source[0] = 1, s.view.source[2] = SLOPE;
        s.view.centre[2] = above;
        s.view.columns = s.view.rows = SIDE;
        s.view.column_step[0] = s.view.row_step[1] = WIDE / SIDE;
        s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 1;
        /* .1 mm high and 1 mm wide where it meets the cube. */
        s.jaws.low[0] = above / SLOPE - 50, s.jaws.high[0] = above / SLOPE + 50;
        s.jaws.low[1] = -0.5, s.jaws.high[1] = 0.5;
        s.options.quantity = SKG_QUANTITY_PHOTONS;
        subject_plan(&s);
        ck_skg(isotropic_run(run_context, s.plan, 1, paths[p] / CUBE, HISTORIES, orders, &sigma));
        const double half = 0.5 * -expm1(-paths[p]), share = (orders[0] + orders[1] + orders[2]) / half;
        printf("%g free paths: %.5f +- %.5f of half of the photons, %.3f of them after one interaction\n",
               paths[p], share, sigma / half, orders[0] / (orders[0] + orders[1] + orders[2]));
        fflush(stdout); /* before an assertion ends the process */
        /* The beam's slope moves interactions by up to .001 of the cube. */
        ck_assert_double_eq_tol(share, 1, 4 * sigma / half + 1e-3);
        subject_close(&s);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, a_half_space_reflects_as_the_exact_solution);
    tcase_add_test(tests, half_of_all_photons_go_up);
}

SKG_SUITE_MAIN("scatter/isotropic", add_tests)
