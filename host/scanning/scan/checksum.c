/* Checksums of finished projections. They stand beside the progress, and are written before the byte that says "finished":
 * a writer that ends in between leaves a projection that is computed again. */
#include "scan/format.h"

#include "core/crc.h"
#include "core/text.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <unistd.h>

skg_status skg_scan_read_at(const skg_scan_file *file, void *to, int64_t count, int64_t at) {
    char *bytes = to;
    while (count > 0) {
        const ssize_t got = pread(file->data, bytes, (size_t)count, (off_t)at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            return skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s", file->path,
                            got < 0 ? strerror(errno) : "it ends");
        bytes += got, at += got, count -= got;
    }
    return SKG_OK;
}

void skg_scan_checksums_read(skg_scan_file *file) {
    const size_t bytes = (size_t)file->projections * sizeof *file->checksums;
    if (!file->checksum_at ||
        pread(file->progress, file->checksums, bytes, (off_t)file->checksum_at) != (ssize_t)bytes)
        file->checksum_at = 0; /* a file of an earlier build */
}

skg_status skg_scan_checksum_write(skg_scan_file *file, int64_t at, const void *image) {
    if (!file->checksum_at) return SKG_OK;
    file->checksums[at] = skg_crc32c(image, (size_t)file->bytes);
    return skg_scan_write_at(file->path, file->progress, &file->checksums[at], sizeof *file->checksums,
                             file->checksum_at + at * (int64_t)sizeof *file->checksums);
}

int skg_scan_checksum_fits(const skg_scan_file *file, int64_t at, const void *image) {
    return !file->checksum_at || file->checksums[at] == skg_crc32c(image, (size_t)file->bytes);
}

static skg_status verify(skg_scan_file *file, void *image) {
    static const char zero = 0;
    for (int64_t k = 0; k < file->projections; k++) {
        if (file->done[k] != 1) continue;
        SKG_TRY(skg_scan_read_at(file, image, file->bytes, file->data_at + k * file->bytes));
        if (skg_scan_checksum_fits(file, k, image)) continue;
        SKG_TRY(skg_scan_write_at(file->path, file->progress, &zero, 1, file->done_at + k));
        file->done[k] = 0;
        file->done_count--;
        file->damaged++;
    }
    return SKG_OK;
}

skg_status skg_scan_file_verify(skg_scan_file *file) {
    SKG_PLAIN;
    void *image = NULL;
    SKG_NEEDS(file);
    if (file->data < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: a folder has no checksums; scan to an .h5", file->path);
    if (file->progress < 0 || !file->checksum_at)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s: has no checksums; they go with FILE.progress when such a file is finished, and an .h5 "
            "keeps them",
            file->path);
    skg_scan_checksums_read(file); /* other processes may have written */
    SKG_TRY(skg_alloc(file->bytes, 1, "projection", &image));
    const skg_status status = verify(file, image);
    skg_free(&image);
    return status;
}

skg_status skg_scan_file_damaged_count(const skg_scan_file *file, int64_t *count) {
    SKG_NEEDS(file);
    SKG_NEEDS(count);
    *count = file->damaged;
    return SKG_OK;
}
