/* The files that a scene names: where they are, and the list of those that were read. */
#include "setup/reader.h"

#include <inttypes.h>
#include <string.h>

/* Where the source of the set-up says that a file is; NULL: it says nothing. */
static const char *find_elsewhere(const skg_setup_source *source, const char *name) {
    for (int64_t i = 0; i < source->file_count; i++)
        if (strcmp(source->file_names[i], name) == 0) return source->file_paths[i];
    return NULL;
}

skg_status skg_setup_where(const skg_setup_reader *reader, const char *name, char **path) {
    const char *elsewhere = find_elsewhere(&reader->source, name);
    return elsewhere ? skg_copy_text(elsewhere, path) : skg_setup_resolve(reader, name, path);
}

static skg_status add_file(const skg_setup_reader *reader, const char *name, skg_setup_file *file) {
    SKG_TRY(skg_copy_text(name, &file->name));
    return skg_setup_where(reader, name, &file->path);
}

skg_status skg_setup_find_file(skg_setup_reader *reader, const char *name, const char **path) {
    skg_setup *setup = reader->setup;
    skg_setup_file file = {0};
    for (int64_t i = 0; i < setup->file_count; i++)
        if (strcmp(setup->files[i].name, name) == 0) {
            *path = setup->files[i].path;
            return SKG_OK;
        }
    skg_status status = add_file(reader, name, &file);
    if (status == SKG_OK)
        status = skg_realloc(setup->file_count + 1, sizeof *setup->files, "files of a scene", &setup->files);
    if (status != SKG_OK) {
        skg_free(&file.name);
        skg_free(&file.path);
        return status;
    }
    setup->files[setup->file_count++] = file;
    *path = file.path;
    return SKG_OK;
}

void skg_setup_files_free(skg_setup *setup) {
    for (int64_t i = 0; i < setup->file_count; i++) {
        skg_free(&setup->files[i].name);
        skg_free(&setup->files[i].path);
    }
    skg_free(&setup->files);
}

skg_status skg_setup_file_count(const skg_setup *setup, int64_t *count) {
    SKG_NEEDS(setup);
    SKG_NEEDS(count);
    *count = setup->file_count;
    return SKG_OK;
}

skg_status skg_setup_file_get(const skg_setup *setup, int64_t index, const char **name, const char **path) {
    SKG_NEEDS(setup);
    SKG_NEEDS(name);
    SKG_NEEDS(path);
    if (index < 0 || index >= setup->file_count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_setup_file_get: index %" PRId64 " is not below %" PRId64,
                        index, setup->file_count);
    *name = setup->files[index].name;
    *path = setup->files[index].path;
    return SKG_OK;
}
