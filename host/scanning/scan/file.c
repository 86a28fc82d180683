/* Opening, writing and ending a file of projections. */
#include "scan/format.h"

#include "core/files.h"
#include "core/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PROGRESS_TEXT = 256 };

void skg_scan_file_options_init_sized(void *options, int32_t size) {
    const skg_scan_file_options defaults = {.flats = 1, .darks = 1};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

skg_status skg_scan_find_format(const char *path, const skg_scan_format **format) {
    static const skg_scan_format *const formats[] = {&skg_scan_format_mha, &skg_scan_format_raw,
                                                     &skg_scan_format_tiff, &skg_scan_format_hdf5};
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    *format = &skg_scan_format_folder;
    if (!*path) return skg_fail(SKG_ERR_ARGUMENT, "scan: the path is empty");
    if (!dot || dot[1] == '\0' || dot[1] == '.') return SKG_OK;
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        for (int e = 0; formats[i]->extensions[e]; e++)
            if (skg_same_name(dot, formats[i]->extensions[e])) {
                *format = formats[i];
                if (!formats[i]->is_missing) return SKG_OK;
                return skg_fail(
                    SKG_ERR_UNSUPPORTED,
                    "%s: this build of skiagraph has no HDF5; build it with libhdf5-dev, or use .mha", path);
            }
    return skg_fail(
        SKG_ERR_ARGUMENT,
        "%s: the extension %s is no format of scans; use .h5, .nxs, .mha, .raw, .tif, or a folder without an "
        "extension",
        path, dot);
}

skg_status skg_scan_file_path_check(const char *path) {
    const skg_scan_format *format = NULL;
    SKG_NEEDS(path);
    return skg_scan_find_format(path, &format);
}

skg_status skg_scan_file_samples_get(const char *path, const char *hash, int64_t *samples) {
    const skg_scan_format *format = NULL;
    skg_scan_identity identity;
    SKG_NEEDS(path);
    SKG_NEEDS(hash);
    SKG_NEEDS(samples);
    SKG_TRY(skg_scan_find_format(path, &format));
    SKG_TRY(format->identify(path, &identity));
    *samples = strcmp(identity.hash, hash) == 0 ? identity.samples : 0;
    return SKG_OK;
}

/* Where checksums stand in NAME.progress. */
static int64_t checksums_behind(const skg_scan_file *file) {
    return (PROGRESS_TEXT + file->projections + 3) / 4 * 4;
}

/* The progress of a file that was just laid out. */
static skg_status begin_progress(const skg_scan_file *file) {
    static const char none[4];
    char text[PROGRESS_TEXT] = "";
    skg_output_file output;
    if (!file->progress_path) return SKG_OK;
    SKG_TRY(skg_output_open(file->progress_path, &output));
    skg_scan_write_identity(file, text, sizeof text);
    fwrite(text, 1, sizeof text, output.stream);
    fwrite(file->done, 1, (size_t)file->projections, output.stream);
    fwrite(none, 1, (size_t)(checksums_behind(file) - PROGRESS_TEXT - file->projections), output.stream);
    fwrite(file->checksums, sizeof *file->checksums, (size_t)file->projections, output.stream);
    return skg_output_commit(&output);
}

/* Makes the name durable: after a crash of the machine the folder has it. */
static void sync_folder(const char *path) {
    char folder[4096];
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) : 0;
    if (length >= sizeof folder) return;
    snprintf(folder, sizeof folder, "%.*s", (int)length, path);
    const int descriptor = open(slash ? length ? folder : "/" : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
}

/* Removes what was made of a file that could not be laid out. */
static void take_back(skg_scan_file *file, const char *temporary) {
    if (temporary) unlink(temporary);
    if (file->progress_path) unlink(file->progress_path);
    if (file->format->remove) file->format->remove(file);
}

/* First the progress, then the file: whoever finds a file without a progress finds a finished one. */
static skg_status lay_out(skg_scan_file *file) {
    char *temporary = NULL;
    skg_status status = SKG_OK;
    int descriptor = -1;
    if (file->format->remove)
        SKG_TRY(file->format->remove(file));
    else
        unlink(file->path);
    SKG_TRY(skg_scan_fields_remove(file));
    SKG_TRY(begin_progress(file));
    if (file->format->write) return file->format->lay_out(file, NULL);
    SKG_TRY_CLEANUP(skg_alloc((int64_t)strlen(file->path) + SKG_PART_ENDING, 1, "file name", &temporary));
    descriptor = skg_part_open(file->path, temporary);
    if (descriptor < 0)
        status = skg_output_part_fail(file->path, temporary, errno);
    else
        close(descriptor), status = file->format->lay_out(file, temporary);
    if (status == SKG_OK && rename(temporary, file->path) != 0)
        status = skg_output_fail(file->path, errno, "");
    if (status == SKG_OK) sync_folder(file->path);
cleanup:
    if (status != SKG_OK) take_back(file, descriptor < 0 ? NULL : temporary);
    skg_free(&temporary);
    return status;
}

static skg_status read_done(skg_scan_file *file) {
    const ssize_t got = pread(file->progress, file->done, (size_t)file->projections, (off_t)file->done_at);
    if (got != (ssize_t)file->projections)
        return skg_fail(SKG_ERR_OUTPUT, "%s: is too short; remove it with the file that it belongs to",
                        file->progress_path ? file->progress_path : file->path);
    file->done_count = 0;
    for (int64_t k = 0; k < file->projections; k++) file->done_count += file->done[k] == 1;
    skg_scan_checksums_read(file);
    return SKG_OK;
}

/* Opens the progress of this scan; a file that has none is finished. */
static skg_status open_progress(skg_scan_file *file) {
    skg_scan_identity identity;
    SKG_TRY(skg_scan_read_identity(file->progress_path, &identity));
    if (strcmp(identity.hash, file->options.hash) != 0) {
        memset(file->done, 1, (size_t)file->projections);
        file->done_count = file->projections;
        return SKG_OK;
    }
    file->done_at = PROGRESS_TEXT;
    file->checksum_at = checksums_behind(file);
    file->progress = open(file->progress_path, O_RDWR | O_CLOEXEC);
    if (file->progress < 0) return skg_output_fail(file->progress_path, errno, "");
    return read_done(file);
}

static skg_status open_laid_out(skg_scan_file *file) {
    if (file->format->find_done) return file->format->find_done(file);
    SKG_TRY(file->format->locate(file));
    file->data = open(file->path, O_RDWR | O_CLOEXEC);
    if (file->data < 0) return skg_output_fail(file->path, errno, "");
    skg_scan_open_direct(file);
    if (!file->format->has_progress_inside) return open_progress(file);
    file->progress = dup(file->data);
    return file->progress < 0 ? skg_output_fail(file->path, errno, "") : read_done(file);
}

/* Whether something of another scan stands at the path, or of this one. */
static skg_status look(const skg_scan_file *file, int *is_there) {
    skg_scan_identity identity;
    struct stat there;
    *is_there = 0;
    if (stat(file->path, &there) != 0) return SKG_OK;
    const int is_folder = file->format == &skg_scan_format_folder;
    if (!(is_folder ? S_ISDIR(there.st_mode) : S_ISREG(there.st_mode)))
        return skg_output_fail(file->path, 0,
                               is_folder ? "it is no folder" : "it is a folder or a device; name a file");
    SKG_TRY(file->format->identify(file->path, &identity));
    if (strcmp(identity.hash, file->options.hash) == 0) {
        if (identity.samples != file->options.samples)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s: was begun with %" PRId64 " source samples, not %" PRId64
                            "; plan with as many (skg_scan_file_samples_get)",
                            file->path, identity.samples, file->options.samples);
        *is_there = 1;
        return SKG_OK;
    }
    if (file->options.overwrite || (is_folder && !identity.hash[0])) return SKG_OK;
    return skg_fail(SKG_ERR_OUTPUT, "%s: is %s; choose another output, or give --overwrite to replace it",
                    file->path,
                    identity.hash[0] ? "another scan, or one of another state of this scene" : "no scan");
}

