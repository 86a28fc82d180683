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

/* The projections that are missing, and how many a rank takes at a time. */
typedef struct {
    const int64_t *list;
    int64_t missing, group, first;
} groups;

/* Takes the next group and starts it. *run is NULL if there is none left. */
static skg_status start_group(cli_acquisition *a, groups *g, skg_scan_run **run) {
    skg_scan_run_options options = a->options;
    *run = NULL;
    g->first = ranks_take(&a->ranks, g->group);
    const int64_t left = g->missing - g->first;
    if (left <= 0) return SKG_OK;
    options.from = options.to = 0;
    options.only = g->list + g->first;
    options.only_count = left < g->group ? left : g->group;
    return skg_scan_run_create(a->plan, a->scan, &options, run);
}

/* The next group is started before this one is written, so that the device has work meanwhile. */
static int take_groups(cli_acquisition *a, const int64_t *list, int64_t missing) {
    const int64_t even = missing / ((int64_t)GROUPS_PER_RANK * a->ranks.count);
    groups g = {.list = list,
                .missing = missing,
                .group = even < 1            ? 1
                         : even < GROUP_MOST ? even
                                             : GROUP_MOST};
    skg_scan_run *run = NULL, *next = NULL;
    if (a->ranks.rank == 0) cli_progress_begin("projections", missing);
    skg_status status = start_group(a, &g, &run);
    while (status == SKG_OK && run) {
        const int64_t first = g.first;
        status = start_group(a, &g, &next);
        if (status == SKG_OK) status = write_batches(a, run, 0);
        skg_scan_run_release(&run);
        run = next;
        next = NULL;
        if (status == SKG_OK && a->ranks.rank == 0) cli_progress_step(first);
    }
    skg_scan_run_release(&run);
    if (a->ranks.rank == 0) cli_progress_end();
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
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
