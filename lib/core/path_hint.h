/* What may be meant by the path of a file that is not there. Private. */
#ifndef SKG_PATH_HINT_H
#define SKG_PATH_HINT_H

#include "core/core.h"

/* Fails with SKG_ERR_FILE, "PATH: cannot be read: REASON", and a hint where a file of almost this path exists: one with
 * / for every backslash, or one whose name is spelled in other case.
 *
 * reason   a value of errno */
skg_status skg_fail_unreadable(const char *path, int reason);

#endif
