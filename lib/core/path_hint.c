/* Says what is wrong with a path that cannot be opened. */
#include "core/text.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { LONGEST_PATH = 4096 };

/* Replaces the name at the end of a path by the one in its folder that differs in case only. Returns whether there is
 * one. */
static int mend_case(char *path) {
    char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    int found = 0;
    const char end = *name;
    *name = '\0'; /* the folder with its slash */
    DIR *folder = opendir(slash ? path : ".");
    *name = end;
    for (struct dirent *entry; folder && !found && (entry = readdir(folder));)
        if (skg_same_name(entry->d_name, name)) memcpy(name, entry->d_name, strlen(name)), found = 1;
    if (folder) closedir(folder);
    return found;
}

skg_status skg_fail_unreadable(const char *path, int reason) {
    char meant[LONGEST_PATH];
    int mended = 0;
    if (reason == ENOENT && strlen(path) < sizeof meant) {
        strcpy(meant, path);
        for (char *at = meant; (at = strchr(at, '\\')); at++) *at = '/';
        mended = access(meant, F_OK) == 0 || mend_case(meant);
    }
    return skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s%s%s%s", path, strerror(reason),
                    mended ? "; did you mean " : "", mended ? meant : "", mended ? "?" : "");
}
