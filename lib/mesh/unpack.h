/* Parts of a ZIP archive. Private. */
#ifndef SKG_MESH_UNPACK_H
#define SKG_MESH_UNPACK_H

#include <stdint.h>
#include <stdio.h>

/* A part as the directory of its archive describes it. */
typedef struct {
    int64_t header;          /* place in the file of its own header */
    uint64_t packed, length; /* bytes in the file, and unpacked */
    uint32_t crc;            /* CRC-32 of the unpacked bytes */
    uint32_t method;         /* 0: stored, 8: deflated; others are refused */
    uint32_t flags;
    uint32_t name; /* length of its name */
} skg_packed_part;

/* Whether the part can be unpacked and is what the directory and its own header say. Assimp aborts the process if the check
 * sum of a part is wrong.
 *
 * keep   [most + 1] receives the first `most` bytes and a zero behind them; NULL with most 0: none */
int skg_unpack_is_whole(FILE *stream, const skg_packed_part *part, char *keep, uint64_t most);

#endif
