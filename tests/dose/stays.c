/* Dose in parts and backscatter from them, against closed forms, published figures and photons that are followed one by one. */
#include "analogue_box.h"

#include "beam/spectrum.h"
#include "dose/exposed.h"
#include "dose/figures.h"
#include "scatter/matter.h"

/* --- what stays in parts */

/* The mean energy that Compton scattering leaves an electron. */
static double electron_of(const matter *m, double kev) {
    enum { STEPS = 20000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double cosine = -1 + 2 * (i + 0.5) / STEPS;
        sum += 2.0 / STEPS * matter_compton(m, kev, cosine) * kev * (1 - matter_ratio(kev, cosine));
    }
    return sum;
}

/* A foil of a parallel beam: mu_tr t of its energy, but for what meets it twice. */
START_TEST(a_foil_keeps_what_its_energy_transfer_says) {
    subject s = open_box(300, 300, 0.01, "Al");
    static matter m;
    skg_dose_options options = options_of(20000);
    matter_make("Al", 0, s.kev, &m);
    s.view.projection = SKG_PROJECTION_PARALLEL;
    skg_dose *dose = dose_of(&s, &options);
    const skg_dose_part part = part_of(dose, 0);
    const double total = matter_at_energy(m.total, &m, 60),
                 compton = total * matter_at_energy(m.compton, &m, 60),
                 rayleigh = total * matter_at_energy(m.rayleigh, &m, 60);
    const double per_mm = (total - compton - rayleigh) * 60 + compton * electron_of(&m, 60);
    const double expected = 1e5 * 40 * 30 * per_mm * 0.01;
    /* Photons that scatter along the foil leave more: a share of mu t ln(1 / mu t), 5e-3. And the noise. */
    ck_assert_double_eq_tol(part.energy_kev / expected, 1.002, 6e-3);
    ck_assert_double_eq_tol(part.mass_g, 2.6989 * 0.9, 1e-9);
    ck_assert_double_eq_tol(part.dose_ugy, part.energy_kev * JOULE_PER_KEV / (part.mass_g * 1e-3) * 1e6,
                            1e-9 * part.dose_ugy); /* rounding */
    ck_assert_double_lt(part.sigma_ugy, 0.01 * part.dose_ugy);
    skg_dose_release(&dose);
    subject_close(&s);
}
END_TEST

/* A block in two layers, beside photons that are followed one by one: what stays, and in which. Fluorescence is below what is followed. */
START_TEST(layers_keep_what_single_photons_leave) {
    static const struct {
        const char *material;
        double kev;
    } blocks[] = {{"Water, Liquid", 60},   {"Water, Liquid", 22},   {"Al", 300},
                  {"Water, Liquid", 1250}, {"Water, Liquid", 6000}, {"Pb", 6000}};
    const analogue_box box = {.material = blocks[_i].material,
                              .kev = blocks[_i].kev,
                              .low = {-60, -50, 0},
                              .high = {60, 50, 80},
                              .source = -500,
                              .plane = 200,
                              .side = 80,
                              .inner = {0, 20}};
    const analogue_absorbed truth = analogue_box_run(&box, 120000, 7);
    const skg_dose_options options = options_of(64000);
    skg_mesh *mesh = NULL;
    subject s;
    subject_open(&s);
    s.view.rows = 40, s.view.column_step[0] = s.view.row_step[1] = 2;
    s.kev = box.kev;
    for (int k = 0; k < 2; k++) {
        ck_skg(skg_mesh_create_cuboid(120, 100, k ? 60 : 20, &mesh));
        subject_add(&s, mesh, box.material, 0, 0, k ? 50 : 10, -1);
    }
    skg_dose *dose = dose_of(&s, &options);
    const skg_dose_report report = report_of(dose);
    const skg_dose_part front = part_of(dose, 0), back = part_of(dose, 1);
    const double all = (front.energy_kev + back.energy_kev) / report.incident_kev,
                 inner = front.energy_kev / report.incident_kev;
    const double own = front.sigma_ugy / front.dose_ugy + back.sigma_ugy / back.dose_ugy;
    printf("stays %.4f, not %.4f +- %.4f; in front %.4f, not %.4f +- %.4f; own error %.2g\n", all,
           truth.absorbed, truth.absorbed_sigma, inner, truth.inner, truth.inner_sigma, own);
    fflush(stdout); /* before an assertion ends the process */
    /* Four standard errors, and 1e-3 for the tables of both. */
    ck_assert_double_eq_tol(all, truth.absorbed, 4 * (truth.absorbed_sigma + own * all) + 1e-3 * all);
    ck_assert_double_eq_tol(inner, truth.inner, 4 * (truth.inner_sigma + own * inner) + 1e-3 * inner);
    /* Energy is kept: the balance is its own error off at most, four times. */
    const double left = report.incident_kev - report.escaped_kev - front.energy_kev - back.energy_kev;
    ck_assert_double_le(fabs(left), 4 * report.balance_sigma_kev);
    ck_assert_double_lt(report.balance_sigma_kev, 5e-3 * report.incident_kev); /* the noise of 64,000 */
    skg_dose_release(&dose);
    subject_close(&s);
}
END_TEST

