/* Projections sorted by phases of the breath. */
#include "scan/steps.h"

#include "common/say.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PHASES_MAX = 100 };

int phases_read_flag(const cli_arguments *arguments, cli_acquisition *a) {
    const int exit_status = cli_integer(arguments, "--phases", 1, PHASES_MAX, &a->phases);
    if (exit_status != CLI_DONE || a->phases == 0) return exit_status;
    if (!cli_given(arguments, "--breathing"))
        return cli_error(CLI_USAGE, "--phases sorts a scan of a breathing scene; add --breathing");
    if (cli_given(arguments, "--shard"))
        return cli_error(CLI_USAGE, "--phases sorts a whole scan; give it with --join, not with --shard");
    const char *slash = strrchr(a->place, '/'), *dot = strrchr(slash ? slash : a->place, '.');
    if (!dot || !dot[1])
        return cli_error(CLI_USAGE, "%s: phases are files; give an output with an extension, such as .h5",
                         a->place);
    return CLI_DONE;
}

/* The phase of each projection in the middle of its exposure. */
static skg_status find_phases(const cli_acquisition *a, double *phases) {
    for (int64_t k = 0; k < a->projections; k++) {
        skg_motion_state state;
        double time = 0;
        skg_motion_state_init(&state);
        skg_status status = skg_scan_time_get(a->scan, k, &time, NULL);
        if (status == SKG_OK) status = skg_motion_pose_at_time(a->motion, time);
        if (status == SKG_OK) status = skg_motion_state_get(a->motion, &state);
        if (status != SKG_OK) return status;
        phases[k] = state.phase;
    }
    return SKG_OK;
}

/* Phase K of N is centred at (K - 1) / N of the breath, so that the first one is end-inspiration. */
static int64_t bin_of(double phase, int64_t bins) {
    return (int64_t)floor(phase * (double)bins + 0.5) % bins;
}

/* "scan.phase-2-of-8.h5" for "scan.h5"; NULL: no memory. */
static char *phase_path(const char *place, int64_t bin, int64_t bins) {
    const char *dot = strrchr(place, '.');
    const size_t size = strlen(place) + 64;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%.*s.phase-%" PRId64 "-of-%" PRId64 "%s", (int)(dot - place), place, bin + 1,
                 bins, dot);
    return path;
}

/* Copies the projections of one phase into a file of their own, which replaces an earlier one. */
static skg_status write_phase(cli_acquisition *a, const char *path, int64_t bin, int64_t count,
                              const int64_t *indices, const double *phases) {
    skg_scan_file_options options;
    skg_scan_file *file = NULL;
    skg_scan *subset = NULL;
    char hash[65];
    skg_scan *const known = a->record.known ? a->record.known : a->scan;
    snprintf(hash, sizeof hash, "%.48s%08" PRIx32 "%08" PRIx32, a->hash, (uint32_t)bin, (uint32_t)a->phases);
    skg_status status = skg_scan_create_subset(known, count, indices, &subset);
    if (status == SKG_OK) {
        options = a->file_options;
        options.scan = subset;
        options.hash = hash;
        options.from = options.count = 0;
        options.overwrite = 1;
        status = skg_scan_file_open(path, &options, &file);
    }
    if (status == SKG_OK) status = skg_scan_file_copy(file, a->file, count, indices, phases);
    if (status == SKG_OK) status = skg_scan_file_finish(file);
    skg_scan_file_release(&file);
    skg_scan_release(&subset);
    return status;
}

static skg_status write_bin(cli_acquisition *a, int64_t bin, const double *all, int64_t *indices,
                            double *phases) {
    int64_t count = 0;
    for (int64_t k = 0; k < a->projections; k++)
        if (bin_of(all[k], a->phases) == bin) phases[count] = all[k], indices[count++] = k;
    char *path = phase_path(a->place, bin, a->phases);
    if (!path) return SKG_ERR_MEMORY;
    skg_status status = SKG_OK;
    if (count > 0) status = write_phase(a, path, bin, count, indices, phases);
    if (count == 0) {
        char sentence[4352];
        snprintf(sentence, sizeof sentence,
                 "phase %" PRId64 " of %" PRId64 " has no projection; %.4096s is not written", bin + 1,
                 a->phases, path);
        cli_log(SKG_LOG_WARNING, sentence, NULL);
    } else if (status == SKG_OK) {
        cli_tell("%s has %" PRId64 " %s", path, count, skg_plural(count, "projection", "projections"));
    }
    free(path);
    return status;
}

int phases_write(cli_acquisition *a) {
    const size_t count = (size_t)a->projections;
    double *all = calloc(count, sizeof *all), *phases = calloc(count, sizeof *phases);
    int64_t *indices = calloc(count, sizeof *indices), done = 0;
    skg_status status = all && phases && indices ? SKG_OK : SKG_ERR_MEMORY;
    if (status == SKG_OK) status = skg_scan_file_done_count(a->file, &done);
    /* A scan of which only some projections were asked for is sorted when it is whole. */
    if (status == SKG_OK && done == a->projections) status = find_phases(a, all);
    for (int64_t bin = 0; bin < a->phases && status == SKG_OK && done == a->projections; bin++)
        status = write_bin(a, bin, all, indices, phases);
    free(all);
    free(phases);
    free(indices);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}
