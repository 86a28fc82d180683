/* The programs that a context keeps. Private to lib/device. */
#ifndef SKG_PROGRAM_H
#define SKG_PROGRAM_H

#include "device/device.h"

/* Frees the cache; OpenCL is told only where `ours` (not in a child after fork). */
void skg_programs_release(skg_device *device, int ours);

#endif