/* Which projections the file has. */
static skg_status find_part(skg_scan_file *file, const skg_scan_file_options *o) {
    int64_t all = 0;
    SKG_TRY(skg_scan_projection_count(o->scan, &all));
    file->first = o->from;
    file->projections = o->count > 0 ? o->count : all - o->from;
    if (o->from >= 0 && o->count >= 0 && file->projections > 0 && file->first <= all - file->projections)
        return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "scan file: %" PRId64 " projections from %" PRId64 " on; the scan has %" PRId64,
                    file->projections, file->first, all);
}

static skg_status prepare(skg_scan_file *file, const char *path, const skg_scan_file_options *o) {
    SKG_TRY(skg_scan_find_format(path, &file->format));
    SKG_TRY(skg_scan_copy_path(path, &file->path));
    SKG_TRY(skg_scan_path_with(file->path, ".lock", &file->lock_path));
    if (!file->format->find_done && !file->format->has_progress_inside)
        SKG_TRY(skg_scan_path_with(file->path, ".progress", &file->progress_path));
    SKG_TRY(skg_copy_text(o->hash, (char **)&file->options.hash));
    SKG_TRY(skg_copy_text(o->name ? o->name : "", (char **)&file->options.name));
    SKG_TRY(skg_copy_text(o->unit ? o->unit : "", (char **)&file->options.unit));
    SKG_TRY(skg_copy_text(o->stem, (char **)&file->options.stem));
    SKG_TRY(find_part(file, o));
    skg_view_init(&file->view);
    SKG_TRY(skg_scan_view_get(o->scan, 0, &file->view));
    file->bytes = file->view.columns * file->view.rows * skg_element_bytes(o->type);
    SKG_TRY(skg_alloc(file->projections, sizeof *file->checksums, "list of projections", &file->checksums));
    return skg_alloc(file->projections, 1, "list of projections", &file->done);
}

