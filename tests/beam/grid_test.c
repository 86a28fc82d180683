/* The primary transmission of anti-scatter grids: closed forms, and rays one by one through strips. */
#include "suite.h"
#include "support/named.h"

#include <skiagraph/options.h>

#include <float.h>
#include <math.h>

static skg_grid make(double ratio, double lines, double strip) {
    skg_grid grid;
    skg_grid_init(&grid);
    grid.ratio = ratio, grid.lines_per_cm = lines, grid.strip_mm = strip;
    return grid;
}

static double pass(const skg_grid *grid, double kev, double oblique, double tilt) {
    double transmission = -1;
    ck_skg(skg_grid_transmission_get(grid, kev, oblique, tilt, &transmission));
    return transmission;
}

static double mu(const skg_material *material, double kev) { /* 1/mm */
    double per_cm = 0;
    if (material) ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return per_cm / 10;
}

/* Along the strips: D/p exp(-mu h) of the interspace and d/p exp(-mu h) of the strip. */
START_TEST(at_the_focus) {
    skg_material *lead = named("Pb"), *aluminium = named("Al");
    skg_grid grid = make(12, 40, 0.05);
    grid.interspace = aluminium;
    for (double kev = 20; kev < 150; kev += 7) {
        const double height = 12 * 0.2, oblique = 1.1;
        const double truth =
            0.8 * exp(-mu(aluminium, kev) * height * oblique) + 0.2 * exp(-mu(lead, kev) * height * oblique);
        ck_assert_double_eq_tol(pass(&grid, kev, oblique, 0), truth, 16 * DBL_EPSILON);
    }
    skg_material_release(&lead);
    skg_material_release(&aluminium);
}
END_TEST

/* Cut-off by strips that stop everything. A source beside the focus by b at its distance f tilts the ray by b/f and loses r b/f
 * of the primary; one above or below the focus, at f1, loses r c |1/f1 - 1/f| at the distance c from the middle (W. J. Meredith
 * and J. B. Massey, Fundamental Physics of Radiology, 3rd ed., 1977, chapter on grids; T. S. Curry et al., Christensen's
 * Physics of Diagnostic Radiology, 4th ed., 1990, chapter 8). */
START_TEST(cut_off) {
    skg_material *black = NULL;
    ck_skg(skg_material_create_mu("black", 1e7, &black));
    skg_grid grid = make(8, 40, 0.05);
    grid.strip = black;
    const double f = 1000;
    for (double b = 0; b <= 200; b += 12.5) {
        const double truth = fmax(0, 1 - 8 * b / f);
        /* Rays that touch a corner of a strip: 1/mu = 1e-6 mm of 0.2 mm, times the ratio. */
        ck_assert_double_eq_tol(pass(&grid, 60, 1, b / f) / 0.8, truth, 1e-4);
    }
    for (double c = 0; c <= 200; c += 25) {
        const double f1 = 800, tilt = c / f1 - c / f;
        ck_assert_double_eq_tol(pass(&grid, 60, 1, tilt) / 0.8, 1 - 8 * c * (1 / f1 - 1 / f),
                                1e-4); /* as above */
        ck_assert_double_eq_tol(pass(&grid, 60, 1, -tilt), pass(&grid, 60, 1, tilt), 4 * DBL_EPSILON);
    }
    skg_material_release(&black);
}
END_TEST

/* The length that a ray has in strips, whose left edges are at 0, p, 2p, ... at every height. */
static double length_in_strips(double start, double across, double p, double d) {
    double sum = 0;
    for (int k = 0; k * p < start + across; k++)
        sum += fmax(0, fmin(start + across, k * p + d) - fmax(start, k * p));
    return sum;
}

/* Any tilt, thick and thin strips: the mean over many rays. */
START_TEST(ray_by_ray) {
    static const double shapes[][3] = {{12, 40, 0.05}, {5, 30, 0.2}, {8, 70, 0.036}, {16, 36, 0.036}};
    enum { RAYS = 20000 };
    skg_material *lead = named("Pb"), *aluminium = named("Al");
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        skg_grid grid = make(shapes[s][0], shapes[s][1], shapes[s][2]);
        grid.interspace = s % 2 ? aluminium : NULL;
        const double p = 10 / shapes[s][1], d = shapes[s][2], height = shapes[s][0] * (p - d);
        for (double tilt = 0.003; tilt < 0.9; tilt *= 1.45)
            for (double kev = 40; kev < 150; kev += 47) {
                const double across = height * tilt, path = height * sqrt(1 + tilt * tilt);
                const double strip = mu(lead, kev), between = mu(grid.interspace, kev);
                double sum = 0;
                for (int k = 0; k < RAYS; k++) {
                    const double in = length_in_strips((k + 0.5) / RAYS * p, across, p, d) * path / across;
                    sum += exp(-strip * in - between * (path - in)) / RAYS;
                }
                /* Where a ray begins to meet a strip it falls by up to mu path p / across from one to the next, in two of
                 * 20000 of them; far less than this in most. */
                ck_assert_double_eq_tol(pass(&grid, kev, sqrt(1 + tilt * tilt), tilt), sum, 2e-4);
            }
    }
    skg_material_release(&lead);
    skg_material_release(&aluminium);
}
END_TEST

/* Nothing jumps where a ray begins to cross another strip. */
START_TEST(continuous) {
    const skg_grid grid = make(10, 40, 0.1);
    for (int k = 1; k < 40; k++) {
        const double tilt = 0.025 * k * 0.25 / 1.5; /* multiples of a tenth of the period over the height */
        ck_assert_double_eq_tol(pass(&grid, 70, 1.05, tilt * (1 - 1e-9)),
                                pass(&grid, 70, 1.05, tilt * (1 + 1e-9)), 1e-7); /* slopes are below 50 */
    }
}
END_TEST

START_TEST(refused) {
    static const struct {
        double ratio, lines, strip, focus;
        const char *text;
    } cases[] = {{0, 40, 0.05, 0, "grid ratio of 0"},
                 {12, 0, 0.05, 0, "0 strips per cm"},
                 {12, 40, 0.25, 0, "one follows another every 0.25 mm"},
                 {12, 40, 0, 0, "0 mm thick"},
                 {12, 40, 0.05, -1, "focus at -1 mm"}};
    double transmission = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        skg_grid grid = make(cases[i].ratio, cases[i].lines, cases[i].strip);
        grid.focus_mm = cases[i].focus;
        ck_skg_fails(skg_grid_transmission_get(&grid, 60, 1, 0, &transmission), SKG_ERR_SCENE, cases[i].text);
    }
    const skg_grid grid = make(12, 40, 0.05);
    ck_skg_fails(skg_grid_transmission_get(&grid, 60, 0.9, 0, &transmission), SKG_ERR_ARGUMENT, "at least 1");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, at_the_focus);
    tcase_add_test(tests, cut_off);
    tcase_add_test(tests, ray_by_ray);
    tcase_add_test(tests, continuous);
    tcase_add_test(tests, refused);
}

SKG_SUITE_MAIN("grid", add_tests)
