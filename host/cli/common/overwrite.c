/* Refuses an output that is an input, or that exists beside one and is not of this command. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "common/values.h"

#include "common/say.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { LOOKED_AT = 65536 };

/* Whether the bytes hold a word, whatever the case of its first letter. */
static int holds(const char *bytes, size_t count, const char *word) {
    const size_t length = strlen(word);
    for (size_t i = 1; i + length - 1 <= count; i++)
        if (memcmp(bytes + i, word + 1, length - 1) == 0 && (bytes[i - 1] | 32) == word[0]) return 1;
    return 0;
}

/* How tables begin, which have no room for a name. */
static int begins_as_table(const char *bytes, size_t count) {
    static const char *const headings[] = {"t_s,phase,amplitude,", "dial,precision,",
                                           "label,phase,motion_mm,", "label,material,density (g/cm3),"};
    for (size_t h = 0; h < sizeof headings / sizeof *headings; h++)
        if (count >= strlen(headings[h]) && memcmp(bytes, headings[h], strlen(headings[h])) == 0) return 1;
    return 0;
}

/* Whether the nodes of a .glb name this command: they come behind a list that is as long as the scene is large. */
static int is_our_model(FILE *stream) {
    unsigned char head[20];
    int ours = 0;
    rewind(stream);
    if (fread(head, 1, sizeof head, stream) != sizeof head || memcmp(head, "glTF", 4) != 0) return 0;
    const size_t count = head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16 | (size_t)head[15] << 24;
    char *text = malloc(count + 1);
    if (text) ours = fread(text, 1, count, stream) == count && holds(text, count, "skiagraph");
    free(text);
    return ours;
}

/* Whether a file is empty or names this command near its beginning or its end. */
static int is_ours(const char *path) {
    FILE *stream = fopen(path, "rb");
    char *bytes = malloc(LOOKED_AT);
    int ours = 0;
    if (stream && bytes) {
        size_t count = fread(bytes, 1, LOOKED_AT, stream);
        ours = count == 0 || begins_as_table(bytes, count) || holds(bytes, count, "skiagraph");
        if (!ours && count == LOOKED_AT && fseek(stream, -LOOKED_AT, SEEK_END) == 0) {
            count = fread(bytes, 1, LOOKED_AT, stream);
            ours = holds(bytes, count, "skiagraph") || is_our_model(stream);
        }
    }
    free(bytes);
    if (stream) fclose(stream);
    return ours;
}

/* The folder of a file without links, with a slash at its end. Returns 0 if it cannot be found out. */
static int folder_of(const char *path, char *folder) {
    char text[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length >= sizeof text) return 0;
    memcpy(text, path, length);
    text[length] = '\0';
    if (!realpath(length ? text : ".", folder)) return 0;
    const size_t its = strlen(folder);
    if (its + 2 > PATH_MAX) return 0;
    if (its > 1) strcpy(folder + its, "/");
    return 1;
}

static int check(const char *input, const char *path, const struct stat *there) {
    char of_input[PATH_MAX], of_path[PATH_MAX];
    struct stat its;
    if (stat(input, &its) != 0 || !S_ISREG(its.st_mode)) return CLI_DONE;
    if (its.st_dev == there->st_dev && its.st_ino == there->st_ino)
        return cli_error(CLI_OUTPUT, "%s: is the input; name another file", path);
    if (!folder_of(input, of_input) || !folder_of(path, of_path)) return CLI_DONE;
    if (strncmp(of_path, of_input, strlen(of_input)) != 0 || is_ours(path)) return CLI_DONE;
    return cli_error(CLI_OUTPUT,
                     "%s: exists beside the input %s and was not written by skiagraph; name another file, or "
                     "remove it first",
                     path, input);
}

int cli_check_overwrite(const cli_arguments *arguments, const char *path) {
    struct stat there;
    int exit_status = CLI_DONE;
    if (strcmp(path, "-") == 0 || stat(path, &there) != 0 || !S_ISREG(there.st_mode)) return CLI_DONE;
    for (int i = 0; i < arguments->operand_count && exit_status == CLI_DONE; i++)
        exit_status = check(arguments->operands[i], path, &there);
    for (int i = 0; i < arguments->given_count && exit_status == CLI_DONE; i++) {
        const struct cli_given *given = &arguments->given[i];
        if (given->flag->names == CLI_NAMES_FILE && !cli_flag_is_output(given->flag))
            exit_status = check(given->value, path, &there);
    }
    return exit_status;
}

/* Whether both are the same file. */
static int is_same(const char *path, const char *other) {
    struct stat its, others;
    return stat(path, &its) == 0 && stat(other, &others) == 0 && S_ISREG(its.st_mode) &&
           its.st_dev == others.st_dev && its.st_ino == others.st_ino;
}

/* Whether a file stands in a folder that is read, such as that of a DICOM series, and is not of this command. */
static int is_of_folder(const char *path, const char *folder) {
    char of_path[PATH_MAX];
    struct stat its, others, there;
    return stat(folder, &its) == 0 && S_ISDIR(its.st_mode) && stat(path, &there) == 0 &&
           S_ISREG(there.st_mode) && folder_of(path, of_path) && stat(of_path, &others) == 0 &&
           its.st_dev == others.st_dev && its.st_ino == others.st_ino && !is_ours(path);
}

int cli_check_file_kept(const skg_setup *setup, const char *output) {
    int64_t count = 0;
    const char *name = NULL, *path = NULL;
    if (skg_setup_file_count(setup, &count) != SKG_OK) return CLI_DONE;
    for (int64_t f = 0; f < count && skg_setup_file_get(setup, f, &name, &path) == SKG_OK; f++)
        if (is_same(output, path) || is_of_folder(output, path))
            return cli_error(CLI_OUTPUT, "%s: is read by the scene, as %s; name another file", output, name);
    return CLI_DONE;
}

int cli_check_files_kept(const cli_arguments *arguments, const skg_setup *setup) {
    int exit_status = CLI_DONE;
    for (int i = 0; i < arguments->given_count && exit_status == CLI_DONE; i++)
        if (cli_flag_is_output(arguments->given[i].flag))
            exit_status = cli_check_file_kept(setup, arguments->given[i].value);
    return exit_status;
}

int cli_check_overwrites(const cli_arguments *arguments) {
    if (arguments->manual->checks_outputs) return CLI_DONE;
    int exit_status = CLI_DONE;
    for (int i = 0; i < arguments->given_count && exit_status == CLI_DONE; i++)
        if (cli_flag_is_output(arguments->given[i].flag))
            exit_status = cli_check_overwrite(arguments, arguments->given[i].value);
    return exit_status;
}
