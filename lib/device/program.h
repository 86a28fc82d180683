/* The programs that a context keeps. Private to lib/device. */
#ifndef SKG_PROGRAM_H
#define SKG_PROGRAM_H

#include "device/device.h"

/* Frees the cache. OpenCL is called only if `ours`: not in a child process after a fork. */
void skg_programs_release(skg_device *device, int ours);

#endif
