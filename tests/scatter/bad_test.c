/* Errors and warnings of scatter, and their sentences. */
#include "subject.h"
#include "suite.h"

#include <math.h>
#include <string.h>

static subject filled(void) {
    subject s;
    subject_open(&s);
    subject_fill(&s);
    return s;
}

static void refuse(subject *s, skg_status status, const char *says) {
    ck_skg_fails(subject_try(s), status, says);
    ck_assert_ptr_null(s->plan);
    subject_close(s);
}

START_TEST(numbers) {
    static const struct {
        skg_scatter scatter;
        const char *says;
    } bad[] = {
        {{.tolerance = -0.1}, "a tolerance of -0.1; a share of its mean from 0 to below 1"},
        {{.tolerance = 1}, "a tolerance of 1;"},
        {{.tolerance = (double)NAN}, "a tolerance of nan;"},
        {{.histories = -1}, "-1 histories; 0 to 1073741824"},
        {{.histories = ((int64_t)1 << 30) + 1}, "1073741825 histories"},
        {{.tolerance = 0}, "neither a tolerance nor histories are given; give one of them"},
        {{.tolerance = 0.1, .voxel_mm = -1}, "cells of -1 mm; above 0, or 0 for 64 along each side"},
        {{.tolerance = 0.1, .voxel_mm = (double)INFINITY}, "cells of inf mm"},
        {{.tolerance = 0.1, .columns = 257}, "257 x 0 places of the detector; 0 to 256"},
        {{.tolerance = 0.1, .rows = -1}, "0 x -1 places of the detector"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        subject s = filled();
        s.scatter = bad[k].scatter;
        s.scatter.size = sizeof s.scatter;
        refuse(&s, SKG_ERR_ARGUMENT, bad[k].says);
    }
}
END_TEST

START_TEST(materials) {
    subject s = filled();
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cube(1, &mesh));
    subject_add(&s, mesh, "mu:0.2", 100, 0, 0, -1);
    refuse(&s, SKG_ERR_MATERIAL, "part 2: mu:0.2");
}
END_TEST

START_TEST(leaky_meshes) {
    subject s = filled();
    solid hole = solid_box(10, 10, 10);
    hole.triangles--;
    subject_add(&s, run_mesh(&hole), "Water, Liquid", 100, 0, 0, -1);
    solid_free(&hole);
    refuse(&s, SKG_ERR_UNSUPPORTED, "part 2: its mesh is not closed");
}
END_TEST

START_TEST(energies) {
    subject s = filled();
    for (int k = 0; k < 2; k++) { /* the ends of the tables */
        s.kev = k ? 20000 : 1;
        subject_plan(&s);
        pictures p = subject_pictures(&s, NULL);
        ck_assert_double_ge(subject_sum(&s, p.scatter), 0);
        ck_assert(isfinite(subject_sum(&s, p.scatter)));
        pictures_free(&p);
    }
    subject_close(&s);
}
END_TEST

/* A response that begins far above the energies that photons are followed to, and ends at the beam's. */
START_TEST(responses_need_not_reach_down) {
    static const double kev[] = {20, 60};
    subject s = filled();
    skg_response_table table;
    skg_response_table_init(&table);
    table.count = 2, table.energies_kev = table.recorded_kev = kev;
    subject_plan(&s);
    pictures ideal = subject_pictures(&s, NULL);
    const double all = subject_sum(&s, ideal.scatter);
    pictures_free(&ideal);
    subject_close(&s);
    s = filled();
    ck_skg(skg_response_create_table(&table, &s.options.response));
    skg_response *response = s.options.response;
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    ck_assert_double_gt(subject_sum(&s, p.scatter), 0);
    /* Both follow the same histories, but to 15 and to 20 keV, and their tables of angles have other energies: 1 % of noise. */
    ck_assert_double_eq_tol(subject_sum(&s, p.scatter), all, 0.03 * all);
    pictures_free(&p);
    skg_response_release(&response);
    subject_close(&s);
}
END_TEST

/* Only a frame has the detector. */
START_TEST(oblique_detectors) {
    subject s = filled();
    skg_output output;
    s.view.row_step[0] = 1;
    subject_plan(&s);
    skg_output_init(&output);
    output.data = calloc((size_t)(s.view.rows * s.view.columns), sizeof(float));
    skg_job *job = NULL;
    skg_status status = skg_plan_submit(s.plan, 1, NULL, 1, &output, &job);
    if (status == SKG_OK) status = skg_job_wait(&job);
    ck_skg_fails(status, SKG_ERR_UNSUPPORTED,
                 "rows and columns are at 78.69 degrees; make them perpendicular");
    free(output.data);
    subject_close(&s);
}
END_TEST

