/* Beams, detectors and parts in all kinds of places, against photons that are followed one by one. */
#include "analogue.h"
#include "subject.h"
#include "suite.h"

#include <math.h>

#define WATER "Water, Liquid"

enum { HISTORIES = 1 << 16, PHOTONS = 1000000 };

/* The image of one box, 200 x 150 mm2 of detector. */
typedef struct {
    const char *name;
    double middle[3], size[3], source[3]; /* of a parallel beam its direction */
    int parallel;
    double plane; /* the detector's z */
} box_scene;

static subject open_box(const box_scene *b, const char *material) {
    subject s;
    skg_mesh *mesh = NULL;
    subject_open(&s);
    ck_skg(skg_mesh_create_cuboid(b->size[0], b->size[1], b->size[2], &mesh));
    subject_add(&s, mesh, material, b->middle[0], b->middle[1], b->middle[2], -1);
    for (int k = 0; k < 3; k++) s.view.source[k] = b->source[k];
    s.view.centre[2] = b->plane;
    if (b->parallel) s.view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    s.scatter.histories = HISTORIES;
    return s;
}

/* Compares the sum over the detector, and that of each order. */
static void compare(const box_scene *b, const char *material, double kev) {
    subject s = open_box(b, material);
    s.kev = kev;
    analogue_scene a = {.material = material,
                        .kev = s.kev,
                        .parallel = b->parallel,
                        .plane = b->plane,
                        .side = {200, 150},
                        .per_area = s.photons / 25};
    for (int k = 0; k < 3; k++) {
        a.low[k] = b->middle[k] - b->size[k] / 2, a.high[k] = b->middle[k] + b->size[k] / 2;
        a.source[k] = b->source[k];
    }
    const analogue_result truth = analogue_run(&a, PHOTONS, 33);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const skg_scatter_report report = subject_report(&s);
    const double sum = subject_sum(&s, p.scatter), error = truth.sigma / truth.sum,
                 own = report.sigma / report.mean;
    printf(
        "%s: %.4f +- %.4f (+- %.4f of pixels) of the analogue sum; orders %.3f %.3f %.3f, not %.3f %.3f %.3f\n",
        b->name, sum / truth.sum, error, own, report.orders[0], report.orders[1], report.orders[2],
        truth.order[0] / truth.sum, truth.order[1] / truth.sum, truth.order[2] / truth.sum);
    fflush(stdout); /* before an assertion ends the process */
    /* Four standard errors; that of a sum is below that of its pixels. And 2e-3 for cells and tables. */
    ck_assert_double_eq_tol(sum / truth.sum, 1, 4 * error + own + 2e-3);
    for (int k = 0; k < 3; k++) /* a share has a smaller error than its order and the sum */
        ck_assert_double_eq_tol(report.orders[k], truth.order[k] / truth.sum, 4 * error + own + 2e-3);
    pictures_free(&p);
    subject_close(&s);
}

static const box_scene boxes[] = {
    {"on the detector", {0, 0, 149.99}, {180, 140, 100}, {0, 0, -500}, 0, 200},
    {"oblique and parallel", {10, 0, 100}, {120, 100, 80}, {0.3, -0.1, 1}, 1, 200},
    {"source inside", {0, 0, 0}, {150, 150, 150}, {20, 10, -40}, 0, 120},
    {"oblique", {0, 0, 50}, {120, 100, 80}, {200, 0, -300}, 0, 200},
    {"in the middle", {0, 0, 50}, {120, 100, 80}, {0, 0, -500}, 0, 200},
    {"beside the beam", {90, 20, 100}, {100, 80, 60}, {0, 0, -500}, 0, 200},
    {"parallel", {0, 0, 100}, {120, 100, 80}, {0, 0, 1}, 1, 200},
    {"20 cm of water", {0, 0, 0}, {300, 300, 200}, {0, 0, -900}, 0, 300},
};

START_TEST(sums_are_those_of_single_photons) {
    compare(&boxes[_i], WATER, 60);
}
END_TEST

/* Photons that lose most of their energy at once, and pairs. */
static const struct {
    box_scene box;
    const char *material;
    double kev;
} hard[] = {
    {{"cobalt 60 on 20 cm of water", {0, 0, 0}, {300, 300, 200}, {0, 0, -900}, 0, 110}, WATER, 1250},
    {{"6 MeV on 2 cm of lead", {0, 0, 0}, {300, 300, 20}, {0, 0, -900}, 0, 30}, "Pb", 6000},
    {{"6 MeV on 20 cm of water", {0, 0, 0}, {300, 300, 200}, {0, 0, -900}, 0, 110}, WATER, 6000},
    {{"caesium 137 on 20 cm of water", {0, 0, 0}, {300, 300, 200}, {0, 0, -900}, 0, 110}, WATER, 661.7},
    {{"20 MeV inside lead", {0, 0, 0}, {150, 150, 60}, {20, 10, -10}, 0, 40}, "Pb", 20000},
};

