/* Files that appear whole or not at all, and folders. */
#include "common/file.h"
#include "common/made.h"

#include "common/say.h"
#include "core/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

int cli_file_fail(const char *path, const char *reason) {
    return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, reason);
}

static void forget(cli_file *file) {
    free(file->path);
    free(file->temporary);
    *file = (cli_file){0};
}

int cli_file_open(const char *path, cli_file *file) {
    const size_t length = strlen(path) + 1;
    struct stat there;
    *file = (cli_file){0};
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode)) /* rename() would replace the device */
        return cli_file_fail(path, "it is a folder or a device; name a file");
    file->path = malloc(length);
    file->temporary = malloc(length + SKG_PART_ENDING);
    if (!file->path || !file->temporary) {
        forget(file);
        return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    }
    memcpy(file->path, path, length);
    const int descriptor = skg_part_open(path, file->temporary);
    file->stream = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    if (file->stream) return CLI_DONE;
    const int reason = errno;
    if (descriptor >= 0) {
        close(descriptor);
        unlink(file->temporary);
    } else if (reason == EEXIST) {
        cli_error(
            CLI_OUTPUT,
            "%s: cannot be written: unfinished files of this name are in the way, such as %s; remove them",
            path, file->temporary);
        forget(file);
        return CLI_OUTPUT;
    }
    forget(file);
    return cli_file_fail(path,
                         reason == ENOENT ? "its folder does not exist; make it first" : strerror(reason));
}

int cli_file_write(cli_file *file, const void *bytes, size_t count) {
    errno = 0;
    if (fwrite(bytes, 1, count, file->stream) == count) return 1;
    if (!file->reason) file->reason = errno ? errno : EIO;
    return 0;
}

int cli_file_commit(cli_file *file) {
    int reason = file->reason, exit_status = CLI_DONE;
    errno = 0;
    if (!reason && (fflush(file->stream) != 0 || fsync(fileno(file->stream)) != 0))
        reason = errno ? errno : EIO;
    if (fclose(file->stream) != 0 && !reason) reason = errno;
    file->stream = NULL;
    if (!reason && rename(file->temporary, file->path) != 0) reason = errno;
    if (reason) {
        unlink(file->temporary);
        exit_status = cli_file_fail(file->path, strerror(reason));
    }
    forget(file);
    return exit_status;
}

void cli_file_discard(cli_file *file) {
    if (file->stream) fclose(file->stream);
    if (file->temporary) unlink(file->temporary);
    forget(file);
}

int cli_file_check(const char *path) {
    cli_file file;
    const int exit_status = cli_file_open(path, &file);
    if (exit_status == CLI_DONE) cli_file_discard(&file);
    return exit_status;
}

int cli_write_file(const char *path, const void *bytes, size_t count) {
    cli_file file;
    const int exit_status = cli_file_open(path, &file);
    if (exit_status != CLI_DONE) return exit_status;
    cli_file_write(&file, bytes, count);
    return cli_file_commit(&file);
}

int cli_has_extension(const char *path, const char *extension) {
    size_t length = strlen(path), its = strlen(extension);
    return length > its && strcasecmp(path + length - its, extension) == 0;
}

int cli_names_folder(const char *place) {
    const char *slash = strrchr(place, '/'), *dot = strrchr(slash ? slash : place, '.');
    return !dot || !dot[1] || dot[1] == '.';
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
    cli_made(folder);
    if (mkdir(folder, 0777) == 0) return CLI_DONE;
    int reason = errno;
    if (stat(folder, &found) == 0 && S_ISDIR(found.st_mode)) return CLI_DONE;
    return cli_error(CLI_OUTPUT, "%s: cannot be made: %s", folder, strerror(reason));
}

void cli_name_of_part(const char *label, int64_t part, char name[CLI_NAME_OF_PART]) {
    enum { LONGEST = 120 };
    size_t length = strlen(label);
    int is_mended = length > LONGEST || *label == '.' || !*label;
    if (length > LONGEST) length = LONGEST;
    if (length == LONGEST) /* not within a character of UTF-8 */
        while (length > 0 && ((unsigned char)label[length] & 0xC0) == 0x80) length--;
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)label[i];
        const int is_bad = c < ' ' || c == 127 || c == '/' || (i == 0 && c == '.');
        is_mended |= is_bad;
        name[i] = (char)(is_bad || c == ' ' ? '-' : c);
    }
    name[length] = '\0';
    if (is_mended) snprintf(name + length, CLI_NAME_OF_PART - length, "-%" PRId64, part);
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
