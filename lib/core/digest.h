/* SHA-256 (FIPS 180-4) by libmd, which names and checks what the library keeps on disk. Private. */
#ifndef SKG_DIGEST_H
#define SKG_DIGEST_H

#include <sha2.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t bytes[32];
} skg_digest;

/* A digest that is being computed. */
typedef SHA2_CTX skg_digester;

void skg_digest_start(skg_digester *digester);
void skg_digest_add(skg_digester *digester, const void *data, size_t bytes);

/* Adds a text with its final zero, so that "ab" + "c" and "a" + "bc" differ. NULL counts as "". */
void skg_digest_add_text(skg_digester *digester, const char *text);

skg_digest skg_digest_end(skg_digester *digester);

/* The digest of one block of memory. */
skg_digest skg_digest_of(const void *data, size_t bytes);

/* 1: the same */
int skg_digest_same(const skg_digest *a, const skg_digest *b);

enum { SKG_DIGEST_TEXT = 65 };

/* Writes 64 hexadecimal digits and a zero. */
void skg_digest_text(const skg_digest *digest, char text[SKG_DIGEST_TEXT]);

#endif
