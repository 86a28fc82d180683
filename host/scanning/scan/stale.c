/* Removes the unfinished files that killed writers of a scan have left. */
#include "scan/format.h"

#include "core/text.h"

#include <dirent.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int begins_with(const char *name, const char *start) {
    return strncmp(name, start, strlen(start)) == 0;
}

/* Unfinished files in a folder that begin with `start` and whose finished names end in `end`. */
static void clear(const char *folder, const char *start, const char *end) {
    DIR *stream = opendir(folder);
    for (struct dirent *entry; stream && (entry = readdir(stream));)
        if (begins_with(entry->d_name, start) && skg_part_is_of(entry->d_name, end))
            unlinkat(dirfd(stream), entry->d_name, 0);
    if (stream) closedir(stream);
}

/* Of one file: NAME, NAME.progress and, of .raw, its header. */
static void clear_file(const skg_scan_file *file, const char *folder, const char *name) {
    static const char progress[] = ".progress";
    char *its = NULL;
    clear(folder, name, name);
    if (skg_scan_path_with(name, progress, &its) == SKG_OK) clear(folder, name, its);
    skg_free(&its);
    if (file->format != &skg_scan_format_raw || skg_copy_text(name, &its) != SKG_OK) return;
    memcpy(its + strlen(its) - 4, ".mhd", 4);
    clear(folder, its, its);
    skg_free(&its);
}

void skg_scan_remove_stale(const skg_scan_file *file) {
    char *folder = NULL;
    if (file->format == &skg_scan_format_folder) {
        clear(file->path, "scan.txt", "scan.txt");
        clear(file->path, file->options.stem ? file->options.stem : "projection-", ".tif");
        if (file->options.stem) return;
        clear(file->path, "flat-", ".tif");
        clear(file->path, "dark-", ".tif");
        return;
    }
    if (skg_copy_text(file->path, &folder) != SKG_OK) return;
    char *slash = strrchr(folder, '/');
    if (slash) *slash = '\0';
    const char *in = slash ? slash == folder ? "/" : folder : ".";
    clear_file(file, in, slash ? slash + 1 : folder);
    for (int32_t dark = 0; dark < 2 && file->format->fields_beside; dark++) {
        char *beside = NULL;
        if (skg_scan_path_beside(slash ? slash + 1 : folder, skg_scan_field_kind(dark), &beside) == SKG_OK)
            clear_file(file, in, beside);
        skg_free(&beside);
    }
    skg_free(&folder);
}
