/* Gradients of scenes that show nothing or cannot be projected, and jobs that are not done: zeros or a sentence, and no crash. Adjoints of another size or with
 * values that are not finite are in gradient_bits_test.c and gradient_job_test.c. */
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>
#include <string.h>

/* Everything that a gradient can be of, for a part of at most 8 vertices. */
typedef struct {
    double pose[6], source[3], detector[6], density, attenuation, vertices[24];
} everything;

static const double MARK = 7;

/* Takes the gradient of a part by everything and the derivative along everything. Each number has to be 0. by_mu: by its attenuation
 * coefficient, too */
static void check_zeros(const char *name, const skg_view *view, int by_mu, int is_double) {
    static double adjoint[PIXELS], found[PIXELS];
    everything e, way;
    double *const targets[1] = {e.vertices};
    const double *const moves[1] = {way.vertices};
    double *const numbers[2] = {(double *)&e, (double *)&way};
    const int64_t size = (int64_t)(sizeof e / sizeof(double));
    skg_gradient gradient;
    skg_direction direction_of;
    skg_plan *plan = run_plan(
        scene, view,
        (run_choice){.precision = is_double && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                     .quantity = SKG_QUANTITY_ATTENUATION});
    for (int64_t k = 0; k < size; k++) numbers[0][k] = MARK, numbers[1][k] = 0.1;
    fill_adjoint(PIXELS, adjoint);
    const skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    gradient.poses = e.pose, gradient.source = e.source, gradient.detector = e.detector;
    gradient.densities = &e.density, gradient.nodes = by_mu;
    gradient.attenuations = by_mu ? &e.attenuation : NULL;
    gradient.vertices = targets;
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int k = 0; k < 9; k++) ck_assert_double_eq(k < 3 ? e.source[k] : e.detector[k - 3], 0);
    for (int k = 0; k < 6; k++) ck_assert_msg(e.pose[k] == 0, "%s: pose %d is %g", name, k, e.pose[k]);
    for (int k = 0; k < 9; k++) ck_assert_msg(e.vertices[k] == 0, "%s: vertex %g", name, e.vertices[k]);
    ck_assert_msg(e.density == 0, "%s: density %g", name, e.density);
    ck_assert_msg(!by_mu || e.attenuation == 0, "%s: attenuation %g", name, e.attenuation);
    skg_direction_init(&direction_of);
    direction_of.poses = way.pose, direction_of.source = way.source;
    direction_of.detector = way.detector, direction_of.densities = &way.density;
    direction_of.attenuations = by_mu ? &way.attenuation : NULL, direction_of.nodes = by_mu;
    direction_of.vertices = moves;
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &direction_of, DOUBLES(found), NULL));
    for (int p = 0; p < PIXELS; p++) ck_assert_msg(found[p] == 0, "%s: pixel %d is %g", name, p, found[p]);
    skg_plan_release(&plan);
}

/* A part without a mesh, or with a mesh of no triangles, cannot be made. */
START_TEST(a_part_without_a_mesh) {
    const double corner[3] = {0};
    const int32_t none[3] = {0};
    skg_part part;
    skg_mesh_source source;
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.label = "ghost";
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_ARGUMENT,
                 "part ghost has no mesh; give it one");
    skg_mesh_source_init(&source);
    source.vertices = 1, source.positions = corner, source.corners = none;
    ck_skg_fails(skg_mesh_create(run_context, "ghost", &source, &part.mesh), SKG_ERR_MESH,
                 "ghost: no triangles");
    const skg_view view = run_view(SIDE, 4);
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    ck_skg(skg_spectrum_create_mono(100, 1, &beam));
    ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, NULL, &plan), SKG_ERR_SCENE,
                 "the scene has no parts");
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
}
END_TEST

