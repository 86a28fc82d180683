/* Calls that fail on demand, wrapped by the linker. */
#include "hard/failing_calls.h"

#include <CL/cl.h>

#include <execinfo.h>
#include <jansson.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CALLS_MAX = 1 << 16, BLOCKS_MAX = 1 << 16, SITES_MAX = 1 << 10, DEPTH = 8 };

static atomic_flag locked = ATOMIC_FLAG_INIT;
static int counting = -1; /* the kind; -1: not counting */
static int parsing;       /* within Jansson's parser */
static int64_t calls, target;
static const char *hit;
static uint64_t places[CALLS_MAX];   /* of each call, a hash of its callers */
static const void *sites[SITES_MAX]; /* that made a call which was counted */
static int site_count;
static void *blocks[BLOCKS_MAX]; /* open addressing; NULL: free, &gone: was used */
static int gone;
static int64_t live_blocks;
static atomic_llong live_objects;

static void lock(void) {
    while (atomic_flag_test_and_set(&locked)) continue;
}

static void unlock(void) {
    atomic_flag_clear(&locked);
}

static uint64_t hash_callers(void) {
    void *callers[DEPTH];
    uint64_t hash = 14695981039346656037u;
    const int depth = backtrace(callers, DEPTH);
    for (int n = 2; n < depth; n++) hash = (hash ^ (uint64_t)(uintptr_t)callers[n]) * 1099511628211u;
    return hash;
}

static void note_site(const void *site) {
    lock();
    int n = 0;
    while (n < site_count && sites[n] != site) n++;
    if (n == site_count && n < SITES_MAX) sites[site_count++] = site;
    unlock();
}

/* Whether this call has to fail. Notes where it comes from: `site` is the address to which it returns. */
static int decide(int kind, const char *name, const void *site) {
    if (counting != kind || parsing) return 0;
    note_site(site);
    lock();
    const int now = calls == target;
    if (now) hit = name;
    if (target < 0 && calls < CALLS_MAX) places[calls] = hash_callers();
    calls++;
    unlock();
    return now;
}

#define fails(kind, name) decide(kind, name, __builtin_return_address(0))

void failing_start(int kind, int64_t at) {
    calls = 0;
    target = at;
    hit = NULL;
    counting = kind;
}

int64_t failing_stop(void) {
    counting = -1;
    return calls;
}

const char *failing_hit(void) {
    return hit;
}

int failing_is_new(int64_t at) {
    static uint64_t tried[CALLS_MAX];
    static int count;
    if (at >= CALLS_MAX) return 0;
    for (int n = 0; n < count; n++)
        if (tried[n] == places[at]) return 0;
    if (count < CALLS_MAX) tried[count++] = places[at];
    return 1;
}

void failing_write_sites(const char *path) {
    extern const char __executable_start[]; /* of the linker */
    FILE *file = fopen(path, "a");
    if (!file) abort();
    for (int n = 0; n < site_count; n++) fprintf(file, "%tx\n", (const char *)sites[n] - __executable_start);
    if (fclose(file) != 0) abort();
}

int64_t failing_live_blocks(void) {
    return live_blocks;
}

int64_t failing_live_objects(void) {
    return atomic_load(&live_objects);
}

/* --- allocations ---------------------------------------------------------------------------------------- */

static size_t slot_of(const void *block) {
    return (size_t)(((uintptr_t)block >> 4) * 0x9e3779b97f4a7c15u >> 48) % BLOCKS_MAX;
}

static void note_block(void *block) {
    lock();
    size_t slot = slot_of(block);
    while (blocks[slot] && blocks[slot] != &gone) slot = (slot + 1) % BLOCKS_MAX;
    blocks[slot] = block;
    live_blocks++;
    unlock();
}

static void forget_block(const void *block) {
    lock();
    size_t slot = slot_of(block);
    for (int n = 0; n < BLOCKS_MAX && blocks[slot]; n++, slot = (slot + 1) % BLOCKS_MAX)
        if (blocks[slot] == block) {
            blocks[slot] = &gone;
            live_blocks--;
            break;
        }
    unlock();
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) {
    void *block = fails(FAIL_ALLOCATION, "malloc") ? NULL : __real_malloc(size);
    if (block) note_block(block);
    return block;
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size) {
    void *block = fails(FAIL_ALLOCATION, "calloc") ? NULL : __real_calloc(count, size);
    if (block) note_block(block);
    return block;
}

void *__real_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size) {
    if (fails(FAIL_ALLOCATION, "realloc")) return NULL;
    if (old) forget_block(old);
    void *block = __real_realloc(old, size);
    if (block) note_block(block);
    return block;
}

void __real_free(void *block);
void __wrap_free(void *block);
void __wrap_free(void *block) {
    if (block) forget_block(block);
    __real_free(block);
}

