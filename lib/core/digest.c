/* SHA-256 (FIPS 180-4), which names and checks what the library keeps on disk. */
#include "core/digest.h"

#include <stdio.h>
#include <string.h>

enum { ROUNDS = 64, BLOCK = 64 };

/* The first 32 bits of the fractional parts of the cube roots of the first 64 primes. */
static const uint32_t constants[ROUNDS] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t turned(uint32_t word, int bits) {
    return word >> bits | word << (32 - bits);
}

static void add_block(uint32_t state[8], const uint8_t *block) {
    uint32_t words[ROUNDS], s[8];
    for (int i = 0; i < 16; i++)
        words[i] = (uint32_t)block[4 * i] << 24 | (uint32_t)block[4 * i + 1] << 16 |
                   (uint32_t)block[4 * i + 2] << 8 | block[4 * i + 3];
    for (int i = 16; i < ROUNDS; i++) {
        const uint32_t a = words[i - 15], b = words[i - 2];
        words[i] = words[i - 16] + (turned(a, 7) ^ turned(a, 18) ^ a >> 3) + words[i - 7] +
                   (turned(b, 17) ^ turned(b, 19) ^ b >> 10);
    }
    memcpy(s, state, sizeof s);
    /* Instead of moving the eight words up in each round, round i takes word k from place (k - i) mod 8. Eight rounds
     * together, so that places are known when this is compiled. */
    for (int i = 0; i < ROUNDS; i += 8)
        for (int r = 0; r < 8; r++) {
            const uint32_t a = s[(8 - r) % 8], b = s[(9 - r) % 8], c = s[(10 - r) % 8];
            const uint32_t e = s[(12 - r) % 8], f = s[(13 - r) % 8], g = s[(14 - r) % 8];
            const uint32_t chosen = (e & f) ^ (~e & g), majority = (a & b) ^ (a & c) ^ (b & c);
            const uint32_t first = s[(15 - r) % 8] + (turned(e, 6) ^ turned(e, 11) ^ turned(e, 25)) + chosen +
                                   constants[i + r] + words[i + r];
            s[(11 - r) % 8] += first;
            s[(15 - r) % 8] = first + (turned(a, 2) ^ turned(a, 13) ^ turned(a, 22)) + majority;
        }
    for (int i = 0; i < 8; i++) state[i] += s[i];
}

void skg_digest_start(skg_digester *digester) {
    static const uint32_t start[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    memcpy(digester->state, start, sizeof start);
    digester->length = 0;
}

void skg_digest_add(skg_digester *digester, const void *data, size_t bytes) {
    const uint8_t *at = data;
    size_t used = (size_t)(digester->length % BLOCK);
    digester->length += bytes;
    while (bytes > 0) {
        const size_t part = bytes < BLOCK - used ? bytes : BLOCK - used;
        memcpy(digester->block + used, at, part);
        at += part, bytes -= part, used += part;
        if (used < BLOCK) return;
        add_block(digester->state, digester->block);
        used = 0;
    }
}

void skg_digest_add_text(skg_digester *digester, const char *text) {
    const char *given = text ? text : "";
    skg_digest_add(digester, given, strlen(given) + 1);
}

skg_digest skg_digest_end(skg_digester *digester) {
    static const uint8_t padding[BLOCK] = {0x80};
    const uint64_t bits = digester->length * 8;
    const size_t used = (size_t)(digester->length % BLOCK);
    uint8_t last[8];
    skg_digest digest;
    for (int i = 0; i < 8; i++) last[i] = (uint8_t)(bits >> (56 - 8 * i));
    skg_digest_add(digester, padding, (used < 56 ? 56 : 120) - used);
    skg_digest_add(digester, last, sizeof last);
    for (int i = 0; i < 32; i++) digest.bytes[i] = (uint8_t)(digester->state[i / 4] >> (24 - 8 * (i % 4)));
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
