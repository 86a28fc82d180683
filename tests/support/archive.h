/* ZIP archives of a few texts that are stored, not compressed, written without the library. */
#ifndef SKG_TESTS_ARCHIVE_H
#define SKG_TESTS_ARCHIVE_H

#include <stddef.h>
#include <stdint.h>

enum { FILES_MAX = 4, ARCHIVE_BYTES = 1 << 17 };

typedef struct {
    unsigned char bytes[ARCHIVE_BYTES];
    size_t size, directory; /* of the archive; where its directory begins */
} archive;

/* Appends the low bytes of a number. */
void put(archive *a, uint64_t value, int count);

/* Begins anew with these files, which fit in ARCHIVE_BYTES. */
void make_archive_of(archive *a, int count, const char *const *names, const char *const *texts);

#endif
