/* Flat and dark fields of a file of projections: inside an .h5, as files of their own in a folder, and as a stack beside a stack. */
#include "core/files.h"
#include "core/text.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

skg_status skg_scan_fields_name_get(const char *path, int32_t dark, char *name, int64_t size) {
    const skg_scan_format *format = NULL;
    char *beside = NULL;
    SKG_NEEDS(path);
    SKG_NEEDS(name);
    SKG_TRY(skg_scan_find_format(path, &format));
    const char *slash = strrchr(path, '/'), *kind = skg_scan_field_kind(dark);
    int length = 0;
    if (format == &skg_scan_format_hdf5)
        length = snprintf(name, (size_t)size, "/exchange/data_%s", dark ? "dark" : "white");
    else if (format == &skg_scan_format_folder)
        length = snprintf(name, (size_t)size, "%s-00000.tif", kind);
    else {
        SKG_TRY(skg_scan_path_beside(slash ? slash + 1 : path, kind, &beside));
        length = snprintf(name, (size_t)size, "%s", beside);
        skg_free(&beside);
    }
    if (length < size) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: the name of its fields has %d bytes, more than %" PRId64, path,
                    length, size - 1);
}

/* Writes a stack of `count` images that appears whole or not at all. */
static skg_status save_stack(const skg_scan_file *file, char *path, int64_t count, const void *images) {
    skg_scan_file stack = *file;
    char *temporary = NULL;
    skg_status status = SKG_OK;
    stack.path = path;
    stack.projections = count;
    SKG_TRY(skg_alloc((int64_t)strlen(path) + SKG_PART_ENDING, 1, "file name", &temporary));
    int descriptor = skg_part_open(path, temporary);
    if (descriptor < 0) {
        status = skg_output_part_fail(path, temporary, errno);
        skg_free(&temporary);
        return status;
    }
    SKG_TRY_CLEANUP(file->format->lay_out(&stack, temporary));
    stack.path = temporary;
    SKG_TRY_CLEANUP(file->format->locate(&stack));
    SKG_TRY_CLEANUP(skg_scan_write_at(path, descriptor, images, count * file->bytes, stack.data_at));
    if (fsync(descriptor) != 0 || rename(temporary, path) != 0) status = skg_output_fail(path, errno, "");
cleanup:
    close(descriptor);
    if (status != SKG_OK) unlink(temporary);
    skg_free(&temporary);
    return status;
}

/* Fields inside the file, which stand side by side. */
static skg_status write_inside(skg_scan_file *file, int64_t at, int64_t have, int64_t count,
                               const void *images) {
    if (!at) return SKG_OK;
    if (count != have)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: has room for %" PRId64 " fields, not %" PRId64, file->path,
                        have, count);
    return skg_scan_write_at(file->path, file->data, images, count * file->bytes, at);
}

static skg_status write_beside(skg_scan_file *file, const char *kind, int64_t count, const void *images) {
    char *path = NULL;
    SKG_TRY(skg_scan_path_beside(file->path, kind, &path));
    skg_status status = count > 0 ? save_stack(file, path, count, images) : skg_scan_stack_remove(file, path);
    skg_free(&path);
    return status;
}

skg_status skg_scan_file_fields_write(skg_scan_file *file, int64_t flats, const void *white, int64_t darks,
                                      const void *dark) {
    SKG_NEEDS(file);
    if (flats > 0) SKG_NEEDS(white);
    if (darks > 0) SKG_NEEDS(dark);
    if (file->format->write_fields) return file->format->write_fields(file, flats, white, darks, dark);
    if (file->format->fields_beside) {
        SKG_TRY(write_beside(file, skg_scan_field_kind(0), flats, white));
        return write_beside(file, skg_scan_field_kind(1), darks, dark);
    }
    SKG_TRY(write_inside(file, file->white_at, file->options.flats, flats, white));
    return write_inside(file, file->dark_at, file->options.darks, darks, dark);
}
