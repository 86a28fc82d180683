/* Sentences of the threads of a driver, kept until the thread that uses the context can log them. */
#include "core/log.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>

struct skg_mailbox {
    skg_mailbox *next;
    uintptr_t number;
    atomic_int waiting; /* sentences and the note on dropped ones; read without the lock */
    int32_t first, count, dropped;
    char sentences[SKG_MAILBOX_CAPACITY][SKG_MAILBOX_SENTENCE]; /* a ring that starts at first */
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static skg_mailbox *mailboxes;
static uintptr_t last_number;

/* A child process may be forked while a driver's thread holds the lock. */
static void take_lock(void) {
    pthread_mutex_lock(&lock);
}

static void give_lock(void) {
    pthread_mutex_unlock(&lock);
}

static void survive_fork(void) {
    pthread_atfork(take_lock, give_lock, give_lock);
}

skg_status skg_mailbox_create(skg_mailbox **mailbox) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, survive_fork);
    SKG_TRY(skg_alloc(1, sizeof **mailbox, "mailbox", mailbox));
    take_lock();
    (*mailbox)->number = ++last_number;
    (*mailbox)->next = mailboxes;
    mailboxes = *mailbox;
    give_lock();
    return SKG_OK;
}

void skg_mailbox_release(skg_mailbox **mailbox) {
    if (!*mailbox) return;
    take_lock();
    skg_mailbox **link = &mailboxes;
    while (*link != *mailbox) link = &(*link)->next;
    *link = (*mailbox)->next;
    give_lock();
    skg_free(mailbox);
}

void *skg_mailbox_address(const skg_mailbox *mailbox) {
    return (void *)mailbox->number;
}

void skg_mailbox_put(const void *address, const char *sentence) {
    take_lock();
    skg_mailbox *mailbox = mailboxes;
    while (mailbox && mailbox->number != (uintptr_t)address) mailbox = mailbox->next;
    if (mailbox && mailbox->count == SKG_MAILBOX_CAPACITY) {
        mailbox->dropped++;
    } else if (mailbox) {
        int32_t at = (mailbox->first + mailbox->count++) % SKG_MAILBOX_CAPACITY;
        snprintf(mailbox->sentences[at], SKG_MAILBOX_SENTENCE, "%s", sentence);
    }
    if (mailbox) atomic_store(&mailbox->waiting, mailbox->count + (mailbox->dropped > 0));
    give_lock();
}

int skg_mailbox_take(skg_mailbox *mailbox, char sentence[SKG_MAILBOX_SENTENCE]) {
    if (atomic_load(&mailbox->waiting) == 0) return 0;
    take_lock();
    if (mailbox->count > 0) {
        snprintf(sentence, SKG_MAILBOX_SENTENCE, "%s", mailbox->sentences[mailbox->first]);
        mailbox->first = (mailbox->first + 1) % SKG_MAILBOX_CAPACITY;
        mailbox->count--;
    } else {
        snprintf(sentence, SKG_MAILBOX_SENTENCE, "%" PRId32 " more sentences were dropped", mailbox->dropped);
        mailbox->dropped = 0;
    }
    atomic_store(&mailbox->waiting, mailbox->count + (mailbox->dropped > 0));
    give_lock();
    return 1;
}