static skg_status open_file(skg_scan_file *file) {
    int is_there = 0;
    if (!file->options.helper) {
        SKG_TRY(skg_scan_lock(file->lock_path, &file->lock));
        skg_scan_remove_stale(file);
    }
    SKG_TRY(look(file, &is_there));
    if (!is_there && file->options.helper) return skg_fail(SKG_ERR_OUTPUT, "%s: is not laid out", file->path);
    if (!is_there) SKG_TRY(lay_out(file));
    SKG_TRY(open_laid_out(file));
    const int continues = file->done_count > 0 && file->done_count < file->projections;
    return continues && !file->options.helper && file->checksum_at ? skg_scan_file_verify(file) : SKG_OK;
}

skg_status skg_scan_file_open(const char *path, const skg_scan_file_options *options,
                              skg_scan_file **result) {
    SKG_PLAIN;
    skg_scan_file *file = NULL;
    skg_scan_file_options o;
    skg_status status = SKG_OK;
    SKG_NEEDS(result);
    *result = NULL;
    SKG_NEEDS(path);
    skg_scan_file_options_init(&o);
    SKG_TRY(skg_struct_read(options, "skg_scan_file_options", &o, sizeof o));
    if (!o.scan || !o.hash || strlen(o.hash) != SKG_DIGEST_TEXT - 1)
        return skg_fail(SKG_ERR_ARGUMENT, "scan file: it needs a scan, and a hash of 64 hexadecimal digits");
    if (o.flats < 0 || o.darks < 0 || o.flats > INT32_MAX || o.darks > INT32_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "scan file: %" PRId64 " flat and %" PRId64 " dark fields", o.flats,
                        o.darks);
    if (o.type < SKG_TYPE_FLOAT32 || o.type > SKG_TYPE_UINT16)
        return skg_fail(SKG_ERR_ARGUMENT, "scan file: type %" PRId32 " is no SKG_TYPE_ value", o.type);
    SKG_TRY(skg_alloc(1, sizeof *file, "file of projections", &file));
    file->options = o;
    file->options.hash = file->options.name = file->options.unit = file->options.stem = NULL;
    file->lock = file->data = file->progress = file->direct = -1;
    skg_scan_retain(o.scan);
    SKG_TRY_CLEANUP(prepare(file, path, &o));
    SKG_TRY_CLEANUP(open_file(file));
    *result = file;
    return SKG_OK;
cleanup:
    skg_scan_file_release(&file);
    return status;
}