START_TEST(hard_photons_are_those_of_single_ones) {
    compare(&hard[_i].box, hard[_i].material, hard[_i].kev);
}
END_TEST

/* A part that the field does not reach scatters nothing; one that only scattered photons reach does. */
START_TEST(parts_outside_the_field_scatter_what_reaches_them) {
    const box_scene b = {"", {0, 0, 50}, {60, 60, 60}, {0, 0, -500}, 0, 200};
    double sums[2];
    for (int wall = 0; wall < 2; wall++) {
        subject s = open_box(&b, WATER);
        skg_mesh *mesh = NULL;
        s.jaws.kind = SKG_COLLIMATION_RECTANGLE;
        s.jaws.distance_mm = 400;
        for (int k = 0; k < 2; k++) s.jaws.low[k] = -20, s.jaws.high[k] = 20;
        ck_skg(skg_mesh_create_cuboid(20, 200, 200, &mesh));
        if (wall)
            subject_add(&s, mesh, "Water, Liquid", 80, 0, 60, -1);
        else
            skg_mesh_release(&mesh);
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        sums[wall] = subject_sum(&s, p.scatter);
        pictures_free(&p);
        subject_close(&s);
    }
    /* The wall sends photons back in, and keeps few that would have arrived. */
    ck_assert_double_gt(sums[1], 1.01 * sums[0]);
    ck_assert_double_lt(sums[1], 1.5 * sums[0]);
}
END_TEST

/* A spot of 2 mm changes the sum by less than its noise. */
START_TEST(extended_sources_have_the_scatter_of_their_middle) {
    const box_scene b = boxes[0];
    double sums[2], error = 0;
    skg_spot spot;
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_DISC, spot.extent[0] = 2, spot.samples = 16;
    for (int k = 0; k < 2; k++) {
        subject s = open_box(&b, WATER);
        if (k) s.options.spot = &spot;
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        const skg_scatter_report report = subject_report(&s);
        sums[k] = subject_sum(&s, p.scatter);
        error = hypot(error, report.sigma / report.mean);
        pictures_free(&p);
        subject_close(&s);
    }
    ck_assert_double_eq_tol(sums[1] / sums[0], 1, 4 * error);
    ck_assert_double_ne(sums[1], sums[0]);
}
END_TEST

/* A block that is cut into 1,000 parts scatters as the whole: their cells are the same but for roundings. */
START_TEST(many_parts_are_one) {
    enum { SIDE = 10 };
    const box_scene b = {"", {0, 0, 50}, {120, 96, 72}, {0, 0, -500}, 0, 200};
    subject whole = open_box(&b, WATER), s;
    subject_open(&s);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        const int index[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        skg_mesh *mesh = NULL;
        double at[3];
        for (int k = 0; k < 3; k++) at[k] = b.middle[k] + b.size[k] * ((index[k] + 0.5) / SIDE - 0.5);
        ck_skg(skg_mesh_create_cuboid(b.size[0] / SIDE, b.size[1] / SIDE, b.size[2] / SIDE, &mesh));
        subject_add(&s, mesh, "Water, Liquid", at[0], at[1], at[2], -1);
    }
    s.scatter.histories = HISTORIES;
    s.options.overlaps = 0;
    subject_plan(&whole);
    subject_plan(&s);
    pictures p = subject_pictures(&whole, NULL), q = subject_pictures(&s, NULL);
    /* A rounding sends a photon elsewhere now and then. */
    ck_assert_double_eq_tol(subject_sum(&s, q.scatter) / subject_sum(&whole, p.scatter), 1, 1e-3);
    pictures_free(&p);
    pictures_free(&q);
    subject_close(&s);
    subject_close(&whole);
}
END_TEST

/* --- rooms: parts that are small or thin in the box of all of them */

/* keV over the left and the right half of the detector behind a beam of one photon for each of 32 x 32
 * pixels at the foot of the perpendicular: 1.5 to 6 million photons followed through exact bodies, with next-event estimates and without cells, by a program
 * of a few hundred lines that shares the cross sections; their standard errors are .05 to .6 %. */
typedef struct {
    const char *name;
    double plane, side, kev, left, right;
} room;

