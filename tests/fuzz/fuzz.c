/* Shared code of the fuzz targets: a folder of their own, and files in it. */
#include "fuzz/fuzz.h"

#include <skiagraph/error.h>

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[64];

static void remove_folder(void) {
    DIR *all = opendir(folder);
    for (struct dirent *one; all && (one = readdir(all));)
        if (one->d_name[0] != '.') unlink(fuzz_path(one->d_name));
    if (all) closedir(all);
    rmdir(folder);
}

const char *fuzz_path(const char *name) {
    static char path[512];
    if (!*folder) {
        strcpy(folder, "/tmp/skg-fuzz-XXXXXX");
        if (!mkdtemp(folder) || atexit(remove_folder) != 0) abort();
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

const char *fuzz_write(const char *name, const void *bytes, size_t size) {
    const char *path = fuzz_path(name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) abort();
    return path;
}

void fuzz_expect_sentence(int32_t status) {
    if (status < 0 && (!*skg_last_error() || strchr(skg_last_error(), '\n'))) abort();
    if (status == SKG_ERR_INTERNAL) abort();
}

char *fuzz_text(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    if (!text) abort();
    memcpy(text, data, size);
    text[size] = '\0';
    return text;
}
