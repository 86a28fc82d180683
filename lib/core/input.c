/* Opens and reads files of the user: text without a mark, lines of any end. */
#include "core/files.h"

#include "core/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

skg_status skg_input_fail_long(const char *path, int64_t most) {
    return skg_fail(SKG_ERR_FILE,
                    "%s: cannot be read: it is longer than %" PRId64 " MiB, the limit of such a file", path,
                    most >> 20);
}

static skg_status check(const char *path, int descriptor, int64_t most, int64_t *size) {
    struct stat about;
    if (fstat(descriptor, &about) != 0) return skg_fail_unreadable(path, errno);
    if (S_ISDIR(about.st_mode))
        return skg_fail(SKG_ERR_FILE, "%s: cannot be read: it is a folder, not a file", path);
    if (!S_ISREG(about.st_mode))
        return skg_fail(SKG_ERR_FILE, "%s: cannot be read: it is a pipe or a device, not a file", path);
    if ((int64_t)about.st_size > most) return skg_input_fail_long(path, most);
    if (size) *size = (int64_t)about.st_size;
    return SKG_OK;
}

/* O_NONBLOCK: a pipe without a writer is opened at once, and then refused. Reading a regular file does not heed it. */
static skg_status open_checked(const char *path, int64_t most, int *descriptor, int64_t *size) {
    *descriptor = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (*descriptor < 0) return skg_fail_unreadable(path, errno);
    const skg_status status = check(path, *descriptor, most, size);
    if (status != SKG_OK) close(*descriptor);
    return status;
}

skg_status skg_input_open(const char *path, int64_t most, FILE **stream, int64_t *size) {
    int descriptor = -1;
    SKG_TRY(open_checked(path, most, &descriptor, size));
    *stream = fdopen(descriptor, "rb");
    if (*stream) return SKG_OK;
    const int reason = errno;
    close(descriptor);
    return skg_fail_unreadable(path, reason);
}

skg_status skg_input_check(const char *path, int64_t most) {
    int descriptor = -1;
    SKG_TRY(open_checked(path, most, &descriptor, NULL));
    close(descriptor);
    return SKG_OK;
}

skg_status skg_input_read(FILE *stream, const char *path, int64_t most, char **text, size_t *length) {
    skg_status status = SKG_OK;
    size_t capacity = 0, got = 0;
    *length = 0;
    do {
        if (*length + 1 >= capacity) {
            capacity = 2 * capacity + 65536;
            SKG_TRY_CLEANUP(skg_realloc((int64_t)capacity, 1, path, text));
        }
        got = fread(*text + *length, 1, capacity - 1 - *length, stream);
        *length += got;
        if ((int64_t)*length > most) SKG_TRY_CLEANUP(skg_input_fail_long(path, most));
    } while (got > 0);
    if (ferror(stream)) SKG_TRY_CLEANUP(skg_fail_unreadable(path, errno));
    (*text)[*length] = '\0';
    return SKG_OK;
cleanup:
    skg_free(text);
    return status;
}

skg_status skg_text_mark(const char *path, const char *text, size_t length, size_t *mark) {
    *mark = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    if (length < 2 || (memcmp(text, "\xFF\xFE", 2) != 0 && memcmp(text, "\xFE\xFF", 2) != 0)) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: is text in UTF-16; save it as UTF-8 or ASCII", path);
}

skg_status skg_text_open(const char *path, FILE **stream) {
    char start[3];
    size_t mark = 0;
    SKG_TRY(skg_input_open(path, SKG_INPUT_TEXT, stream, NULL));
    const size_t length = fread(start, 1, sizeof start, *stream);
    skg_status status = skg_text_mark(path, start, length, &mark);
    if (status == SKG_OK && fseek(*stream, (long)mark, SEEK_SET) != 0)
        status = skg_fail_unreadable(path, errno);
    if (status != SKG_OK) fclose(*stream);
    return status;
}