/* Jansson 2.14 does not look whether the buffer of a token could grow, and reads beyond what it has: while it
 * parses, nothing fails. */
#define PARSER(name, parameters, arguments)                                                                  \
    json_t *__real_##name parameters;                                                                        \
    json_t *__wrap_##name parameters;                                                                        \
    json_t *__wrap_##name parameters {                                                                       \
        parsing = 1;                                                                                         \
        json_t *parsed = __real_##name arguments;                                                            \
        parsing = 0;                                                                                         \
        return parsed;                                                                                       \
    }

PARSER(json_loads, (const char *text, size_t flags, json_error_t *error), (text, flags, error))
PARSER(json_loadb, (const char *text, size_t size, size_t flags, json_error_t *error),
       (text, size, flags, error))

/* --- OpenCL --------------------------------------------------------------------------------------------- */

/* A call that returns a code. */
#define CODE(name, parameters, arguments)                                                                    \
    cl_int __real_##name parameters;                                                                         \
    cl_int __wrap_##name parameters;                                                                         \
    cl_int __wrap_##name parameters {                                                                        \
        return fails(FAIL_OPENCL, #name) ? CL_OUT_OF_RESOURCES : __real_##name arguments;                    \
    }

/* One that may hand out an event. */
#define EVENT(name, parameters, arguments)                                                                   \
    cl_int __real_##name parameters;                                                                         \
    cl_int __wrap_##name parameters;                                                                         \
    cl_int __wrap_##name parameters {                                                                        \
        if (fails(FAIL_OPENCL, #name)) return CL_OUT_OF_RESOURCES;                                           \
        const cl_int code = __real_##name arguments;                                                         \
        if (code == CL_SUCCESS && event) live_objects++;                                                     \
        return code;                                                                                         \
    }

/* One that makes an object. */
#define OBJECT(type, name, parameters, arguments)                                                            \
    type __real_##name parameters;                                                                           \
    type __wrap_##name parameters;                                                                           \
    type __wrap_##name parameters {                                                                          \
        if (fails(FAIL_OPENCL, #name)) {                                                                     \
            if (code) *code = CL_OUT_OF_HOST_MEMORY;                                                         \
            return NULL;                                                                                     \
        }                                                                                                    \
        type made = __real_##name arguments;                                                                 \
        if (made) live_objects++;                                                                            \
        return made;                                                                                         \
    }

/* One that gives an object back, which does not fail: nobody could do anything about it. */
#define RELEASE(type, name)                                                                                  \
    cl_int __real_##name(type object);                                                                       \
    cl_int __wrap_##name(type object);                                                                       \
    cl_int __wrap_##name(type object) {                                                                      \
        live_objects--;                                                                                      \
        return __real_##name(object);                                                                        \
    }

/* One that holds an object once more, which does not fail either. */
#define RETAIN(type, name)                                                                                   \
    cl_int __real_##name(type object);                                                                       \
    cl_int __wrap_##name(type object);                                                                       \
    cl_int __wrap_##name(type object) {                                                                      \
        live_objects++;                                                                                      \
        return __real_##name(object);                                                                        \
    }

/* clang-format off */
typedef void (CL_CALLBACK *driver_function)(const char *, const void *, size_t, void *);
typedef void (CL_CALLBACK *built_function)(cl_program, void *);
OBJECT(cl_context, clCreateContext,
       (const cl_context_properties *properties, cl_uint count, const cl_device_id *devices, driver_function says,
        void *user, cl_int *code), (properties, count, devices, says, user, code))
OBJECT(cl_command_queue, clCreateCommandQueue,
       (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int *code),
       (context, device, properties, code))
OBJECT(cl_program, clCreateProgramWithSource,
       (cl_context context, cl_uint count, const char **texts, const size_t *lengths, cl_int *code),
       (context, count, texts, lengths, code))
OBJECT(cl_program, clCreateProgramWithBinary,
       (cl_context context, cl_uint count, const cl_device_id *devices, const size_t *lengths,
        const unsigned char **binaries, cl_int *loaded, cl_int *code),
       (context, count, devices, lengths, binaries, loaded, code))
OBJECT(cl_kernel, clCreateKernel, (cl_program program, const char *name, cl_int *code), (program, name, code))
OBJECT(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *code),
       (context, flags, size, host, code))
/* A mapping is held until it is given back, which does not fail. */
OBJECT(void *, clEnqueueMapBuffer,
       (cl_command_queue queue, cl_mem memory, cl_bool blocking, cl_map_flags how, size_t offset, size_t size,
        cl_uint count, const cl_event *waits, cl_event *event, cl_int *code),
       (queue, memory, blocking, how, offset, size, count, waits, event, code))
cl_int __real_clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem memory, void *mapped, cl_uint count,
                                      const cl_event *waits, cl_event *event);
cl_int __wrap_clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem memory, void *mapped, cl_uint count,
                                      const cl_event *waits, cl_event *event);