/* Lines of iodine leave a foil that absorbs behind its edge; what they take is not counted, and is kept elsewhere. */
START_TEST(fluorescence_carries_energy_away) {
    double energy[2];
    for (int k = 0; k < 2; k++) {
        subject s = open_box(100, 100, 0.05, "I");
        const skg_dose_options options = options_of(20000);
        skg_scatter scatter;
        skg_scatter_init(&scatter);
        scatter.fluorescence = k ? SKG_FLUORESCENCE_OFF : SKG_FLUORESCENCE_AUTO;
        s.kev = 40;
        make_plan(&s);
        skg_dose *dose = NULL;
        if (k) s.options.scatter = &scatter, make_plan(&s);
        ck_skg(skg_dose_create(s.plan, &options, &dose));
        const skg_dose_report report = report_of(dose);
        energy[k] = part_of(dose, 0).energy_kev;
        /* Four standard errors. */
        ck_assert_double_le(fabs(report.incident_kev - report.escaped_kev - energy[k]),
                            4 * report.balance_sigma_kev);
        skg_dose_release(&dose);
        subject_close(&s);
    }
    /* Of 40 keV some 29 fly off in .75 of the absorptions, half of them out of the foil, which is .6 of a mean free path at 29 keV. */
    ck_assert_double_lt(energy[0], 0.75 * energy[1]);
    ck_assert_double_gt(energy[0], 0.4 * energy[1]);
}
END_TEST

/* Parts displace what they lie inside; of those that compete the higher priority counts; and all together keep what one block does. */
START_TEST(parts_share_what_a_block_keeps) {
    const skg_dose_options options = options_of(20000);
    double energy[3], mass[3];
    for (int k = 0; k < 3; k++) {
        subject s = open_box(100, 80, 40, "Water, Liquid");
        skg_mesh *mesh = NULL;
        skg_part part;
        if (k == 1) {
            ck_skg(skg_mesh_create_cuboid(30, 20, 10, &mesh));
            subject_add(&s, mesh, "Water, Liquid", 5, 0, 5, 0);
        }
        if (k == 2) { /* it lies across the rim, and outside there is more of it */
            ck_skg(skg_mesh_create_cuboid(60, 20, 10, &mesh));
            skg_part_init(&part);
            part.mesh = mesh, part.priority = 1, part.pose[3] = 30;
            ck_skg(skg_material_create_named("Water, Liquid", &part.material));
            ck_skg(skg_scene_part_add(s.scene, &part, NULL));
            skg_material_release(&part.material);
            skg_mesh_release(&mesh);
        }
        skg_dose *dose = dose_of(&s, &options);
        energy[k] = part_of(dose, 0).energy_kev, mass[k] = part_of(dose, 0).mass_g;
        if (k) {
            const skg_dose_part inner = part_of(dose, 1);
            energy[k] += inner.energy_kev, mass[k] += inner.mass_g;
            ck_assert_double_gt(inner.energy_kev, 0);
        }
        skg_dose_release(&dose);
        subject_close(&s);
    }
    /* Rounding. */
    ck_assert_double_eq_tol(mass[0], 320, 1e-9);
    ck_assert_double_eq_tol(mass[1], 320, 1e-9);
    /* Rounding: lines end at faces of boxes. */
    ck_assert_double_eq_tol(mass[2], 320 + 0.2 * 10, 1e-9);
    /* Equal photons, but for roundings that send some elsewhere. */
    ck_assert_double_eq_tol(energy[1] / energy[0], 1, 2e-3);
    ck_assert_double_gt(energy[2], energy[0]);
    ck_assert_double_lt(energy[2], 1.05 * energy[0]); /* the piece outside is 1/160 of the block */
}
END_TEST

