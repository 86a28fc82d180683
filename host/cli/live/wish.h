/* A wish of a page: its message, and what that says. */
#ifndef CLI_LIVE_WISH_H
#define CLI_LIVE_WISH_H

#include <jansson.h>
#include <skiagraph/live.h>

enum { LIVE_SENTENCE = 1024 };

typedef struct {
    skg_live_message *message;
    skg_live_asked says; /* valid as long as the message */
} live_wish;

/* Takes over a message. */
live_wish live_wish_of(skg_live_message *message);

/* A scene as its file has it; without memory its message is NULL, which calls refuse. */
live_wish live_wish_plain(void);
live_wish live_wish_copy(const live_wish *wish);
void live_wish_free(live_wish *wish);

/* Makes keys of a wish others. changes: an object, which is released. Returns 0 with a sentence. */
int live_wish_change(live_wish *wish, json_t *changes, char *sentence);

/* Copies the library's last sentence and returns 0. */
int live_fail(char *sentence);

/* A letter with a text of an object, which is released; NULL without memory. */
skg_live_letter *live_letter_of(json_t *object);

#endif
