/* CRC-32C, the checksum of Castagnoli (RFC 3720, section 12.1): it finds damage, not intent. */
#include "core/crc.h"

#include <string.h>

enum { WIDTH = 8, BYTES = 256 };

/* table[k][b]: the remainder of byte b with k zeros behind it. */
typedef struct {
    uint32_t table[WIDTH][BYTES];
} tables;

static void make(tables *t) {
    static const uint32_t polynomial = 0x82F63B78u; /* bits reversed */
    for (uint32_t b = 0; b < BYTES; b++) {
        uint32_t crc = b;
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? polynomial : 0);
        t->table[0][b] = crc;
    }
    for (int k = 1; k < WIDTH; k++)
        for (int b = 0; b < BYTES; b++)
            t->table[k][b] = t->table[k - 1][b] >> 8 ^ t->table[0][t->table[k - 1][b] & 255];
}

/* The tables are made for each call: a few microseconds against the milliseconds of a projection. */
uint32_t skg_crc32c_by_tables(const void *data, size_t bytes) {
    const unsigned char *at = data;
    tables t;
    uint32_t crc = UINT32_MAX;
    make(&t);
    for (; bytes >= WIDTH; at += WIDTH, bytes -= WIDTH) {
        uint32_t next = 0;
        for (int k = 0; k < WIDTH; k++) {
            const uint32_t mixed = at[k] ^ (k < 4 ? crc >> 8 * k : 0);
            next ^= t.table[WIDTH - 1 - k][mixed & 255];
        }
        crc = next;
    }
    for (; bytes > 0; at++, bytes--) crc = crc >> 8 ^ t.table[0][(crc ^ *at) & 255];
    return ~crc;
}

#if defined __x86_64__ && defined __GNUC__
__attribute__((target("sse4.2"))) static uint32_t by_instruction(const void *data, size_t bytes) {
    const unsigned char *at = data;
    uint64_t crc = UINT32_MAX;
    for (; bytes >= sizeof crc; at += sizeof crc, bytes -= sizeof crc) {
        uint64_t word;
        memcpy(&word, at, sizeof word);
        crc = __builtin_ia32_crc32di(crc, word);
    }
    uint32_t rest = (uint32_t)crc;
    for (; bytes > 0; at++, bytes--) rest = __builtin_ia32_crc32qi(rest, *at);
    return ~rest;
}

uint32_t skg_crc32c(const void *data, size_t bytes) {
    return __builtin_cpu_supports("sse4.2") ? by_instruction(data, bytes) : skg_crc32c_by_tables(data, bytes);
}
#else
uint32_t skg_crc32c(const void *data, size_t bytes) {
    return skg_crc32c_by_tables(data, bytes);
}
#endif
