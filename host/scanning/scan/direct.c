/* Projections past the page cache. A copy into it takes about as long as a disk of 2 GB/s, on the cores that compute; the
 * disk fetches whole blocks from our memory itself. What begins or ends within a block goes through the cache. */
#define _GNU_SOURCE /* O_DIRECT */
#include "scan/block.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#ifndef O_DIRECT
#define O_DIRECT 0 /* of systems without it: the cache takes everything */
#endif

/* PIECE: of memory that is not aligned, what is copied at a time. LEAST: below it a request costs more than the copy. */
enum { PIECE = 1 << 21, LEAST = 1 << 16 };

void skg_scan_open_direct(skg_scan_file *file) {
    if (O_DIRECT) file->direct = open(file->path, O_WRONLY | O_DIRECT | O_CLOEXEC);
}

/* Writes through the cache what the file system refuses to write directly, and the rest of a short write; the cache also gives the reason
 * if the disk is full. */
static skg_status write_piece(skg_scan_file *file, const char *from, int64_t count, int64_t at) {
    ssize_t put = -1;
    do put = file->direct >= 0 ? pwrite(file->direct, from, (size_t)count, (off_t)at) : 0;
    while (put < 0 && errno == EINTR);
    if (put < 0) {
        close(file->direct);
        file->direct = -1;
        put = 0;
    }
    return skg_scan_write_at(file->path, file->data, from + put, count - put, at + put);
}

static skg_status write_blocks(skg_scan_file *file, const char *from, int64_t count, int64_t at) {
    if ((uintptr_t)from % SKG_SCAN_BLOCK == 0) return write_piece(file, from, count, at);
    if (!file->copies) SKG_TRY(skg_scan_block_make(PIECE, 0, &file->copies_block, &file->copies));
    for (int64_t done = 0; done < count; done += PIECE) {
        const int64_t piece = count - done < PIECE ? count - done : PIECE;
        memcpy(file->copies, from + done, (size_t)piece);
        SKG_TRY(write_piece(file, file->copies, piece, at + done));
    }
    return SKG_OK;
}

skg_status skg_scan_write_large(skg_scan_file *file, const void *bytes, int64_t count, int64_t at) {
    const char *from = bytes;
    const int64_t head = (SKG_SCAN_BLOCK - at % SKG_SCAN_BLOCK) % SKG_SCAN_BLOCK;
    if (file->direct < 0 || count - head < LEAST)
        return skg_scan_write_at(file->path, file->data, bytes, count, at);
    const int64_t blocks = (count - head) / SKG_SCAN_BLOCK * SKG_SCAN_BLOCK, tail = head + blocks;
    SKG_TRY(skg_scan_write_at(file->path, file->data, from, head, at));
    SKG_TRY(write_blocks(file, from + head, blocks, at + head));
    return skg_scan_write_at(file->path, file->data, from + tail, count - tail, at + tail);
}
