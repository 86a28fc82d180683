/* SHA-256 (FIPS 180-4) by libmd, which names and checks what the library keeps on disk. */
#include "core/digest.h"

#include <stdio.h>
#include <string.h>

void skg_digest_start(skg_digester *digester) {
    SHA256Init(digester);
}

void skg_digest_add(skg_digester *digester, const void *data, size_t bytes) {
    if (bytes > 0) SHA256Update(digester, data, bytes);
}

void skg_digest_add_text(skg_digester *digester, const char *text) {
    const char *given = text ? text : "";
    skg_digest_add(digester, given, strlen(given) + 1);
}

skg_digest skg_digest_end(skg_digester *digester) {
    skg_digest digest;
    SHA256Final(digest.bytes, digester);
    return digest;
}

skg_digest skg_digest_of(const void *data, size_t bytes) {
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add(&digester, data, bytes);
    return skg_digest_end(&digester);
}

int skg_digest_same(const skg_digest *a, const skg_digest *b) {
    return memcmp(a->bytes, b->bytes, sizeof a->bytes) == 0;
}

void skg_digest_text(const skg_digest *digest, char text[SKG_DIGEST_TEXT]) {
    for (size_t i = 0; i < sizeof digest->bytes; i++) snprintf(text + 2 * i, 3, "%02x", digest->bytes[i]);
}
