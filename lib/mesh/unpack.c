/* Parts of a ZIP archive. */
#include "mesh/unpack.h"

#include <string.h>
#include <zlib.h>

enum { HEADER = 30, PIECE = 1 << 14 };

/* What is left of a part, and what it gave so far. */
typedef struct {
    FILE *stream;
    uint64_t left, length;
    uLong crc;
    char *keep; /* receives the first `most` bytes */
    uint64_t most;
} reader;

static size_t next(reader *r, unsigned char *bytes) {
    const size_t count = r->left < PIECE ? (size_t)r->left : PIECE;
    r->left -= count;
    return fread(bytes, 1, count, r->stream) == count ? count : 0;
}

static void take(reader *r, const unsigned char *bytes, size_t count) {
    const uint64_t room = r->length < r->most ? r->most - r->length : 0;
    if (room > 0) memcpy(r->keep + r->length, bytes, room < count ? (size_t)room : count);
    r->crc = crc32(r->crc, bytes, (uInt)count);
    r->length += count;
}

static int read_stored(reader *r) {
    unsigned char bytes[PIECE];
    while (r->left > 0) {
        const size_t count = next(r, bytes);
        if (count == 0) return 0;
        take(r, bytes, count);
    }
    return 1;
}

/* most: more than this is not unpacked */
static int read_deflated(reader *r, uint64_t most) {
    unsigned char packed[PIECE], bytes[PIECE];
    z_stream z;
    int result = Z_OK;
    memset(&z, 0, sizeof z);
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK) return 0; /* negative: no header of zlib */
    while (result == Z_OK && r->length <= most) {
        if (z.avail_in == 0) z.avail_in = (uInt)next(r, packed), z.next_in = packed;
        z.next_out = bytes, z.avail_out = sizeof bytes;
        result = inflate(&z, Z_NO_FLUSH); /* without input: Z_BUF_ERROR */
        take(r, bytes, sizeof bytes - z.avail_out);
    }
    inflateEnd(&z);
    return result == Z_STREAM_END;
}

static uint32_t number(const unsigned char *bytes, int count) {
    uint32_t value = 0;
    for (int b = count - 1; b >= 0; b--) value = value << 8 | bytes[b];
    return value;
}

/* Whether the header before a part agrees with the directory, as Assimp's reader of archives asks for. */
static int agrees(const unsigned char *header, const skg_packed_part *part) {
    enum { LATER = 8, ENCRYPTED = 1 }; /* LATER: sizes and check sum stand behind the part */
    if (memcmp(header, "PK\3\4", 4) != 0 || number(header + 8, 2) != part->method ||
        number(header + 26, 2) != part->name || part->flags & ENCRYPTED)
        return 0;
    if (number(header + 6, 2) & LATER) return 1;
    const uint32_t packed = number(header + 18, 4), length = number(header + 22, 4);
    return number(header + 14, 4) == part->crc && (packed == UINT32_MAX || packed == part->packed) &&
           (length == UINT32_MAX || length == part->length);
}

int skg_unpack_is_whole(FILE *stream, const skg_packed_part *part, char *keep, uint64_t most) {
    unsigned char header[HEADER];
    reader r = {.stream = stream, .left = part->packed, .crc = crc32(0, NULL, 0), .keep = keep, .most = most};
    if ((part->method != 0 && part->method != 8) || part->header < 0 ||
        fseek(stream, (long)part->header, SEEK_SET) != 0 || fread(header, 1, HEADER, stream) != HEADER)
        return 0;
    const long names = (long)number(header + 26, 2) + (long)number(header + 28, 2);
    if (!agrees(header, part) || fseek(stream, names, SEEK_CUR) != 0) return 0;
    if (!(part->method ? read_deflated(&r, part->length) : read_stored(&r))) return 0;
    if (keep) keep[r.length < most ? r.length : most] = '\0';
    return r.length == part->length && r.crc == part->crc;
}
