#include "common/say.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int is_quiet;

void cli_set_quiet(int quiet) {
    is_quiet = quiet;
}

int cli_is_quiet(void) {
    return is_quiet;
}

int cli_error(int exit_status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("skiagraph: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
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
}
