/* Memory that a disk fetches by itself. Private. */
#ifndef SKG_SCAN_BLOCK_H
#define SKG_SCAN_BLOCK_H

#include "core/core.h"

/* Memory and places of writes past the page cache are multiples of this; no disk has larger blocks. */
enum { SKG_SCAN_BLOCK = 4096 };

/* Allocates bytes that begin `shift` bytes behind a whole block, so that they are aligned like a place in a file. Large
 * ones lie in huge pages where the system has them: the kernel prepares each page for the disk, which takes longer than
 * the transfer if pages are small.
 *
 *     block   result: freed by skg_free
 *     start   result: the bytes */
skg_status skg_scan_block_make(int64_t bytes, int64_t shift, void **block, void **start);

#endif
