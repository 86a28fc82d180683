/* Gradients as jobs: what is submitted may be changed, jobs run in order, and can be asked, cancelled and waited for. */
#include "core/context.h"
#include "device/device.h"
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>
#include <string.h>
#include <time.h>

static const setting settings[] = {
    {.name = "energy", .colours = 1, .nested = 1},
    {.name = "attenuation, blur", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .blur = 1},
    {.name = "priority, spot", .priority = 1, .spot = 1},
};

/* A gradient of poses, vertices, source and densities. */
static skg_gradient wanted_of(result *r) {
    skg_gradient wanted;
    skg_gradient_init(&wanted);
    wanted.poses = r->poses[0], wanted.vertices = r->vertices, wanted.densities = r->densities;
    wanted.source = r->source, wanted.detector = r->detector;
    return wanted;
}

/* Memory for a second gradient of the scene. */
static void take_memory(result *r) {
    *r = (result){.source = {0}};
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        r->vertices[p] = calloc((size_t)(3 * vertices), sizeof(double));
    }
}

static void give_memory(result *r) {
    for (int64_t p = 0; p < parts; p++) free(r->vertices[p]);
}

static void check_same(const setting *set, const result *a, const result *b) {
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        ck_assert_msg(memcmp(a->poses[p], b->poses[p], sizeof a->poses[p]) == 0, "%s: poses", set->name);
        ck_assert_msg(memcmp(a->vertices[p], b->vertices[p], (size_t)(3 * vertices) * sizeof(double)) == 0,
                      "%s: vertices of part %d", set->name, (int)p);
        ck_assert_msg(a->densities[p] == b->densities[p], "%s: density of part %d", set->name, (int)p);
    }
    ck_assert_msg(memcmp(a->source, b->source, sizeof a->source) == 0, "%s: source", set->name);
    ck_assert_msg(memcmp(a->detector, b->detector, sizeof a->detector) == 0, "%s: detector", set->name);
}

static void make_image(skg_plan *plan, double *image) {
    skg_output output;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_image(plan, &output));
}

/* Moves a part and its vertices somewhere else. */
static void disturb(void) {
    const double away[16] = {1, 0, 0, 5, 0, 1, 0, -4, 0, 0, 1, 3, 0, 0, 0, 1};
    int64_t vertices, triangles;
    ck_skg(skg_mesh_count(meshes[0], &vertices, &triangles));
    double *positions = calloc((size_t)(3 * vertices), sizeof *positions);
    ck_skg(skg_mesh_positions_get(meshes[0], positions, 0));
    for (int64_t i = 0; i < 3 * vertices; i++) positions[i] *= 1.1;
    ck_skg(skg_mesh_positions_set(meshes[0], positions, 0));
    ck_skg(skg_scene_part_pose_set(scene, 1, away));
    free(positions);
}

/* Scene, adjoint and the list of arrays are changed between submission and wait; an image that is submitted later has the changed
 * scene, and the gradient does not. */
START_TEST(a_job_has_the_scene_of_its_submission) {
    const setting *set = &settings[_i];
    static double adjoint[PIXELS], image[PIXELS], changed[PIXELS];
    result direct, later;
    skg_job *job = NULL;
    int32_t done = 0;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&direct);
    take_memory(&later);
    fill_adjoint(PIXELS, adjoint);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    make_gradient(plan, set, adjoint, &direct);
    const skg_adjoint given = adjoint_of(adjoint);
    double *list[PARTS];
    memcpy(list, later.vertices, sizeof list);
    skg_gradient wanted = wanted_of(&later);
    wanted.vertices = list;
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    memset(adjoint, 0, sizeof adjoint);
    memset(list, 0, sizeof list);
    disturb();
    make_image(plan, image); /* the gradient is made before it */
    ck_skg(skg_job_test(job, &done));
    ck_assert_int_eq(done, 1);
    ck_skg(skg_job_wait(&job));
    ck_assert_ptr_null(job);
    check_same(set, &direct, &later);
    make_image(plan, changed);
    ck_assert_mem_eq(image, changed, sizeof image);
    skg_plan_release(&plan);
    give_memory(&later);
    release(&direct);
}
END_TEST

