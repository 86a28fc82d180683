/* Hash of a set-up: of its file after the settings, and of the contents of the files that it names. */
#include "core/digest.h"
#include "core/files.h"
#include "core/text.h"
#include "scene/scene.h"
#include "setup/sections.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

skg_status skg_setup_keep_text(skg_setup_reader *reader) {
    char *text = json_dumps(reader->file.root, JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(17));
    if (!text) return skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", reader->file.path);
    skg_status status = skg_copy_text(text, &reader->setup->text);
    free(text);
    return status;
}

/* Adds the length and the contents of a file. A folder, such as OutFolder, adds nothing. */
static skg_status add_file(const char *path, skg_digester *sum) {
    char bytes[65536];
    struct stat there;
    int64_t size = 0;
    size_t got;
    FILE *file = NULL;
    if (stat(path, &there) != 0 || !S_ISREG(there.st_mode)) return SKG_OK;
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, &file, &size));
    snprintf(bytes, sizeof bytes, "%" PRId64 "\n", size);
    skg_digest_add_text(sum, bytes);
    while ((got = fread(bytes, 1, sizeof bytes, file)) > 0) skg_digest_add(sum, bytes, got);
    const int reason = ferror(file) ? errno : 0;
    fclose(file);
    return reason ? skg_fail_unreadable(path, reason) : SKG_OK;
}

/* Adds the cells of volumes, which may lie in a file beside the one that the scene names. */
static void add_cells(const skg_scene *scene, skg_digester *sum) {
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_volume *volume = scene->parts[p].volume;
        if (!volume) continue;
        skg_digest_add(sum, &volume->low, sizeof volume->low); /* that of code 0 */
        skg_digest_add(sum, &volume->high, sizeof volume->high);
        skg_digest_add(sum, volume->cells, (size_t)skg_volume_bytes(volume));
    }
}

skg_status skg_setup_text_get(const skg_setup *setup, const char **text) {
    SKG_NEEDS(setup);
    SKG_NEEDS(text);
    *text = setup->text;
    return SKG_OK;
}

skg_status skg_setup_hash_get(const skg_setup *setup, char *hash, int64_t size) {
    skg_digester sum;
    SKG_NEEDS(setup);
    SKG_NEEDS(hash);
    if (size < SKG_DIGEST_TEXT)
        return skg_fail(SKG_ERR_ARGUMENT, "hash: %" PRId64 " bytes; it needs %d", size, SKG_DIGEST_TEXT);
    skg_digest_start(&sum);
    skg_digest_add_text(&sum, setup->text);
    for (int64_t i = 0; i < setup->file_count; i++) SKG_TRY(add_file(setup->files[i].path, &sum));
    add_cells(setup->scene, &sum);
    const skg_digest digest = skg_digest_end(&sum);
    skg_digest_text(&digest, hash);
    return SKG_OK;
}
