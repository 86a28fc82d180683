#include "common/say.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 78 };

static int is_quiet, is_verbose;
static int has_line; /* 1: a line is shown; guarded by `terminal`, as is standard error */
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

void cli_tell(const char *format, ...) {
    if (!is_verbose) return;
    va_list arguments;
    va_start(arguments, format);
    begin_sentence();
    fputs("skiagraph: ", stderr);
    vfprintf(stderr, format, arguments);
    end_sentence();
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
    begin_sentence();
    fputs("skiagraph: ", stderr);
    vfprintf(stderr, format, arguments); /* whole, whatever its length */
    end_sentence();
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

void cli_warn(const char *format, ...) {
    if (is_quiet) return;
    va_list arguments;
    va_start(arguments, format);
    begin_sentence();
    fputs("skiagraph: warning: ", stderr);
    vfprintf(stderr, format, arguments);
    end_sentence();
    va_end(arguments);
}

void cli_note(const char *format, ...) {
    if (is_quiet) return;
    va_list arguments;
    va_start(arguments, format);
    begin_sentence();
    fputs("skiagraph: note: ", stderr);
    vfprintf(stderr, format, arguments);
    end_sentence();
    va_end(arguments);
}

void cli_log(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING) cli_warn("%s", sentence);
    if (level == SKG_LOG_NOTE) cli_note("%s", sentence);
    if (level == SKG_LOG_PROGRESS && isatty(STDERR_FILENO)) cli_note("%s", sentence);
}