void skg_scan_file_release(skg_scan_file **file) {
    if (!file || !*file) return;
    skg_scan_file *f = *file;
    if (f->data >= 0) close(f->data);
    if (f->direct >= 0) close(f->direct);
    if (f->progress >= 0) close(f->progress);
    skg_scan_unlock(f->lock_path, &f->lock);
    skg_scan_release(&f->options.scan);
    skg_free(&f->options.hash);
    skg_free(&f->options.name);
    skg_free(&f->options.unit);
    skg_free(&f->options.stem);
    skg_free(&f->path);
    skg_free(&f->lock_path);
    skg_free(&f->progress_path);
    skg_free(&f->done);
    skg_free(&f->checksums);
    skg_free(&f->copies_block);
    skg_free(file);
}

skg_status skg_scan_file_done_count(const skg_scan_file *file, int64_t *count) {
    SKG_NEEDS(file);
    SKG_NEEDS(count);
    *count = file->done_count;
    return SKG_OK;
}

skg_status skg_scan_file_check_index(const skg_scan_file *file, int64_t index) {
    if (index >= file->first && index < file->first + file->projections) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: no projection %" PRId64 "; projections are %" PRId64 " to %" PRId64, file->path,
                    index, file->first, file->first + file->projections - 1);
}

skg_status skg_scan_file_done_get(const skg_scan_file *file, int64_t index, int32_t *done) {
    SKG_NEEDS(file);
    SKG_NEEDS(done);
    SKG_TRY(skg_scan_file_check_index(file, index));
    *done = file->done[index - file->first] == 1;
    return SKG_OK;
}

/* Marks what the disk has. */
static skg_status mark(skg_scan_file *file, int64_t count, const int64_t *indices, const char *images) {
    static const char one = 1;
    if (file->data >= 0 && fdatasync(file->data) != 0) return skg_output_fail(file->path, errno, "");
    for (int64_t i = 0; i < count; i++) {
        const int64_t at = indices[i] - file->first;
        if (file->progress >= 0) {
            SKG_TRY(skg_scan_checksum_write(file, at, images + i * file->bytes));
            SKG_TRY(skg_scan_write_at(file->path, file->progress, &one, 1, file->done_at + at));
        }
        file->done_count += file->done[at] != 1;
        file->done[at] = 1;
    }
    return SKG_OK;
}

/* Writes projections that follow each other in the file. */
static skg_status write_row(skg_scan_file *file, int64_t first, int64_t count, const void *images,
                            const double *phases) {
    const double none = (double)NAN;
    const int64_t at = first - file->first;
    SKG_TRY(skg_scan_write_large(file, images, count * file->bytes, file->data_at + at * file->bytes));
    for (int64_t i = 0; i < count && file->phase_at; i++)
        SKG_TRY(skg_scan_write_at(file->path, file->data, phases ? phases + i : &none, sizeof none,
                                  file->phase_at + (at + i) * (int64_t)sizeof none));
    return SKG_OK;
}

skg_status skg_scan_file_write(skg_scan_file *file, int64_t count, const int64_t *indices, const void *images,
                               const double *phases) {
    SKG_PLAIN;
    SKG_NEEDS(file);
    SKG_NEEDS(indices);
    SKG_NEEDS(images);
    for (int64_t i = 0; i < count; i++) SKG_TRY(skg_scan_file_check_index(file, indices[i]));
    for (int64_t i = 0, row = 0; i < count; i += row) {
        const char *image = (const char *)images + i * file->bytes;
        row = 1;
        if (file->format->write) {
            SKG_TRY(file->format->write(file, indices[i], image, phases ? phases[i] : 0));
            continue;
        }
        while (i + row < count && indices[i + row] == indices[i] + row) row++;
        SKG_TRY(write_row(file, indices[i], row, image, phases ? phases + i : NULL));
    }
    return mark(file, count, indices, images);
}

skg_status skg_scan_file_finish(skg_scan_file *file) {
    SKG_NEEDS(file);
    if (file->progress < 0) return SKG_OK;
    SKG_TRY(read_done(file)); /* other processes may have written */
    if (file->done_count < file->projections) return SKG_OK;
    if (fsync(file->data) != 0) return skg_output_fail(file->path, errno, "");
    close(file->progress);
    file->progress = -1;
    if (file->progress_path && unlink(file->progress_path) != 0)
        return skg_output_fail(file->progress_path, errno, "");
    sync_folder(file->path);
    return SKG_OK;
}
