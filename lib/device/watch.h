/* Says that the device is compiling when it takes longer than a second. Private to lib/device. */
#ifndef SKG_WATCH_H
#define SKG_WATCH_H

#include "device/device.h"

/* Calls work(data) and returns when it is done. It runs in a thread of its own, with all signals blocked, while the
 * caller waits: only the caller's thread may write to the log. Once the compilations of a context have taken a second in
 * total, the log gets one line. */
void skg_watch(skg_context *context, void (*work)(void *data), void *data);

#endif