START_TEST(options) {
    subject s = filled();
    s.options.precision = SKG_PRECISION_HALF;
    refuse(&s, SKG_ERR_UNSUPPORTED, "precision half");
}
END_TEST

START_TEST(outputs_need_scatter) {
    subject s = filled();
    skg_spectrum *beam = NULL;
    skg_output output;
    skg_job *job = NULL;
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    ck_skg(skg_spectrum_create_mono(60, 1, &beam));
    subject_plan(&s);
    ck_skg_fails(skg_plan_scatter_report_get(s.plan, &report), SKG_ERR_ARGUMENT, "scatter");
    skg_plan_release(&s.plan);
    s.options.scatter = NULL;
    ck_skg(skg_plan_create(run_context, s.scene, &s.view, beam, &s.options, &s.plan));
    skg_output_init(&output);
    output.data = &report;
    for (int32_t kind = SKG_OUTPUT_SCATTER; kind <= SKG_OUTPUT_SCATTER_COMPONENT; kind++) {
        output.kind = kind;
        ck_skg_fails(skg_plan_submit(s.plan, 1, NULL, 1, &output, &job), SKG_ERR_ARGUMENT, "scatter");
    }
    ck_skg_fails(skg_plan_scatter_report_get(s.plan, &report), SKG_ERR_ARGUMENT, "scatter");
    skg_spectrum_release(&beam);
    subject_close(&s);
}
END_TEST

START_TEST(components) {
    subject s = filled();
    float image[40 * 30];
    skg_output output;
    skg_job *job = NULL;
    subject_plan(&s);
    skg_output_init(&output);
    output.data = image;
    output.kind = SKG_OUTPUT_SCATTER_COMPONENT;
    output.component = SKG_SCATTER_COMPONENT_COMPTON_HIGHER + 1;
    ck_skg_fails(skg_plan_submit(s.plan, 1, NULL, 1, &output, &job), SKG_ERR_ARGUMENT, "component 6");
    output.component = -1;
    ck_skg_fails(skg_plan_submit(s.plan, 1, NULL, 1, &output, &job), SKG_ERR_ARGUMENT, "component -1");
    subject_close(&s);
}
END_TEST

/* Water and, behind half of it, a sheet of lead that is far thinner than a cell; the sheet has this priority. tolerance: 0: the subject's
 * histories. beam: NULL: the subject's */
static skg_scatter_report report_of_sheet(int32_t priority, double tolerance, skg_spectrum *beam) {
    subject s;
    skg_mesh *sheet = NULL;
    skg_part part;
    subject_open(&s);
    s.beam = beam;
    s.scatter.tolerance = tolerance;
    if (tolerance > 0) s.scatter.histories = 0;
    subject_add_box(&s, 200, 160, 100, "Water, Liquid");
    ck_skg(skg_mesh_create_cuboid(100, 160, 0.5, &sheet));
    skg_part_init(&part);
    part.mesh = sheet, part.label = "lead", part.pose[3] = -50, part.pose[11] = 80;
    part.pose[0] = part.pose[10] = 0.96, part.pose[2] = 0.28, part.pose[8] = -0.28; /* aslant to the cells */
    part.priority = priority;
    ck_skg(skg_material_create_named("Pb", &part.material));
    ck_skg(skg_scene_part_add(s.scene, &part, NULL));
    skg_material_release(&part.material);
    skg_mesh_release(&sheet);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const skg_scatter_report report = subject_report(&s);
    pictures_free(&p);
    subject_close(&s);
    return report;
}

/* Photons meet the faces of thin parts, so that their primary is that of the image; but where priorities decide, a cell stands for
 * what is in it, and the report says how wrong that is. */
START_TEST(cells_that_are_too_large_are_told) {
    ck_assert_double_le(report_of_sheet(0, 0, NULL).cells_error, 1e-5); /* faces are floats: 1e-5 mm of .5 */
    ck_assert_double_gt(report_of_sheet(1, 0, NULL).cells_error, 0.005);
}
END_TEST

/* Iron stops most of what is stopped, but the scatter comes from the aluminium beside it: cells that held mixtures there, because the
 * primary was right within 1 %, had scatter that was 2 % too large. */
