/* Scenes: parts, nesting, poses, and what is refused. */
#include "core/context.h"
#include "scene/scene.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static skg_scene *scene;
static skg_mesh *cube;
static skg_material *water;

static void set_up(void) {
    ck_skg(skg_scene_create(NULL, &scene));
    ck_skg(skg_mesh_create_cube(10, &cube));
    ck_skg(skg_material_create_mu("water", 0.2, &water));
}

static void tear_down(void) {
    skg_scene_release(&scene);
    skg_mesh_release(&cube);
    skg_material_release(&water);
}

static skg_part good_part(const char *label) {
    skg_part part;
    skg_part_init(&part);
    part.mesh = cube;
    part.material = water;
    part.label = label;
    return part;
}

static int64_t add(const char *label, int64_t inside) {
    skg_part part = good_part(label);
    int64_t id = -2;
    part.inside = inside;
    part.pose[3] = (double)strlen(label); /* no twins */
    ck_skg(skg_scene_part_add(scene, &part, &id));
    return id;
}

START_TEST(parts_come_back_as_they_went_in) {
    char label[] = "skin";
    ck_assert_int_eq(add(label, -1), 0);
    memset(label, 'x', 4); /* labels are copied */
    skg_part part = good_part("liver"), read;
    int64_t id = -1, count = 0;
    part.inside = 0;
    part.pose[0] = -2; /* mirrored is fine */
    part.pose[7] = 3.5;
    ck_skg(skg_scene_part_add(scene, &part, &id));
    ck_assert_int_eq(id, 1);
    skg_part_init(&read);
    ck_skg(skg_scene_part_get(scene, 1, &read));
    const char *its = NULL;
    ck_skg(skg_scene_part_label_get(scene, 1, &its));
    ck_assert_str_eq(its, read.label);
    ck_skg_fails(skg_scene_part_label_get(scene, 99, &its), SKG_ERR_SCENE, "99");
    ck_assert_ptr_null(its);
    ck_assert_int_eq(read.inside, 0);
    ck_assert_ptr_eq(read.mesh, cube);
    ck_assert_ptr_eq(read.material, water);
    ck_assert_str_eq(read.label, "liver");
    ck_assert_mem_eq(read.pose, part.pose, sizeof part.pose);
    ck_skg(skg_scene_part_count(scene, &count));
    ck_assert_int_eq(count, 2);
    ck_skg(skg_scene_part_get(scene, 0, &read));
    ck_assert_str_eq(read.label, "skin");
}
END_TEST

START_TEST(a_part_keeps_mesh_and_material) {
    add("only", -1);
    skg_mesh_release(&cube);
    skg_material_release(&water);
    skg_part read;
    int64_t vertices = 0, triangles = 0;
    skg_part_init(&read);
    ck_skg(skg_scene_part_get(scene, 0, &read));
    ck_skg(skg_mesh_count(read.mesh, &vertices, &triangles));
    ck_assert_int_eq(triangles, 12);
}
END_TEST

START_TEST(a_part_without_label_has_its_meshs_name) {
    skg_part part = good_part(NULL), read;
    const char *name = NULL;
    ck_skg(skg_mesh_name_get(cube, &name));
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_part_init(&read);
    ck_skg(skg_scene_part_get(scene, 0, &read));
    ck_assert_str_eq(read.label, name);
}
END_TEST

START_TEST(labels_are_found) {
    int64_t id = -1;
    add("liver", -1), add("Lung", -1), add("spine", -1), add("SPINE", -1);
    ck_skg(skg_scene_part_find(scene, "liver", &id));
    ck_assert_int_eq(id, 0);
    ck_skg(skg_scene_part_find(scene, "LUNG", &id)); /* the only one alike */
    ck_assert_int_eq(id, 1);
    ck_skg(skg_scene_part_find(scene, "SPINE", &id)); /* the exact one first */
    ck_assert_int_eq(id, 3);
    ck_skg_fails(skg_scene_part_find(scene, "Spine", &id), SKG_ERR_SCENE, "no part has the label Spine");
    ck_skg_fails(skg_scene_part_find(scene, "aortic arch", &id), SKG_ERR_SCENE,
                 "no part has the label aortic arch; the scene has liver, Lung, spine, SPINE");
    ck_skg_fails(skg_scene_part_find(scene, "livre", &id), SKG_ERR_SCENE, "did you mean liver");
}
END_TEST

START_TEST(plans_can_see_what_changed) {
    double pose[16] = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    int64_t structure = scene->structure, poses = scene->poses;
    add("a", -1);
    ck_assert_int_gt(scene->structure, structure);
    structure = scene->structure;
    ck_skg(skg_scene_part_pose_set(scene, 0, pose));
    ck_assert_int_eq(scene->structure, structure);
    ck_assert_int_gt(scene->poses, poses);
    poses = scene->poses;
    pose[0] = (double)NAN;
    ck_skg_fails(skg_scene_part_pose_set(scene, 0, pose), SKG_ERR_SCENE, "not finite");
    ck_assert_int_eq(scene->poses, poses);
    ck_assert_double_eq(scene->parts[0].pose[3], 5);
}
END_TEST

