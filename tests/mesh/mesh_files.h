/* A folder for mesh files, written, loaded, refused. */
#ifndef SKG_TESTS_MESH_FILES_H
#define SKG_TESTS_MESH_FILES_H

#include "mesh/mesh_health.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static char folder[64], path[512];

static inline void make_folder(void) {
    strcpy(folder, "/tmp/skg-mesh-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static inline void remove_folder(void) {
    DIR *all = opendir(folder);
    for (struct dirent *entry; (entry = readdir(all));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path);
    }
    closedir(all);
    ck_assert_int_eq(rmdir(folder), 0);
}

static inline const char *in_folder(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static inline const char *file_of_bytes(const char *name, const void *bytes, size_t count) {
    FILE *stream = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fwrite(bytes, 1, count, stream), count);
    ck_assert_int_eq(fclose(stream), 0);
    return path;
}

static inline const char *file_of(const char *name, const char *text) {
    return file_of_bytes(name, text, strlen(text));
}

static inline skg_mesh *load(const char *file) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_load(NULL, file, 1, &mesh));
    return mesh;
}

static inline void refuse(const char *file, skg_status status, const char *text) {
    skg_mesh *mesh;
    ck_skg_fails(skg_mesh_load(NULL, file, 1, &mesh), status, text);
    ck_assert_ptr_null(mesh);
    const char *slash = strrchr(file, '/'); /* every sentence names the file */
    ck_assert_msg(strstr(skg_last_error(), slash ? slash + 1 : file) != NULL, "%s", skg_last_error());
}

#endif