START_TEST(cells_are_judged_by_what_scatters) {
    static const struct {
        const char *material;
        double at[3], size[3]; /* size: of a cylinder radius, height, 0 */
    } bodies[] = {{"Fe", {44, -12, -199}, {104, 279, 1.9}},
                  {"PMMA", {3, -5, -159}, {221, 289, 1}},
                  {"Fe", {15, 35, -95}, {125, 111, 49}},
                  {"Al", {-35, -58, -13}, {19.4, 102, 0}},
                  {"Tissue, Soft (ICRU-44)", {33, 47, 67}, {104, 75, 3}}};
    subject s;
    subject_open(&s);
    s.kev = 144;
    s.view.source[2] = -1000, s.view.centre[2] = 171;
    s.view.columns = s.view.rows = 32;
    s.view.column_step[0] = 156.0 / 32, s.view.row_step[1] = 199.0 / 32;
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        const double *size = bodies[b].size, *at = bodies[b].at;
        skg_mesh *mesh = NULL;
        if (size[2] > 0)
            ck_skg(skg_mesh_create_cuboid(size[0], size[1], size[2], &mesh));
        else
            ck_skg(skg_mesh_create_cylinder(size[0], size[1], 256, &mesh));
        subject_add(&s, mesh, bodies[b].material, at[0], at[1], at[2], -1);
    }
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    ck_assert_double_le(subject_report(&s).cells_error, 0.5 * 0.01); /* half of the default tolerance */
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

/* Rays beside all parts are no part of the shadow, whatever the shares of the beam's energies add to: 67 energies, all but equal, are as
 * one. */
START_TEST(the_error_of_cells_does_not_depend_on_rounding) {
    enum { ENERGIES = 67, TAIL = 8 };
    double kev[ENERGIES], photons[ENERGIES];
    skg_spectrum *beam = NULL;
    for (int i = 0; i < ENERGIES; i++) {
        kev[i] = 60 + 1e-6 * i;
        photons[i] =
            i < ENERGIES - TAIL ? 1e5 * (0.3 + 0.01 * i) : 1e-20; /* of which the sum takes no notice */
    }
    ck_skg(skg_spectrum_create_bins(ENERGIES, kev, photons, &beam));
    const double one = report_of_sheet(1, 0, NULL).cells_error;
    /* Attenuation changes by 3e-6 at most over these energies. */
    ck_assert_double_eq_tol(report_of_sheet(1, 0, beam).cells_error / one, 1, 1e-4);
    skg_spectrum_release(&beam);
}
END_TEST

/* No number of histories makes up for what cells are off by: they end where they add little to it, and the stated error is not what was
 * asked for. */
START_TEST(histories_end_where_cells_decide) {
    const skg_scatter_report report = report_of_sheet(1, 0.01, NULL);
    ck_assert_double_gt(report.sigma / report.mean, 0.01);
    ck_assert_int_le(report.histories, (int64_t)1 << 20);
}
END_TEST

static double scatter_of_hole(const char *material) {
    subject s;
    skg_mesh *hole = NULL;
    subject_open(&s);
    const int64_t block = subject_add_box(&s, 60, 60, 60, "Al");
    ck_skg(skg_mesh_create_cube(30, &hole));
    subject_add(&s, hole, material, 0, 0, 0, block);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    const double sum = subject_sum(&s, p.scatter);
    pictures_free(&p);
    subject_close(&s);
    return sum;
}

/* Air is a 2000th of aluminium. Photons are the same but for what meets it. */
START_TEST(a_void_scatters_as_thin_air_does) {
    const double of_air = scatter_of_hole("Air, Dry (near sea level)");
    ck_assert_double_gt(of_air, 0);
    /* Few of the histories meet the air at all, and one more or less is a 4096th of them. */
    ck_assert_double_eq_tol(scatter_of_hole("Vacuum"), of_air, 0.01 * of_air);
}
END_TEST

START_TEST(voids_alone_scatter_nothing) {
    subject s;
    subject_open(&s);
    subject_add_box(&s, 60, 60, 60, "Vacuum");
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    ck_assert_double_eq(subject_sum(&s, p.scatter), 0);
    pictures_free(&p);
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, cells_that_are_too_large_are_told);
    tcase_add_test(tests, cells_are_judged_by_what_scatters);
    tcase_add_test(tests, the_error_of_cells_does_not_depend_on_rounding);
    tcase_add_test(tests, histories_end_where_cells_decide);
    tcase_add_test(tests, a_void_scatters_as_thin_air_does);
    tcase_add_test(tests, voids_alone_scatter_nothing);
    tcase_add_test(tests, numbers);
    tcase_add_test(tests, materials);
    tcase_add_test(tests, leaky_meshes);
    tcase_add_test(tests, energies);
    tcase_add_test(tests, responses_need_not_reach_down);
    tcase_add_test(tests, oblique_detectors);
    tcase_add_test(tests, options);
    tcase_add_test(tests, outputs_need_scatter);
    tcase_add_test(tests, components);
}

SKG_SUITE_MAIN("scatter/bad", add_tests)
