/* The last error of each thread, and its sentence. */
#include "core/core.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Long enough for an OpenCL build log of ordinary length; longer ones are cut at the end. */
static _Thread_local char last_error[16384];

const char *skg_status_name(skg_status status) {
    switch (status) {
#define SKG_STATUS_NAME(name, value, text)                                                                   \
    case value:                                                                                              \
        return #name;
        SKG_STATUS_LIST(SKG_STATUS_NAME)
#undef SKG_STATUS_NAME
    default:
        return "SKG_UNKNOWN";
    }
}

const char *skg_status_text(skg_status status) {
    switch (status) {
#define SKG_STATUS_TEXT(name, value, text)                                                                   \
    case value:                                                                                              \
        return text;
        SKG_STATUS_LIST(SKG_STATUS_TEXT)
#undef SKG_STATUS_TEXT
    default:
        return "no status of this library";
    }
}

const char *skg_last_error(void) {
    return last_error;
}

void skg_one_line(char *sentence) {
    for (; *sentence; sentence++)
        if ((unsigned char)*sentence < ' ' || *sentence == 0x7f) *sentence = '?';
}

#ifdef SKG_ASSERTIONS
void skg_assertion_failed(const char *condition, const char *file, int line) {
    fprintf(stderr, "%s:%d: %s does not hold\n", file, line, condition);
    abort();
}
#endif

skg_status skg_fail(skg_status status, const char *format, ...) {
    /* The arguments may quote the last error, so the sentence is formatted in a buffer of its own. */
    static _Thread_local char sentence[sizeof last_error];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    if (status != SKG_ERR_BUILD) skg_one_line(sentence); /* a build log keeps its lines */
    snprintf(last_error, sizeof last_error, "%s", sentence);
    return status;
}
