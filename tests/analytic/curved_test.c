/* Curved detectors: path lengths against a ray caster in long double, which sees each column as a flat detector of one column where
 * the column stands on its cylinder; the same bits by every strategy; closed meshes without a seam; falloff, world and priorities
 * against flat detectors of one column; and what is refused. */
#include "suite.h"
#include "support/angles.h"
#include "support/random.h"
#include "support/verdict.h"

#include <math.h>
#include <string.h>

enum { COLUMNS = 75, ROWS = 61, PIXELS = COLUMNS * ROWS };

/* Column k of a curved detector as a flat one, by the definition of the interface: on a cylinder that touches the plane of the view in its
 * middle, whose axis is parallel to the rows' step and lies towards the source. */
static skg_view column_of(const skg_view *view, int64_t k) {
    skg_view one = *view;
    double normal[3], across[3], way[3], width = 0, facing = 0;
    const double *c = view->column_step, *r = view->row_step;
    for (int n = 0; n < 3; n++) width += c[n] * c[n];
    width = sqrt(width);
    for (int n = 0; n < 3; n++) {
        const int a = (n + 1) % 3, b = (n + 2) % 3;
        normal[n] = c[a] * r[b] - c[b] * r[a];
        across[n] = c[n] / width;
        way[n] = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY
                     ? -view->source[n]
                     : view->source[n] - view->centre[n];
        facing += normal[n] * way[n];
    }
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const double angle = ((double)k - (double)(view->columns - 1) / 2) * width / view->radius;
    one.columns = 1;
    one.radius = 0;
    for (int n = 0; n < 3; n++) {
        normal[n] /= facing < 0 ? -length : length;
        one.centre[n] += view->radius * (sin(angle) * across[n] + (1 - cos(angle)) * normal[n]);
        one.column_step[n] = width * (cos(angle) * across[n] + sin(angle) * normal[n]);
    }
    /* The direction of a parallel beam is that of the view, and so is the plane where its rays start. */
    if (one.projection == SKG_PROJECTION_PARALLEL) {
        double square = 0, along = 0;
        for (int n = 0; n < 3; n++) {
            way[n] = view->centre[n] - view->source[n];
            square += way[n] * way[n], along += way[n] * (one.centre[n] - view->source[n]);
        }
        for (int n = 0; n < 3; n++) one.source[n] = one.centre[n] - along / square * way[n];
    }
    return one;
}

typedef struct {
    const char *name;
    double radius, source[3], centre[3];
    int32_t projection;
} geometry;

/* Detectors at z = 200 about. */
static const geometry geometries[] = {
    {"axis through the source", 1200, {0, 0, -1000}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"axis near the detector", 420, {0, 0, -1000}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"axis behind the source", 5000, {0, 0, -700}, {3, -2, 150}, SKG_PROJECTION_POINT},
    {"source beside the middle", 700, {90, -120, -600}, {-20, 15, 200}, SKG_PROJECTION_POINT},
    {"cone from far above", 900, {-30, 260, -640}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"parallel beam", 380, {40, 90, -600}, {0, 5, 200}, SKG_PROJECTION_PARALLEL},
    {"parallel beam from infinity", 300, {0.2, -0.1, 1}, {0, 5, 200}, SKG_PROJECTION_PARALLEL_FROM_INFINITY},
};
enum { GEOMETRIES = sizeof geometries / sizeof *geometries };

/* Turned about no axis in particular, with columns that grow to one side or the other. */
static skg_view view_of(const geometry *g, int mirrored) {
    skg_view view = run_view(0, 1);
    view.columns = COLUMNS, view.rows = ROWS;
    view.radius = g->radius;
    view.projection = g->projection;
    const double turn = 0.1, tilt = mirrored ? -0.05 : 0.05;
    const double across[3] = {cos(turn), sin(turn) * cos(tilt), sin(turn) * sin(tilt)},
                 down[3] = {-sin(turn), cos(turn) * cos(tilt), cos(turn) * sin(tilt)};
    for (int k = 0; k < 3; k++) {
        view.source[k] = g->source[k], view.centre[k] = g->centre[k];
        view.column_step[k] = (mirrored ? -4.1 : 4.1) * across[k];
        view.row_step[k] = 3.3 * down[k];
    }
    return view;
}

/* 300 pixels against the caster. */
static void judge(const char *what, const solid *s, const double *pose, const skg_view *view,
                  const double *got, int32_t precision) {
    enum { COUNT = 300 };
    const double shift = precision == SKG_PRECISION_SINGLE ? 4 * (double)COLUMNS * 0x1p-23 : 0;
    double values[COUNT], low[COUNT], high[COUNT], least, most, longest = 0;
    uint64_t seed = 7;
    verdict v = {0};
    caster *c = caster_create(s, pose);
    for (int n = 0; n < COUNT; n++) {
        const int64_t column = draw_below(&seed, COLUMNS), row = draw_below(&seed, ROWS);
        const skg_view one = column_of(view, column);
        values[n] = got[row * COLUMNS + column];
        caster_range(c, &one, 0, row, 0, &low[n], &high[n]);
        longest = fmax(longest, high[n]);
        /* Truth in single is an interval where the length changes much under roundings of the ray (support/verdict.h). */
        caster_range(c, &one, 0, row, shift, &least, &most);
        if (shift > 0 && most - least > 1e-6 * fmax(longest, 1)) low[n] = least, high[n] = most;
    }
    verdict_add(&v, COUNT, values, low, high);
    verdict_check(&v, precision, what);
    verdict_free(&v);
    caster_free(c);
}