START_TEST(bad_parts_are_refused) {
    int64_t count = 0;
    add("taken", -1);
    skg_part part = good_part("taken");
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "two parts have the label taken");
    part = good_part("part");
    part.inside = 1;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "inside itself");
    part.inside = 2;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "part 2, which is not there");
    part.inside = -2;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "not there");
    part = good_part("part");
    part.mesh = NULL;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_ARGUMENT, "no mesh");
    part = good_part("part");
    part.material = NULL;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_ARGUMENT, "no material");
    part = good_part("");
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "empty label");
    part = (skg_part){0};
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_ARGUMENT, "skg_part_init");
    ck_skg(skg_scene_part_count(scene, &count));
    ck_assert_int_eq(count, 1);
    skg_part_init(&part);
    ck_skg_fails(skg_scene_part_get(scene, 1, &part), SKG_ERR_SCENE, "part 1 of 1");
}
END_TEST

/* A pose is singular by its shape, not by its scale. */
START_TEST(singular_poses_are_refused) {
    skg_part part = good_part("flat");
    part.pose[10] = 0;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "singular");
    part = good_part("sheared flat"); /* rows 0 and 1 equal */
    part.pose[0] = part.pose[1] = part.pose[4] = part.pose[5] = 1;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "singular");
    part = good_part("perspective");
    part.pose[12] = 0.1;
    ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "last row");
    part = good_part("tiny");
    for (int k = 0; k < 3; k++) part.pose[5 * k] = 1e-9;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
}
END_TEST

START_TEST(circles_of_parents_are_refused) {
    int64_t a = add("a", -1), b = add("bb", a), c = add("ccc", b);
    ck_skg_fails(skg_scene_set_inside(scene, a, c), SKG_ERR_SCENE, "circle");
    ck_skg_fails(skg_scene_set_inside(scene, a, a), SKG_ERR_SCENE, "inside itself");
    ck_skg_fails(skg_scene_set_inside(scene, a, 9), SKG_ERR_SCENE, "not there");
    ck_assert_int_eq(scene->parts[a].inside, -1);
    ck_skg(skg_scene_set_inside(scene, c, -1));
    ck_skg(skg_scene_set_inside(scene, a, c));
    ck_assert_int_eq(scene->parts[a].inside, c);
}
END_TEST

static void count_warnings(int32_t level, const char *sentence, void *user) {
    if (level == SKG_LOG_WARNING && strstr(sentence, "same mesh in the same place")) ++*(int *)user;
}

START_TEST(the_same_mesh_twice_in_a_place_is_reported) {
    skg_context *context = NULL;
    int warnings = 0;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_context_log_set(context, count_warnings, &warnings));
    skg_scene_release(&scene);
    ck_skg(skg_scene_create(context, &scene));
    skg_context_release(&context); /* the scene keeps it */
    skg_part part = good_part("a");
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    part.label = "b";
    part.pose[3] = 20;
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    ck_assert_int_eq(warnings, 0);
    part.label = "c";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    ck_assert_int_eq(warnings, 1);
}
END_TEST

/* Each part was compared with all before it: a million took hours. */
START_TEST(many_parts) {
    enum { PARTS = 300000 };
    int64_t id = -1;
    char label[16];
    skg_part part = good_part("0");
    for (int n = 0; n < PARTS; n++) {
        snprintf(label, sizeof label, "%d", n);
        part.label = label;
        part.pose[3] = n;
        ck_skg(skg_scene_part_add(scene, &part, NULL));
    }
    for (int n = 0; n < PARTS; n += 9973) {
        snprintf(label, sizeof label, "%d", n);
        ck_skg(skg_scene_part_find(scene, label, &id));
        ck_assert_int_eq(id, n);
        part.label = label;
        ck_skg_fails(skg_scene_part_add(scene, &part, NULL), SKG_ERR_SCENE, "two parts have the label");
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, parts_come_back_as_they_went_in);
    tcase_add_test(tests, a_part_keeps_mesh_and_material);
    tcase_add_test(tests, a_part_without_label_has_its_meshs_name);
    tcase_add_test(tests, labels_are_found);
    tcase_add_test(tests, plans_can_see_what_changed);
    tcase_add_test(tests, bad_parts_are_refused);
    tcase_add_test(tests, singular_poses_are_refused);
    tcase_add_test(tests, circles_of_parents_are_refused);
    tcase_add_test(tests, the_same_mesh_twice_in_a_place_is_reported);
    tcase_add_test(tests, many_parts);
}

SKG_SUITE_MAIN("scene", add_tests)
