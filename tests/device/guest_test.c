/* The library beside a driver that ends, crashes or blocks the process that calls it, or computes wrongly. */
#include "device/choice.h"
#include "device/device.h"
#include "device/guest/folder.h"
#include "device/self_tests.h"
#include "driver/driver.h"
#include "suite.h"

#include <skiagraph/opencl.h>

/* Misdeeds of the guest in calls that any program causes which opens a device of the guest. */
static const char *const misdeeds[] = {
    "exit:clGetDeviceInfo", "abort:clGetDeviceInfo", "crash:clGetDeviceInfo",
    "hang:clGetDeviceInfo", "fail:clGetDeviceInfo",  "leak:clGetDeviceInfo",
    "exit:clCreateContext", "hang:clBuildProgram",   "wrong:"};

static const char *const open_words[] = {NULL, "device=auto", "device=cpu", "threads=1"};

/* The guest claims to be a GPU with more compute units than any. It is not even asked. */
START_TEST(a_driver_that_is_not_known_is_left_alone) {
    skg_context *context = NULL;
    skg_device_info info;
    int32_t untested = 1;
    setenv("SKG_GUEST", misdeeds[_i], 1);
    for (size_t n = 0; n < sizeof open_words / sizeof *open_words; n++) {
        ck_skg(skg_device_untested(open_words[n], &untested));
        ck_assert_int_eq(untested, 0);
        skg_device_info_init(&info);
        ck_skg(skg_device_find(open_words[n], &info));
        ck_assert_int_eq(info.known, 1);
    }
    ck_skg(skg_device_untested("device=pthread", &untested)); /* a name that fits a known one */
    ck_assert_int_eq(untested, 0);
    ck_skg_fails(skg_context_create("device=gpu", &context), SKG_ERR_NO_DEVICE,
                 "\"A bad guest\" is not known");
    if (_i == 0) ck_skg(skg_context_create(NULL, &context));
    skg_context_release(&context);
    ck_assert_int_gt(count_calls("clGetPlatformInfo"), 0);
    ck_assert_int_eq(count_calls("clGetDeviceInfo"), 0);
    ck_assert_int_eq(count_calls("clCreateContext"), 0);
}
END_TEST

static skg_device_info find_guest(void) {
    int64_t count = 0;
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_device_count(&count));
    ck_assert_int_ge(count, 2);
    for (int64_t k = 0; k < count; k++) {
        ck_skg(skg_device_get(k, &info));
        if (strcmp(info.name, "guest's GPU") == 0) break;
        ck_assert_int_eq(info.known, 1); /* known ones come first */
    }
    ck_assert_str_eq(info.platform_name, "A bad guest");
    ck_assert_int_eq(info.known, 0);
    return info;
}

/* Naming it is the caller's decision; the caller can ask first. */
START_TEST(a_device_that_is_named_is_tested) {
    skg_context *context = NULL;
    int32_t untested = 0;
    char config[64];
    ck_skg(skg_device_untested("device=GUEST", &untested));
    ck_assert_int_eq(untested, 1);
    ck_assert_int_eq(count_calls("clGetDeviceInfo"), 0);
    const skg_device_info info = find_guest();
    snprintf(config, sizeof config, "device=%d:%d", info.platform, info.device);
    ck_skg(skg_device_untested(config, &untested));
    ck_assert_int_eq(untested, 1);
    ck_skg_fails(skg_context_create(config, &context), SKG_ERR_DEVICE, "computes wrongly");
    ck_skg_fails(skg_context_create("device=guest", &context), SKG_ERR_DEVICE, "computes wrongly");
    ck_assert_ptr_null(context);
    ck_skg_fails(skg_context_create("device=gpu", &context), SKG_ERR_NO_DEVICE, "is not known");
    ck_skg(skg_device_untested("device=-1:0", &untested));
    ck_assert_int_eq(untested, 0);
    ck_skg(skg_device_untested("device=77:0", &untested));
    ck_assert_int_eq(untested, 0);
    ck_skg_fails(skg_device_untested("colour=red", &untested), SKG_ERR_ARGUMENT, "colour");
    ck_skg_fails(skg_device_untested(NULL, NULL), SKG_ERR_ARGUMENT, "untested");
}
END_TEST

/* Work is divided by the number of compute units, and buffers are compared with the memory. */
START_TEST(numbers_that_no_device_has) {
    skg_context *context = NULL;
    int32_t index = 0;
    setenv("SKG_GUEST", "odd:", 1);
    const skg_device_info info = find_guest();
    ck_assert_int_eq(info.compute_units, 1);
    ck_assert_int_eq(info.memory, INT64_MAX);
    ck_assert_int_eq(info.max_allocation, INT64_MAX);
    ck_assert_int_eq(info.local_memory, INT64_MAX);
    ck_skg(skg_context_open("device=guest", 0, &context, &index));
    skg_buffer buffer = {0};
    ck_skg(skg_buffer_reserve(context, &buffer, (int64_t)1 << 40, CL_MEM_READ_WRITE,
                              "a buffer")); /* not "at most -1 MiB" */
    skg_buffer_release(&buffer);
    skg_context_release(&context);
    ck_skg_fails(skg_context_create("device=guest", &context), SKG_ERR_DEVICE, "computes wrongly");
}
END_TEST

