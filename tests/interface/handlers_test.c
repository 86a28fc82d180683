/* The error handler hears once of each call that takes a context, a plan or a job and fails, but for the exceptions that context.h
 * names. The calls are those of the list of the interface: a function that is added later is among them. */
#include "interface/handlers.h"
#include "suite.h"
#include "support/run.h"

#include <string.h>

enum { SIDE = 8 };

static int heard;
static skg_status last;

static void hear(skg_status status, const char *sentence, void *user) {
    (void)user;
    heard++;
    last = status;
    ck_assert_str_eq(sentence, skg_last_error());
}

static int ends_with(const char *name, const char *end) {
    return strlen(name) > strlen(end) && strcmp(name + strlen(name) - strlen(end), end) == 0;
}

/* The exceptions of skg_context_error_set. */
static int is_silent(const char *name) {
    return ends_with(name, "_get") || ends_with(name, "_count") || strcmp(name, "skg_context_log_set") == 0 ||
           strcmp(name, "skg_context_error_set") == 0 || strcmp(name, "skg_job_cancel") == 0 ||
           strcmp(name, "skg_scan_run_each") == 0;
}

START_TEST(every_failure_is_heard_once) {
    static float pixels[SIDE * SIDE];
    const skg_view view = run_view(SIDE, 10);
    solid s = solid_blob(60, 40, 20, 1);
    skg_scene *scene = run_scene(&s, NULL);
    handles h = {.context = run_context, .plan = run_plan(scene, &view, (run_choice){0})};
    skg_output output;
    int failures = 0, silent = 0;
    solid_free(&s);
    skg_output_init(&output);
    output.data = pixels;
    ck_skg(skg_plan_submit(h.plan, 1, NULL, 1, &output, &h.job));
    for (const bare_call *c = bare_calls; c->name; c++) {
        ck_skg(skg_context_error_set(run_context, hear, NULL)); /* the call of this setter takes it away */
        heard = 0;
        const skg_status status = c->call(&h);
        if (!SKG_FAILED(status)) ck_assert_msg(heard == 0, "%s succeeds, and is heard", c->name);
        if (!SKG_FAILED(status)) continue;
        failures++;
        silent += is_silent(c->name);
        ck_assert_msg(heard == !is_silent(c->name), "%s fails, and is heard %d times", c->name, heard);
        if (heard) ck_assert_int_eq(last, status);
    }
    ck_assert_int_gt(failures - silent, 30);
    ck_assert_int_gt(silent, 10);
    skg_job_release(&h.job);
    skg_plan_release(&h.plan);
    skg_scene_release(&scene);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, every_failure_is_heard_once);
}

SKG_SUITE_MAIN("handlers", add_tests)