/* A triangle and its back: closed, without a volume. */
static skg_mesh *make_leaf(void) {
    static const double positions[9] = {-8, -7, 0, 9, -6, 1, 2, 11, 3};
    static const int32_t corners[6] = {0, 1, 2, 0, 2, 1};
    skg_mesh_source source;
    skg_mesh *mesh = NULL;
    skg_mesh_source_init(&source);
    source.vertices = 3, source.triangles = 2, source.positions = positions, source.corners = corners;
    ck_skg(skg_mesh_create(run_context, "leaf", &source, &mesh));
    return mesh;
}

/* A part beside the rays; one without volume, seen askew or edge-on; one of vacuum, which shows
 * its attenuation coefficient alone. */
START_TEST(parts_that_show_nothing) {
    static const double away[16] = {1, 0, 0, 900, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const double upright[16] = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
    solid s = solid_box(10, 12, 14);
    skg_mesh *box = run_mesh(&s), *leaf = make_leaf();
    const struct {
        const char *name;
        skg_mesh *mesh;
        double mu;
        const double *pose;
    } cases[] = {{"beside", box, 1, away},
                 {"leaf", leaf, 1, NULL},
                 {"leaf, edge-on", leaf, 1, upright},
                 {"vacuum", box, 0, NULL}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int way = 0; way < 4; way++) {
            skg_view view = run_view(SIDE, 4);
            if (way & 1) view.projection = SKG_PROJECTION_PARALLEL;
            ck_skg(skg_scene_create(run_context, &scene));
            run_part(scene, "part", cases[c].mesh, cases[c].mu, cases[c].pose, -1);
            check_zeros(cases[c].name, &view, cases[c].mu > 0, way & 2);
            skg_scene_release(&scene);
        }
    skg_mesh_release(&box);
    skg_mesh_release(&leaf);
    solid_free(&s);
}
END_TEST

/* Until a job was waited for, it is not an error to ask about it, to cancel it, to change or release what it was made of, or to start
 * others; afterwards there is no job. */
START_TEST(a_job_that_is_not_done) {
    static double adjoint[PIXELS], once[PARTS][6], later[PARTS][6], lost[PARTS][6];
    const setting set = {.colours = 1, .priority = 1};
    skg_gradient gradient;
    skg_job *jobs[3] = {NULL, NULL, NULL};
    int32_t done = -1;
    ck_skg_fails(skg_job_wait(NULL), SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    ck_skg_fails(skg_job_wait(&jobs[0]), SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    ck_skg_fails(skg_job_test(NULL, &done), SKG_ERR_ARGUMENT, "skg_job_test");
    make_scene(&set);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    fill_adjoint(PIXELS, adjoint);
    const skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    gradient.poses = once[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    gradient.poses = later[0];
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &gradient, &jobs[0]));
    gradient.poses = lost[0];
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &gradient, &jobs[1]));
    ck_skg(skg_job_cancel(jobs[1]));
    skg_adjoint other = adjoint_of(adjoint);
    other.columns = SIDE + 1;
    ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &other, &gradient, &jobs[2]), SKG_ERR_ARGUMENT,
                 "24 x 25");
    ck_assert_ptr_null(jobs[2]); /* a call that fails leaves the others alone */
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_context_release(&run_context);
    const skg_status status = skg_job_wait(&jobs[1]); /* it may have been done before it was cancelled */
    ck_assert(status == SKG_OK || status == SKG_ERR_CANCELLED);
    ck_skg(skg_job_wait(&jobs[0]));
    ck_skg_fails(skg_job_wait(&jobs[0]), SKG_ERR_ARGUMENT, "skg_job_wait: no job");
    for (int64_t p = 0; p < parts; p++) {
        for (int k = 0; k < 6; k++) ck_assert_double_eq(once[p][k], later[p][k]);
        skg_mesh_release(&meshes[p]);
    }
}
END_TEST

/* A gradient takes the projection of the frame before over, if it is that of its own frame: with the vertices that could not be
 * projected. */
