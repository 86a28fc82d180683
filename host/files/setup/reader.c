/* Functions that the readers of a scene file's sections share. */
#include "setup/reader.h"

#include <string.h>

skg_status skg_setup_resolve(const skg_setup_reader *reader, const char *path, char **resolved) {
    const char *folder = *path == '/' ? "" : reader->folder;
    SKG_TRY(skg_alloc((int64_t)(strlen(folder) + strlen(path)) + 1, 1, "path", resolved));
    strcpy(*resolved, folder);
    strcat(*resolved, path);
    return SKG_OK;
}

skg_status skg_setup_find_part(const skg_setup_reader *reader, const skg_json_node *node, const char *label,
                               int64_t *part) {
    skg_status status = skg_scene_part_find(reader->setup->scene, label, part);
    return skg_json_at(node, status);
}
