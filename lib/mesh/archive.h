/* Mesh files that are ZIP archives, such as 3MF. Private. */
#ifndef SKG_MESH_ARCHIVE_H
#define SKG_MESH_ARCHIVE_H

#include "core/core.h"

#include <stdio.h>

/* The longest contents of an archive together, unpacked: 1 GiB. */
#define SKG_ARCHIVE_MAX ((int64_t)1 << 30)

/* Fails with SKG_ERR_FORMAT if a file is an archive that is damaged, or that is longer when it is unpacked. A kilobyte can
 * hold a gigabyte of zeros, and Assimp unpacks all that the directory of an archive announces. It aborts the process if the
 * check sum of a part is wrong. */
skg_status skg_archive_check(const char *path, FILE *stream, int64_t size);

#endif
