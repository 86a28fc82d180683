/* Writes JSON: numbers, texts, objects, and what a page can hold. */
#include "common/encode.h"

#include "common/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

json_t *cli_json_number(double number) {
    return isfinite(number) ? json_real(number) : json_null();
}

json_t *cli_json_text(const char *text) {
    json_t *value = json_string(text);
    if (value) return value;
    size_t length = strlen(text);
    char *plain = malloc(length + 1);
    if (!plain) return json_null();
    for (size_t i = 0; i <= length; i++) plain[i] = (unsigned char)text[i] < 128 ? text[i] : '?';
    value = json_string(plain);
    free(plain);
    return value;
}

json_t *cli_json_numbers(const double *numbers, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, cli_json_number(numbers[i]));
    return list;
}

char *cli_json_for_page(const json_t *object) {
    static const char escaped[] = "\\u003c";
    char *plain = json_dumps(object, JSON_COMPACT | JSON_ENSURE_ASCII), *text = NULL;
    size_t count = 0;
    for (const char *c = plain; c && *c; c++) count += *c == '<'; /* in texts only: JSON itself has none */
    if (plain) text = malloc(strlen(plain) + count * (sizeof escaped - 2) + 1);
    char *to = text;
    for (const char *c = plain; text && *c; c++) {
        if (*c == '<')
            memcpy(to, escaped, sizeof escaped - 1), to += sizeof escaped - 1;
        else
            *to++ = *c;
    }
    if (text) *to = '\0';
    free(plain);
    return text;
}

static int is_printed; /* 1: standard output has its object */

int cli_json_print(json_t *object) {
    is_printed = 1;
    int failed = json_dumpf(object, stdout, JSON_INDENT(2)) != 0;
    putchar('\n');
    json_decref(object);
    /* main reports an error of standard output, such as a full disk. */
    return failed && !ferror(stdout) ? cli_error(CLI_DEVICE, "out of host memory") : CLI_DONE;
}

/* Whether a piece of a message before ": " says where: a word such as scene.json or Samples[1].Material, "line 3" or
 * "part liver". */
static int is_place(const char *piece, size_t length) {
    return length > 0 && (memchr(piece, ' ', length) == NULL || strncmp(piece, "line ", 5) == 0 ||
                          strncmp(piece, "part ", 5) == 0);
}

/* The number of characters of a message that say where. */
static size_t place_length(const char *message, const char *file) {
    size_t length = 0, its = file ? strlen(file) : 0;
    if (its > 0 && strncmp(message, file, its) == 0 && strncmp(message + its, ": ", 2) == 0) length = its + 2;
    for (const char *end; (end = strstr(message + length, ": ")); length = (size_t)(end - message) + 2)
        if (!is_place(message + length, (size_t)(end - message) - length)) break;
    return length > 0 ? length - 2 : 0;
}

void cli_json_print_failure(const char *file) {
    const cli_failure *failure = cli_first_failure();
    if (is_printed || !*failure->message) return;
    const size_t length = place_length(failure->message, file);
    char where[sizeof failure->message];
    memcpy(where, failure->message, length);
    where[length] = '\0';
    json_t *error = json_object(), *object = json_object();
    json_object_set_new(error, "status", cli_json_text(skg_status_name(failure->status)));
    json_object_set_new(error, "message", cli_json_text(failure->message));
    json_object_set_new(error, "where", length > 0 ? cli_json_text(where) : json_null());
    json_object_set_new(object, "error", error);
    cli_json_print(object);
}
