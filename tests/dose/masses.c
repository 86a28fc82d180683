/* Masses of parts of which others displace something: thin ones are right, too. */
#include "dose/exposed.h"

#include <string.h>

#define WATER "Water, Liquid"

enum { NONE = -1 };

/* Adds a box, of a priority, or inside a part. */
static int64_t add_box(subject *s, const double size[3], double x, double y, double z, const char *material,
                       int32_t priority, int64_t inside) {
    skg_mesh *mesh = NULL;
    skg_part part;
    int64_t id = 0;
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cuboid(size[0], size[1], size[2], &mesh));
    ck_skg(skg_material_create_named(material, &part.material));
    part.label = material;
    part.mesh = mesh, part.priority = priority, part.inside = inside;
    part.pose[3] = x, part.pose[7] = y, part.pose[11] = z;
    ck_skg(skg_scene_part_add(s->scene, &part, &id));
    skg_material_release(&part.material);
    skg_mesh_release(&mesh);
    return id;
}

/* The masses of three parts; no photons are followed. */
static void weigh(subject *s, double grams[3]) {
    const skg_dose_options options = options_of(0);
    skg_dose *dose = dose_of(s, &options);
    for (int k = 0; k < 3; k++) grams[k] = part_of(dose, k).mass_g;
    skg_dose_release(&dose);
    subject_close(s);
}

/* A foil along each axis; a bead with a priority stands far from both, in it, or across half of it. */
START_TEST(thin_parts_keep_their_mass) {
    static const double thickness[] = {0.02, 0.3, 1};
    const double t = thickness[_i / 3], water = 320; /* 100 x 80 x 40 mm */
    const int axis = _i % 3;
    double foil[3] = {30, 30, 30}, half[3] = {10, 10, 10}, at[3] = {0, 0, 0}, grams[3];
    foil[axis] = t, half[axis] = 5, at[(axis + 1) % 3] = 5 + 15 - 10;
    const double ti = 4.54e-3 * 30 * 30 * t;
    subject s = open_box(100, 80, 40, WATER);
    add_box(&s, foil, 3.3, 5.1, 90, "Ti", 0, NONE); /* beside the water */
    add_box(&s, half, 70, 1, 2, "Al", 1, NONE);
    weigh(&s, grams);
    /* Rounding: nothing is displaced. */
    ck_assert_double_eq_tol(grams[0] / water, 1, 1e-12);
    ck_assert_double_eq_tol(grams[1] / ti, 1, 1e-12);
    s = open_box(100, 80, 40, WATER);
    add_box(&s, foil, 3.3, 1.7, 0.4, "Ti", 1, NONE);
    add_box(&s, half, 0, 0, 90, "Al", 0, NONE);
    weigh(&s, grams);
    /* Rounding of lines that end at the faces of boxes along the axes. */
    ck_assert_double_eq_tol(grams[1] / ti, 1, 1e-12);
    ck_assert_double_eq_tol(grams[0], water - 1e-3 * 30 * 30 * t, 1e-9 * water);
    s = open_box(100, 80, 40, WATER);
    add_box(&s, foil, 0, 0, 90, "Ti", 0, NONE);
    add_box(&s, half, at[0], at[1], 90 + at[2], "Al", 1, NONE); /* it covers 10 x 10 of it */
    weigh(&s, grams);
    /* Rounding, as before: lines end at faces of boxes. */
    ck_assert_double_eq_tol(grams[1] / (4.54e-3 * (30 * 30 - 10 * 10) * t), 1, 1e-9);
    ck_assert_double_eq_tol(grams[2] / (2.6989e-3 * 10 * 10 * 5), 1, 1e-12);
}
END_TEST