/* 300 x 300 x 150 mm of water 1 m from the source, fields of 10 cm in diameter, by P. Andreo and others (in G. Poludniowski, A. Omar and P. Andreo,
 * Calculating X-ray Tube Spectra, CRC Press 2022, chapter 9: photons of one energy, for water kerma). */
START_TEST(backscatter_is_that_of_a_water_phantom) {
    static const struct {
        double kev, factor;
    } published[] = {{29.344129, 1.259964}, {64, 1.437416}, {98.701493, 1.313453}};
    subject s;
    skg_mesh *mesh = NULL;
    const skg_dose_options options = options_of(60000);
    subject_open(&s);
    ck_skg(skg_mesh_create_cuboid(300, 300, 150, &mesh));
    subject_add(&s, mesh, "Water, Liquid", 0, 0, 75, -1);
    s.view.source[2] = -1000;
    s.jaws.kind = SKG_COLLIMATION_RECTANGLE, s.jaws.distance_mm = 1000;
    /* A square of the area of the circle; of its mean scatter it has .2 % less. */
    for (int k = 0; k < 2; k++) s.jaws.low[k] = -44.31, s.jaws.high[k] = 44.31;
    s.kev = published[_i].kev;
    skg_dose *dose = dose_of(&s, &options);
    const skg_dose_point entrance = point_of(dose, 0);
    printf("%g keV: %.4f +- %.4f, published %.4f\n", s.kev, entrance.backscatter, entrance.backscatter_sigma,
           published[_i].factor);
    fflush(stdout); /* before an assertion ends the process */
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(entrance.at[k], 0, 1e-9);
    /* Air takes more of the softer photons that come back than water does, up to 1 % of the factor; other tables, .5 %; and its noise. */
    ck_assert_double_eq_tol(entrance.backscatter / published[_i].factor, 1,
                            0.015 + 3 * entrance.backscatter_sigma);
    ck_assert_double_lt(entrance.backscatter_sigma, 0.02); /* the noise of 60,000 photons */
    skg_dose_release(&dose);
    subject_close(&s);
}
END_TEST

/* Tungsten before a beam of 40 keV: its L lines come back from some micrometres. A plane source shines (S / 2) E1(mu z) on a place at the
 * distance z, so that one that falls like exp(-mu0 z) gives S / (2 mu0) ln(1 + mu0 / mu). */
