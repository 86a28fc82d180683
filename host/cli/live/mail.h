/* What waits to be sent to a page. */
#ifndef CLI_LIVE_MAIL_H
#define CLI_LIVE_MAIL_H

#include <stddef.h>
#include <stdint.h>

/* Bytes that several pages share. */
typedef struct {
    int owners;
    int64_t number;
    size_t size;
    unsigned char *bytes;
} live_packet;

/* One more owner of a packet, or one less; the last one frees it. Under the hub's lock. */
live_packet *live_packet_retain(live_packet *packet);
void live_packet_release(live_packet **packet);

/* NULL without memory; takes over the bytes. */
live_packet *live_packet_create(int64_t number, unsigned char *bytes, size_t size);

enum { LIVE_LETTERS_MAX = 64 };

/* Texts and files, in order. */
typedef struct {
    live_packet *letters[LIVE_LETTERS_MAX];
    int is_binary[LIVE_LETTERS_MAX];
    int first, count;
} live_mail;

/* Adds a copy; the oldest is dropped where there are too many. */
void live_mail_add(live_mail *mail, int is_binary, const void *bytes, size_t size);

/* Takes the oldest; NULL: there is none. */
live_packet *live_mail_take(live_mail *mail, int *is_binary);
void live_mail_clear(live_mail *mail);

#endif
