/* A scan by the ranks of MPI, which write one file. */
#include "scan/steps.h"

#include "common/progress.h"
#include "common/say.h"

#include <stdlib.h>
#include <string.h>

enum { WINDOWS_PER_RANK = 8, WINDOW_MAX = 64 }; /* several batches: rank 0 answers after each of its own */

/* Projections of this rank. */
typedef struct {
    skg_scan_run *run;
    int64_t taken, window; /* projections that it took; how many at least are on the way */
    int is_exhausted;
} share;

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
    if (SKG_FAILED(status)) return cli_fail(status);
    uint64_t first = bits[0];
    ranks_share(&a->ranks, &first, sizeof first);
    if (first == bits[0] || cli_given(arguments, "--mixed")) return CLI_DONE;
    return cli_error(
        CLI_DEVICE,
        "rank %d: %s gives other bits than the device of rank 0; choose like devices, or allow this with "
        "--mixed",
        a->ranks.rank, a->session.device.name);
}

/* Takes numbers until `window` projections are on the way, and hands them to the run, which begins with the first. */
static skg_status fill(cli_acquisition *a, const int64_t *list, share *s) {
    skg_scan_run_options options = a->options;
    while (!s->is_exhausted && s->taken - a->computed < s->window) {
        int64_t first = 0, count = 0;
        if (!ranks_take(&a->ranks, s->taken == a->computed, &first, &count)) return SKG_OK;
        s->is_exhausted = count == 0;
        s->taken += count;
        if (count == 0) return SKG_OK;
        options.from = options.to = 0;
        options.only = list + first;
        options.only_count = count;
        const skg_status status = s->run ? skg_scan_run_add(s->run, count, list + first)
                                         : skg_scan_run_create(a->plan, a->scan, &options, &s->run);
        if (status != SKG_OK) return status;
    }
    return SKG_OK;
}

static int take_share(cli_acquisition *a, const int64_t *list, int64_t missing) {
    const int64_t even = missing / ((int64_t)WINDOWS_PER_RANK * a->ranks.count);
    share s = {.window = even < 1 ? 1 : even < WINDOW_MAX ? even : WINDOW_MAX};
    int64_t count = 1;
    a->ranks.total = missing;
    if (a->ranks.rank == 0) cli_progress_begin("projections", missing);
    skg_status status = fill(a, list, &s);
    while (status == SKG_OK && s.run && count > 0) {
        status = write_batch(a, s.run, &count);
        ranks_serve(&a->ranks, 0);
        if (status == SKG_OK) status = fill(a, list, &s);
        if (a->ranks.rank == 0) cli_progress_step(a->ranks.next - (s.taken - a->computed));
    }
    skg_scan_run_release(&s.run);
    if (status == SKG_OK) ranks_serve(&a->ranks, 1);
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
        exit_status = take_share(a, list, missing);
        if (exit_status != CLI_DONE) ranks_abort(&a->ranks, exit_status);
        exit_status = ranks_agree(&a->ranks, exit_status);
    }
    a->seconds = 1e-3 * (cli_now_ms() - start);
    a->computed = ranks_sum(&a->ranks, a->computed);
    a->clipped = ranks_sum(&a->ranks, a->clipped);
    free(list);
    return exit_status;
}
