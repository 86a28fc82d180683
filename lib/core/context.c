/* The part of a context that every room may use: its life, its log, and its device by name only. */
#include "core/context.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

static void say(const skg_logger *logger, int32_t level, const char *format, va_list arguments) {
    char sentence[4096];
    if (!logger->call) return;
    vsnprintf(sentence, sizeof sentence, format, arguments);
    logger->call(level, sentence, logger->user);
}

void skg_logger_say(const skg_logger *logger, int32_t level, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say(logger, level, format, arguments);
    va_end(arguments);
}

static _Thread_local int is_aside;

void skg_log_from_aside(void) {
    is_aside = 1;
}

void skg_log(const skg_context *context, int32_t level, const char *format, ...) {
    char sentence[SKG_MAILBOX_SENTENCE];
    if (!context) return;
    va_list arguments;
    va_start(arguments, format);
    if (!is_aside) {
        say(&context->log, level, format, arguments);
    } else if (level != SKG_LOG_PROGRESS) {
        vsnprintf(sentence, sizeof sentence, format, arguments);
        skg_mailbox_put(skg_mailbox_address(context->driver), sentence);
    }
    va_end(arguments);
}

skg_status skg_context_log_set(skg_context *context, skg_log_function log, void *user) {
    SKG_TRY(skg_context_enter(context));
    context->log = (skg_logger){log, user};
    return SKG_OK;
}

skg_status skg_context_error_set(skg_context *context, skg_error_function error, void *user) {
    SKG_TRY(skg_context_enter(context));
    context->error = (skg_error_handler){error, user};
    return SKG_OK;
}

/* Not skg_context_enter: another thread is in a call, whose log it is, and a signal handler may not lock. */
skg_status skg_context_interrupt(skg_context *context) {
    SKG_NEEDS(context);
    atomic_store(&context->interrupted, 1);
    return SKG_OK;
}

static _Thread_local int depth; /* of public calls */

skg_call skg_call_begin(const skg_context *context) {
    depth++;
    if (!context) return (skg_call){0};
    skg_turn *turn = skg_turn_retain(context->turn);
    skg_turn_take(turn, NULL);
    return (skg_call){context->error, turn};
}

skg_status skg_call_end(skg_call begun, skg_status status) {
    skg_turn_give(begun.turn);
    skg_turn_release(&begun.turn);
    if (--depth == 0 && SKG_FAILED(status) && begun.error.call)
        begun.error.call(status, skg_last_error(), begun.error.user);
    return status;
}

skg_status skg_context_enter(const skg_context *context) {
    if (!context) return skg_fail(SKG_ERR_ARGUMENT, "no context; make one with skg_context_create");
    if (context->process != (int64_t)getpid())
        return skg_fail(
            SKG_ERR_FORK,
            "the context was made before a fork, and OpenCL does not survive one; start the child process "
            "by exec or spawn");
    char sentence[SKG_MAILBOX_SENTENCE];
    while (context->log.call && skg_mailbox_take(context->driver, sentence))
        skg_log(context, SKG_LOG_WARNING, "%s", sentence);
    return SKG_OK;
}

skg_status skg_context_retain(skg_context *context) {
    SKG_TRY(skg_context_enter(context));
    skg_ref(&context->refs);
    return SKG_OK;
}
