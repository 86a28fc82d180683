/* The log of the library, messages of other threads, progress. Private. */
#ifndef SKG_LOG_H
#define SKG_LOG_H

#include "core/core.h"

#include <skiagraph/context.h>
#include <skiagraph/progress.h>

/* --- Where warnings, notes and progress go. */

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

/* From now on what this thread says to a context's log waits in its mailbox for the next call of the program. */
void skg_log_from_aside(void);

/* --- Sentences that threads of a driver leave for the thread that owns a context. *
 * An OpenCL driver may call back from a thread of its own at any time, also after the context was released, and
 * OpenCL 1.2 does not say which call is the last. The driver therefore holds an address that is a number, not a
 * pointer: it is looked up, under one lock of the process, among the mailboxes that exist. A sentence for a mailbox
 * that is gone is dropped. */

/* Sentences that a mailbox keeps, and the bytes of one with its closing zero; what goes beyond is cut off. */
enum { SKG_MAILBOX_CAPACITY = 16, SKG_MAILBOX_SENTENCE = 512 };

typedef struct skg_mailbox skg_mailbox;

skg_status skg_mailbox_create(skg_mailbox **mailbox);
void skg_mailbox_release(skg_mailbox **mailbox);

/* Address by which a callback reaches the mailbox; not to be dereferenced. */
void *skg_mailbox_address(const skg_mailbox *mailbox);

/* Leaves a sentence; from any thread, whether or not the mailbox still exists. */
void skg_mailbox_put(const void *address, const char *sentence);

/* Takes the oldest sentence out; returns 0 when there is none. The last one says how many did not fit. */
int skg_mailbox_take(skg_mailbox *mailbox, char sentence[SKG_MAILBOX_SENTENCE]);

/* --- How far long work is. */

/* Says how far the work is; SKG_ERR_CANCELLED if it is to end. progress: NULL: nobody wants to know. */
skg_status skg_progress_step(skg_progress *progress, int64_t done, int64_t total);

/* Adds an owner and returns the progress; NULL of NULL. */
skg_progress *skg_progress_keep(skg_progress *progress);

#endif
