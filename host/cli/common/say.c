#include "common/say.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int is_quiet;
static cli_failure first; /* of this run */

void cli_set_quiet(int quiet) {
    is_quiet = quiet;
}

int cli_is_quiet(void) {
    return is_quiet;
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
    fputs("skiagraph: ", stderr);
    vfprintf(stderr, format, arguments); /* whole, whatever its length */
    fputc('\n', stderr);
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
    fputs("skiagraph: warning: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

void cli_log(int32_t level, const char *sentence, void *user) {
    (void)user;
    if (level == SKG_LOG_WARNING)
        cli_warn("%s", sentence);
    else if (level == SKG_LOG_NOTE && !is_quiet)
        fprintf(stderr, "skiagraph: note: %s\n", sentence);
    else if (level == SKG_LOG_PROGRESS && !is_quiet && isatty(STDERR_FILENO))
        fprintf(stderr, "skiagraph: %s\n", sentence);
}
