#include "core/context.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

void skg_log(skg_context *context, int32_t level, const char *format, ...) {
    if (!context || !context->log) return;
    char sentence[4096];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    context->log(level, sentence, context->log_user);
}

skg_status skg_context_log_set(skg_context *context, skg_log_function log, void *user) {
    SKG_TRY(skg_context_enter(context));
    context->log = log;
    context->log_user = user;
    return SKG_OK;
}

skg_status skg_context_enter(const skg_context *context) {
    if (!context) return skg_fail(SKG_ERR_ARGUMENT, "no context; make one with skg_context_create");
    if (context->process != (int64_t)getpid())
        return skg_fail(
            SKG_ERR_FORK,
            "the context was made before a fork, and OpenCL does not survive one; make a new context in "
            "the child process");
    return SKG_OK;
}

skg_status skg_context_retain(skg_context *context) {
    SKG_TRY(skg_context_enter(context));
    skg_ref(&context->refs);
    return SKG_OK;
}
