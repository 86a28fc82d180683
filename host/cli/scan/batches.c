/* Runs a scan in batches, each written while the next is computed. */
#include "scan/steps.h"

#include "common/progress.h"
#include "session/frames.h"

skg_status write_batch(cli_acquisition *a, skg_scan_run *run, int64_t *count) {
    const void *images = NULL;
    skg_scan_batch batch;
    skg_scan_batch_init(&batch);
    *count = 0;
    skg_status status = skg_scan_run_next(run, &batch);
    if (status == SKG_RANGE) cli_end_image(status, &a->range_warned);
    if (SKG_FAILED(status)) return status;
    if (batch.count == 0) return SKG_OK;
    status = grey_batch(a, &batch, &images);
    if (status == SKG_OK)
        status = skg_scan_file_write(a->file, batch.count, batch.indices, images, batch.phases);
    if (status != SKG_OK) return status;
    *count = batch.count;
    a->computed += batch.count;
    return SKG_OK;
}

skg_status write_batches(cli_acquisition *a, skg_scan_run *run, double begun_ms) {
    int64_t count = 1;
    skg_status status = SKG_OK;
    cli_progress_follow("projections");
    while (status == SKG_OK && count > 0) status = write_batch(a, run, &count);
    cli_progress_end();
    a->is_stopped = status == SKG_ERR_CANCELLED;
    if (a->is_stopped) status = SKG_OK;
    a->seconds = 1e-3 * (cli_now_ms() - begun_ms);
    return status;
}
