/* Letters that wait to be sent to a page. */
#include "live/mail.h"

#include <stddef.h>

skg_live_letter *live_letter_share(skg_live_letter *letter) {
    if (letter) (void)skg_live_letter_retain(letter);
    return letter;
}

void live_mail_add(live_mail *mail, skg_live_letter *letter) {
    if (!letter) return;
    if (mail->count == LIVE_LETTERS_MAX) {
        skg_live_letter *oldest = live_mail_take(mail);
        skg_live_letter_release(&oldest);
    }
    mail->letters[(mail->first + mail->count++) % LIVE_LETTERS_MAX] = live_letter_share(letter);
}

skg_live_letter *live_mail_take(live_mail *mail) {
    if (mail->count == 0) return NULL;
    skg_live_letter *letter = mail->letters[mail->first];
    mail->first = (mail->first + 1) % LIVE_LETTERS_MAX;
    mail->count--;
    return letter;
}

void live_mail_clear(live_mail *mail) {
    for (skg_live_letter *letter; (letter = live_mail_take(mail));) skg_live_letter_release(&letter);
}
