/* What makes one device with its driver differ from another. Compiled kernels and verdicts are kept under it. Private to
 * lib/device. */
#ifndef SKG_IDENTITY_H
#define SKG_IDENTITY_H

#include "core/digest.h"

#include <CL/cl.h>

/* The digest of the names and versions of platform, device and driver; of the processor's name and features if the
 * device is a CPU, because a folder may be shared by machines; of the environment variables that change what the driver
 * compiles; and of the version of this library. A part of a device
 * (threads=) has that of the whole. */
skg_digest skg_identity_of(cl_platform_id platform, cl_device_id device);

/* 1: the device's platform has this in its name. */
int skg_platform_is(cl_platform_id platform, const char *part_of_name);

#endif
