/* Names of the stacks of flat and dark fields beside a stack of projections, and their removal with it. */
#include "core/text.h"
#include "scan/format.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char *skg_scan_field_kind(int32_t dark) {
    return dark ? "dark" : "flat";
}

skg_status skg_scan_path_beside(const char *path, const char *kind, char **result) {
    const char *dot = strrchr(path, '.');
    const size_t stem = (size_t)(dot - path), room = strlen(path) + strlen(kind) + 3;
    SKG_TRY(skg_alloc((int64_t)room, 1, "path", result));
    snprintf(*result, room, "%.*s-%ss%s", (int)stem, path, kind, dot);
    return SKG_OK;
}

skg_status skg_scan_stack_remove(const skg_scan_file *file, char *path) {
    skg_scan_identity identity;
    skg_scan_file stack = *file;
    stack.path = path;
    SKG_TRY(file->format->identify(path, &identity));
    if (!identity.hash[0]) return SKG_OK;
    if (file->format->remove) return file->format->remove(&stack);
    unlink(path);
    return SKG_OK;
}

skg_status skg_scan_fields_remove(skg_scan_file *file) {
    skg_status status = SKG_OK;
    for (int k = 0; k < 2 && status == SKG_OK && file->format->fields_beside; k++) {
        char *path = NULL;
        SKG_TRY(skg_scan_path_beside(file->path, skg_scan_field_kind(k), &path));
        status = skg_scan_stack_remove(file, path);
        skg_free(&path);
    }
    return status;
}
