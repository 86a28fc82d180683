/* Memory for a buffer of a CPU, entered before the first frame needs it. Private to lib/device. */
#ifndef SKG_PAGES_H
#define SKG_PAGES_H

#include "device/device.h"

/* Plans memory for an expected buffer, of a CPU only. If that fails, nothing is expected. */
void skg_pages_expect(skg_device *device, int64_t bytes, int64_t count, const skg_byte_range *ranges);

/* Allocates the memory, and writes to each page of the ranges: the system clears a page when it is first written, which takes
 * longer than a whole frame for 16 MiB of accumulators (4 to 6 ms on an EPYC with Linux 6.18). */
void skg_pages_enter(skg_device *device);

/* Makes a buffer with these flags in that memory, if it has this size. OpenCL drops the memory with the buffer. NULL: there is
 * none, and OpenCL allocates. */
cl_mem skg_pages_take(skg_device *device, int64_t bytes, cl_mem_flags flags);

/* Frees the memory if no buffer has taken it. */
void skg_pages_drop(skg_device *device);

#endif
