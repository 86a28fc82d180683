/* Sentences that threads of a driver leave for the thread that owns a context. Private.
 *
 * An OpenCL driver may call back from a thread of its own at any time, also after the context was released, and
 * OpenCL 1.2 does not say which call is the last. The driver therefore holds an address that is a number, not a
 * pointer: it is looked up, under one lock of the process, among the mailboxes that exist. A sentence for a mailbox
 * that is gone is dropped. */
#ifndef SKG_MAILBOX_H
#define SKG_MAILBOX_H

#include "core/core.h"

/* Sentences that a mailbox keeps, and the bytes of one with its closing zero; what goes beyond is cut off. */
enum { SKG_MAILBOX_CAPACITY = 16, SKG_MAILBOX_SENTENCE = 512 };

typedef struct skg_mailbox skg_mailbox;

skg_status skg_mailbox_create(skg_mailbox **mailbox);
void skg_mailbox_release(skg_mailbox **mailbox);

/* What a callback is given to reach the mailbox; not to be dereferenced. */
void *skg_mailbox_address(const skg_mailbox *mailbox);

/* Leaves a sentence; from any thread, whether or not the mailbox still exists. */
void skg_mailbox_put(const void *address, const char *sentence);

/* Takes the oldest sentence out; returns 0 when there is none. The last one says how many did not fit. */
int skg_mailbox_take(skg_mailbox *mailbox, char sentence[SKG_MAILBOX_SENTENCE]);

#endif
