/* How OpenCL is started, and how drivers are called where they may make threads. Private.
 *
 * PoCL 3.1 starts without a lock, so that two threads that start it at once crash. Its worker threads inherit from the
 * thread that starts it the CPUs, the signal mask and the floating-point environment, which may be narrow, open and
 * unusual. Therefore the process starts OpenCL once, under a lock, in a thread made for this. */
#ifndef SKG_START_H
#define SKG_START_H

#include "core/core.h"
#include "device/platforms.h"

/* Starts OpenCL unless this process has done so. Every public call that may be the first to use OpenCL begins with it.
 * SKG_ERR_FORK if a process has started OpenCL and this one is its child by fork. */
skg_status skg_opencl_start(void);

/* Runs work(argument) in a thread of its own and waits for it. That thread, and so those that a driver makes in it, has
 * the CPUs of skg_cpus_allowed and the default floating-point environment, and blocks the signals that are sent to the
 * process; those that report a fault of the thread itself are not blocked. Dispositions of signals that change are
 * restored. */
skg_status skg_opencl_call(void (*work)(void *argument), void *argument);

/* Asks platforms for their devices in such a thread, so that drivers make their threads there. */
skg_status skg_opencl_touch(skg_platform_list *list);

/* The number of CPUs that the threads of a driver may use; 0: unknown. To be called after skg_opencl_start. */
int32_t skg_opencl_cpu_count(void);

#endif
