/* An OpenCL device with its queue, programs and buffers, and the errors of OpenCL. Private.
 *
 * A context has one in-order queue. All commands are enqueued there, and only jobs wait. */
#ifndef SKG_DEVICE_H
#define SKG_DEVICE_H

#include "core/aside.h"
#include "core/context.h"
#include "core/digest.h"

#include <skiagraph/opencl.h>

struct skg_program;
struct skg_pages;

typedef struct skg_device {
    cl_platform_id platform;
    cl_device_id id;
    cl_context cl;
    cl_command_queue queue;
    int32_t profiling; /* 1: the commands of the queue are timed */
    skg_device_info info;
    char *kernel_dir; /* folder that kernels are read from; NULL: those that are built in are used */
    struct skg_program *programs; /* by files and options */
    skg_aside loading;            /* of what is expected */
    struct skg_pages *pages;      /* of the expected buffer; NULL: none */
    int64_t builds;        /* programs compiled so far; a second scene with the same effects adds none */
    int64_t launched;      /* programs that there were when a job was last complete; later ones may be new */
    int64_t loads;         /* programs taken from the user's folder so far */
    skg_digest identity;   /* of the device and its driver */
    char *store;           /* folder in which compiled programs are kept; "": none */
    int32_t clang;         /* 1: kernels may use the builtins of clang */
    int32_t caches;        /* 1: the driver keeps compiled kernels itself */
    int32_t simulates;     /* 1: a simulator, which is not tested and keeps nothing */
    uint64_t passed;       /* bit n: test n of lib/trial */
    int32_t compile_noted; /* 1: the log has been told that kernels are compiled */
    int64_t compile_ms;    /* time that compiling has taken */
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
 * compile, the sentence of SKG_ERR_BUILD holds the build log. program: NULL: it is only expected (skg_expected_begin). */
skg_status skg_program_get(skg_context *context, int32_t files, const char *const *names, const char *options,
                           cl_program *program);

/* Begins to load those of the expected programs that the user's folder has, and to enter the memory of the expected buffer, in
 * a thread of its own, until skg_expected_wait. Meanwhile the context must not be used otherwise. What cannot be had is left
 * to skg_program_get and skg_buffer_reserve, and its errors too. */
void skg_expected_begin(skg_context *context);
void skg_expected_wait(skg_context *context);

/* Kernels of this process, of any context, may run from the one call to the other. skg_work_begin waits while programs are kept. */
void skg_work_begin(void);
void skg_work_end(void);
int64_t skg_work_count(void); /* work that has begun and not ended */

/* To be called when work has ended: the programs have been launched, and are kept in the user's folder, unless other work is
 * under way: a driver that is asked for a binary compiles its kernels once more, and PoCL 3.1 ends the process (an assertion on
 * a count of uses) if one of them began to run before. */
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

/* Bytes of a buffer: from <= byte < to. */
typedef struct {
    int64_t from, to;
} skg_byte_range;

/* Expects a buffer of so many bytes without contents, of which kernels will soon write these ranges (skg_expected_begin), until
 * skg_buffer_forget. */
void skg_buffer_expect(skg_context *context, int64_t bytes, int64_t count, const skg_byte_range *ranges);
void skg_buffer_forget(skg_context *context);

/* Makes a buffer that kernels read, with these bytes in it. The queue is not used, so nothing is waited for. */
skg_status skg_buffer_create(skg_context *context, int64_t bytes, const void *data, const char *what,
                             skg_buffer *buffer);

/* Reserves the bytes and writes the data. The call returns when the data has been copied. */
skg_status skg_buffer_write(skg_context *context, skg_buffer *buffer, int64_t bytes, const void *data,
                            const char *what);

/* --- choosing (choose.c) --- */

/* What the words of a config say of the device; NULL where they say nothing. */
typedef struct {
    const char *device, *driver; /* the values of device= and driver= */
} skg_device_words;

/* Chooses the device for the words of a config, and fills info. without: bit n is set if device n is not wanted; index: the
 * number of the one that is chosen. A device that has failed the test of what every plan needs is passed over, unless it
 * is the only one that fits; its user then hears why. */
skg_status skg_device_choose(const skg_device_words *words, uint64_t without, cl_platform_id *platform,
                             cl_device_id *device, skg_device_info *info, int32_t *index);

/* untested: 1 if the device of these words is of a platform that is not known, and no verdict on it is kept, so that the first
 * context on it would test it in this process. Platforms that are not trusted are not asked for their devices. */
skg_status skg_device_doubt(const skg_device_words *words, int32_t *untested);

/* The device that skg_context_create tries first for this config. */
skg_status skg_device_locate(const char *config, cl_platform_id *platform, cl_device_id *device,
                             skg_device_info *info);

/* Opens a device as skg_context_create does, but tests nothing. */
skg_status skg_context_open(const char *config, uint64_t without, skg_context **context, int32_t *index);

/* Fills in what programs are kept under. To be called once platform and id are set. */
skg_status skg_device_identify(skg_device *device);

/* Fills info with what OpenCL reports on a device. */
skg_status skg_device_inform(int32_t platform_number, int32_t device_number, cl_platform_id platform,
                             cl_device_id device, skg_device_info *info);

#endif
