/* Drivers that driver=PATH names: libraries that are opened without the OpenCL loader. Private to lib/device.
 *
 * Objects of such a driver (an ICD) begin with a pointer to its functions, as those of every driver, so that the loader's
 * calls work on them. Only the list of platforms, and calls that compare with it, do not know them. */
#ifndef SKG_ICD_H
#define SKG_ICD_H

#include "core/core.h"
#include "device/platforms.h"

/* Lists the loader's platforms, then those of drivers that were opened, in the order of opening. So a platform keeps its
 * number. No platform is no failure. */
skg_status skg_platforms_find(skg_platform_list *list);

/* Opens the library at this path, and lists its platforms. It stays loaded until the process ends, because its threads do.
 * To be called after skg_opencl_start. SKG_ERR_NO_DEVICE: it cannot be loaded, is no driver, or has no platform. */
skg_status skg_icd_open(const char *path, skg_platform_list *list);

/* 1: the platform came from skg_icd_open, and the loader does not list it. */
int skg_icd_has(cl_platform_id platform);

#endif