/* Of a part in another one that it leaves, with clip; and one that is displaced whole has no mass and no dose. */
START_TEST(clip_and_displacement_leave_the_rest) {
    const double stick[3] = {60, 0.1, 10}, cover[3] = {80, 20, 20};
    double grams[3];
    subject s = open_box(100, 80, 40, WATER);
    s.options.clip = 1;
    add_box(&s, stick, 50, 3, 1, "Ti", 0, 0); /* half of it is outside */
    add_box(&s, cover, 0, 0, 90, "Al", 0, NONE);
    weigh(&s, grams);
    /* Rounding: lines end at faces of boxes. */
    ck_assert_double_eq_tol(grams[1] / (4.54e-3 * 30 * 0.1 * 10), 1, 1e-9);
    ck_assert_double_eq_tol(grams[0], 320 - 1e-3 * 30 * 0.1 * 10, 1e-9 * 320);
    s = open_box(100, 80, 40, WATER);
    add_box(&s, stick, 0, 0, 90, "Ti", 0, NONE);
    add_box(&s, cover, 0, 0, 90, "Al", 1, NONE);
    const skg_dose_options options = options_of(100);
    skg_dose *dose = dose_of(&s, &options);
    ck_assert_double_eq(part_of(dose, 1).mass_g, 0);
    ck_assert(isnan(part_of(dose, 1).dose_ugy));
    skg_dose_release(&dose);
    subject_close(&s);
}
END_TEST

static int doubts; /* warnings of masses */
static void count_doubts(int32_t level, const char *message, void *user) {
    (void)user;
    doubts += level == SKG_LOG_WARNING && strstr(message, "is known to") != NULL;
}

/* A part that leaves its parent on all sides takes away more than there is, which the plan warns of, not the search for masses. */
START_TEST(exact_masses_are_not_doubted) {
    const double larger[3] = {20, 20, 20}, bead[3] = {5, 5, 5};
    double grams[3];
    subject s = open_box(10, 10, 10, WATER);
    add_box(&s, larger, 0, 0, 0, "Al", 0, 0);
    add_box(&s, bead, 0, 0, 90, "Ti", 0, NONE);
    doubts = 0;
    ck_skg(skg_context_log_set(run_context, count_doubts, NULL));
    weigh(&s, grams);
    ck_skg(skg_context_log_set(run_context, NULL, NULL));
    ck_assert_int_eq(doubts, 0);
    ck_assert_double_lt(grams[0], 0);
}
END_TEST

/* A needle with a priority, turned or not. */
START_TEST(needles_displace_what_they_weigh) {
    const double radius[] = {0.1, 0.5, 2};
    const double r = radius[_i % 3], turn = _i / 3 * 0.4, mm2 = 8 * r * r * sin(acos(-1) / 8);
    double grams[3];
    subject s = open_box(100, 80, 40, WATER);
    skg_mesh *mesh = NULL;
    skg_part part;
    skg_part_init(&part);
    ck_skg(skg_mesh_create_cylinder(r, 70, 16, &mesh));
    ck_skg(skg_material_create_named("Ti", &part.material));
    part.mesh = mesh, part.priority = 1;
    part.pose[0] = part.pose[10] = cos(turn), part.pose[2] = sin(turn), part.pose[8] = -sin(turn);
    ck_skg(skg_scene_part_add(s.scene, &part, NULL));
    skg_material_release(&part.material);
    skg_mesh_release(&mesh);
    const double bead[3] = {5, 5, 5};
    add_box(&s, bead, 0, 0, 90, "Al", 0, NONE);
    weigh(&s, grams);
    /* Rounding. */
    ck_assert_double_eq_tol(grams[1] / (4.54e-3 * mm2 * 70), 1, 1e-9);
    /* Lines through a box of its own, 1/384 of it apart. */
    ck_assert_double_eq_tol((320 - grams[0]) / (1e-3 * mm2 * 40 / cos(turn)), 1, 2e-3);
}
END_TEST

void add_masses(TCase *tests) {
    tcase_add_loop_test(tests, thin_parts_keep_their_mass, 0, 9);
    tcase_add_test(tests, clip_and_displacement_leave_the_rest);
    tcase_add_test(tests, exact_masses_are_not_doubted);
    tcase_add_loop_test(tests, needles_displace_what_they_weigh, 0, 6);
}