/* Asked for again and again it is done after as many passes as the source has samples. */
START_TEST(progress_and_cancel) {
    const setting *set = &settings[2];
    static double adjoint[PIXELS], image[PIXELS], again[PIXELS];
    result direct, later;
    skg_job *job = NULL;
    int64_t done = 0, total = 0, turns = 0;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&direct);
    take_memory(&later);
    fill_adjoint(PIXELS, adjoint);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    const skg_adjoint given = adjoint_of(adjoint);
    const skg_gradient wanted = wanted_of(&later);
    make_image(plan, image);
    make_gradient(plan, set, adjoint, &direct);
    skg_turn_take(run_context->turn, NULL); /* the job goes on when it is asked, and only then */
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    do {
        ck_skg(skg_job_progress(job, &done, &total));
        turns++;
        nanosleep(&(const struct timespec){.tv_nsec = 100000}, NULL);
    } while (done < total);
    ck_assert_int_gt(total, 1);
    ck_assert_int_ge(turns, total); /* a pass in each */
    ck_skg(skg_job_wait(&job));
    check_same(set, &direct, &later);
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    ck_skg(skg_job_progress(job, &done, &total));
    ck_skg(skg_job_cancel(job));
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_CANCELLED, "passes were made, and the results are not in place");
    ck_assert_ptr_null(job);
    make_image(plan, again);
    ck_assert_mem_eq(image, again, sizeof image);
    /* One that nobody has asked for. */
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    ck_skg(skg_job_cancel(job));
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_CANCELLED, "0 of");
    skg_turn_give(run_context->turn);
    skg_plan_release(&plan);
    give_memory(&later);
    release(&direct);
}
END_TEST

/* Several jobs at once, of gradients and along directions; plan and scene are released before. */
START_TEST(several_jobs) {
    const setting *set = &settings[_i];
    static double adjoint[PIXELS], along_once[PIXELS], along_job[PIXELS];
    double twists[PARTS][6] = {{1, 0, 0, 0, 0.01, 0}, {0, 1, 0, 0.02, 0, 0}}, densities[PARTS] = {0, 0.5};
    result direct, later;
    skg_job *jobs[2] = {NULL, NULL};
    skg_direction along_both;
    int64_t saturated = -1;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&direct);
    take_memory(&later);
    fill_adjoint(PIXELS, adjoint);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    const skg_adjoint given = adjoint_of(adjoint);
    const skg_gradient wanted = wanted_of(&later);
    skg_direction_init(&along_both);
    along_both.poses = twists[0], along_both.densities = densities;
    make_gradient(plan, set, adjoint, &direct);
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &along_both, DOUBLES(along_once), NULL));
    ck_skg(skg_plan_derivatives_submit(plan, NULL, 1, &along_both, DOUBLES(along_job), &saturated, &jobs[0]));
    memset(twists, 0, sizeof twists);
    memset(densities, 0, sizeof densities);
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &jobs[1]));
    skg_plan_release(&plan);
    ck_skg(skg_job_wait(&jobs[1]));
    ck_skg(skg_job_wait(&jobs[0]));
    check_same(set, &direct, &later);
    ck_assert_mem_eq(along_once, along_job, sizeof along_once);
    ck_assert_int_eq(saturated, 0);
    give_memory(&later);
    release(&direct);
}
END_TEST

/* An adjoint in device memory is the same; whether it is finite is known when the job is waited for. */
START_TEST(adjoints_in_device_memory) {
    const setting *set = &settings[0];
    static double adjoint[PIXELS];
    result direct, later;
    skg_job *job = NULL;
    const cl_command_queue queue = run_context->device->queue;
    cl_int code = CL_SUCCESS;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&direct);
    take_memory(&later);
    fill_adjoint(PIXELS, adjoint);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    make_gradient(plan, set, adjoint, &direct);
    cl_mem buffer = clCreateBuffer(run_context->device->cl, CL_MEM_READ_ONLY, sizeof adjoint, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    ck_assert_int_eq(clEnqueueWriteBuffer(queue, buffer, CL_TRUE, 0, sizeof adjoint, adjoint, 0, NULL, NULL),
                     CL_SUCCESS);
    skg_adjoint given = adjoint_of(NULL);
    given.buffer = buffer;
    const skg_gradient wanted = wanted_of(&later);
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    ck_skg(skg_job_wait(&job));
    check_same(set, &direct, &later);
    adjoint[2 * SIDE + 5] = (double)NAN;
    ck_assert_int_eq(clEnqueueWriteBuffer(queue, buffer, CL_TRUE, 0, sizeof adjoint, adjoint, 0, NULL, NULL),
                     CL_SUCCESS);
    ck_skg(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job));
    ck_skg_fails(skg_job_wait(&job), SKG_ERR_ARGUMENT,
                 "skg_plan_gradient_submit: the adjoint is nan in channel 0, row 2, column 5");
    given.offset = 16;
    ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job), SKG_ERR_ARGUMENT,
                 "its buffer at");
    ck_assert_ptr_null(job);
    clReleaseMemObject(buffer);
    skg_plan_release(&plan);
    give_memory(&later);
    release(&direct);
}
END_TEST

