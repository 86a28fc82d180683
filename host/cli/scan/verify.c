/* Checks files of a scan against their checksums. */
#include "scan/steps.h"

#include "common/encode.h"
#include "common/say.h"
#include "core/text.h"

#include <inttypes.h>
#include <stdio.h>

int verify_check(const cli_arguments *arguments, const cli_acquisition *a, int64_t samples) {
    if (samples > 0 || !cli_given(arguments, "--verify")) return CLI_DONE;
    return cli_error(CLI_INPUT, "%s: there is no output of this scan to verify", a->place);
}

void verify_note(const cli_acquisition *a) {
    int64_t damaged = 0;
    if (skg_scan_file_damaged_count(a->file, &damaged) == SKG_OK && damaged > 0)
        cli_warn("%s: %" PRId64 " of its projections did not fit their checksums; they are computed again",
                 a->place, damaged);
}

int verify_run(const cli_arguments *arguments, cli_acquisition *a) {
    int64_t damaged = 0, there = 0;
    skg_status status = skg_scan_file_verify(a->file);
    if (status == SKG_OK) status = skg_scan_file_damaged_count(a->file, &damaged);
    if (status == SKG_OK) status = skg_scan_file_done_count(a->file, &there);
    if (status != SKG_OK) return cli_fail(status);
    const int64_t missing = a->projections - there - damaged;
    if (cli_given(arguments, "--json")) {
        const int exit_status = cli_json_print(json_pack(
            "{s:I,s:I,s:I,s:I,s:s}", "projections", (json_int_t)a->projections, "intact", (json_int_t)there,
            "damaged", (json_int_t)damaged, "missing", (json_int_t)missing, "file", a->place));
        if (exit_status != CLI_DONE) return exit_status;
    } else if (!cli_is_quiet()) {
        cli_print("%s: %" PRId64 " of %" PRId64 " %s their checksums, %" PRId64 " %s damaged, %" PRId64
                  " %s missing\n",
                  a->place, there, a->projections,
                  skg_plural(a->projections, "projection fits", "projections fit"), damaged,
                  skg_plural(damaged, "is", "are"), missing, skg_plural(missing, "is", "are"));
    }
    return there == a->projections ? CLI_DONE : CLI_CHECK_FAILED;
}