cl_int __wrap_clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem memory, void *mapped, cl_uint count,
                                      const cl_event *waits, cl_event *event) {
    live_objects--;
    return __real_clEnqueueUnmapMemObject(queue, memory, mapped, count, waits, event);
}
CODE(clCreateSubDevices, (cl_device_id device, const cl_device_partition_property *how, cl_uint most,
                          cl_device_id *devices, cl_uint *count), (device, how, most, devices, count))
CODE(clBuildProgram, (cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      built_function built, void *user), (program, count, devices, options, built, user))
CODE(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void *value), (kernel, index, size, value))
CODE(clGetPlatformIDs, (cl_uint most, cl_platform_id *platforms, cl_uint *count), (most, platforms, count))
CODE(clGetPlatformInfo, (cl_platform_id platform, cl_platform_info what, size_t size, void *value, size_t *used),
     (platform, what, size, value, used))
CODE(clGetDeviceIDs, (cl_platform_id platform, cl_device_type type, cl_uint most, cl_device_id *devices,
                      cl_uint *count), (platform, type, most, devices, count))
CODE(clGetDeviceInfo, (cl_device_id device, cl_device_info what, size_t size, void *value, size_t *used),
     (device, what, size, value, used))
CODE(clGetCommandQueueInfo, (cl_command_queue queue, cl_command_queue_info what, size_t size, void *value,
                             size_t *used), (queue, what, size, value, used))
CODE(clGetEventInfo, (cl_event of, cl_event_info what, size_t size, void *value, size_t *used),
     (of, what, size, value, used))
CODE(clGetEventProfilingInfo, (cl_event of, cl_profiling_info what, size_t size, void *value, size_t *used),
     (of, what, size, value, used))
CODE(clGetKernelInfo, (cl_kernel kernel, cl_kernel_info what, size_t size, void *value, size_t *used),
     (kernel, what, size, value, used))
CODE(clGetProgramInfo, (cl_program program, cl_program_info what, size_t size, void *value, size_t *used),
     (program, what, size, value, used))
CODE(clGetMemObjectInfo, (cl_mem memory, cl_mem_info what, size_t size, void *value, size_t *used),
     (memory, what, size, value, used))
CODE(clSetMemObjectDestructorCallback,
     (cl_mem memory, void(CL_CALLBACK *callback)(cl_mem memory, void *user), void *user),
     (memory, callback, user))
CODE(clFlush, (cl_command_queue queue), (queue))
CODE(clFinish, (cl_command_queue queue), (queue))
CODE(clWaitForEvents, (cl_uint count, const cl_event *events), (count, events))
EVENT(clEnqueueNDRangeKernel, (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
                               const size_t *global, const size_t *local, cl_uint count, const cl_event *waits,
                               cl_event *event), (queue, kernel, dimensions, offset, global, local, count, waits, event))
EVENT(clEnqueueCopyBuffer, (cl_command_queue queue, cl_mem from, cl_mem to, size_t from_at, size_t to_at, size_t bytes,
                            cl_uint count, const cl_event *list, cl_event *event),
      (queue, from, to, from_at, to_at, bytes, count, list, event))
EVENT(clEnqueueFillBuffer, (cl_command_queue queue, cl_mem memory, const void *pattern, size_t size, size_t offset,
                            size_t bytes, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, memory, pattern, size, offset, bytes, count, waits, event))
EVENT(clEnqueueReadBuffer, (cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset, size_t size,
                            void *to, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, memory, blocking, offset, size, to, count, waits, event))
EVENT(clEnqueueReadBufferRect, (cl_command_queue queue, cl_mem memory, cl_bool blocking, const size_t *from,
                                const size_t *at, const size_t *region, size_t row, size_t slice, size_t host_row,
                                size_t host_slice, void *to, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, memory, blocking, from, at, region, row, slice, host_row, host_slice, to, count, waits, event))
EVENT(clEnqueueWriteBuffer, (cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset, size_t size,
                             const void *from, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, memory, blocking, offset, size, from, count, waits, event))
EVENT(clEnqueueBarrierWithWaitList, (cl_command_queue queue, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, count, waits, event))
EVENT(clEnqueueMarkerWithWaitList, (cl_command_queue queue, cl_uint count, const cl_event *waits, cl_event *event),
      (queue, count, waits, event))
RETAIN(cl_context, clRetainContext)
RETAIN(cl_command_queue, clRetainCommandQueue)
RETAIN(cl_event, clRetainEvent)
RELEASE(cl_context, clReleaseContext)
RELEASE(cl_command_queue, clReleaseCommandQueue)
RELEASE(cl_program, clReleaseProgram)
RELEASE(cl_kernel, clReleaseKernel)
RELEASE(cl_mem, clReleaseMemObject)
RELEASE(cl_event, clReleaseEvent)
/* clang-format on */
