/* Huge pages for the buffers of a CPU. Private to lib/device. */
#ifndef SKG_PAGES_H
#define SKG_PAGES_H

#include "device/device.h"

/* Makes a large buffer of a CPU in memory of our own that asks for huge pages. In a driver's own memory the first frame
 * enters each page of 4 KiB by itself: 5 to 9 ms for 16 MiB of accumulators, and 0.8 ms with huge pages (EPYC, Linux 6.18).
 * OpenCL drops the memory with the buffer. NULL: the buffer is small, the device is no CPU, or there is no such memory;
 * then OpenCL allocates. */
cl_mem skg_pages_buffer(const skg_device *device, int64_t bytes, cl_mem_flags flags);

#endif