/* Keeps that the guest has passed, as its test would. */
static void let_pass(double score) {
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    skg_device_info info;
    skg_verdict verdict = {.good = 1, .score = score};
    ck_skg(skg_device_locate("device=guest", &platform, &device, &info));
    const skg_digest identity = skg_identity_of(platform, device);
    skg_verdict_keep(cache_folder, &identity, skg_self_test_name(SKG_SELF_TEST_CORE), &verdict);
    skg_platform_trust(cache_folder, platform);
}

START_TEST(a_device_that_has_passed_is_chosen) {
    skg_device_info info;
    skg_device_test result;
    int32_t untested = 1;
    let_pass(1e6);
    skg_device_info_init(&info);
    ck_skg(skg_device_find(NULL, &info));
    ck_assert_str_eq(info.name, "guest's GPU");
    ck_skg(skg_device_find("device=gpu", &info));
    ck_assert_str_eq(info.name, "guest's GPU");
    ck_skg(skg_device_untested("device=guest", &untested));
    ck_assert_int_eq(untested, 0);
    /* A later test in a child finds that its driver ends the process. */
    skg_device_test_init(&result);
    result.verdict = SKG_TEST_FAILED;
    snprintf(result.reason, sizeof result.reason, "the driver ended the process");
    ck_skg(skg_device_test_keep("device=guest", 0, &result));
    ck_skg(skg_device_find(NULL, &info));
    ck_assert_int_eq(info.known, 1);
    skg_context *context = NULL;
    ck_skg_fails(skg_context_create("device=guest", &context), SKG_ERR_DEVICE,
                 "fails with the kernels of core: the driver ended the process");
    ck_assert_int_eq(count_calls("clBuildProgram"), 0);
}
END_TEST

/* A trusted platform whose device does not answer is passed over. */
START_TEST(a_device_that_fails_later_is_passed_over) {
    skg_device_info info;
    let_pass(1e6);
    setenv("SKG_GUEST", "fail:clGetDeviceInfo", 1);
    skg_device_info_init(&info);
    ck_skg(skg_device_find(NULL, &info));
    ck_assert_int_eq(info.known, 1);
}
END_TEST

START_TEST(without_a_cache_it_is_never_chosen) {
    skg_device_info info;
    let_pass(1e6);
    setenv("SKG_CACHE_DIR", _i ? "/proc/none" : "none", 1);
    skg_device_info_init(&info);
    ck_skg(skg_device_find(NULL, &info));
    ck_assert_int_eq(info.known, 1);
}
END_TEST

START_TEST(alone_it_is_no_device) {
    skg_context *context = NULL;
    be_alone();
    ck_skg_fails(skg_context_create(NULL, &context), SKG_ERR_NO_DEVICE,
                 "`skiagraph devices` tests such devices");
    ck_assert_int_eq(count_calls("clGetDeviceInfo"), 0);
}
END_TEST

START_TEST(only_what_can_be_kept_is_kept) {
    skg_device_test result;
    const char *name = NULL;
    skg_device_test_init(&result);
    result.verdict = SKG_TEST_RIGHT;
    ck_skg_fails(skg_device_test_keep("device=0:0", 0, &result), SKG_ERR_ARGUMENT, "only WRONG and FAILED");
    result.verdict = SKG_TEST_WRONG;
    ck_skg_fails(skg_device_test_keep("device=0:0", 999, &result), SKG_ERR_ARGUMENT, "counted from 0");
    ck_skg_fails(skg_device_test_keep("device=99:0", 0, &result), SKG_ERR_NO_DEVICE, "no OpenCL device fits");
    ck_skg_fails(skg_device_test_keep("device=0:0", 0, NULL), SKG_ERR_ARGUMENT, "result");
    ck_skg(skg_device_test_name_get(0, &name));
    ck_assert_str_eq(name, skg_self_test_name(SKG_SELF_TEST_CORE));
    ck_skg_fails(skg_device_test_name_get(-1, &name), SKG_ERR_ARGUMENT, "counted from 0");
    ck_skg_fails(skg_device_test_name_get(0, NULL), SKG_ERR_ARGUMENT, "name");
}
END_TEST

/* PoCL compiles the programs that it always did; others may not use builtins of clang. */
START_TEST(builtins_are_for_known_compilers) {
    skg_context *context = NULL;
    int32_t index = 0;
    ck_skg(skg_context_open("device=guest", 0, &context, &index));
    ck_assert_int_eq(context->device->clang, 0);
    skg_context_release(&context);
    ck_skg(skg_context_open(NULL, 0, &context, &index));
    ck_assert_int_eq(context->device->clang,
                     strcmp(context->device->info.platform_name, "Portable Computing Language") == 0);
    skg_context_release(&context);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_guest_folder, remove_guest_folder);
    tcase_add_loop_test(tests, a_driver_that_is_not_known_is_left_alone, 0,
                        (int)(sizeof misdeeds / sizeof *misdeeds));
    tcase_add_test(tests, a_device_that_is_named_is_tested);
    tcase_add_test(tests, numbers_that_no_device_has);
    tcase_add_test(tests, a_device_that_has_passed_is_chosen);
    tcase_add_test(tests, a_device_that_fails_later_is_passed_over);
    tcase_add_loop_test(tests, without_a_cache_it_is_never_chosen, 0, 2);
    tcase_add_test(tests, alone_it_is_no_device);
    tcase_add_test(tests, only_what_can_be_kept_is_kept);
    tcase_add_test(tests, builtins_are_for_known_compilers);
}

SKG_SUITE_MAIN("guest", add_tests)
