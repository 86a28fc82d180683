/* Letters that wait to be sent to a page. */
#ifndef CLI_LIVE_MAIL_H
#define CLI_LIVE_MAIL_H

#include <skiagraph/live.h>

enum { LIVE_LETTERS_MAX = 64 };

/* Texts and files, in order. */
typedef struct {
    skg_live_letter *letters[LIVE_LETTERS_MAX];
    int first, count;
} live_mail;

/* One more owner of a letter; NULL of NULL. */
skg_live_letter *live_letter_share(skg_live_letter *letter);

/* Adds a letter, which other owners keep; the oldest is dropped where there are too many. */
void live_mail_add(live_mail *mail, skg_live_letter *letter);

/* Takes the oldest; NULL: there is none. */
skg_live_letter *live_mail_take(live_mail *mail);
void live_mail_clear(live_mail *mail);

#endif
