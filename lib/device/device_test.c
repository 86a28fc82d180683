/* Public calls that run a single self-test. */
#include "core/clock.h"
#include "core/text.h"
#include "device/cache.h"
#include "device/choice.h"
#include "device/device.h"
#include "device/self_tests.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void skg_device_test_init_sized(void *result, int32_t size) {
    const skg_device_test defaults = {0};
    skg_struct_init(result, size, &defaults, sizeof defaults);
}

skg_status skg_device_test_count(int64_t *count) {
    SKG_NEEDS(count);
    *count = SKG_SELF_TESTS;
    return SKG_OK;
}

static skg_status check_test(int64_t test) {
    if (test >= 0 && test < SKG_SELF_TESTS) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "test %" PRId64 " of %d (counted from 0)", test, SKG_SELF_TESTS);
}

skg_status skg_device_test_name_get(int64_t test, const char **name) {
    SKG_NEEDS(name);
    SKG_TRY(check_test(test));
    *name = skg_self_test_name((skg_self_test)test);
    return SKG_OK;
}

/* The verdict if a call has failed. Too little memory and wrong arguments are not the device's fault. */
static skg_status take_failure(skg_status status, skg_device_test *result) {
    if (status == SKG_ERR_MEMORY || status == SKG_ERR_ARGUMENT) return status;
    result->verdict = status == SKG_ERR_UNSUPPORTED ? SKG_TEST_UNSUPPORTED : SKG_TEST_FAILED;
    snprintf(result->reason, sizeof result->reason, "%s", skg_last_error());
    result->reason[strcspn(result->reason, "\n")] = '\0'; /* the first line of a build log */
    return SKG_OK;
}

static skg_status run_test(const skg_device_info *info, skg_self_test number, skg_device_test *result) {
    char config[64];
    skg_context *context = NULL;
    skg_verdict verdict;
    int32_t index = 0;
    snprintf(config, sizeof config, "device=%" PRId32 ":%" PRId32, info->platform, info->device);
    skg_status status = skg_context_open(config, 0, &context, &index);
    if (status == SKG_OK) status = skg_self_test_repeat(context, number, &verdict);
    if (status == SKG_OK) {
        result->verdict = verdict.good ? SKG_TEST_RIGHT : SKG_TEST_WRONG;
        result->score = verdict.score;
        memcpy(result->reason, verdict.reason, sizeof result->reason);
    } else {
        status = take_failure(status, result);
    }
    skg_context_release(&context);
    return status;
}

skg_status skg_device_test_run(int64_t device, int64_t test, skg_device_test *result) {
    SKG_PLAIN;
    SKG_NEEDS(result);
    skg_device_info info;
    skg_device_test ours;
    SKG_TRY(check_test(test));
    skg_device_info_init(&info);
    skg_device_test_init(&ours);
    SKG_TRY(skg_device_get(device, &info));
    snprintf(ours.name, sizeof ours.name, "%s", skg_self_test_name((skg_self_test)test));
    const double start = skg_seconds();
    SKG_TRY(run_test(&info, (skg_self_test)test, &ours));
    ours.seconds = skg_seconds() - start;
    return skg_struct_write(&ours, sizeof ours, "skg_device_test", result);
}

skg_status skg_device_test_keep(const char *config, int64_t test, const skg_device_test *result) {
    SKG_PLAIN;
    char store[SKG_STORE_PATH];
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    skg_device_info info;
    skg_device_test ours;
    SKG_TRY(check_test(test));
    SKG_NEEDS(result);
    skg_device_test_init(&ours);
    SKG_TRY(skg_struct_read(result, "skg_device_test", &ours, sizeof ours));
    if (ours.verdict != SKG_TEST_WRONG && ours.verdict != SKG_TEST_FAILED)
        return skg_fail(SKG_ERR_ARGUMENT, "a verdict of %" PRId32 " is not cached; only WRONG and FAILED are",
                        ours.verdict);
    SKG_TRY(skg_device_locate(config, &platform, &device, &info));
    skg_verdict verdict = {.failed = ours.verdict == SKG_TEST_FAILED};
    snprintf(verdict.reason, sizeof verdict.reason, "%.*s", (int)sizeof ours.reason - 1, ours.reason);
    const skg_digest identity = skg_identity_of(platform, device);
    skg_store_find(store);
    skg_verdict_keep(store, &identity, skg_self_test_name((skg_self_test)test), &verdict);
    return SKG_OK;
}
