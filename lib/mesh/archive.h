/* Mesh files that are ZIP archives, such as 3MF, read by libzip. Private. */
#ifndef SKG_MESH_ARCHIVE_H
#define SKG_MESH_ARCHIVE_H

#include "core/core.h"

#include <stdio.h>

/* The longest contents of an archive together, unpacked: 1 GiB. */
#define SKG_ARCHIVE_MAX ((int64_t)1 << 30)

/* The most bytes that a deflated byte can stand for: two bits for 258 bytes. */
#define SKG_ARCHIVE_TIMES 1032

/* Fails with SKG_ERR_FORMAT if a file is an archive that is damaged, or announces more than that for its bytes, or that is longer
 * when it is unpacked. A kilobyte can hold a gigabyte of zeros, and Assimp unpacks all that the directory of an archive announces.
 * It aborts the process if the check sum of a part is wrong.
 *
 * stream   the file, for its first bytes */
skg_status skg_archive_check(const char *path, FILE *stream);

/* Whether a file begins as an archive does. */
int skg_archive_is(FILE *stream);

/* Unpacks the first part whose name ends in `end`, without regard to case and to a slash at its start; whole: the name is `end`.
 *
 * text     result: ends with a zero; the caller frees it; NULL: there is no such part
 * errors   as above */
skg_status skg_archive_read(const char *path, const char *end, int whole, char **text);

/* Reads the part that the relationships of a 3MF file name as its model, as skg_archive_read does. name: [SKG_RELATION_MAX] result: the
 * part's */
skg_status skg_archive_read_model(const char *path, char *name, char **text);

#endif
