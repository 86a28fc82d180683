#include "common/file.h"

#include "common/say.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LONGEST_PATH = 4096 };

static int fail(const char *path, const char *reason) {
    return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, reason);
}

int cli_write_file(const char *path, const void *bytes, size_t count) {
    char temporary[LONGEST_PATH];
    struct stat there;
    int length = snprintf(temporary, sizeof temporary, "%s.part-%ld", path, (long)getpid());
    if (length < 0 || length >= (int)sizeof temporary) return fail(path, strerror(ENAMETOOLONG));
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode)) /* rename() would replace the device */
        return fail(path, "it is a folder or a device; name a file");
    FILE *stream = fopen(temporary, "wbx");
    if (!stream)
        return fail(path, errno == ENOENT ? "its folder does not exist; make it first" : strerror(errno));
    int reason = 0;
    errno = 0;
    if (fwrite(bytes, 1, count, stream) != count || fflush(stream) != 0 || fsync(fileno(stream)) != 0)
        reason = errno ? errno : EIO;
    if (fclose(stream) != 0 && !reason) reason = errno;
    if (!reason && rename(temporary, path) != 0) reason = errno;
    if (!reason) return CLI_DONE;
    unlink(temporary);
    return fail(path, strerror(reason));
}

int cli_has_extension(const char *path, const char *extension) {
    size_t length = strlen(path), its = strlen(extension);
    return length > its && strcasecmp(path + length - its, extension) == 0;
}

/* Refuses a new folder that is named like a film or a picture. */
static int check_folder_name(const char *folder) {
    static const char *const extensions[] = {
        ".gif", ".mp4", ".webm", ".avi",  ".mov", ".mkv", ".mpg",  ".mpeg", ".m4v", ".apng", ".ogv",
        ".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tif", ".tiff", ".svg",  ".mha", ".dcm",  ".pdf"};
    for (size_t e = 0; e < sizeof extensions / sizeof *extensions; e++)
        if (cli_has_extension(folder, extensions[e]))
            return cli_error(
                CLI_USAGE,
                "%s: %s files are not written here, and a folder of this name would be taken for one; name "
                "a folder without extension",
                folder, extensions[e]);
    return CLI_DONE;
}

int cli_make_folder(const char *folder) {
    struct stat found;
    if (stat(folder, &found) != 0 && check_folder_name(folder) != CLI_DONE) return CLI_USAGE;
    if (mkdir(folder, 0777) == 0) return CLI_DONE;
    int reason = errno;
    if (stat(folder, &found) == 0 && S_ISDIR(found.st_mode)) return CLI_DONE;
    return cli_error(CLI_OUTPUT, "%s: cannot be made: %s", folder, strerror(reason));
}

char *cli_path_in(const char *folder, const char *format, ...) {
    char name[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    size_t capacity = strlen(folder) + strlen(name) + 2;
    char *path = malloc(capacity);
    if (path) snprintf(path, capacity, "%s/%s", folder, name);
    return path;
}
