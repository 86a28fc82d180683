/* The scene file that a live page began with, and whether it has changed. */
#include "live/scene.h"

#include "common/values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

/* When a file was last changed; 0: there is none. */
static int64_t stamp_of(const char *path) {
    struct stat status;
    if (stat(path, &status) != 0) return 0;
    return (int64_t)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec + status.st_size;
}

static void forget_files(live_base *base) {
    for (int64_t i = 0; base->files && i < base->file_count; i++) free(base->files[i]);
    free(base->files);
    free(base->stamps);
    base->files = NULL;
    base->stamps = NULL;
    base->file_count = 0;
}

/* ns: clocks of files are that coarse. */
static const int64_t TICK = 20000000;

/* When a file that was read from `begun` on was last changed; -1, which no file has: it may have been while it was read, so it is
 * read again. */
static int64_t stamp_since(const char *path, int64_t begun) {
    struct stat status;
    if (stat(path, &status) != 0) return 0;
    const int64_t changed = (int64_t)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    /* a file from the future would be read for ever */
    const int is_past = changed <= (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
    return changed >= begun - TICK && is_past ? -1 : changed + status.st_size;
}

/* Notes the files of a set-up, so that a change is seen. begun: when the first of them was opened, ns. */
static int note_files(live_base *base, const skg_setup *setup, int64_t begun) {
    int64_t count = 0;
    forget_files(base);
    if (setup && skg_setup_file_count(setup, &count) != SKG_OK) return 0;
    base->files = calloc((size_t)count + 1, sizeof *base->files);
    base->stamps = calloc((size_t)count + 1, sizeof *base->stamps);
    if (!base->files || !base->stamps) return 0;
    for (int64_t i = 0; i <= count; i++) {
        const char *name = NULL, *path = base->path;
        if (i > 0 && skg_setup_file_get(setup, i - 1, &name, &path) != SKG_OK) return 0;
        base->files[i] = strdup(path);
        if (!base->files[i]) return 0;
        base->stamps[i] = stamp_since(path, begun);
        base->file_count = i + 1;
    }
    return 1;
}

int live_base_is_stale(const live_base *base) {
    for (int64_t i = 0; i < base->file_count; i++) {
        const int64_t stamp = stamp_of(base->files[i]);
        /* an editor may remove a file for a moment */
        if (stamp && stamp != base->stamps[i]) return 1;
    }
    return 0;
}

void live_base_free(live_base *base) {
    forget_files(base);
    free(base->text);
    base->text = NULL;
    register_free_images(1, base->fixed);
    base->fixed = NULL;
    json_decref(base->warnings);
    base->warnings = NULL;
}

/* The settings of the command line, which the caller frees. */
static const char **read_settings(const live_base *base, char *tolerance, size_t size, int64_t *count) {
    const cli_arguments *arguments = base->arguments;
    const char **settings = calloc((size_t)arguments->given_count + 1, sizeof *settings),
               *value = cli_value(arguments, "--tolerance"), *set;
    *count = 0;
    if (!settings) return NULL;
    for (int i = 0; (set = cli_nth_value(arguments, "--set", i)); i++) settings[(*count)++] = set;
    snprintf(tolerance, size, "Tolerance=%s", value ? value : "");
    if (value) settings[(*count)++] = tolerance;
    return settings;
}

int live_base_read(live_base *base, char *sentence) {
    char tolerance[64];
    skg_setup_source source;
    skg_setup *setup = NULL;
    const char *text = NULL;
    skg_setup_source_init(&source);
    const char **settings = read_settings(base, tolerance, sizeof tolerance, &source.setting_count);
    source.path = base->path;
    source.settings = settings;
    source.lenient = cli_given(base->arguments, "--lenient");
    struct timespec begun;
    clock_gettime(CLOCK_REALTIME, &begun);
    skg_status status = settings ? skg_setup_create(base->context, &source, &setup) : SKG_ERR_MEMORY;
    if (status == SKG_OK) status = skg_setup_text_get(setup, &text);
    char *copy = status == SKG_OK ? strdup(text) : NULL;
    if (status != SKG_OK) live_fail(sentence);
    const int is_noted =
        note_files(base, setup,
                   (int64_t)begun.tv_sec * 1000000000 +
                       begun.tv_nsec); /* also of a file that is wrong, so that its mending is seen */
    if (copy) {
        free(base->text);
        base->text = copy;
    }
    free(settings);
    skg_setup_release(&setup);
    return copy && is_noted;
}
