/* Projections of one file copied into another: of shards into the whole, and of the whole into phases. */
#include "scan/format.h"

#include "core/text.h"

#include <inttypes.h>
#include <math.h>

skg_status skg_scan_file_join(skg_scan_file *file, const skg_scan_file *part) {
    SKG_PLAIN;
    char *image = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(file);
    SKG_NEEDS(part);
    if (part->data < 0 || file->data < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: folders are not joined; write their projections to one folder", part->path);
    SKG_TRY(skg_scan_file_check_index(file, part->first));
    SKG_TRY(skg_scan_file_check_index(file, part->first + part->projections - 1));
    if (part->bytes != file->bytes || part->options.samples != file->options.samples)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: has another type or number of source samples than %s",
                        part->path, file->path);
    SKG_TRY(skg_alloc(file->bytes, 1, "projection", &image));
    for (int64_t k = 0; k < part->projections && status == SKG_OK; k++) {
        const int64_t index = part->first + k;
        double phase = (double)NAN;
        if (part->done[k] != 1 || file->done[index - file->first] == 1) continue;
        status = skg_scan_read_at(part, image, part->bytes, part->data_at + k * part->bytes);
        if (status == SKG_OK && !skg_scan_checksum_fits(part, k, image))
            continue; /* damaged: computed again */
        if (status == SKG_OK && part->phase_at)
            status = skg_scan_read_at(part, &phase, sizeof phase, part->phase_at + k * (int64_t)sizeof phase);
        if (status == SKG_OK) status = skg_scan_file_write(file, 1, &index, image, &phase);
    }
    skg_free(&image);
    return status;
}

/* Flat or dark fields of both, if they have as many. */
static skg_status copy_fields(const skg_scan_file *to, int64_t to_at, int64_t to_count,
                              const skg_scan_file *from, int64_t from_at, int64_t from_count, char *image) {
    if (!to_at || !from_at || to_count != from_count) return SKG_OK;
    for (int64_t f = 0; f < to_count; f++) {
        SKG_TRY(skg_scan_read_at(from, image, from->bytes, from_at + f * from->bytes));
        SKG_TRY(skg_scan_write_at(to->path, to->data, image, to->bytes, to_at + f * to->bytes));
    }
    return SKG_OK;
}

static skg_status read_projection(const skg_scan_file *from, int64_t index, void *image) {
    const int64_t k = index - from->first;
    SKG_TRY(skg_scan_read_at(from, image, from->bytes, from->data_at + k * from->bytes));
    if (skg_scan_checksum_fits(from, k, image)) return SKG_OK;
    return skg_fail(SKG_ERR_FILE, "%s: projection %" PRId64 " is damaged; verify the scan first", from->path,
                    index);
}

static skg_status check_finished(const skg_scan_file *from, int64_t index) {
    SKG_TRY(skg_scan_file_check_index(from, index));
    if (from->done[index - from->first] == 1) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: projection %" PRId64 " is not finished", from->path, index);
}

static skg_status check_copy(const skg_scan_file *file, const skg_scan_file *from, int64_t count,
                             const int64_t *indices) {
    if (from->data < 0 || file->data < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: of folders nothing is copied; write one file", from->path);
    if (from->bytes != file->bytes || count != file->projections)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: has another type or number of projections than what is copied",
                        file->path);
    for (int64_t k = 0; k < count; k++) SKG_TRY(check_finished(from, indices[k]));
    return SKG_OK;
}

skg_status skg_scan_file_read(const skg_scan_file *file, int64_t index, void *image) {
    SKG_PLAIN;
    SKG_NEEDS(file);
    SKG_NEEDS(image);
    if (file->data < 0)
        return skg_fail(SKG_ERR_UNSUPPORTED, "%s: of folders nothing is read; write one file", file->path);
    SKG_TRY(check_finished(file, index));
    return read_projection(file, index, image);
}

skg_status skg_scan_file_copy(skg_scan_file *file, const skg_scan_file *from, int64_t count,
                              const int64_t *indices, const double *phases) {
    SKG_PLAIN;
    char *image = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(file);
    SKG_NEEDS(from);
    SKG_NEEDS(indices);
    SKG_TRY(check_copy(file, from, count, indices));
    SKG_TRY(skg_alloc(file->bytes, 1, "projection", &image));
    SKG_TRY_CLEANUP(copy_fields(file, file->white_at, file->options.flats, from, from->white_at,
                                from->options.flats, image));
    SKG_TRY_CLEANUP(copy_fields(file, file->dark_at, file->options.darks, from, from->dark_at,
                                from->options.darks, image));
    for (int64_t k = 0; k < count; k++) {
        SKG_TRY_CLEANUP(read_projection(from, indices[k], image));
        SKG_TRY_CLEANUP(skg_scan_file_write(file, 1, &k, image, phases ? phases + k : NULL));
    }
cleanup:
    skg_free(&image);
    return status;
}
