/* SHA-256 (FIPS 180-4), to name contents. Private. */
#ifndef SKG_SHA256_H
#define SKG_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { SKG_SHA256_TEXT = 65 }; /* 64 hexadecimal digits and a zero */

typedef struct {
    uint32_t state[8];
    uint64_t bytes;
    unsigned char block[64];
} skg_sha256;

void skg_sha256_begin(skg_sha256 *hash);
void skg_sha256_add(skg_sha256 *hash, const void *data, size_t count);
void skg_sha256_end(skg_sha256 *hash, char text[SKG_SHA256_TEXT]);

#endif
