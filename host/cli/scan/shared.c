#include "scan/shared.h"

#include "common/progress.h"
#include "common/say.h"
#include "scan/batches.h"

#include <stdlib.h>
#include <string.h>

enum { GROUPS_PER_RANK = 8, GROUP_MOST = 64 };

/* The projections that the output lacks; the same on every rank, because nobody writes yet. */
static int64_t *list_missing(const cli_acquisition *a, int64_t *count) {
    const skg_scan_run_options *o = &a->options;
    const int64_t to = o->to > 0 ? o->to : a->projections,
                  all = o->only_count > 0 ? o->only_count : to - o->from;
    int64_t *list = calloc((size_t)(all > 0 ? all : 0) + 1, sizeof *list);
    *count = 0;
    for (int64_t i = 0; list && i < all; i++) {
        const int64_t index = o->only_count > 0 ? o->only[i] : o->from + i;
        int32_t done = 1;
        if (skg_scan_file_done_get(a->file, index, &done) == SKG_OK && !done) list[(*count)++] = index;
    }
    return list;
}

/* 64 bits of an image (FNV-1a). */
static skg_status add_bits(const skg_scan_batch *batch, void *user) {
    uint64_t *bits = user;
    const unsigned char *at = batch->images;
    const size_t bytes = ((const size_t *)user)[1];
    for (size_t i = 0; i < bytes; i++) *bits = (*bits ^ at[i]) * 0x100000001b3u;
    return SKG_OK;
}

/* Every device has to give the bits of the first rank's, so that the output does not depend on who computes what. */
static int compare_devices(const cli_arguments *arguments, cli_acquisition *a, int64_t index) {
    const skg_view *view = &a->session.view;
    skg_scan_run_options options = a->options;
    uint64_t bits[2] = {0xcbf29ce484222325u,
                        (uint64_t)(view->columns * view->rows) * (options.type == SKG_TYPE_FLOAT64 ? 8 : 4)};
    options.from = index;
    options.to = index + 1;
    options.only_count = 0;
    const skg_status status = skg_scan_run_each(a->plan, a->scan, &options, add_bits, bits);
    if (status < SKG_OK) return cli_fail(status);
    uint64_t first = bits[0];
    ranks_share(&a->ranks, &first, sizeof first);
    if (first == bits[0] || cli_given(arguments, &cli_flag_scan_mixed)) return CLI_DONE;
    return cli_error(
        CLI_DEVICE,
        "rank %d: %s gives other bits than the device of rank 0; choose like devices, or allow this with "
        "--mixed",
        a->ranks.rank, a->session.device.name);
}

static skg_status write_group(cli_acquisition *a, const int64_t *list, int64_t count) {
    skg_scan_run *run = NULL;
    skg_scan_run_options options = a->options;
    options.from = options.to = 0;
    options.only = list;
    options.only_count = count;
    skg_status status = skg_scan_run_create(a->plan, a->scan, &options, &run);
    if (status == SKG_OK) status = write_batches(a, run, 0);
    skg_scan_run_release(&run);
    return status;
}

static int take_groups(cli_acquisition *a, const int64_t *list, int64_t missing) {
    const int64_t even = missing / ((int64_t)GROUPS_PER_RANK * a->ranks.count);
    const int64_t group = even < 1 ? 1 : even < GROUP_MOST ? even : GROUP_MOST;
    int exit_status = CLI_DONE;
    if (a->ranks.rank == 0) cli_progress_begin("projections", missing);
    for (;;) {
        const int64_t first = ranks_take(&a->ranks, group), left = missing - first;
        if (left <= 0) break;
        const skg_status status = write_group(a, list + first, left < group ? left : group);
        if (status != SKG_OK) exit_status = cli_fail(status);
        if (status != SKG_OK) break;
        if (a->ranks.rank == 0) cli_progress_step(first);
    }
    if (a->ranks.rank == 0) cli_progress_end();
    return exit_status;
}

int shared_run(const cli_arguments *arguments, cli_acquisition *a) {
    int64_t missing = 0;
    int64_t *list = list_missing(a, &missing);
    int exit_status = list ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
    exit_status = ranks_agree(&a->ranks, exit_status);
    if (exit_status == CLI_DONE && missing > 0) exit_status = compare_devices(arguments, a, list[0]);
    exit_status = ranks_agree(&a->ranks, exit_status);
    const double start = cli_now_ms();
    if (exit_status == CLI_DONE) {
        exit_status = take_groups(a, list, missing);
        if (exit_status != CLI_DONE) ranks_abort(&a->ranks, exit_status);
        exit_status = ranks_agree(&a->ranks, exit_status);
    }
    a->seconds = 1e-3 * (cli_now_ms() - start);
    a->computed = ranks_sum(&a->ranks, a->computed);
    free(list);
    return exit_status;
}
