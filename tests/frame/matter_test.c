/* Matter of a frame: other densities, and parts that are there in part. */
#include "suite.h"
#include "support/run.h"

#include <math.h>
#include <string.h>

enum { SIDE = 32, PIXELS = SIDE * SIDE };

static skg_view view;
static skg_mesh *outer, *inner;

static skg_mesh *mesh_of(solid s) {
    skg_mesh *mesh = run_mesh(&s);
    solid_free(&s);
    return mesh;
}

static void open_all(void) {
    run_open();
    view = run_view(SIDE, 6);
    outer = mesh_of(solid_blob(60, 40, 20, 1));
    inner = mesh_of(solid_sphere(15, 24, 12));
}

static void close_all(void) {
    skg_mesh_release(&outer);
    skg_mesh_release(&inner);
    run_close();
}

/* Water with two bones in it, in a world of thin water; two energies. */
static skg_plan *make_plan(skg_material *water, skg_material *bone, skg_material *other,
                           skg_material *world) {
    static const double kev[2] = {30, 80}, photons[2] = {1, 2};
    skg_scene *scene;
    skg_spectrum *spectrum;
    skg_plan *plan;
    skg_part part;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.world = world;
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.mesh = outer, part.material = water, part.label = "outer";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    part.mesh = inner, part.material = bone, part.label = "inner", part.inside = 0;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    part.material = other, part.label = "other", part.pose[3] = 25, part.pose[11] = 25;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    ck_skg(skg_spectrum_create_bins(2, kev, photons, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    skg_scene_release(&scene);
    skg_spectrum_release(&spectrum);
    return plan;
}

static skg_material *dense(const char *name, double density) {
    skg_material *material, *result;
    ck_skg(skg_material_create_named(name, &material));
    ck_skg(skg_material_create_at_density(material, density, &result));
    skg_material_release(&material);
    return result;
}

static skg_status submit(skg_plan *plan, int64_t count, const int64_t *ids, const double *density,
                         const double *share, float *to) {
    skg_job *job = NULL;
    skg_frame frame;
    skg_output output;
    skg_frame_init(&frame);
    skg_output_init(&output);
    frame.override_count = count, frame.override_parts = ids, frame.density_ratios = density,
    frame.fill_fractions = share;
    output.data = to;
    skg_status status = skg_plan_submit(plan, 1, &frame, 1, &output, &job);
    return status == SKG_OK ? skg_job_wait(&job) : status;
}

/* Path lengths carry 3e-6 of the largest, of an attenuation below 20. */
static void ck_like(const float *image, const float *expected) {
    double most = 0;
    for (int i = 0; i < PIXELS; i++) {
        /* 3e-6 of an attenuation below 20. */
        ck_assert_double_le(fabs((double)image[i] - (double)expected[i]), 3e-6 * 20);
        most = fmax(most, (double)expected[i]);
    }
    ck_assert_double_gt(most, 1);
}

START_TEST(density_is_that_of_other_materials) {
    static float image[PIXELS], expected[PIXELS];
    static const int64_t ids[3] = {0, 1, 2};
    for (int which = 0; which < 4; which++) {
        /* Bones of one density add alike; of two densities they are of more kinds than planned for. */
        const double density[3] = {0.5, 1.5, which & 2 ? 1.25 : 1.5};
        skg_material *world = which & 1 ? dense("Water", 0.02) : NULL;
        skg_material *water = dense("Water", 1), *bone = dense("Bone", 1.92);
        skg_material *thin = dense("Water", 0.5), *hard = dense("Bone", 2.88);
        skg_material *third = dense("Bone", 1.92 * density[2]);
        skg_plan *plan = make_plan(water, bone, bone, world), *other = make_plan(thin, hard, third, world);
        ck_skg(submit(plan, 3, ids, density, NULL, image));
        ck_skg(submit(other, 0, NULL, NULL, NULL, expected));
        ck_like(image, expected);
        ck_skg(submit(plan, 0, NULL, NULL, NULL, expected)); /* and only in that frame */
        ck_skg(submit(plan, 1, ids, NULL, NULL, image));
        ck_like(image, expected);
        skg_plan_release(&plan);
        skg_plan_release(&other);
        skg_material_release(&water);
        skg_material_release(&bone);
        skg_material_release(&thin);
        skg_material_release(&hard);
        skg_material_release(&third);
        skg_material_release(&world);
    }
}
END_TEST

START_TEST(what_is_there_in_part_leaves_its_place_to_what_it_lies_in) {
    static float none[PIXELS], all[PIXELS], image[PIXELS], expected[PIXELS];
    static const int64_t id = 1;
    double share = 0, one = 1;
    skg_material *water = dense("Water", 1), *bone = dense("Bone", 1.92);
    skg_plan *plan = make_plan(water, bone, bone, NULL), *empty = make_plan(water, water, bone, NULL);
    ck_skg(submit(plan, 1, &id, NULL, &share, none));
    ck_skg(submit(empty, 0, NULL, NULL, NULL, expected));
    ck_like(none, expected);
    ck_skg(submit(plan, 1, &id, NULL, &one, all));
    ck_skg(submit(plan, 0, NULL, NULL, NULL, expected));
    ck_like(all, expected);
    share = 0.25;
    ck_skg(submit(plan, 1, &id, NULL, &share, image));
    for (int i = 0; i < PIXELS; i++) ck_assert(image[i] >= none[i] - 1e-4F && image[i] <= all[i] + 1e-4F);
    ck_assert(image[PIXELS / 2 + SIDE / 2] > none[PIXELS / 2 + SIDE / 2] + 0.01F);
    skg_plan_release(&plan);
    skg_plan_release(&empty);
    skg_material_release(&water);
    skg_material_release(&bone);
}
END_TEST

START_TEST(matter_that_cannot_be) {
    static float image[PIXELS];
    int64_t id = 1;
    double number = 2;
    skg_material *water = dense("Water", 1), *bone = dense("Bone", 1.92);
    skg_plan *plan = make_plan(water, bone, bone, NULL);
    ck_skg_fails(submit(plan, 1, NULL, &number, NULL, image), SKG_ERR_ARGUMENT, "no ids");
    ck_skg_fails(submit(plan, 1, &id, NULL, &number, image), SKG_ERR_ARGUMENT, "inner: a fill fraction of 2");
    number = (double)NAN;
    ck_skg_fails(submit(plan, 1, &id, &number, NULL, image), SKG_ERR_ARGUMENT, "inner");
    id = 0, number = 0.5;
    ck_skg_fails(submit(plan, 1, &id, NULL, &number, image), SKG_ERR_UNSUPPORTED, "inner lies inside");
    id = 3;
    ck_skg_fails(submit(plan, 1, &id, &number, NULL, image), SKG_ERR_ARGUMENT, "part 3 of 3");
    skg_plan_release(&plan);
    skg_material_release(&water);
    skg_material_release(&bone);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_all, close_all);
    tcase_add_test(tests, density_is_that_of_other_materials);
    tcase_add_test(tests, what_is_there_in_part_leaves_its_place_to_what_it_lies_in);
    tcase_add_test(tests, matter_that_cannot_be);
}

SKG_SUITE_MAIN("matter", add_tests)
