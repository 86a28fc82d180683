#include "scan/batches.h"

#include "common/progress.h"
#include "scan/grey.h"
#include "session/frames.h"

skg_status write_batches(cli_acquisition *a, skg_scan_run *run, int shows_progress) {
    const double start = cli_now_ms();
    int64_t all = 0;
    skg_status status = skg_scan_run_projection_count(run, &all);
    if (shows_progress) cli_progress_begin("projections", all);
    while (status >= SKG_OK) {
        skg_scan_batch batch;
        skg_scan_batch_init(&batch);
        status = skg_scan_run_next(run, &batch);
        if (status == SKG_RANGE) cli_end_image(status, &a->range_warned);
        if (status < SKG_OK || batch.count == 0) break;
        const void *images = NULL;
        status = grey_batch(a, &batch, &images);
        if (status == SKG_OK)
            status = skg_scan_file_write(a->file, batch.count, batch.indices, images, batch.phases);
        a->computed += batch.count;
        if (shows_progress) cli_progress_step(a->computed);
    }
    if (shows_progress) cli_progress_end();
    a->seconds = 1e-3 * (cli_now_ms() - start);
    return status == SKG_RANGE ? SKG_OK : status;
}
