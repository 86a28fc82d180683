/* Workarounds for OpenCL drivers, each for what one driver does or lacks. They need no open device. Private. */
#ifndef SKG_DRIVER_H
#define SKG_DRIVER_H

#include "core/context.h"
#include "core/digest.h"

#include <CL/cl.h>

/* --- known platforms (platforms.c)
 *
 * A driver that is not known may end, crash or block the process that calls it. The library therefore asks such a platform for
 * its devices only if the caller names one, or if one of them has passed its self-test on this machine. */

/* Maximum number of platforms; further ones are ignored. */
enum { SKG_PLATFORMS_MAX = 32 };

typedef struct {
    cl_platform_id items[SKG_PLATFORMS_MAX];
    int32_t count;
} skg_platform_list;

int skg_platform_listed(const skg_platform_list *platforms, cl_platform_id platform);

/* 1: the platform is known. Reads only its name, which the OpenCL loader has read before. */
int skg_platform_is_known(cl_platform_id platform);

/* 1: kernels may use the builtins of clang where `__has_builtin` reports them. Elsewhere that is not enough: Rusticl's front end
 * is clang, and its translator ends the process when it meets some of them. */
int skg_platform_has_clang(cl_platform_id platform);

/* 1: the platform's name contains this text. */
int skg_platform_is(cl_platform_id platform, const char *part_of_name);

/* "?" if it has none. */
void skg_platform_name(cl_platform_id platform, char *name, size_t size);

/* --- environment variables of drivers (environment.c) */

/* 1: the driver caches compiled kernels itself. PoCL does, unless POCL_KERNEL_CACHE=0. */
int skg_driver_has_cache(cl_platform_id platform);

/* The environment variable that sets the driver's number of threads. NULL: none is known. */
const char *skg_driver_threads_variable(const char *platform_name);

/* Adds the variables that change what PoCL and Intel's runtime compile. */
void skg_driver_environment_add(skg_digester *digester);

/* --- drivers that would end the process (faults.c) */

/* 1: the compiler of this PoCL fails on this processor.
 *
 * PoCL before 3.1, if it is built for many processors, chooses its library of built-in functions by the features of the processor,
 * and the machine to compile for by LLVM's name of the processor. An LLVM that is older than the processor takes it for an older
 * one without AVX-512 (Zen 4 for "znver3"), or for "generic". Functions with and without AVX-512 then meet in one kernel, and LLVM
 * ends the process: "Cannot emit physreg copy instruction".
 * has_avx512: whether the processor has AVX-512. */
int skg_pocl_fails(const skg_device_info *info, int has_avx512);

/* SKG_ERR_DEVICE if the device's driver is known to end the process on this processor. */
skg_status skg_faults_check(const skg_device_info *info);

/* --- CPUs of a driver's threads (cpus.c) */

enum { SKG_CPUS_MAX = 8192 };

/* One bit for each CPU, in the layout of cpu_set_t. */
typedef struct {
    unsigned long words[SKG_CPUS_MAX / (8 * sizeof(unsigned long))];
} skg_cpus;

/* The CPUs of the calling thread. Empty if the system does not report them. */
void skg_cpus_get(skg_cpus *cpus);

/* Binds the calling thread to these CPUs. An empty set changes nothing. */
void skg_cpus_set(const skg_cpus *cpus);

int32_t skg_cpus_count(const skg_cpus *cpus);

/* The CPUs that a driver's threads may use if a thread with the CPUs `thread` starts them: the union of OpenMP's places
 * if OpenMP binds threads and `thread` lies inside the union, because then OpenMP has narrowed it; otherwise `thread`.
 *
 * Some OpenMP runtimes bind a thread when it asks for the places. Call this in a thread whose binding does not matter. */
void skg_cpus_allowed(const skg_cpus *thread, skg_cpus *allowed);

/* --- start (start.c)
 *
 * PoCL 3.1 starts without a lock, so that two threads that start it at once crash. Its worker threads inherit from the
 * thread that starts it the CPUs, the signal mask and the floating-point environment, which may be narrow, open and
 * unusual. Therefore the process starts OpenCL once, under a lock, in a thread made for this. */

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

/* --- signals (signals.c)
 *
 * Drivers install handlers of their own: LLVM inside PoCL and inside Intel's runtime replaces 15 dispositions, among them
 * those of SIGUSR1 and SIGXCPU, by which batch systems ask for a checkpoint. */

/* Saves the dispositions of all signals, if no other thread is between these two calls; and restores those that have
 * changed since. Each keep needs its restore. A change that another thread of the program makes in between is lost. */
void skg_signals_keep(void);
void skg_signals_restore(void);

/* --- parts of a device (sub_devices.c)
 *
 * A thread of PoCL 3.1 still looks at the device of a command after it has told the waiting thread that the command is done. A
 * sub-device that is released at once with its context is then gone, and the process ends. Devices of a platform stay. */

/* Gets the part of a device with this many compute units. Each is made once in a process and stays; the caller releases it as
 * often as it gets it. Returns the code of OpenCL. */
cl_int skg_sub_device_get(cl_device_id device, int32_t units, cl_device_id *part);

/* --- slow compilers (watch.c) */

/* Time that a context has spent compiling. All zero: none. */
typedef struct {
    int64_t ms;
    int32_t logged; /* 1: the log has been told that kernels are compiled */
    int32_t reserved;
} skg_watch;

/* Calls work(data) and returns when it is done. It runs in a thread of its own, with all signals blocked, while the
 * caller waits: only the caller's thread may write to the log. Once the compilations of a context have taken a second in
 * total, the log gets one line with the device's name. */
void skg_watch_call(skg_watch *watch, const skg_context *context, const char *device,
                    void (*work)(void *data), void *data);

/* --- kernels in use (in_use.c)
 *
 * A driver that is asked for a program's binary compiles its kernels once more, and PoCL 3.1 ends the process (an assertion on a
 * count of uses) if one of them began to run before. */

/* Kernels of this process, of any context, may run from the one call to the other. skg_work_begin waits during
 * skg_work_none_call. */
void skg_work_begin(void);
void skg_work_end(void);
int64_t skg_work_count(void); /* work that has begun and not ended */

/* Calls call(data), unless kernels may run. */
void skg_work_none_call(void (*call)(void *data), void *data);

/* --- memory of a CPU (pages.c)
 *
 * The system clears a page when it is first written, which takes longer than a whole frame for 16 MiB of accumulators (4 to 6 ms
 * on an EPYC with Linux 6.18). PoCL writes first in the first frame; these pages are written before it, by another thread. */

/* Bytes of a buffer: from <= byte < to. */
typedef struct {
    int64_t from, to;
} skg_byte_range;

typedef struct skg_pages skg_pages;

/* Plans memory for a buffer of which kernels will write these ranges. *pages stays NULL if they are too few or too many, or there
 * is no memory. */
void skg_pages_prefetch(int64_t bytes, int64_t count, const skg_byte_range *ranges, skg_pages **pages);

/* Allocates the memory, and writes to each page of the ranges. pages: NULL does nothing. */
void skg_pages_enter(skg_pages *pages);

/* Makes a buffer with these flags in that memory, if it has this size. OpenCL frees the memory with the buffer. NULL: there is
 * none, and OpenCL allocates. */
cl_mem skg_pages_take(skg_pages **pages, cl_context cl, int64_t bytes, cl_mem_flags flags);

/* Frees the memory if no buffer has taken it. */
void skg_pages_drop(skg_pages **pages);

#endif
