/* An OpenCL device with its queue, programs and buffers, and OpenCL's errors in our words. Private.
 *
 * One in-order queue per context; everything is enqueued there, only jobs wait. */
#ifndef SKG_DEVICE_H
#define SKG_DEVICE_H

#include "core/context.h"

#include <skiagraph/opencl.h>

struct skg_program;

typedef struct skg_device {
    cl_platform_id platform;
    cl_device_id id;
    cl_context cl;
    cl_command_queue queue;
    int32_t profiling; /* the queue's commands are timed */
    skg_device_info info;
    char *kernel_dir;             /* kernels are read from here instead of those built in; NULL: built in */
    struct skg_program *programs; /* by files and options */
    int64_t builds; /* programs compiled so far: a second scene with the same effects adds none */
} skg_device;

/* --- errors --- */

/* "CL_OUT_OF_RESOURCES"; static storage. */
const char *skg_cl_name(cl_int code);

/* Keeps the code for skg_last_cl_error and says which call failed where; memory codes become
 * SKG_ERR_DEVICE_MEMORY. */
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

/* The program made of these kernel files, in this order, compiled with these options ("-D SKG_PARALLEL=1
 * ..."): from the context's cache, or built. The cache keeps it; do not release. Failure shows the build log.
 */
skg_status skg_program_get(skg_context *context, int32_t files, const char *const *names, const char *options,
                           cl_program *program);

/* A kernel of such a program; the caller releases it with clReleaseKernel. */
skg_status skg_kernel_create(cl_program program, const char *name, cl_kernel *kernel);

/* clSetKernelArg for several arguments: skg_kernel_set(kernel, index, sizeof x, &x), the kernel named on
 * failure. */
skg_status skg_kernel_set(cl_kernel kernel, cl_uint index, size_t size, const void *value);

/* --- buffers --- */

/* Device memory that grows as needed. All zero: none yet. */
typedef struct {
    cl_mem memory;
    int64_t bytes;
} skg_buffer;

/* At least so many bytes (at least 1 is allocated); contents are lost when it grows. what: for the message.
 */
skg_status skg_buffer_reserve(skg_context *context, skg_buffer *buffer, int64_t bytes, cl_mem_flags flags,
                              const char *what);
void skg_buffer_release(skg_buffer *buffer);

/* Enqueues a write whose source is copied by the time the call returns, reserving as needed. */
skg_status skg_buffer_write(skg_context *context, skg_buffer *buffer, int64_t bytes, const void *data,
                            const char *what);

/* --- choosing (choose.c) --- */

/* The device that config asks for. info is filled. */
skg_status skg_device_choose(const char *wanted, cl_platform_id *platform, cl_device_id *device,
                             skg_device_info *info);

/* Everything OpenCL tells about one device. */
skg_status skg_device_inform(int32_t platform_number, int32_t device_number, cl_platform_id platform,
                             cl_device_id device, skg_device_info *info);

#endif
