#include "folder.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int cli_make_folder(const char *folder) {
    struct stat found;
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
    size_t room = strlen(folder) + strlen(name) + 2;
    char *path = malloc(room);
    if (path) snprintf(path, room, "%s/%s", folder, name);
    return path;
}
