/* The command line that makes the image of a point. */
#include "cost/output.h"

#include "cost/dial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_plain(const char *word) {
    return *word &&
           strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,+-@%") ==
               strlen(word);
}

/* Writes a word such that a shell reads it back unchanged. */
static void put_word(FILE *stream, const char *word) {
    fputc(' ', stream);
    if (is_plain(word)) {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stream);
        else
            fputc(*word, stream);
    fputc('\'', stream);
}

static void put_flag(FILE *stream, const cost_study *study, const char *flag) {
    const char *value;
    for (int i = 0; (value = cli_nth_value(study->arguments, flag, i)); i++) {
        fprintf(stream, " %s", flag);
        put_word(stream, value);
    }
}

/* The command up to the scene file. For another number of the thorax's triangles, commands before it make the
 * meshes and copy the scene file to them. */
static void put_scene(FILE *stream, const cost_study *study, const cost_meshing *meshing) {
    const char *path = study->session.path, *slash = strrchr(path, '/');
    char copy[4096];
    if (!meshing || !meshing->thorax) {
        fputs("skiagraph image", stream);
        put_word(stream, path);
        return;
    }
    const long long triangles = (long long)meshing->thorax;
    fprintf(stream, "skiagraph thorax %s--quiet -o thorax-%lld --triangles %lld && cp",
            study->subject.thorax_is_simple ? "--simple " : "", triangles, triangles);
    put_word(stream, path);
    fprintf(stream, " thorax-%lld/ && skiagraph image", triangles);
    snprintf(copy, sizeof copy, "thorax-%lld/%s", triangles, slash ? slash + 1 : path);
    put_word(stream, copy);
}

char *cost_command(const cost_study *study, const cost_setting *setting) {
    const cost_meshing *meshing = setting->meshing < 0 ? NULL : &study->meshings[setting->meshing];
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    put_scene(stream, study, meshing);
    fputs(" -o image.mha", stream);
    put_flag(stream, study, "--device");
    put_flag(stream, study, "--strategy");
    put_flag(stream, study, "--set");
    if (cli_given(study->arguments, "--lenient")) fputs(" --lenient", stream);
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++) {
        char flag[128] = "";
        const int is_own =
            dial == COST_SUPERSAMPLING && setting->supersampling == study->subject.own.supersampling;
        if (!cost_dials[dial].flag || is_own || !cost_has_value(dial, setting)) continue;
        cost_append_value(study, setting, dial, cost_dials[dial].flag, flag, sizeof flag);
        fputs(flag, stream);
    }
    if (setting->repair >= COST_UNITE)
        fprintf(stream, " --set 'Repair=[\"%s\",\"union\"]'",
                cost_repair_names[setting->repair - COST_UNITE]);
    else if (setting->repair >= 0)
        fprintf(stream, " --set Repair=%s", cost_repair_names[setting->repair]);
    for (int64_t i = 0; meshing && i < meshing->setting_count; i++) {
        fputs(" --set", stream);
        put_word(stream, meshing->settings[i]);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
