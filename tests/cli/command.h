/* Runs the command in a folder of its own and reads what it said. */
#ifndef SKG_TESTS_COMMAND_H
#define SKG_TESTS_COMMAND_H

#include "suite.h"

#include <dirent.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[64], said[1 << 18], complained[65536];

static inline void set_up(void) {
    strcpy(folder, "/tmp/skg-cli-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static inline void read_back(const char *name, char *text, size_t size) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    text[fread(text, 1, size - 1, stream)] = '\0';
    fclose(stream);
    unlink(path);
}

/* Files in the folder; remove: all of them go. */
static inline int look_at_folder(int remove) {
    int count = 0;
    DIR *directory = opendir(folder);
    ck_assert_ptr_nonnull(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        char path[512];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        count++;
        if (remove) ck_assert_int_eq(unlink(path), 0);
    }
    closedir(directory);
    return count;
}

static inline void tear_down(void) {
    look_at_folder(1);
    ck_assert_int_eq(rmdir(folder), 0);
}

static inline int has_file(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

static inline void write_bytes(const char *name, const void *bytes, size_t count) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fwrite(bytes, 1, count, stream), count);
    ck_assert_int_eq(fclose(stream), 0);
}

static inline void write_text(const char *name, const char *text) {
    write_bytes(name, text, strlen(text));
}

/* The exit status; what was said is in `said` and `complained`. The words may begin with settings of the
 * environment, NAME=VALUE ..., before a '|'. */
static inline int run(const char *format, ...) __attribute__((format(printf, 1, 2)));

static inline int run(const char *format, ...) {
    char words[2048], line[8192];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    char *bar = strchr(words, '|');
    if (bar) *bar = '\0';
    snprintf(line, sizeof line, "cd %s && %s %s %s >.said 2>.complained </dev/null", folder, bar ? words : "",
             SKG_COMMAND, bar ? bar + 1 : words);
    int status = system(line);
    ck_assert_msg(WIFEXITED(status), "%s: ended by a signal", line);
    read_back(".said", said, sizeof said);
    read_back(".complained", complained, sizeof complained);
    return WEXITSTATUS(status);
}

/* Runs and compares the exit status. */
#define ck_run(expected, ...)                                                                                \
    do {                                                                                                     \
        int ck_status = run(__VA_ARGS__);                                                                    \
        ck_assert_msg(ck_status == (expected), "exit status %d instead of %d; said: %s; complained: %s",     \
                      ck_status, (expected), said, complained);                                              \
    } while (0)

/* Fails with this status, this text in one sentence on standard error, and nothing on standard output. */
#define ck_run_fails(expected, text, ...)                                                                    \
    do {                                                                                                     \
        ck_run(expected, __VA_ARGS__);                                                                       \
        ck_assert_msg(strstr(complained, (text)) != NULL, "\"%s\" does not say \"%s\"", complained, (text)); \
        ck_assert_msg(strncmp(complained, "skiagraph: ", 11) == 0, "\"%s\"", complained);                    \
        ck_assert_msg(strchr(complained, '\n') == complained + strlen(complained) - 1,                       \
                      "not one line: \"%s\"", complained);                                                   \
        ck_assert_str_eq(said, "");                                                                          \
    } while (0)

/* Standard output of the last run as JSON; the caller releases it. */
static inline json_t *said_json(void) {
    json_error_t error;
    json_t *object = json_loads(said, JSON_REJECT_DUPLICATES, &error);
    ck_assert_msg(json_is_object(object), "%s in: %.2000s", error.text, said);
    return object;
}

static inline json_t *member(json_t *object, const char *key) {
    json_t *value = json_object_get(object, key);
    ck_assert_msg(value != NULL, "no \"%s\" in: %.2000s", key, said);
    return value;
}

#endif
