/* Prints the self-tests of devices, for `devices --test`. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/environment.h"
#include "common/probe.h"
#include "common/say.h"

#include <skiagraph/skiagraph.h>

#include <stdio.h>
#include <string.h>

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

/* Takes the result of a test. *bad: 1 if it is wrong or failed. tests: NULL for the table. */
static void take(const skg_device_test *result, json_t *tests, int *bad) {
    if (result->verdict == SKG_TEST_WRONG || result->verdict == SKG_TEST_FAILED) *bad = 1;
    if (tests)
        json_array_append_new(tests, test_json(result));
    else
        print_test(result);
}

/* The driver has ended or blocked the child during a test. That is kept if the platform is not known; on a known one the machine
 * may have been busy, and its verdict is found by the next process that needs it. */
static void take_loss(const skg_device_info *info, int64_t test, const char *ended, json_t *tests, int *bad) {
    char words[64];
    const char *name = "?";
    skg_device_test result;
    skg_device_test_init(&result);
    result.verdict = SKG_TEST_FAILED;
    skg_device_test_name_get(test, &name);
    snprintf(result.name, sizeof result.name, "%s", name);
    snprintf(result.reason, sizeof result.reason, "%s", ended);
    snprintf(words, sizeof words, "device=%d:%d", info->platform, info->device);
    if (!info->known) skg_device_test_keep(words, test, &result);
    take(&result, tests, bad);
}

/* All tests of one device, in a child. If the driver ends it, the next test is the first of another child, unless it was test 0,
 * without which no plan is made. */
static int test_device(const char *config, int64_t device, const skg_device_info *info, json_t *tests,
                       int *bad) {
    int64_t count = 0, test = 0;
    const skg_status status = skg_device_test_count(&count);
    if (status != SKG_OK) return cli_fail(status);
    while (test < count) {
        cli_probe probe;
        cli_probe_answer answer = {0};
        const int reason = cli_probe_test(config, device, test, &probe);
        if (reason)
            return cli_error(CLI_DEVICE, "no process can be started that tests a device: %s",
                             strerror(reason));
        while (test < count && cli_probe_next(&probe, &answer) && answer.kind == CLI_PROBE_RESULT) {
            take(&answer.result, tests, bad);
            test++;
        }
        cli_probe_end(&probe);
        if (answer.kind == CLI_PROBE_REFUSED)
            return cli_error(cli_exit_status(answer.status), "%s", answer.sentence);
        if (test == count) break;
        take_loss(info, test, probe.ended, tests, bad);
        if (test++ == 0) break;
    }
    return CLI_DONE;
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

int cli_device_tests(const char *config, int json) {
    int64_t count = 0;
    int bad = 0;
    json_t *list = json ? json_array() : NULL;
    cli_prepare_environment();
    int exit_status = cli_probe_all(config, &count);
    for (int64_t k = 0; k < count && exit_status == CLI_DONE; k++) {
        skg_device_info info;
        skg_device_info_init(&info);
        const skg_status status = skg_device_get(k, &info);
        json_t *object = status == SKG_OK ? begin_device(&info, json) : NULL;
        exit_status = status == SKG_OK ? test_device(config, k, &info,
                                                     object ? json_object_get(object, "tests") : NULL, &bad)
                                       : cli_fail(status);
        if (object) json_array_append_new(list, object);
    }
    if (exit_status != CLI_DONE) {
        json_decref(list);
        return exit_status;
    }
    if (json) {
        json_t *object = json_object();
        json_object_set_new(object, "devices", list);
        const int printed = cli_json_print(object);
        if (printed != CLI_DONE) return printed;
    }
    return bad ? CLI_CHECK_FAILED : CLI_DONE;
}
