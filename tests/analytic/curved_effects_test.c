/* Images of curved detectors: falloff, world, priorities, holes and filters against flat detectors of few columns, several rays a
 * pixel against a finer detector; and what is refused. */
#include "curved_views.h"
#include "suite.h"

#include <string.h>

/* The image of a scene with another part inside, a world, a part that wins by priority, and falloff. */
static skg_plan *rich_plan(const skg_view *view, int falloff) {
    const int has_start =
        view->projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY; /* of the way through the world */
    static const double energies[2] = {50, 80}, photons[2] = {2, 3};
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_scene *scene = NULL;
    skg_mesh *ball = NULL, *core = NULL, *rod = NULL;
    skg_plan *plan = NULL;
    skg_part part;
    ck_skg(skg_scene_create(run_context, &scene));
    ck_skg(skg_mesh_create_sphere(60, 90, &ball));
    ck_skg(skg_mesh_create_sphere(25, 50, &core));
    ck_skg(skg_mesh_create_cuboid(200, 20, 20, &rod));
    const int64_t outside = run_part(scene, "ball", ball, 0.2, NULL, -1);
    run_part(scene, "core", core, 0.5, NULL, outside);
    skg_part_init(&part);
    part.label = "rod", part.mesh = rod, part.priority = 2;
    ck_skg(skg_material_create_mu("rod", 0.9, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_material_release(&part.material);
    skg_plan_options_init(&options);
    options.falloff = falloff ? SKG_FALLOFF_ON : SKG_FALLOFF_OFF;
    if (has_start) ck_skg(skg_material_create_mu("around", 0.002, &options.world));
    ck_skg(skg_spectrum_create_bins(2, energies, photons, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, view, spectrum, &options, &plan));
    skg_material_release(&options.world);
    skg_spectrum_release(&spectrum);
    skg_mesh_release(&ball);
    skg_mesh_release(&core);
    skg_mesh_release(&rod);
    skg_scene_release(&scene);
    return plan;
}

/* Every 9th column against a flat detector there. Its falloff is that of its own foot: the flat field of both says what that is. */
START_TEST(effects_of_the_beam) {
    for (int g = 0; g < GEOMETRIES; g++) {
        const skg_view view = view_of(&geometries[g], g % 2);
        const int is_point = view.projection == SKG_PROJECTION_POINT;
        skg_plan *plan = rich_plan(&view, is_point);
        double *got = run_image(plan, &view);
        for (int64_t k = 4; k < COLUMNS; k += 9) {
            const skg_view one = column_of(&view, k);
            double normal[3], middle[3], foot = 0, own_foot = 0, length = 0, own_length = 0;
            skg_plan *flat = rich_plan(&one, is_point);
            double *want = run_image(flat, &one);
            for (int n = 0; n < 3; n++) {
                const int a = (n + 1) % 3, b = (n + 2) % 3;
                middle[n] = view.column_step[a] * view.row_step[b] - view.column_step[b] * view.row_step[a];
                normal[n] = one.column_step[a] * one.row_step[b] - one.column_step[b] * one.row_step[a];
                foot += middle[n] * (view.centre[n] - view.source[n]), length += middle[n] * middle[n];
                own_foot += normal[n] * (one.centre[n] - one.source[n]), own_length += normal[n] * normal[n];
            }
            const double by = is_point ? pow(foot / own_foot, 2) * own_length / length : 1;
            for (int64_t r = 0; r < ROWS; r++)
                /* Single precision: 3e-6 of 120 mm of 0.09 / mm, and a few roundings. */
                ck_assert_msg(fabs(got[r * COLUMNS + k] - by * want[r]) <= 5e-5 * by * want[r],
                              "%s: %.9g instead of %.9g at column %d, row %d", geometries[g].name,
                              got[r * COLUMNS + k], by * want[r], (int)k, (int)r);
            free(want);
            skg_plan_release(&flat);
        }
        free(got);
        skg_plan_release(&plan);
    }
}
END_TEST

/* Several rays a pixel are those of a detector whose pixels are as many times finer, and a mesh with a hole is left out where it is on a flat
 * detector. */
START_TEST(finer_rays_and_holes) {
    enum { SIDE = 3 };
    const skg_view view = view_of(&geometries[3], 1);
    skg_view fine = view;
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL, *finer = NULL;
    solid blob = solid_blob(70, 60, 40, 3);
    skg_scene *scene = run_scene(&blob, NULL);
    fine.columns *= SIDE, fine.rows *= SIDE;
    for (int k = 0; k < 3; k++) fine.column_step[k] /= SIDE, fine.row_step[k] /= SIDE;
    skg_plan_options_init(&options);
    options.supersampling = SIDE;
    ck_skg(skg_spectrum_create_mono(70, 1, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    options.supersampling = 1;
    ck_skg(skg_plan_create(run_context, scene, &fine, spectrum, &options, &finer));
    double *got = run_image(plan, &view), *parts = run_image(finer, &fine);
    for (int p = 0; p < PIXELS; p++) {
        double sum = 0;
        for (int k = 0; k < SIDE * SIDE; k++)
            sum += parts[(p / COLUMNS * SIDE + k / SIDE) * fine.columns + p % COLUMNS * SIDE + k % SIDE];
        /* Single precision: paths of 140 mm by 0.1 / mm are right to 4e-5, pixels to a few roundings. */
        ck_assert_double_eq_tol(got[p], sum / (SIDE * SIDE), 5e-5 * sum / (SIDE * SIDE));
    }
    free(got);
    free(parts);
    skg_plan_release(&plan);
    skg_plan_release(&finer);
    skg_scene_release(&scene);
    blob.triangles -= 3; /* a hole */
    scene = run_scene(&blob, NULL);
    options.repair = SKG_REPAIR_NONE;
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    got = run_image(plan, &view);
    for (int64_t k = 1; k < COLUMNS; k += 6) {
        const skg_view one = column_of(&view, k);
        ck_skg(skg_plan_create(run_context, scene, &one, spectrum, &options, &finer));
        double *want = run_image(finer, &one);
        for (int64_t r = 0; r < ROWS; r++) /* the same as above */
            ck_assert_double_eq_tol(got[r * COLUMNS + k], want[r], 5e-5 * want[r]);
        free(want);
        skg_plan_release(&finer);
    }
    options.repair = SKG_REPAIR_EXACT;
    ck_skg_fails(skg_plan_create(run_context, scene, &view, spectrum, &options, &finer), SKG_ERR_UNSUPPORTED,
                 "traced again");
    free(got);
    skg_plan_release(&plan);
    skg_spectrum_release(&spectrum);
    skg_scene_release(&scene);
    solid_free(&blob);
}
END_TEST

/* Heel effect and bow-tie filter differ from ray to ray, and are counted from the central ray: a flat detector about the same middle, whose
 * last column has the rays of column k. angle: of the column on a cylinder about the source; far: from the source. */
static skg_view flat_of(const skg_view *view, double angle, double far) {
    skg_view flat = *view;
    flat.radius = 0, flat.columns = 3;
    for (int n = 0; n < 3; n++) {
        flat.column_step[n] = view->column_step[n] / 4.1 * far * tan(angle); /* 4.1 mm: a column */
        flat.row_step[n] = view->row_step[n] / cos(angle);
    }
    return flat;
}

static skg_plan *filtered_plan(const skg_view *view, int has_heel) {
    static const double angles[5] = {-30, -8, 0, 8, 30}, paths[5] = {30, 9, 4, 9, 30};
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_heel heel;
    skg_bowtie bowtie;
    solid box = solid_box(90, 70, 60);
    skg_scene *scene = run_scene(&box, NULL);
    skg_plan_options_init(&options);
    skg_heel_init(&heel);
    heel.kvp = 90, heel.angle_deg = 25, heel.direction[0] = 1, heel.direction[1] = 0.3;
    skg_bowtie_init(&bowtie);
    ck_skg(skg_material_create_named("Al", &bowtie.material));
    bowtie.count = 5, bowtie.angle_deg = angles, bowtie.path_mm = paths;
    options.bowtie = &bowtie, options.heel = has_heel ? &heel : NULL;
    ck_skg(skg_spectrum_create_mono(70, 1, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, view, spectrum, &options, &plan));
    skg_spectrum_release(&spectrum);
    skg_material_release(&bowtie.material);
    skg_scene_release(&scene);
    solid_free(&box);
    return plan;
}

START_TEST(filters_in_the_beam) {
    const double far = 1200;
    skg_view view = view_of(&geometries[0], _i % 2);
    for (int k = 0; k < 3; k++) /* the axis goes through the source: it is straight above the middle */
        view.source[k] = view.centre[k];
    const double *c = view.column_step, *r = view.row_step;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        view.source[k] -= (_i % 2 ? -1 : 1) * far * (c[a] * r[b] - c[b] * r[a]) / (4.1 * 3.3);
    }
    skg_plan *plan = filtered_plan(&view, _i / 2);
    double *got = run_image(plan, &view);
    for (int64_t k = 1; k < COLUMNS; k += 8) {
        const double angle = ((double)k - (COLUMNS - 1) / 2.0) * 4.1 / far;
        const skg_view flat = flat_of(&view, angle, far);
        skg_plan *other = filtered_plan(&flat, _i / 2);
        double *want = run_image(other, &flat);
        for (int64_t row = 0; row < ROWS; row++)
            /* Polynomials of the heel effect are fitted to the angles of each detector, to 1e-4 of the intensity. */
            ck_assert_msg(fabs(got[row * COLUMNS + k] - want[row * 3 + 2]) <= 3e-4 * want[row * 3 + 2],
                          "column %d, row %d: %.9g instead of %.9g", (int)k, (int)row, got[row * COLUMNS + k],
                          want[row * 3 + 2]);
        free(want);
        skg_plan_release(&other);
    }
    free(got);
    skg_plan_release(&plan);
}
END_TEST

/* The corners of the field are those of the detector, on the cylinder: here 1200 mm about the source, 61 rows of 2 mm high. */
START_TEST(corners_of_the_field) {
    skg_view view = run_view(61, 2);
    double corners[12];
    view.radius = 1200;
    ck_skg(skg_collimation_corners_get(NULL, &view, 0, corners));
    for (int c = 0; c < 4; c++) {
        const double *at = corners + 3 * c, angle = 61 / 1200.0;
        ck_assert_double_eq_tol(at[0], (c == 1 || c == 2 ? 1200 : -1200) * sin(angle),
                                1e-9);                                  /* roundings of 2^-53 */
        ck_assert_double_eq_tol(at[1], c >= 2 ? 61 : -61, 1e-9);        /* the same */
        ck_assert_double_eq_tol(at[2], 1200 * cos(angle) - 1000, 1e-9); /* the same */
    }
    skg_collimation jaws;
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_DETECTOR, jaws.margin_mm = -5;
    ck_skg_fails(skg_collimation_corners_get(&jaws, &view, 0, corners), SKG_ERR_UNSUPPORTED,
                 "curved detector");
}
END_TEST

START_TEST(refusals) {
    skg_view view = view_of(&geometries[0], 0), other = view;
    view.radius = -5;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "radius");
    view.radius = (double)NAN;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "radius");
    view.radius = 100;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "degrees");
    view.radius = 1200, view.row_step[0] += 0.5;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "across its columns");
    view = other, view.radius = 130;
    view.source[0] = 900, view.source[2] = 150;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "turns away from the source");
    skg_plan *plan = rich_plan(&other, 0);
    view = other, view.radius = 0;
    ck_skg_fails(skg_plan_view_set(plan, &view), SKG_STALE, "curved");
    skg_plan_release(&plan);
    /* A part at the source. */
    solid box = solid_box(3000, 50, 4000);
    skg_scene *scene = run_scene(&box, NULL);
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_plan_options_init(&options);
    ck_skg(skg_spectrum_create_mono(100, 1, &spectrum));
    ck_skg_fails(skg_plan_create(run_context, scene, &other, spectrum, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "plane of the source");
    options.precision = SKG_PRECISION_HALF;
    ck_skg_fails(skg_plan_create(run_context, scene, &other, spectrum, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "curved detector");
    options.precision = SKG_PRECISION_SINGLE;
    skg_scatter scatter;
    skg_scatter_init(&scatter);
    options.scatter = &scatter;
    ck_skg_fails(skg_plan_create(run_context, scene, &other, spectrum, &options, &plan), SKG_ERR_UNSUPPORTED,
                 "curved detector");
    skg_spectrum_release(&spectrum);
    skg_scene_release(&scene);
    solid_free(&box);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, effects_of_the_beam);
    tcase_add_test(tests, finer_rays_and_holes);
    tcase_add_loop_test(tests, filters_in_the_beam, 0, 4);
    tcase_add_test(tests, corners_of_the_field);
    tcase_add_test(tests, refusals);
}

SKG_SUITE_MAIN("curved_effects", add_tests)