START_TEST(lines_come_back_from_a_metal) {
    skg_dose_matter m;
    skg_material *metal = NULL;
    subject s = open_box(100, 100, 1, "W");
    const skg_dose_options options = options_of(50000);
    double lines = 0;
    s.kev = 40;
    ck_skg(skg_material_create_named("W", &metal));
    ck_skg(skg_dose_matter_make(metal, SKG_FLUORESCENCE_AUTO, s.kev, &m));
    const double mu = skg_dose_meet(&m, s.kev).total;
    for (int64_t k = 0; k < m.emitters.count; k++) {
        double before = 0;
        for (int l = 0; l < SKG_SCATTER_LINES; l++) {
            const double share = (double)m.emitters.of[k].lines[l][0] - before,
                         kev = (double)m.emitters.of[k].lines[l][1];
            before += share;
            lines += skg_dose_emitted(&m, skg_dose_place_of(&m, s.kev), k) * share / (2 * mu) *
                     log1p(mu / skg_dose_total(&m, skg_dose_place_of(&m, kev))) * skg_air_kerma(kev) /
                     skg_air_kerma(s.kev);
        }
    }
    skg_dose *dose = dose_of(&s, &options);
    const skg_dose_point entrance = point_of(dose, 0);
    printf("tungsten: %.4f +- %.4f, by its lines %.4f\n", entrance.backscatter, entrance.backscatter_sigma,
           1 + lines);
    fflush(stdout); /* before an assertion ends the process */
    ck_assert_double_gt(lines, 0.05);
    /* Compton scattering, 1 % of what is met, adds to it, and lines that make softer ones. */
    ck_assert_double_eq_tol(entrance.backscatter, 1.005 + lines, 0.01 + 4 * entrance.backscatter_sigma);
    skg_dose_matter_free(&m);
    skg_material_release(&metal);
    skg_dose_release(&dose);
    subject_close(&s);
}
END_TEST

/* --- lines */

/* Lines through corners, along edges and within faces of a cube and through the poles of a ball: signs cancel, and of a cube a line has a
 * side or nothing. */
START_TEST(lines_through_edges_and_corners_are_closed) {
    static const double ways[][3] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {1, 1, 0}, {1, -1, 1}, {0, 1, -2}};
    for (int shape = 0; shape < 2; shape++) {
        subject s;
        skg_mesh *mesh = NULL;
        skg_forest tree;
        skg_way way = {0};
        subject_open(&s);
        if (shape)
            ck_skg(skg_mesh_create_sphere(2, 16, &mesh));
        else
            ck_skg(skg_mesh_create_cuboid(2, 2, 2, &mesh));
        subject_add(&s, mesh, "Water, Liquid", 0, 0, 0, -1);
        ck_skg(skg_forest_make(s.scene, &tree));
        for (int i = 0; i < 6 * 9 * 9; i++) {
            const double *direction = ways[i / 81], u = (i % 81 % 9 - 4) / 4.0,
                         v = (double)(i % 81 / 9 - 4) / 4;
            double from[3] = {u, v, 0};
            if (direction[2] > -1 && direction[2] < 1) from[1] = 0, from[2] = v;
            for (int k = 0; k < 3; k++) from[k] -= 8 * direction[k];
            ck_skg(skg_way_cross(&tree, from, direction, &way));
            int32_t signs = 0;
            double length = 0;
            for (int64_t c = 0; c < way.crossing_count; c++)
                signs += way.crossings[c].sign, length -= way.crossings[c].sign * way.crossings[c].at;
            ck_assert_int_eq(signs, 0);
            ck_assert_double_ge(length, 0);
            if (shape == 0 && i < 3 * 81) ck_assert(length == 0 || fabs(length - 2) < 1e-12); /* rounding */
        }
        skg_way_free(&way);
        skg_forest_free(&tree);
        subject_close(&s);
    }
}
END_TEST

void add_stays(TCase *tests) {
    tcase_add_test(tests, a_foil_keeps_what_its_energy_transfer_says);
    tcase_add_loop_test(tests, layers_keep_what_single_photons_leave, 0, 6);
    tcase_add_test(tests, fluorescence_carries_energy_away);
    tcase_add_test(tests, parts_share_what_a_block_keeps);
    tcase_add_loop_test(tests, backscatter_is_that_of_a_water_phantom, 0, 3);
    tcase_add_test(tests, lines_come_back_from_a_metal);
    tcase_add_test(tests, lines_through_edges_and_corners_are_closed);
}
