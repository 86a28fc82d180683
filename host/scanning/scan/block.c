/* Memory that a disk fetches by itself. */
#define _GNU_SOURCE /* madvise */
#include "scan/block.h"

#include <sys/mman.h>

enum { HUGE_PAGE = 1 << 21 };

skg_status skg_scan_block_make(int64_t bytes, int64_t shift, void **block, void **start) {
    const int64_t unit = bytes < HUGE_PAGE ? SKG_SCAN_BLOCK : HUGE_PAGE;
    SKG_TRY(skg_alloc(bytes + shift + unit, 1, "batch of projections", block));
    char *aligned = (char *)*block + (unit - (int64_t)((uintptr_t)*block % (uintptr_t)unit)) % unit;
    *start = aligned + shift;
#ifdef MADV_HUGEPAGE
    if (unit == HUGE_PAGE) /* a wish; nothing depends on it */
        (void)madvise(aligned, (size_t)((bytes + shift) / unit * unit), MADV_HUGEPAGE);
#endif
    return SKG_OK;
}