START_TEST(a_vertex_that_cannot_be_projected) {
    static double adjoint[PIXELS], once[PARTS][6], again[PARTS][6];
    static float image[PIXELS];
    const setting set = {.colours = 1};
    skg_gradient gradient;
    skg_output output;
    skg_part part;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    fill_adjoint(PIXELS, adjoint);
    const skg_adjoint given = adjoint_of(adjoint);
    skg_output_init(&output);
    output.data = image;
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(scene, 1, &part));
    const double kept = part.pose[3];
    for (int turn = 0; turn < 8; turn++) {
        const int far = turn & 1, shows = turn & 2;
        part.pose[3] = far ? 1e60 : kept;
        ck_skg(skg_scene_part_pose_set(scene, 1, part.pose));
        const skg_status status = shows ? skg_plan_image(plan, &output) : SKG_OK;
        ck_assert_int_eq(status, shows && far ? SKG_ERR_MESH : SKG_OK);
        for (int time = 0; time < 2; time++) {
            skg_gradient_init(&gradient);
            gradient.poses = turn == 0 ? once[0] : again[0];
            const skg_status found = skg_plan_gradient(plan, NULL, &given, &gradient);
            ck_assert_msg(found == (far ? SKG_ERR_MESH : SKG_OK), "turn %d, time %d: %d", turn, time, found);
            if (far) ck_assert_ptr_nonnull(strstr(skg_last_error(), "cannot be projected"));
        }
        if (!far && turn > 0) ck_assert_mem_eq(again, once, sizeof once);
    }
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* A world of several energies from infinity has no image; with one energy the ratio has no world. From a place, no pixel has a negative exponent:
 * the parts subtract nothing, whichever energy comes through best. */
START_TEST(a_world_and_a_parallel_beam) {
    static double found[PIXELS];
    setting set = {.parallel = 1, .infinity = 1, .world = 1, .quantity = SKG_QUANTITY_ATTENUATION};
    const double energies[2] = {40, 90}, photons[2] = {1, 1}, twists[PARTS][6] = {{1}};
    const int32_t quantities[2] = {SKG_QUANTITY_ATTENUATION, SKG_QUANTITY_ENERGY};
    result r;
    skg_plan_options options;
    skg_plan_report report;
    skg_direction moving;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    make_scene(&set);
    allocate(&r);
    skg_view view = make_view(&set);
    skg_plan_options_init(&options);
    ck_skg(skg_material_create_named("Water", &options.world));
    ck_skg(skg_spectrum_create_bins(2, energies, photons, &beam));
    for (int k = 0; k < 2; k++) {
        options.quantity = quantities[k];
        ck_skg_fails(skg_plan_create(run_context, scene, &view, beam, &options, &plan), SKG_ERR_UNSUPPORTED,
                     "a parallel beam from infinity never comes through a World of Water");
    }
    skg_direction_init(&moving);
    moving.poses = twists[0];
    plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &moving, DOUBLES(found), NULL));
    skg_plan_release(&plan);
    set = (setting){.parallel = 1, .world = 1, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION};
    view = make_view(&set);
    for (int32_t precision = 0; precision <= run_has_double(); precision++) {
        const skg_view from_infinity = make_view(&(setting){.parallel = 1, .infinity = 1});
        plan = make_plan(&set, &view, precision, SKG_STRATEGY_AUTO);
        free(run_image(plan, &view));
        skg_plan_report_init(&report);
        ck_skg(skg_plan_report_get(plan, &report));
        ck_assert_int_eq(report.negative_pixels, 0);
        ck_skg_fails(skg_plan_view_set(plan, &from_infinity), SKG_ERR_UNSUPPORTED,
                     "a parallel beam from infinity never comes through a World of Water");
        skg_plan_release(&plan);
    }
    skg_spectrum_release(&beam);
    skg_material_release(&options.world);
    release(&r);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, a_part_without_a_mesh);
    tcase_add_test(tests, parts_that_show_nothing);
    tcase_add_test(tests, a_job_that_is_not_done);
    tcase_add_test(tests, a_vertex_that_cannot_be_projected);
    tcase_add_test(tests, a_world_and_a_parallel_beam);
}

SKG_SUITE_MAIN("bad gradients", add_tests)