static subject open_room(const room *r) {
    subject s;
    subject_open(&s);
    s.view.source[2] = -1000, s.view.centre[2] = r->plane;
    s.view.columns = s.view.rows = 32;
    s.view.column_step[0] = s.view.row_step[1] = r->side / 32;
    s.kev = r->kev, s.photons = 1;
    s.scatter.histories = 0, s.scatter.tolerance = 0.02;
    return s;
}

static int64_t put_box(subject *s, double x, double y, double z, const char *material, double at_x,
                       double at_z) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cuboid(x, y, z, &mesh));
    return subject_add(s, mesh, material, at_x, 0, at_z, -1);
}

static void compare_room(subject *s, const room *r) {
    double halves[2] = {0};
    subject_plan(s);
    pictures p = subject_pictures(s, NULL);
    const skg_scatter_report report = subject_report(s);
    for (int64_t i = 0; i < p.count; i++) halves[i % 32 / 16] += (double)p.scatter[i];
    const double own = report.sigma / report.mean;
    printf("%s: %+.2f and %+.2f %%, stated %.2f %%\n", r->name, 100 * (halves[0] / r->left - 1),
           100 * (halves[1] / r->right - 1), 100 * own);
    fflush(stdout); /* before an assertion ends the process */
    /* A half has 512 pixels, so that its error is below the one that is stated of them. */
    ck_assert_double_eq_tol(halves[0] / r->left, 1, 1.5 * own);
    ck_assert_double_eq_tol(halves[1] / r->right, 1, 1.5 * own);
    /* Cells hold the faces: what is left is the rounding of floats. */
    ck_assert_double_le(report.cells_error, 1e-4);
    pictures_free(&p);
    subject_close(s);
}

/* 2 mm of lead, 50 mm behind 20 cm of water, before the left half. */
START_TEST(lead_before_half_of_the_detector) {
    const room r = {"lead", 300, 300, 100, 302.0, 1234.2};
    subject s = open_room(&r);
    put_box(&s, 300, 300, 200, "Water, Liquid", 0, 0);
    put_box(&s, 200, 400, 2, "Pb", -100, 151);
    compare_room(&s, &r);
}
END_TEST

/* 3 mm of lead with a hole of 60 mm, 200 mm before 20 cm of water. */
START_TEST(lead_with_a_hole) {
    const room r = {"hole", 300, 400, 80, 108.9, 108.9};
    subject s = open_room(&r);
    skg_mesh *hole = NULL;
    s.scatter.tolerance = 0.05;
    ck_skg(skg_mesh_create_cylinder(30, 3, 256, &hole));
    const int64_t plate = put_box(&s, 400, 400, 3, "Pb", 0, -301.5);
    subject_add(&s, hole, "Vacuum", 0, 0, -301.5, plate);
    put_box(&s, 300, 300, 200, "Water, Liquid", 0, 0);
    compare_room(&s, &r);
}
END_TEST

/* 20 mm of iron, 400 mm above a table of a metre. */
START_TEST(a_cube_far_above_its_table) {
    const room r = {"iron", 600, 200, 200, 3452, 3449};
    subject s = open_room(&r);
    put_box(&s, 20, 20, 20, "Fe", 0, 0);
    put_box(&s, 1000, 1000, 20, "Polymethyl Methacrylate", 0, 420);
    compare_room(&s, &r);
}
END_TEST

/* 10 cm of water in a metre and a half of air. */
START_TEST(air_scatters_outside_the_parts) {
    const room r = {"air", 500, 400, 60, 248.3, 247.9};
    subject s = open_room(&r);
    skg_material *air = NULL;
    put_box(&s, 100, 100, 100, "Water, Liquid", 0, 0);
    ck_skg(skg_material_create_named("Air, Dry (near sea level)", &air));
    s.options.world = air;
    compare_room(&s, &r);
    skg_material_release(&air);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(
        tests, sums_are_those_of_single_photons, 0,
        suite_turns(sizeof boxes / sizeof *boxes, 4)); /* the hardest: the others lie between */
    tcase_add_loop_test(tests, hard_photons_are_those_of_single_ones, 0,
                        suite_turns(sizeof hard / sizeof *hard, 2)); /* dose_test follows others */
    tcase_add_test(tests, parts_outside_the_field_scatter_what_reaches_them);
    tcase_add_test(tests, extended_sources_have_the_scatter_of_their_middle);
    tcase_add_test(tests, many_parts_are_one);
    tcase_add_test(tests, lead_before_half_of_the_detector);
    tcase_add_test(tests, lead_with_a_hole);
    tcase_add_test(tests, a_cube_far_above_its_table);
    tcase_add_test(tests, air_scatters_outside_the_parts);
}

SKG_SUITE_MAIN("scatter/places", add_tests)
