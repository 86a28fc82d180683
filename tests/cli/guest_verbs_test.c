/* The command beside a driver that ends, crashes or blocks the process that calls it, or computes wrongly. */
#include "command.h"
#include "device/guest/folder.h"

static void set_up_both(void) {
    set_up();
    make_guest_folder();
}

static void tear_down_both(void) {
    tear_down();
    remove_guest_folder();
}

/* Misdeeds of the guest, and the sentence of the command about each. */
static const struct {
    const char *guest, *said;
} misdeeds[] = {
    {"exit:clBuildProgram", "ended the process with exit status 8 (\"guest: exit:clBuildProgram\")"},
    {"exit:clReleaseContext", "ended the process with exit status 8"},
    {"abort:clCreateKernel", "ended the process by signal 6"},
    {"crash:clEnqueueNDRangeKernel", "ended the process by signal 11"},
    {"fail:clCreateBuffer", "CL_OUT_OF_RESOURCES"},
    {"leak:clSetKernelArg", "computes wrongly with the kernels of core"},
    {"wrong:", "computes wrongly with the kernels of core"},
};

/* The word of the guest for --device. */
static void find_guest(char word[32]) {
    ck_run(0, "devices --json");
    json_t *object = said_json(), *list = json_object_get(object, "devices"), *device;
    size_t k;
    word[0] = '\0';
    json_array_foreach(list, k, device) {
        const int is_guest =
            strcmp(json_string_value(json_object_get(device, "platform")), "A bad guest") == 0;
        ck_assert_int_eq(json_is_true(json_object_get(device, "known")), !is_guest);
        ck_assert_int_eq(json_is_string(json_object_get(device, "refused")), is_guest);
        if (is_guest) snprintf(word, 32, "%s", json_string_value(json_object_get(device, "device")));
        if (is_guest) ck_assert(json_is_false(json_object_get(device, "chosen")));
    }
    ck_assert_str_ne(word, "");
    json_decref(object);
}

/* The list names the sentence; --device is refused with status 4, by a second process and without a second test. */
START_TEST(a_misdeed_is_a_verdict) {
    char word[32];
    setenv("SKG_GUEST", misdeeds[_i].guest, 1);
    ck_run(0, "devices");
    ck_assert_msg(strstr(said, "refused: ") != NULL && strstr(said, misdeeds[_i].said) != NULL, "%s", said);
    ck_assert_str_eq(complained, "");
    find_guest(word);
    const int built = count_calls("clBuildProgram");
    ck_run_fails(4, misdeeds[_i].said, "plan %s/examples/scenes/cube.json --device %s", SKG_SOURCE, word);
    if (_i != 4)
        ck_assert_int_eq(count_calls("clBuildProgram"), built); /* a call that failed is no verdict */
    ck_run(0, "plan %s/examples/scenes/cube.json --quiet", SKG_SOURCE);
}
END_TEST

/* A device that was never listed is tested when it is named: an exit, a crash, wrong numbers. */
START_TEST(a_name_is_tested_in_a_child) {
    setenv("SKG_GUEST", misdeeds[3 * _i].guest, 1);
    ck_run_fails(4, misdeeds[3 * _i].said, "plan %s/examples/scenes/cube.json --device guest", SKG_SOURCE);
    ck_run_fails(4, misdeeds[3 * _i].said, "SKG_DEVICE=guest|plan %s/examples/scenes/cube.json", SKG_SOURCE);
}
END_TEST

START_TEST(a_driver_that_cannot_be_listed) {
    setenv("SKG_GUEST", _i ? "crash:clGetDeviceInfo" : "exit:clGetDeviceInfo", 1);
    ck_run_fails(4, "a process that listed all devices was lost", "devices");
    ck_run_fails(4, "a process that listed all devices was lost", "devices --test");
    ck_run_fails(4, "a process that asked for guest was lost", "devices --device guest --warm x.json");
    ck_run(4, "devices --json");
    json_t *object = said_json();
    ck_assert_ptr_nonnull(json_object_get(object, "error"));
    json_decref(object);
    ck_run(0, "plan %s/examples/scenes/cube.json --quiet", SKG_SOURCE);
}
END_TEST

START_TEST(alone_it_is_listed_with_the_reason) {
    be_alone();
    setenv("SKG_GUEST", "exit:clBuildProgram", 1);
    ck_run(4, "devices");
    ck_assert_msg(strstr(said, "ended the process with exit status 8") != NULL, "%s", said);
    ck_assert_msg(strstr(complained, "is not known") != NULL, "%s", complained);
    ck_run_fails(4, "is not known", "plan %s/examples/scenes/cube.json", SKG_SOURCE);
    ck_run(1, "devices --test");
    ck_assert_msg(strstr(said, "core               failed") != NULL, "%s", said);
    ck_assert_msg(strstr(said, "exit status 8") != NULL, "%s", said);
    setenv("SKG_GUEST", "exit:clReleaseContext", 1);
    ck_run(1, "devices --test --json");
    json_t *object = said_json(),
           *tests = json_object_get(json_array_get(json_object_get(object, "devices"), 0), "tests");
    ck_assert_uint_eq(json_array_size(tests), 1);
    ck_assert_str_eq(json_string_value(json_object_get(json_array_get(tests, 0), "verdict")), "failed");
    ck_assert_str_eq(json_string_value(json_object_get(json_array_get(tests, 0), "name")), "core");
    json_decref(object);
}
END_TEST

/* Takes the 30 s after which a child is given up, once: the verdict is kept. No child stays behind. */
START_TEST(a_driver_that_hangs) {
    be_alone();
    setenv("SKG_GUEST", "hang:clCreateContext", 1);
    ck_run_fails(4, "gave no answer within 30 s (\"guest: hang:clCreateContext\")",
                 "plan %s/examples/scenes/cube.json --device guest", SKG_SOURCE);
    const int hung = count_calls("clCreateContext");
    ck_assert_int_eq(hung, 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_both, tear_down_both);
    tcase_add_loop_test(tests, a_misdeed_is_a_verdict, 0, (int)(sizeof misdeeds / sizeof *misdeeds));
    tcase_add_loop_test(tests, a_name_is_tested_in_a_child, 0, 3);
    tcase_add_loop_test(tests, a_driver_that_cannot_be_listed, 0, 2);
    tcase_add_test(tests, alone_it_is_listed_with_the_reason);
    tcase_add_test(tests, a_driver_that_hangs);
}

SKG_SUITE_MAIN("guest_verbs", add_tests)
