/* Writes into a PNG which program made it. */
#include "view/picture.h"

#include "common/say.h"

#include <skiagraph/version.h>

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The signature of a PNG file and its header chunk (PNG specification, 5.2 and 11.2.2). */
enum { HEADER = 8 + 25 };

/* CRC-32 of a chunk's type and data (PNG specification, annex D). */
static uint32_t crc_of(const unsigned char *bytes, size_t count) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

static void put_word(unsigned char *to, uint32_t word) {
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(word >> (24 - 8 * k));
}

int view_sign(unsigned char **bytes, size_t *count) {
    /* type, keyword, a zero, text */
    static const char chunk[] = "tEXtSoftware\0skiagraph " SKG_VERSION;
    const size_t length = sizeof chunk - 1, added = length + 8;
    unsigned char *larger = realloc(*bytes, *count + added);
    if (!larger) return cli_error(CLI_DEVICE, "out of host memory for the picture");
    unsigned char *at = larger + HEADER;
    memmove(at + added, at, *count - HEADER);
    put_word(at, (uint32_t)(length - 4));
    memcpy(at + 4, chunk, length);
    put_word(at + 4 + length, crc_of(at + 4, length));
    *bytes = larger;
    *count += added;
    return CLI_DONE;
}
