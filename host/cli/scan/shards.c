/* A scan divided among processes: who makes what, and how shards are joined. */
#include "scan/steps.h"

#include "common/say.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHARDS_MAX = 100000 };

int shards_read_flag(const cli_arguments *arguments, cli_acquisition *a) {
    const char *value = cli_value(arguments, "--shard");
    char rest = 0;
    if (!value) return CLI_DONE;
    if (sscanf(value, "%" SCNd64 "/%" SCNd64 "%c", &a->shard, &a->shards, &rest) != 2 || a->shard < 1 ||
        a->shard > a->shards || a->shards > SHARDS_MAX)
        return cli_error(CLI_USAGE, "--shard %s is not I/N with I from 1 to N", value);
    if (a->only || a->options.from > 0 || a->options.to > 0 || cli_given(arguments, "--join"))
        return cli_error(CLI_USAGE,
                         "--shard chooses the projections; leave out --from, --to, --only and --join");
    return CLI_DONE;
}

/* "scan.2-of-8.h5" for "scan.h5"; NULL: no memory. */
static char *shard_path(const char *place, int64_t shard, int64_t shards) {
    const char *dot = strrchr(place, '.');
    const size_t size = strlen(place) + 64;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%.*s.%" PRId64 "-of-%" PRId64 "%s", (int)(dot - place), place, shard, shards,
                 dot);
    return path;
}

static int needs_extension(const char *place) {
    const char *slash = strrchr(place, '/'), *dot = strrchr(slash ? slash : place, '.');
    if (dot && dot[1]) return CLI_DONE;
    return cli_error(CLI_USAGE, "%s: shards are files; give an output with an extension, such as .h5", place);
}

/* The block of a shard, and the hash of its file: that of the scan with the block in its last 16 digits. */
static void choose_block(const cli_acquisition *a, int64_t shard, int64_t shards, int64_t *from,
                         int64_t *count, char hash[65]) {
    *from = a->projections * (shard - 1) / shards;
    *count = a->projections * shard / shards - *from;
    snprintf(hash, 65, "%.48s%08" PRIx64 "%08" PRIx64, a->hash, (uint64_t)*from, (uint64_t)*count);
}

int shards_choose_part(cli_acquisition *a) {
    char hash[65];
    if (a->shards == 0) return CLI_DONE;
    const int exit_status = needs_extension(a->place);
    if (exit_status != CLI_DONE) return exit_status;
    choose_block(a, a->shard, a->shards, &a->part_from, &a->part_count, hash);
    if (a->part_count == 0)
        return cli_error(CLI_USAGE,
                         "--shard %" PRId64 "/%" PRId64 ": has no projection; the scan has %" PRId64,
                         a->shard, a->shards, a->projections);
    a->shard_place = shard_path(a->place, a->shard, a->shards);
    if (!a->shard_place) return cli_error(CLI_DEVICE, "out of host memory");
    memcpy(a->hash, hash, sizeof hash);
    a->place = a->shard_place;
    a->options.from = a->part_from;
    a->options.to = a->part_from + a->part_count;
    a->projections = a->part_count;
    return CLI_DONE;
}

/* Into how many shards the files beside the output are divided; 0: there are none, or they do not agree. */
static int64_t count_shards(const char *place) {
    const char *slash = strrchr(place, '/'), *name = slash ? slash + 1 : place, *dot = strrchr(name, '.');
    const size_t stem = (size_t)(dot - name);
    int64_t shards = 0;
    char folder[4096];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - place) + 1 : 1, slash ? place : ".");
    DIR *directory = opendir(folder);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        int64_t shard = 0, its = 0;
        int used = 0;
        if (strncmp(entry->d_name, name, stem) != 0 ||
            sscanf(entry->d_name + stem, ".%" SCNd64 "-of-%" SCNd64 "%n", &shard, &its, &used) != 2 ||
            strcmp(entry->d_name + stem + used, dot) != 0)
            continue;
        if (shards != 0 && shards != its) its = 0;
        shards = its;
        if (its == 0) break;
    }
    if (directory) closedir(directory);
    return shards;
}

int shards_join(cli_acquisition *a, const skg_scan_file_options *options) {
    int exit_status = needs_extension(a->place);
    const int64_t shards = exit_status == CLI_DONE ? count_shards(a->place) : 0;
    if (exit_status == CLI_DONE && shards == 0)
        return cli_error(CLI_INPUT, "%s: there are no files of shards beside it, or of different divisions",
                         a->place);
    for (int64_t shard = 1; shard <= shards && exit_status == CLI_DONE; shard++) {
        skg_scan_file_options its = *options;
        skg_scan_file *part = NULL;
        int64_t samples = 0;
        char hash[65], *path = shard_path(a->place, shard, shards);
        if (!path) return cli_error(CLI_DEVICE, "out of host memory");
        choose_block(a, shard, shards, &its.from, &its.count, hash);
        its.hash = hash;
        its.overwrite = 0;
        skg_status status = skg_scan_file_samples_get(path, hash, &samples);
        if (status == SKG_OK && samples == 0)
            exit_status = cli_error(CLI_INPUT, "%s: is missing, or is no shard of this scan", path);
        else if (status == SKG_OK)
            status = skg_scan_file_open(path, &its, &part);
        if (part) status = skg_scan_file_join(a->file, part);
        skg_scan_file_release(&part);
        free(path);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    return exit_status;
}
