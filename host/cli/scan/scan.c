/* The verb `scan`: projections of a scene from all around. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/say.h"
#include "core/text.h"
#include "scan/steps.h"
#include "session/explain.h"

#include <inttypes.h>
#include <stdio.h>

static int print(const cli_arguments *arguments, const cli_acquisition *a) {
    const double rate = a->seconds > 0 ? (double)a->computed / a->seconds : 0;
    const int64_t there = a->found + a->computed;
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "projections", json_integer(a->projections));
        json_object_set_new(object, "computed", json_integer(a->computed));
        json_object_set_new(object, "found", json_integer(a->found));
        json_object_set_new(object, "finished", json_boolean(there == a->projections));
        json_object_set_new(object, "plan_ms", cli_json_number(a->plan_ms));
        json_object_set_new(object, "seconds", cli_json_number(a->seconds));
        json_object_set_new(object, "projections_per_s", cli_json_number(rate));
        json_object_set_new(object, "hash", cli_json_text(a->hash));
        json_object_set_new(object, "file", cli_json_text(a->place));
        json_object_set_new(object, "plan", cli_explain_json(a->plan, &a->session));
        return cli_json_print(object);
    }
    if (cli_is_quiet()) return CLI_DONE;
    if (a->found == a->projections) {
        cli_print("%s is finished: it has %s%" PRId64 " %s\n", a->place,
                  a->projections == 1 ? "its " : "all ", a->projections,
                  skg_plural(a->projections, "projection", "projections"));
        return CLI_DONE;
    }
    cli_print("%" PRId64 " %s in %.1f s, %.3g per second; %s has %" PRId64 " of %" PRId64 "\n", a->computed,
              skg_plural(a->computed, "projection", "projections"), a->seconds, rate, a->place, there,
              a->projections);
    return CLI_DONE;
}

int cli_scan(const cli_arguments *arguments) {
    cli_acquisition a = {0};
    int exit_status = acquisition_read_flags(arguments, &a);
    if (exit_status == CLI_DONE) exit_status = ranks_open(&a.ranks);
    if (exit_status == CLI_DONE) exit_status = acquisition_open(arguments, &a);
    const int verifies = cli_given(arguments, "--verify");
    if (exit_status == CLI_DONE)
        exit_status = verifies ? verify_run(arguments, &a) : acquisition_run(arguments, &a);
    if (exit_status == CLI_DONE && !verifies && a.ranks.rank == 0) exit_status = print(arguments, &a);
    acquisition_close(&a);
    ranks_close(&a.ranks);
    if (exit_status == CLI_DONE && a.is_stopped) cli_end_by_signal();
    return exit_status;
}
