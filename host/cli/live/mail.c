/* What waits to be sent to a page. */
#include "live/mail.h"

#include <stdlib.h>
#include <string.h>

live_packet *live_packet_retain(live_packet *packet) {
    if (packet) packet->owners++;
    return packet;
}

void live_packet_release(live_packet **packet) {
    if (*packet && --(*packet)->owners == 0) {
        free((*packet)->bytes);
        free(*packet);
    }
    *packet = NULL;
}

live_packet *live_packet_create(int64_t number, unsigned char *bytes, size_t size) {
    live_packet *packet = malloc(sizeof *packet);
    if (!packet) {
        free(bytes);
        return NULL;
    }
    *packet = (live_packet){.owners = 1, .number = number, .size = size, .bytes = bytes};
    return packet;
}

void live_mail_add(live_mail *mail, int is_binary, const void *bytes, size_t size) {
    unsigned char *copy = malloc(size + 1);
    if (!copy) return;
    memcpy(copy, bytes, size);
    live_packet *letter = live_packet_create(0, copy, size);
    if (!letter) return;
    if (mail->count == LIVE_LETTERS_MAX) {
        int dropped;
        live_packet *oldest = live_mail_take(mail, &dropped);
        live_packet_release(&oldest);
    }
    const int at = (mail->first + mail->count++) % LIVE_LETTERS_MAX;
    mail->letters[at] = letter;
    mail->is_binary[at] = is_binary;
}

live_packet *live_mail_take(live_mail *mail, int *is_binary) {
    if (mail->count == 0) return NULL;
    live_packet *letter = mail->letters[mail->first];
    *is_binary = mail->is_binary[mail->first];
    mail->first = (mail->first + 1) % LIVE_LETTERS_MAX;
    mail->count--;
    return letter;
}

void live_mail_clear(live_mail *mail) {
    int is_binary;
    for (live_packet *letter; (letter = live_mail_take(mail, &is_binary));) live_packet_release(&letter);
}
