/* How far long work is. Private. */
#ifndef SKG_CORE_PROGRESS_H
#define SKG_CORE_PROGRESS_H

#include <skiagraph/progress.h>

/* Says how far the work is; SKG_ERR_CANCELLED if it is to end. progress: NULL: nobody wants to know. */
skg_status skg_progress_step(skg_progress *progress, int64_t done, int64_t total);

/* Adds an owner and returns the progress; NULL of NULL. */
skg_progress *skg_progress_keep(skg_progress *progress);

#endif
