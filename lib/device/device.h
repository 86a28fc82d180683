/* An OpenCL device with its queue, programs and buffers, and the errors of OpenCL. Private.
 *
 * A context has one in-order queue. All commands are enqueued there, and only jobs wait. */
#ifndef SKG_DEVICE_H
#define SKG_DEVICE_H

#include "core/context.h"
#include "core/digest.h"
#include "core/threads.h"
#include "driver/driver.h"

#include <skiagraph/opencl.h>

struct skg_program;

typedef struct skg_device {
    cl_platform_id platform;
    cl_device_id id;
    cl_context cl;
    cl_command_queue queue;
    int32_t profiling; /* 1: the commands of the queue are timed */
    skg_device_info info;
    char *kernel_dir; /* folder that kernels are read from; NULL: those that are built in are used */
    struct skg_program *programs; /* by files and options */
    skg_async loading;            /* loads prefetched programs */
    skg_pages *pages;             /* of the prefetched buffer; NULL: none */
    int64_t builds;   /* programs compiled so far; a second scene with the same effects adds none */
    int64_t launched; /* value of builds when a job was last complete; later programs may not have run yet */
    int64_t loads;    /* programs taken from the user's folder so far */
    skg_digest identity;  /* of the device and its driver */
    char *store;          /* folder of cached programs and verdicts; "": none */
    int32_t clang;        /* 1: kernels may use the builtins of clang */
    int32_t caches;       /* 1: the driver caches compiled kernels itself */
    int32_t simulates;    /* 1: a simulator, which is not tested and caches nothing */
    uint64_t passed;      /* bit n: enum skg_self_test */
    int32_t self_testing; /* > 0: a self-test is running, whose own calls need none */
    int32_t planes;       /* of the plan that asks for self-tests: that of energies has as many */
    skg_watch compiling;
} skg_device;

/* --- errors --- */

/* The name of a code, such as "CL_OUT_OF_RESOURCES". Static storage. */
const char *skg_cl_name(cl_int code);

/* Fails with a sentence that names the code, the call and the place, and keeps the code for skg_last_cl_error.
 * Codes on memory become SKG_ERR_DEVICE_MEMORY, others SKG_ERR_DEVICE. */
skg_status skg_cl_fail(cl_int code, const char *call, const char *file, int line);

#define SKG_CL_TRY(call)                                                                                     \
    do {                                                                                                     \
        cl_int skg_cl_code = (call);                                                                         \
        if (skg_cl_code != CL_SUCCESS) return skg_cl_fail(skg_cl_code, #call, __FILE__, __LINE__);           \
    } while (0)

#define SKG_CL_CLEANUP(call)                                                                                 \
    do {                                                                                                     \
        cl_int skg_cl_code = (call);                                                                         \
        if (skg_cl_code != CL_SUCCESS) {                                                                     \
            status = skg_cl_fail(skg_cl_code, #call, __FILE__, __LINE__);                                    \
            goto cleanup;                                                                                    \
        }                                                                                                    \
    } while (0)

/* The callback of clCreateContext. The driver calls it at any time and from any thread; user is the address of the
 * context's mailbox. */
void CL_CALLBACK skg_driver_says(const char *sentence, const void *data, size_t size, void *user);

/* --- programs and kernels --- */

/* The program made of these kernel files, in this order, compiled with these options ("-D SKG_PARALLEL=1 ...").
 * It comes from the cache of the context or is built. The cache owns it; do not release it. If it does not
 * compile, the sentence of SKG_ERR_BUILD holds the build log. program: NULL: it is only prefetched (skg_prefetch_begin). */
skg_status skg_program_get(skg_context *context, int32_t files, const char *const *names, const char *options,
                           cl_program *program);

/* Prefetches in a thread of its own, until skg_prefetch_wait: loads the programs that were asked for with NULL from the user's
 * folder, and writes to the pages of the prefetched buffer. Meanwhile the context must not be used. It reports no error: a program
 * or buffer that it could not prefetch is made by skg_program_get or skg_buffer_reserve. */
void skg_prefetch_begin(skg_context *context);
void skg_prefetch_wait(skg_context *context);

/* To be called after skg_work_end, when all programs have been launched: saves them in the user's folder, unless other work is under
 * way (driver.h). */
void skg_programs_launched(skg_context *context);

/* Makes a kernel of such a program. The caller releases it with clReleaseKernel. */
skg_status skg_kernel_create(cl_program program, const char *name, cl_kernel *kernel);

/* Sets one argument of a kernel. If it fails, the sentence names the kernel and the argument. */
skg_status skg_kernel_set(cl_kernel kernel, cl_uint index, size_t size, const void *value);

/* --- buffers --- */

/* Device memory that grows as needed. All zero: nothing is allocated. */
typedef struct {
    cl_mem memory;
    int64_t bytes;
} skg_buffer;

/* Makes sure that the buffer has at least these bytes (at least 1 is allocated). The contents are lost when it grows.
 * what: for the message. */
skg_status skg_buffer_reserve(skg_context *context, skg_buffer *buffer, int64_t bytes, cl_mem_flags flags,
                              const char *what);
void skg_buffer_release(skg_buffer *buffer);

/* Prefetches the memory of a buffer of this size, of which kernels will soon write these ranges (skg_prefetch_begin), until
 * skg_buffer_forget. */
void skg_buffer_prefetch(skg_context *context, int64_t bytes, int64_t count, const skg_byte_range *ranges);
void skg_buffer_forget(skg_context *context);

/* Makes a buffer that kernels read, with these bytes in it. The queue is not used, so nothing is waited for. */
skg_status skg_buffer_create(skg_context *context, int64_t bytes, const void *data, const char *what,
                             skg_buffer *buffer);

/* Makes a buffer of memory that outlives the buffer: a CPU reads it where it is. bytes: above 0 */
skg_status skg_buffer_share(skg_context *context, int64_t bytes, void *data, const char *what,
                            skg_buffer *buffer);

/* Reserves the bytes and writes the data. The call returns when the data has been copied. */
skg_status skg_buffer_write(skg_context *context, skg_buffer *buffer, int64_t bytes, const void *data,
                            const char *what);

/* --- the queue --- */

/* Gives the device what was enqueued. */
skg_status skg_queue_flush(const skg_context *context);

/* Waits until a command is done. */
cl_int skg_event_wait(cl_event event);

#endif
