/* Bytes at their places in a file, and the text that says which scan a file holds. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "core/files.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char hash_key[] = "ScanHash = ", samples_key[] = "ScanSamples = ";

skg_status skg_scan_path_with(const char *path, const char *ending, char **result) {
    const size_t length = strlen(path);
    SKG_TRY(skg_alloc((int64_t)(length + strlen(ending)) + 1, 1, "path", result));
    strcpy(*result, path);
    strcpy(*result + length, ending);
    return SKG_OK;
}

/* The extension, which names the kind of an output. */
static const char *ending_of(const char *path) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot : "";
}

skg_status skg_scan_copy_path(const char *path, char **copy) {
    struct stat its;
    char *target = NULL;
    SKG_TRY(skg_copy_text(path, copy));
    size_t length = strlen(path);
    while (length > 1 && (*copy)[length - 1] == '/') (*copy)[--length] = '\0';
    if (lstat(*copy, &its) == 0 && S_ISLNK(its.st_mode)) target = realpath(*copy, NULL);
    skg_status status = SKG_OK;
    if (target && strcmp(ending_of(target), ending_of(*copy)) == 0) {
        skg_free(copy);
        status = skg_copy_text(target, copy);
    }
    free(target);
    return status;
}

void skg_scan_write_identity(const skg_scan_file *file, char *text, size_t size) {
    snprintf(text, size, "%s%s\n%s%" PRId64 "\n", hash_key, file->options.hash, samples_key,
             file->options.samples);
}

void skg_scan_write_levels(const skg_scan_file *file, char text[SKG_SCAN_LEVELS_LENGTH]) {
    const skg_scan_file_options *o = &file->options;
    snprintf(text, SKG_SCAN_LEVELS_LENGTH,
             "FlatField = %.17g\nDark = %.17g\nFlatFieldVaries = %s\nDarkVaries = %s\n", o->flat_field,
             o->dark, o->flat_varies ? "True" : "False", o->dark_varies ? "True" : "False");
}

skg_status skg_scan_read_identity(const char *path, skg_scan_identity *identity) {
    char text[4096 + 1];
    *identity = (skg_scan_identity){0};
    FILE *stream = NULL;
    if (access(path, F_OK) != 0 && errno == ENOENT) return SKG_OK;
    SKG_TRY(skg_input_open(path, INT64_MAX, &stream, NULL)); /* a scan may have any length */
    const size_t got = fread(text, 1, sizeof text - 1, stream);
    fclose(stream);
    for (size_t i = 0; i < got; i++)
        if (!text[i]) text[i] = ' '; /* of a binary header */
    text[got] = '\0';
    const char *hash = strstr(text, hash_key), *samples = hash ? strstr(hash, samples_key) : NULL;
    if (!samples) return SKG_OK;
    snprintf(identity->hash, sizeof identity->hash, "%.64s", hash + strlen(hash_key));
    identity->samples = strtoll(samples + strlen(samples_key), NULL, 10);
    return SKG_OK;
}

skg_status skg_scan_write_at(const char *path, int descriptor, const void *bytes, int64_t count, int64_t at) {
    const char *from = bytes;
    while (count > 0) {
        const ssize_t put = pwrite(descriptor, from, (size_t)count, (off_t)at);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return skg_output_fail(path, put < 0 ? errno : 0, "nothing was taken");
        from += put, at += put, count -= put;
    }
    return SKG_OK;
}

/* Some file systems cannot reserve room; there the disk may be found full later. */
static int reserve(int descriptor, int64_t total) {
    const int reason = posix_fallocate(descriptor, 0, (off_t)total);
    if (reason != EOPNOTSUPP && reason != EINVAL && reason != ENOSYS) return reason;
    return ftruncate(descriptor, (off_t)total) == 0 ? 0 : errno;
}

skg_status skg_scan_lay_out(const char *path, const void *header, int64_t count, int64_t total) {
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) return skg_output_fail(path, errno, "");
    skg_status status = skg_scan_write_at(path, descriptor, header, count, 0);
    const int reason = status == SKG_OK ? reserve(descriptor, total) : 0;
    if (reason) status = skg_output_fail(path, reason, "");
    if (status == SKG_OK && fsync(descriptor) != 0) status = skg_output_fail(path, errno, "");
    if (close(descriptor) != 0 && status == SKG_OK) status = skg_output_fail(path, errno, "");
    if (status != SKG_OK) unlink(path);
    return status;
}

skg_status skg_scan_reserve(const char *path) {
    struct stat there;
    const int descriptor = open(path, O_RDWR | O_CLOEXEC);
    if (descriptor < 0) return skg_output_fail(path, errno, "");
    int reason = fstat(descriptor, &there) == 0 ? reserve(descriptor, (int64_t)there.st_size) : errno;
    if (!reason && fsync(descriptor) != 0) reason = errno;
    if (close(descriptor) != 0 && !reason) reason = errno;
    return reason ? skg_output_fail(path, reason, "") : SKG_OK;
}

skg_status skg_scan_check_length(const char *path, int64_t total) {
    struct stat there;
    if (stat(path, &there) != 0) return skg_output_fail(path, errno, "");
    if ((int64_t)there.st_size == total) return SKG_OK;
    return skg_fail(SKG_ERR_OUTPUT,
                    "%s: has %" PRId64 " bytes instead of %" PRId64
                    "; something else has changed it: remove it",
                    path, (int64_t)there.st_size, total);
}
