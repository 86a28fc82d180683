#include "verbs/device_tests.h"

#include "common/environment.h"
#include "common/json.h"
#include "common/say.h"

#include <skiagraph/skiagraph.h>

#include <stdio.h>

static const char *verdict_name(int32_t verdict) {
    return verdict == SKG_TEST_RIGHT         ? "right"
           : verdict == SKG_TEST_WRONG       ? "wrong"
           : verdict == SKG_TEST_UNSUPPORTED ? "unsupported"
                                             : "failed";
}

static json_t *test_json(const skg_device_test *test) {
    json_t *object = json_object();
    json_object_set_new(object, "name", cli_json_text(test->name));
    json_object_set_new(object, "verdict", cli_json_text(verdict_name(test->verdict)));
    json_object_set_new(object, "seconds", cli_json_number(test->seconds));
    json_object_set_new(object, "score", test->score > 0 ? cli_json_number(test->score) : json_null());
    json_object_set_new(object, "reason", test->reason[0] ? cli_json_text(test->reason) : json_null());
    return object;
}

static void print_test(const skg_device_test *test) {
    printf("  %-18s %-12s %7.2f s", test->name, verdict_name(test->verdict), test->seconds);
    if (test->score > 0) printf("  %.0f images of 512 x 512 pixels per second", test->score);
    if (test->reason[0]) printf("  %s", test->reason);
    putchar('\n');
    fflush(stdout); /* a test may take a minute */
}

/* All tests of one device. *bad: 1 if one of them is wrong or failed. tests: NULL for the table. */
static skg_status test_device(int64_t device, json_t *tests, int *bad) {
    int64_t count = 0;
    skg_status status = skg_device_test_count(&count);
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        skg_device_test result;
        skg_device_test_init(&result);
        status = skg_device_test_run(device, k, &result);
        if (status != SKG_OK) break;
        if (result.verdict == SKG_TEST_WRONG || result.verdict == SKG_TEST_FAILED) *bad = 1;
        if (tests)
            json_array_append_new(tests, test_json(&result));
        else
            print_test(&result);
    }
    return status;
}

static json_t *begin_device(const skg_device_info *info, int json) {
    if (!json) {
        printf("%d:%d  %s (%s, driver %s)\n", info->platform, info->device, info->name, info->platform_name,
               info->driver);
        return NULL;
    }
    char number[32];
    json_t *object = json_object();
    snprintf(number, sizeof number, "%d:%d", info->platform, info->device);
    json_object_set_new(object, "device", cli_json_text(number));
    json_object_set_new(object, "name", cli_json_text(info->name));
    json_object_set_new(object, "platform", cli_json_text(info->platform_name));
    json_object_set_new(object, "driver", cli_json_text(info->driver));
    json_object_set_new(object, "tests", json_array());
    return object;
}

int cli_device_tests(int json) {
    int64_t count = 0;
    int bad = 0;
    json_t *list = json ? json_array() : NULL;
    cli_prepare_environment();
    skg_status status = skg_device_count(&count);
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        skg_device_info info;
        skg_device_info_init(&info);
        status = skg_device_get(k, &info);
        if (status != SKG_OK) break;
        json_t *object = begin_device(&info, json);
        status = test_device(k, object ? json_object_get(object, "tests") : NULL, &bad);
        if (object) json_array_append_new(list, object);
    }
    if (status != SKG_OK) {
        json_decref(list);
        return cli_fail(status);
    }
    if (json) {
        json_t *object = json_object();
        json_object_set_new(object, "devices", list);
        const int printed = cli_json_print(object);
        if (printed != CLI_DONE) return printed;
    }
    return bad ? CLI_CHECK_FAILED : CLI_DONE;
}
