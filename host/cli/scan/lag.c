/* The lag of a scan's grey values: projections in their order, from a detector at rest. */
#include "scan/steps.h"

#include "common/say.h"

#include <stdlib.h>

/* 1: a projection depends on those before it. */
static int has_past(const cli_acquisition *a) {
    return a->is_grey && (a->readout.lag_count > 0 || a->readout.ghosting_count > 0);
}

static const char *name_of(const cli_acquisition *a) {
    return a->readout.lag_count > 0 ? "Lag" : "Ghosting";
}

int lag_check(const cli_arguments *arguments, const cli_acquisition *a) {
    const char *what = NULL;
    if (!has_past(a)) return CLI_DONE;
    if (cli_given(arguments, "--shard") || cli_given(arguments, "--join")) what = "shards";
    if (cli_given(arguments, "--only")) what = "--only";
    if (a->options.from > 0) what = "--from";
    if (a->ranks.count > 1) what = "several processes (MPI)";
    if (!what) return CLI_DONE;
    return cli_error(
        CLI_USAGE,
        "%s: the detector has %s, so that each projection needs all before it; compute the scan in one run from its "
        "first projection on, or leave out GreyValues.%s",
        what, name_of(a), name_of(a));
}

int lag_open(cli_acquisition *a) {
    if (!has_past(a) || a->found == a->projections) return CLI_DONE;
    if (a->found > 0)
        return cli_error(
            CLI_USAGE,
            "%s: the detector has %s, and what it held when the scan was stopped is not known; remove the output and "
            "begin anew",
            a->place, name_of(a));
    const int64_t pixels = a->session.view.columns * a->session.view.rows;
    a->lagged = malloc((size_t)pixels * sizeof(double));
    if (!a->lagged) return cli_error(CLI_DEVICE, "out of host memory");
    skg_status status = skg_lag_create(pixels, a->readout.lag_count, a->readout.lag, &a->lag);
    if (status == SKG_OK && a->readout.ghosting_count > 0)
        status =
            skg_lag_ghosting_set(a->lag, a->readout.full_kev, a->readout.ghosting_count, a->readout.ghosting);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

void lag_close(cli_acquisition *a) {
    skg_lag_release(&a->lag);
    free(a->lagged);
}
