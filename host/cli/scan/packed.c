/* A finished .h5 again, compressed. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/say.h"

static int is_hdf5(const char *path) {
    return cli_has_extension(path, ".h5") || cli_has_extension(path, ".hdf5");
}

int packed_read_flags(const cli_arguments *arguments, cli_acquisition *a) {
    const char *to = cli_value(arguments, "--packed");
    if (!to && cli_given(arguments, "--packed-grey16"))
        return cli_error(CLI_USAGE, "--packed-grey16 says how --packed FILE is written; add it");
    if (!to) return CLI_DONE;
    if (cli_given(arguments, "--shard"))
        return cli_error(CLI_USAGE, "--packed writes a whole scan; give it with --join, not with --shard");
    if (!is_hdf5(to) || !(is_hdf5(a->place) || cli_has_extension(a->place, ".nxs")))
        return cli_error(CLI_USAGE, "--packed %s: a scan that is an .h5 is packed to another .h5", to);
    const skg_status status = skg_scan_file_path_check(to);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int packed_write(const cli_arguments *arguments, const cli_acquisition *a) {
    const char *to = cli_value(arguments, "--packed");
    skg_scan_pack_options options;
    int64_t done = 0;
    skg_scan_pack_options_init(&options);
    options.grey16 = cli_given(arguments, "--packed-grey16");
    if (!to) return CLI_DONE;
    skg_status status = skg_scan_file_done_count(a->file, &done);
    if (status == SKG_OK && done < a->projections) {
        cli_log(SKG_LOG_NOTE, "the scan is not finished; --packed waits for its last projection", NULL);
        return CLI_DONE;
    }
    if (status == SKG_OK) status = skg_scan_file_pack(a->place, to, &options);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}
