/* Sets the environment variables that PoCL reads. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "common/environment.h"

#include "affinity/affinity.h"
#include "common/say.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *affinity_reason = "not decided yet";
static char temporary_cache[256]; /* made by this process and removed at exit */
static char unwritable_cache[1024];
static int unwritable_reason;

const char *cli_affinity_reason(void) {
    return affinity_reason;
}

/* The folder where PoCL keeps compiled kernels, by PoCL's rule. Returns 0 if the path is too long. */
static int find_cache(char *path, size_t size) {
    const char *own = getenv("POCL_CACHE_DIR"), *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length = 0;
    if (own)
        length = snprintf(path, size, "%s", own);
    else if (cache)
        length = snprintf(path, size, "%s/pocl/kcache", cache);
    else if (home)
        length = snprintf(path, size, "%s/.cache/pocl/kcache", home);
    else
        length = snprintf(path, size, "/tmp/pocl/kcache");
    return length > 0 && (size_t)length < size;
}

/* Makes the folder and those above it, as PoCL would. Returns 0, or the errno value that says why it cannot
 * be used. access() alone does not suffice: root passes it on file systems that allow no new folder, such as
 * /proc. */
static int folder_error(const char *path) {
    char above[1024];
    snprintf(above, sizeof above, "%s", path);
    for (char *slash = strchr(above + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(above, 0777) != 0 && errno != EEXIST) return errno;
        *slash = '/';
    }
    if (mkdir(above, 0777) != 0 && errno != EEXIST) return errno;
    return access(above, W_OK | X_OK) == 0 ? 0 : errno;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *where) {
    (void)status;
    (void)kind;
    (void)where;
    remove(path);
    return 0;
}

static void remove_cache(void) {
    nftw(temporary_cache, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static void decide_cache(void) {
    char path[1024];
    const char *folder = getenv("TMPDIR"), *own = getenv("POCL_CACHE_DIR");
    if (own && !*own) unsetenv("POCL_CACHE_DIR"); /* PoCL fails an assertion if it is empty */
    if (!find_cache(path, sizeof path)) return;
    int reason = folder_error(path);
    if (reason == 0) return;
    snprintf(unwritable_cache, sizeof unwritable_cache, "%s", path);
    unwritable_reason = reason;
    int length = snprintf(temporary_cache, sizeof temporary_cache, "%s/skiagraph-kernels-XXXXXX",
                          folder && *folder ? folder : "/tmp");
    if (length >= (int)sizeof temporary_cache || !mkdtemp(temporary_cache)) return;
    setenv("POCL_CACHE_DIR", temporary_cache, 1);
    atexit(remove_cache);
}

void cli_prepare_environment(void) {
    static int prepared;
    if (prepared) return; /* it would take its own settings for the user's */
    prepared = 1;
    affinity_reason = host_pin_threads();
    decide_cache();
}

void cli_warn_of_cache(const skg_device_info *device) {
    if (unwritable_reason && strstr(device->platform_name, "Portable Computing Language"))
        cli_warn("kernels cannot be kept in %s (%s), so they are compiled at every start; set POCL_CACHE_DIR "
                 "to a folder that can be written to",
                 unwritable_cache, strerror(unwritable_reason));
}
