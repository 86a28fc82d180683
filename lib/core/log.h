/* Where warnings, notes and progress go. Private. */
#ifndef SKG_LOG_H
#define SKG_LOG_H

#include <skiagraph/context.h>

/* A caller's log: of a context, or given with a struct. All zero: none. */
typedef struct {
    skg_log_function call;
    void *user;
} skg_logger;

/* Formats one sentence and gives it to the logger; dropped where it has none. */
void skg_logger_say(const skg_logger *logger, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Same, for the logger of a context; dropped where context is NULL. */
void skg_log(const skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