START_TEST(bad_submissions) {
    const setting *set = &settings[0];
    static double adjoint[PIXELS], derivative[PIXELS];
    double twists[PARTS][6] = {{0}}, densities[PARTS] = {0}, coefficients[PARTS * 8] = {0};
    skg_gradient wanted;
    skg_direction direction_of;
    skg_job *job = NULL;
    result r;
    make_scene(set);
    allocate(&r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&wanted);
    wanted.poses = r.poses[0];
    ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &given, &wanted, NULL), SKG_ERR_ARGUMENT,
                 "skg_plan_gradient_submit");
    given.rows = SIDE - 1;
    ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job), SKG_ERR_ARGUMENT,
                 "the adjoint has 1 channels of 23 x 24 (rows x columns), the image 1 of 24 x 24");
    given = adjoint_of(adjoint);
    for (int k = 0; k < 2; k++) {
        static double extreme[SIDE * SIDE];
        for (int i = 0; i < SIDE * SIDE; i++) extreme[i] = k ? 1e40 : 1e-40;
        given = adjoint_of(extreme);
        ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job), SKG_ERR_ARGUMENT,
                     "give the loss in a unit in which it is 1e-30 to 1e+30, or 0");
        ck_assert_ptr_null(job);
    }
    given = adjoint_of(adjoint);
    adjoint[3] = (double)INFINITY;
    ck_skg_fails(skg_plan_gradient_submit(plan, NULL, &given, &wanted, &job), SKG_ERR_ARGUMENT,
                 "the adjoint is inf in channel 0, row 0, column 3; it has to be finite");
    ck_assert_ptr_null(job);
    skg_direction_init(&direction_of);
    twists[1][2] = (double)NAN;
    direction_of.poses = twists[0];
    ck_skg_fails(skg_plan_derivatives_submit(plan, NULL, 1, &direction_of, DOUBLES(derivative), NULL, &job),
                 SKG_ERR_ARGUMENT, "number 8 of the direction's poses is nan; it has to be finite");
    skg_direction_init(&direction_of);
    densities[1] = (double)INFINITY;
    direction_of.densities = densities;
    ck_skg_fails(skg_plan_derivatives_submit(plan, NULL, 1, &direction_of, DOUBLES(derivative), NULL, &job),
                 SKG_ERR_ARGUMENT, "number 1 of the direction's densities is inf");
    skg_direction_init(&direction_of);
    direction_of.attenuations = coefficients, direction_of.nodes = 8;
    ck_skg_fails(skg_plan_derivatives_submit(plan, NULL, 1, &direction_of, DOUBLES(derivative), NULL, &job),
                 SKG_ERR_ARGUMENT, "the attenuations have memory for 8 energies, and the plan has 3");
    ck_skg_fails(skg_plan_derivatives_submit(plan, NULL, 1, &direction_of, NULL, NULL, &job),
                 SKG_ERR_ARGUMENT, "skg_plan_derivatives_submit");
    ck_assert_ptr_null(job);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, a_job_has_the_scene_of_its_submission, 0, 3);
    tcase_add_test(tests, progress_and_cancel);
    tcase_add_loop_test(tests, several_jobs, 0, 3);
    tcase_add_test(tests, adjoints_in_device_memory);
    tcase_add_test(tests, bad_submissions);
}

SKG_SUITE_MAIN("gradient jobs", add_tests)
