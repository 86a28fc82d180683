/* Which files a page may name: those in the folder of the scene. */
#define _GNU_SOURCE /* realpath */
#include "live/paths.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int has_parent(const char *text) {
    for (const char *at = text; at; at = strchr(at, '/')) {
        at += *at == '/';
        if (strncmp(at, "..", 2) == 0 && (at[2] == '/' || at[2] == '\0')) return 1;
    }
    return 0;
}

/* Whether a file of the folder is no link that leads out of it. Texts that name no file do. */
static int is_inside(const char *folder, const char *text) {
    char path[PATH_MAX], *real;
    const size_t length = strlen(folder);
    if (snprintf(path, sizeof path, "%s/%s", folder, text) >= (int)sizeof path) return 1; /* no such file */
    real = realpath(path, NULL);
    const int is = !real || (strncmp(real, folder, length) == 0 &&
                             (real[length] == '/' || real[length] == '\0' || folder[length - 1] == '/'));
    free(real);
    return is;
}

static int check(const char *folder, const json_t *value, char *sentence) {
    const char *key, *text = json_string_value(value);
    json_t *one;
    size_t k;
    if (text && (*text == '/' || has_parent(text) || !is_inside(folder, text))) {
        snprintf(
            sentence, LIVE_SENTENCE,
            "\"%.200s\" lies outside of the scene's folder: a page names files in it only; copy the file there, or "
            "name it in the scene file",
            text);
        return 0;
    }
    json_array_foreach(value, k, one) if (!check(folder, one, sentence)) return 0;
    json_object_foreach((json_t *)(uintptr_t)value, key, one) if (!check(folder, one, sentence)) return 0;
    return 1;
}

int live_paths_check(const char *scene, const live_wish *wish, char sentence[LIVE_SENTENCE]) {
    const char *slash = strrchr(scene, '/');
    char path[PATH_MAX];
    const char *text = NULL;
    if (skg_live_message_text_get(wish->message, &text) != SKG_OK) return live_fail(sentence);
    json_t *state = json_loads(text, 0, NULL);
    snprintf(path, sizeof path, "%.*s", slash ? (int)(slash + 1 - scene) : 1, slash ? scene : ".");
    char *folder = realpath(path, NULL);
    if (!folder) snprintf(sentence, LIVE_SENTENCE, "the folder of the scene cannot be found");
    const int is = folder && check(folder, json_object_get(state, "settings"), sentence);
    json_decref(state);
    free(folder);
    return is;
}
