/* `devices --warm`: what it compiled is not compiled again. */
#include "command.h"
#include "scene.h"

/* Files of the drivers' and the library's kernel caches. PoCL leaves an empty one in every process. */
static int cached(void) {
    char line[256];
    int count = -1;
    snprintf(line, sizeof line, "find %s/caches -type f -not -empty | wc -l", folder);
    FILE *files = popen(line, "r");
    ck_assert_ptr_nonnull(files);
    ck_assert_int_eq(fscanf(files, "%d", &count), 1);
    ck_assert_int_eq(pclose(files), 0);
    return count;
}

static const char caches[] = "POCL_CACHE_DIR=$PWD/caches/pocl SKG_CACHE_DIR=$PWD/caches/own";

static void remove_folders(void) {
    char line[256];
    snprintf(line, sizeof line, "rm -rf %s/caches %s/scenes", folder, folder);
    ck_assert_int_eq(system(line), 0);
    tear_down();
}

START_TEST(a_folder_of_scenes) {
    char line[256];
    snprintf(line, sizeof line, "mkdir %s/scenes %s/caches", folder, folder);
    ck_assert_int_eq(system(line), 0);
    write_text("scenes/plain.json", scene);
    write_text("scenes/notes.txt", "no scene");
    ck_run(0, "%s |devices --warm scenes --json", caches);
    json_t *object = said_json();
    json_t *list = member(object, "warm");
    ck_assert_uint_eq(json_array_size(list), 1);
    ck_assert_str_eq(json_string_value(member(json_array_get(list, 0), "scene")), "scenes/plain.json");
    ck_assert(json_is_real(member(json_array_get(list, 0), "seconds")));
    ck_assert(json_is_string(member(object, "device")));
    json_decref(object);
    const int warm = cached();
    ck_run(0, "%s |image scenes/plain.json -o image.mha", caches);
    ck_run(0, "%s |lbuffer scenes/plain.json --part bone -o bone.mha", caches);
    ck_assert_int_eq(cached(), warm);
    /* Another kernel is compiled: the count can grow, if this driver keeps what it compiles. */
    ck_run(0, "%s |image scenes/plain.json --strategy atomics -o image.mha", caches);
    if (warm == 0) skip_test("this driver keeps no compiled kernels");
    ck_assert_int_gt(cached(), warm);
}
END_TEST

START_TEST(scenes_that_fail) {
    write_text("good.json", scene);
    write_text("bad.json", "{}");
    ck_run(3, "devices --warm bad.json --warm good.json");
    ck_assert_ptr_nonnull(strstr(said, "good.json: ready after "));
    ck_assert_ptr_nonnull(strstr(complained, "bad.json"));
    ck_run_fails(3, "none", "devices --warm none");
    ck_run(3, "devices --warm .");
    ck_assert_ptr_nonnull(strstr(said, "good.json: ready after "));
    char line[256];
    snprintf(line, sizeof line, "mkdir %s/scenes", folder);
    ck_assert_int_eq(system(line), 0);
    ck_run_fails(3, "scenes: holds no scene files", "devices --warm scenes");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, remove_folders);
    tcase_add_test(tests, a_folder_of_scenes);
    tcase_add_test(tests, scenes_that_fail);
}

SKG_SUITE_MAIN("warm", add_tests)
