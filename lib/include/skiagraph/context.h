/* A context: one OpenCL device with its queue and programs, and where warnings go.
 *
 * A context and the plans made on it belong to one thread at a time. A context used in a child process after
 * fork returns SKG_ERR_FORK: make a new one there. The library never changes the process environment. */
#ifndef SKIAGRAPH_CONTEXT_H
#define SKIAGRAPH_CONTEXT_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_context skg_context;

/* Opens a device. config is words separated by spaces:
 *     device=cpu | gpu | PLATFORM:DEVICE (numbers, as skg_device_get counts) | part of a device's name
 *     threads=N       so many compute units, through a sub-device where the platform offers them
 *     kernels=DIR     reads the kernels from DIR instead of those built in (for development)
 * NULL or a string without device=: the environment variable SKG_DEVICE (the same grammar, or the bare value
 * of device=), then the best device: GPUs before CPUs, more compute units first. SKG_KERNEL_DIR stands for
 * kernels=. Errors: SKG_ERR_ARGUMENT (words), SKG_ERR_NO_DEVICE, SKG_ERR_DEVICE. The caller releases the
 * context. */
SKG_API skg_status skg_context_create(const char *config, skg_context **context);

/* One owner more, one owner less. Release takes the handle's address, sets it to NULL, accepts NULL, never
 * fails. */
SKG_API skg_status skg_context_retain(skg_context *context);
SKG_API void skg_context_release(skg_context **context);

enum { SKG_LOG_WARNING = 1, SKG_LOG_NOTE = 2, SKG_LOG_PROGRESS = 3 };

/* Receives each warning, note and progress line: one sentence, no newline, valid during the call only. */
typedef void (*skg_log_function)(int32_t level, const char *sentence, void *user);

/* Sets where they go; NULL (the default) drops them. */
SKG_API skg_status skg_context_log_set(skg_context *context, skg_log_function log, void *user);

/* What OpenCL offers. Filled by the library; prepare with skg_device_info_init. */
typedef struct {
    int32_t size;
    int32_t platform, device; /* numbers for device=PLATFORM:DEVICE */
    int32_t is_gpu, is_cpu;   /* 1 or 0 */
    int32_t compute_units;
    int32_t has_double;             /* fp64: needed by precision double */
    int32_t correct_division;       /* float division is correctly rounded: same bits as other such devices */
    int32_t float_width;            /* native vector width of float */
    int64_t memory, max_allocation; /* bytes, as reported now */
    int64_t local_memory;           /* bytes */
    char name[128], platform_name[128], version[128], driver[128];
} skg_device_info;

SKG_API void skg_device_info_init(skg_device_info *info);

/* How many devices there are, over all platforms; 0 is no failure. */
SKG_API skg_status skg_device_count(int64_t *count);

/* The device at index 0 <= index < count. */
SKG_API skg_status skg_device_get(int64_t index, skg_device_info *info);

/* The device of a context. */
SKG_API skg_status skg_context_device_get(skg_context *context, skg_device_info *info);

#ifdef __cplusplus
}
#endif
#endif
