/* The programs that a context keeps. Private to lib/device. */
#ifndef SKG_PROGRAM_H
#define SKG_PROGRAM_H

#include "device/device.h"

/* Keeps the programs that were launched and are not kept yet. To be called before the context ends. */
void skg_programs_keep(const skg_device *device);

/* Frees the cache. OpenCL is called only if `ours`: not in a child process after a fork. */
void skg_programs_release(skg_device *device, int ours);

#endif
