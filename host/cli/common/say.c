/* Sentences on standard error, and the exit status that goes with each. */
#include "common/say.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 78 };

static int is_quiet, is_verbose;
static atomic_int warnings;
static char last_warning[1024]; /* guarded by `terminal` */
static int has_line;            /* 1: a line is shown; guarded by `terminal`, as is standard error */
static pthread_mutex_t terminal = PTHREAD_MUTEX_INITIALIZER;
static cli_failure first; /* of this run */

void cli_set_quiet(int quiet) {
    is_quiet = quiet;
}

int cli_is_quiet(void) {
    return is_quiet;
}

void cli_set_verbose(int verbose) {
    is_verbose = verbose;
}

/* Makes room for a sentence. end_sentence follows. */
static void begin_sentence(void) {
    pthread_mutex_lock(&terminal);
    if (has_line) fprintf(stderr, "\r%*s\r", WIDTH, "");
    has_line = 0;
}

static void end_sentence(void) {
    fputc('\n', stderr);
    pthread_mutex_unlock(&terminal);
}

void cli_show_line(const char *line) {
    pthread_mutex_lock(&terminal);
    if (line)
        fprintf(stderr, "\r%-*.*s", WIDTH, WIDTH, line);
    else if (has_line)
        fprintf(stderr, "\r%*s\r", WIDTH, "");
    has_line = line != NULL;
    pthread_mutex_unlock(&terminal);
}

/* Labels and names of files must not command a terminal: control characters of ASCII and, in UTF-8, of Latin-1 are written as
 * \\xNN. New lines stay, which logs of compilers have. */
static void print_plain(const char *text, FILE *to) {
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        if ((*c < ' ' && *c != '\n') || *c == 127)
            fprintf(to, "\\x%02x", *c);
        else if (c[0] == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0)
            fprintf(to, "\\x%02x", *++c);
        else
            fputc(*c, to);
}

/* NULL: no memory. */
static char *format_text(const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length >= 0 ? malloc((size_t)length + 1) : NULL;
    if (text) vsnprintf(text, (size_t)length + 1, format, arguments);
    return text;
}

static void print_sentence(const char *begin, const char *format, va_list arguments) {
    char *text = format_text(format, arguments);
    begin_sentence();
    fputs(begin, stderr);
    print_plain(text ? text : "out of host memory", stderr);
    end_sentence();
    free(text);
}

void cli_print(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *text = format_text(format, arguments);
    va_end(arguments);
    if (text) print_plain(text, stdout);
    free(text);
}

void cli_tell(const char *format, ...) {
    if (!is_verbose) return;
    va_list arguments;
    va_start(arguments, format);
    print_sentence("skiagraph: ", format, arguments);
    va_end(arguments);
}

const cli_failure *cli_first_failure(void) {
    return &first;
}

/* The library's status that stands for a failure of the command itself. */
static skg_status own_status(int exit_status) {
    return exit_status == CLI_USAGE    ? SKG_ERR_ARGUMENT
           : exit_status == CLI_INPUT  ? SKG_ERR_FORMAT
           : exit_status == CLI_OUTPUT ? SKG_ERR_OUTPUT
                                       : SKG_ERR_MEMORY;
}

int cli_error(int exit_status, const char *given, ...) {
    char sentence[sizeof first.message];
    const char *format = given ? given : ""; /* gcc's sanitizer build takes a null format for possible */
    va_list arguments;
    va_start(arguments, given);
    print_sentence("skiagraph: ", format, arguments);
    va_end(arguments);
    va_start(arguments, given);
    if (vsnprintf(sentence, sizeof sentence, format, arguments) < 0) *sentence = '\0';
    va_end(arguments);
    if (!*first.message) {
        memcpy(first.message, sentence, sizeof sentence);
        if (first.status >= 0) first.status = own_status(exit_status);
    }
    return exit_status;
}

int cli_exit_status(skg_status status) {
    switch (status) {
    case SKG_ERR_ARGUMENT:
        return CLI_USAGE;
    case SKG_ERR_OUTPUT:
        return CLI_OUTPUT;
    case SKG_ERR_MEMORY:
    case SKG_ERR_NO_DEVICE:
    case SKG_ERR_DEVICE:
    case SKG_ERR_DEVICE_MEMORY:
    case SKG_ERR_BUILD:
    case SKG_ERR_FORK:
    case SKG_ERR_INTERNAL:
        return CLI_DEVICE;
    default:
        return status < 0 ? CLI_INPUT : CLI_DONE;
    }
}

int cli_fail(skg_status status) {
    const char *sentence = status < 0 ? skg_last_error() : skg_status_text(status);
    if (!*sentence) sentence = skg_status_text(status);
    int length = (int)strlen(sentence); /* a build log ends in empty lines */
    while (length > 0 && sentence[length - 1] == '\n') length--;
    if (!*first.message) first.status = status;
    return cli_error(cli_exit_status(status), "%.*s", length, sentence);
}

int cli_warning_count(void) {
    return warnings;
}

int cli_was_warned(const char *sentence) {
    static const char digits[] = "0123456789";
    pthread_mutex_lock(&terminal);
    const char *last = last_warning + strspn(last_warning, digits),
               *its = sentence + strspn(sentence, digits);
    const int is_same = strcmp(last, its) == 0;
    pthread_mutex_unlock(&terminal);
    return is_same;
}

void cli_warn(const char *format, ...) {
    va_list arguments;
    warnings++;
    pthread_mutex_lock(&terminal);
    va_start(arguments, format);
    vsnprintf(last_warning, sizeof last_warning, format, arguments);
    va_end(arguments);
    pthread_mutex_unlock(&terminal);
    if (is_quiet) return;
    va_start(arguments, format);
    print_sentence("skiagraph: warning: ", format, arguments);
    va_end(arguments);
}

void cli_note(const char *format, ...) {
    if (is_quiet) return;
    va_list arguments;
    va_start(arguments, format);
    print_sentence("skiagraph: note: ", format, arguments);
    va_end(arguments);
}

void cli_log(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING) cli_warn("%s", sentence);
    if (level == SKG_LOG_NOTE) cli_note("%s", sentence);
    if (level == SKG_LOG_PROGRESS && isatty(STDERR_FILENO)) cli_note("%s", sentence);
}