static const run_choice choices[] = {{.strategy = SKG_STRATEGY_COPIES},
                                     {.strategy = SKG_STRATEGY_TILES},
                                     {.strategy = SKG_STRATEGY_TILES, .tile = 7},
                                     {.strategy = SKG_STRATEGY_ATOMICS}};
enum { CHOICES = sizeof choices / sizeof *choices };

static void check_solid(const char *name, const solid *s, const double *pose) {
    for (int g = 0; g < 2 * GEOMETRIES; g++) {
        const skg_view view = view_of(&geometries[g / 2], g % 2);
        char what[128];
        snprintf(what, sizeof what, "%s, %s", name, geometries[g / 2].name);
        ck_skg(skg_view_check(&view));
        for (int32_t precision = SKG_PRECISION_SINGLE;
             precision <= (run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE); precision++) {
            double *first = NULL;
            for (int k = 0; k < CHOICES; k++) {
                run_choice choice = choices[k];
                choice.precision = precision;
                double *got = run_solid(s, pose, &view, choice);
                if (!first) {
                    judge(what, s, pose, &view, got, precision);
                    first = got;
                    continue;
                }
                ck_assert_msg(memcmp(first, got, PIXELS * sizeof *got) == 0, "%s: strategy %d has other bits",
                              what, k);
                free(got);
            }
            free(first);
        }
    }
}

static void pose_of(double angle, double x, double y, double z, double pose[16]) {
    const double c = cos(angle), s = sin(angle);
    const double turned[16] = {c, -s, 0, x, s * c, c * c, -s, y, s * s, c * s, c, z, 0, 0, 0, 1};
    memcpy(pose, turned, sizeof turned);
}

START_TEST(large_triangles) {
    double pose[16];
    solid box = solid_box(90, 70, 60);
    pose_of(0.7, 5, -8, 20, pose);
    check_solid("box", &box, pose);
    solid_free(&box);
}
END_TEST

START_TEST(small_triangles) {
    double pose[16];
    solid blob = solid_blob(70, 60, 40, 3);
    pose_of(-0.4, 20, 5, 0, pose);
    check_solid("blob", &blob, pose);
    solid_free(&blob);
}
END_TEST

START_TEST(soup) {
    const double box[3] = {90, 70, 60};
    solid tetrahedra = solid_tetrahedra(300, 12, box, 5);
    check_solid("tetrahedra", &tetrahedra, NULL);
    solid_free(&tetrahedra);
}
END_TEST

/* A seam would show as a whole depth: in every pixel, also where nothing is, lengths are between 0 and the diameter. */
START_TEST(no_seams) {
    uint64_t seed = 11;
    solid ball = solid_sphere(40, 150, 90);
    for (int n = 0; n < 24; n++) {
        double pose[16];
        pose_of(6.2 * draw(&seed, 0, 1), 120 * draw(&seed, 0, 1) - 60, 90 * draw(&seed, 0, 1) - 45,
                60 * draw(&seed, 0, 1), pose);
        const skg_view view = view_of(&geometries[n % GEOMETRIES], n % 2);
        double *got = run_solid(&ball, pose, &view, choices[n % CHOICES]);
        int hit = 0;
        for (int p = 0; p < PIXELS; p++) {
            ck_assert_msg(got[p] > -3e-5 * 80 && got[p] < 80 * (1 + 3e-5), "%s: %.9g mm at pixel %d",
                          geometries[n % GEOMETRIES].name, got[p], p);
            hit += got[p] > 1;
        }
        ck_assert_int_gt(hit, 30);
        free(got);
    }
    solid_free(&ball);
}
END_TEST

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

START_TEST(refusals) {
    skg_view view = view_of(&geometries[0], 0), other = view;
    view.radius = -5;
    ck_skg_fails(skg_view_check(&view), SKG_ERR_SCENE, "radius");
    view.radius = NAN;
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
    tcase_add_test(tests, large_triangles);
    tcase_add_test(tests, small_triangles);
    tcase_add_test(tests, soup);
    tcase_add_test(tests, no_seams);
    tcase_add_test(tests, effects_of_the_beam);
    tcase_add_test(tests, finer_rays_and_holes);
    tcase_add_loop_test(tests, filters_in_the_beam, 0, 4);
    tcase_add_test(tests, refusals);
}

SKG_SUITE_MAIN("curved", add_tests)
