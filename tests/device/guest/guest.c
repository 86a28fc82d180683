/* A driver of OpenCL that misbehaves, for the tests of who is a good guest. It offers one platform that the library does not know
 * with one GPU, compiles everything and computes nothing: what is read from its memory is 0.
 *
 * SKG_GUEST=KIND:CALL   at that call it ends the process (exit), aborts, crashes, hangs, fails, or leaks 1 MiB each time
 * SKG_GUEST=odd:        it says numbers that no device has: 0 compute units, and 2^64-1 bytes of memory
 * SKG_GUEST_LOG=FILE    the names of the calls, one a line */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl_icd.h>

#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define GUEST __attribute__((visibility("default")))

/* All objects of OpenCL begin with the table of calls. */
typedef struct {
    const cl_icd_dispatch *calls;
} object;

static const cl_icd_dispatch calls;
static object platform = {&calls}, device = {&calls}, context = {&calls}, queue = {&calls},
              program = {&calls}, kernel = {&calls}, event = {&calls};
static void *volatile leaked;

static void note(const char *name) {
    const char *path = getenv("SKG_GUEST_LOG");
    const int file = path ? open(path, O_WRONLY | O_APPEND | O_CREAT, 0600) : -1;
    if (file < 0) return;
    dprintf(file, "%s\n", name);
    close(file);
}

/* 1: the call fails. */
static int act(const char *name) {
    const char *wanted = getenv("SKG_GUEST"), *colon = wanted ? strchr(wanted, ':') : NULL;
    note(name);
    if (!colon || strcmp(colon + 1, name) != 0) return 0;
    fprintf(stderr, "first line\nguest: %s\n", wanted);
    switch (*wanted) {
    case 'e':
        exit(8);
    case 'a':
        abort();
    case 'c':
        raise(SIGSEGV);
        return 0;
    case 'h':
        for (;;) pause();
    case 'l':
        leaked = malloc(1 << 20);
        if (leaked) memset(leaked, 1, 1 << 20);
        return 0;
    default:
        return 1;
    }
}

static cl_int give(const void *value, size_t bytes, size_t size, void *place, size_t *needed) {
    if (needed) *needed = bytes;
    if (place && size < bytes) return CL_INVALID_VALUE;
    if (place) memcpy(place, value, bytes);
    return CL_SUCCESS;
}

static cl_int give_text(const char *text, size_t size, void *place, size_t *needed) {
    return give(text, strlen(text) + 1, size, place, needed);
}

/* Answers a query that no test reads with 0, as wide as the caller has room. */
static cl_int give_zero(size_t size, void *place, size_t *needed) {
    if (needed) *needed = size;
    if (place) memset(place, 0, size);
    return CL_SUCCESS;
}

static cl_int CL_API_CALL platform_ids(cl_uint room, cl_platform_id *platforms, cl_uint *count) {
    if (act("clGetPlatformIDs")) return CL_OUT_OF_HOST_MEMORY;
    if (count) *count = 1;
    if (platforms && room) platforms[0] = (cl_platform_id)(void *)&platform;
    return CL_SUCCESS;
}

static cl_int CL_API_CALL platform_info(cl_platform_id of, cl_platform_info what, size_t size, void *place,
                                        size_t *needed) {
    (void)of;
    if (act("clGetPlatformInfo")) return CL_OUT_OF_HOST_MEMORY;
    return give_text(what == CL_PLATFORM_NAME             ? "A bad guest"
                     : what == CL_PLATFORM_VERSION        ? "OpenCL 1.2 guest"
                     : what == CL_PLATFORM_EXTENSIONS     ? "cl_khr_icd"
                     : what == CL_PLATFORM_ICD_SUFFIX_KHR ? "GUEST"
                                                          : "tests",
                     size, place, needed);
}

static cl_int CL_API_CALL device_ids(cl_platform_id of, cl_device_type type, cl_uint room,
                                     cl_device_id *devices, cl_uint *count) {
    (void)of;
    if (act("clGetDeviceIDs")) return CL_OUT_OF_HOST_MEMORY;
    if (!(type & (CL_DEVICE_TYPE_GPU | CL_DEVICE_TYPE_DEFAULT))) return CL_DEVICE_NOT_FOUND;
    if (count) *count = 1;
    if (devices && room) devices[0] = (cl_device_id)(void *)&device;
    return CL_SUCCESS;
}

static cl_int CL_API_CALL device_info(cl_device_id of, cl_device_info what, size_t size, void *place,
                                      size_t *needed) {
    const cl_device_type type = CL_DEVICE_TYPE_GPU;
    const char *kind = getenv("SKG_GUEST");
    const int odd = kind && strncmp(kind, "odd:", 4) == 0;
    const cl_uint units = odd ? 0 : 9999;
    const cl_ulong bytes = odd ? UINT64_MAX : 1 << 30, local = odd ? UINT64_MAX : 48 << 10;
    const size_t group = 1024;
    const object *own = &platform;
    (void)of;
    if (act("clGetDeviceInfo")) return CL_OUT_OF_HOST_MEMORY;
    switch (what) {
    case CL_DEVICE_TYPE:
        return give(&type, sizeof type, size, place, needed);
    case CL_DEVICE_PLATFORM:
        return give(&own, sizeof own, size, place, needed);
    case CL_DEVICE_MAX_COMPUTE_UNITS:
    case CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT:
        return give(&units, sizeof units, size, place, needed);
    case CL_DEVICE_GLOBAL_MEM_SIZE:
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE:
        return give(&bytes, sizeof bytes, size, place, needed);
    case CL_DEVICE_LOCAL_MEM_SIZE:
        return give(&local, sizeof local, size, place, needed);
    case CL_DEVICE_MAX_WORK_GROUP_SIZE:
        return give(&group, sizeof group, size, place, needed);
    case CL_DEVICE_NAME:
        return give_text("guest's GPU", size, place, needed);
    case CL_DEVICE_VENDOR:
    case CL_DEVICE_VERSION:
    case CL_DRIVER_VERSION:
    case CL_DEVICE_EXTENSIONS:
        return give_text("1.0", size, place, needed);
    default:
        return give_zero(size, place, needed);
    }
}

/* Calls that return a code. */
#define CODE(name, parameters)                                                                               \
    static cl_int CL_API_CALL guest_##name parameters {                                                      \
        return act(#name) ? CL_OUT_OF_RESOURCES : CL_SUCCESS;                                                \
    }
/* Calls that make an object. */
#define MAKE(kind, name, made, parameters)                                                                   \
    static kind CL_API_CALL guest_##name parameters {                                                        \
        const int fails = act(#name);                                                                        \
        if (code) *code = fails ? CL_OUT_OF_RESOURCES : CL_SUCCESS;                                          \
        return fails ? NULL : (kind)(void *)(made);                                                          \
    }
/* Calls that give information. */
#define INFORM(name, parameters)                                                                             \
    static cl_int CL_API_CALL guest_##name parameters {                                                      \
        if (act(#name)) return CL_OUT_OF_RESOURCES;                                                          \
        return give_zero(size, place, needed);                                                               \
    }
/* Calls that put something in the queue; it is done at once. */
#define ENQUEUE(name, parameters)                                                                            \
    static cl_int CL_API_CALL guest_##name parameters {                                                      \
        if (done) *done = (cl_event)(void *)&event;                                                          \
        return act(#name) ? CL_OUT_OF_RESOURCES : CL_SUCCESS;                                                \
    }

/* The tables of calls have the types, so unnamed parameters say enough. */
typedef void(CL_CALLBACK *notify_context)(const char *, const void *, size_t, void *);
typedef void(CL_CALLBACK *notify_program)(cl_program, void *);
typedef const cl_event *waits;
#pragma GCC diagnostic ignored "-Wunused-parameter"
MAKE(cl_context, clCreateContext, &context,
     (const cl_context_properties *p, cl_uint n, const cl_device_id *d, notify_context f, void *u,
      cl_int *code))
MAKE(cl_command_queue, clCreateCommandQueue, &queue,
     (cl_context c, cl_device_id d, cl_command_queue_properties p, cl_int *code))
MAKE(cl_mem, clCreateBuffer, &event, (cl_context c, cl_mem_flags f, size_t n, void *h, cl_int *code))
MAKE(cl_program, clCreateProgramWithSource, &program,
     (cl_context c, cl_uint n, const char **t, const size_t *l, cl_int *code))
MAKE(cl_kernel, clCreateKernel, &kernel, (cl_program p, const char *n, cl_int *code))
CODE(clBuildProgram,
     (cl_program p, cl_uint n, const cl_device_id *d, const char *o, notify_program f, void *u))
CODE(clRetainContext, (cl_context c))
CODE(clReleaseContext, (cl_context c))
CODE(clRetainCommandQueue, (cl_command_queue q))
CODE(clReleaseCommandQueue, (cl_command_queue q))
CODE(clRetainDevice, (cl_device_id d))
CODE(clReleaseDevice, (cl_device_id d))
CODE(clReleaseProgram, (cl_program p))
CODE(clReleaseKernel, (cl_kernel k))
CODE(clReleaseMemObject, (cl_mem m))
CODE(clRetainEvent, (cl_event e))
CODE(clReleaseEvent, (cl_event e))
CODE(clSetKernelArg, (cl_kernel k, cl_uint i, size_t n, const void *v))
CODE(clFlush, (cl_command_queue q))
CODE(clFinish, (cl_command_queue q))
CODE(clWaitForEvents, (cl_uint n, waits w))
INFORM(clGetCommandQueueInfo,
       (cl_command_queue q, cl_command_queue_info w, size_t size, void *place, size_t *needed))
INFORM(clGetProgramInfo, (cl_program p, cl_program_info w, size_t size, void *place, size_t *needed))
INFORM(clGetProgramBuildInfo,
       (cl_program p, cl_device_id d, cl_program_build_info w, size_t size, void *place, size_t *needed))
INFORM(clGetEventInfo, (cl_event e, cl_event_info w, size_t size, void *place, size_t *needed))
INFORM(clGetEventProfilingInfo, (cl_event e, cl_profiling_info w, size_t size, void *place, size_t *needed))
INFORM(clGetKernelInfo, (cl_kernel k, cl_kernel_info w, size_t size, void *place, size_t *needed))
INFORM(clGetMemObjectInfo, (cl_mem m, cl_mem_info w, size_t size, void *place, size_t *needed))
ENQUEUE(clEnqueueNDRangeKernel, (cl_command_queue q, cl_kernel k, cl_uint d, const size_t *o, const size_t *g,
                                 const size_t *l, cl_uint n, waits w, cl_event *done))
ENQUEUE(clEnqueueWriteBuffer, (cl_command_queue q, cl_mem m, cl_bool b, size_t o, size_t s, const void *p,
                               cl_uint n, waits w, cl_event *done))
ENQUEUE(clEnqueueCopyBuffer, (cl_command_queue q, cl_mem a, cl_mem b, size_t o, size_t i, size_t s, cl_uint n,
                              waits w, cl_event *done))
ENQUEUE(clEnqueueFillBuffer, (cl_command_queue q, cl_mem m, const void *v, size_t k, size_t o, size_t s,
                              cl_uint n, waits w, cl_event *done))
ENQUEUE(clEnqueueMarkerWithWaitList, (cl_command_queue q, cl_uint n, waits w, cl_event *done))
ENQUEUE(clEnqueueBarrierWithWaitList, (cl_command_queue q, cl_uint n, waits w, cl_event *done))

static cl_int CL_API_CALL guest_clEnqueueReadBuffer(cl_command_queue q, cl_mem m, cl_bool b, size_t o,
                                                    size_t bytes, void *place, cl_uint n, waits w,
                                                    cl_event *done) {
    if (done) *done = (cl_event)(void *)&event;
    if (act("clEnqueueReadBuffer")) return CL_OUT_OF_RESOURCES;
    memset(place, 0, bytes);
    return CL_SUCCESS;
}

#define CALL(name) .name = guest_##name
static const cl_icd_dispatch calls = {.clGetPlatformIDs = platform_ids,
                                      .clGetPlatformInfo = platform_info,
                                      .clGetDeviceIDs = device_ids,
                                      .clGetDeviceInfo = device_info,
                                      CALL(clCreateContext),
                                      CALL(clCreateCommandQueue),
                                      CALL(clCreateBuffer),
                                      CALL(clCreateProgramWithSource),
                                      CALL(clCreateKernel),
                                      CALL(clBuildProgram),
                                      CALL(clRetainContext),
                                      CALL(clReleaseContext),
                                      CALL(clRetainCommandQueue),
                                      CALL(clReleaseCommandQueue),
                                      CALL(clRetainDevice),
                                      CALL(clReleaseDevice),
                                      CALL(clReleaseProgram),
                                      CALL(clReleaseKernel),
                                      CALL(clReleaseMemObject),
                                      CALL(clRetainEvent),
                                      CALL(clReleaseEvent),
                                      CALL(clSetKernelArg),
                                      CALL(clFlush),
                                      CALL(clFinish),
                                      CALL(clWaitForEvents),
                                      CALL(clGetCommandQueueInfo),
                                      CALL(clGetProgramInfo),
                                      CALL(clGetProgramBuildInfo),
                                      CALL(clGetEventInfo),
                                      CALL(clGetEventProfilingInfo),
                                      CALL(clGetKernelInfo),
                                      CALL(clGetMemObjectInfo),
                                      CALL(clEnqueueNDRangeKernel),
                                      CALL(clEnqueueWriteBuffer),
                                      CALL(clEnqueueCopyBuffer),
                                      CALL(clEnqueueFillBuffer),
                                      CALL(clEnqueueMarkerWithWaitList),
                                      CALL(clEnqueueBarrierWithWaitList),
                                      CALL(clEnqueueReadBuffer)};

/* Functions that the loader looks for. */
GUEST cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *platforms, cl_uint *count);
GUEST cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *platforms, cl_uint *count) {
    return platform_ids(room, platforms, count);
}

GUEST void *CL_API_CALL clGetExtensionFunctionAddress(const char *name);
GUEST void *CL_API_CALL clGetExtensionFunctionAddress(const char *name) {
    if (strcmp(name, "clGetPlatformInfo") == 0) return (void *)(intptr_t)platform_info;
    return strcmp(name, "clIcdGetPlatformIDsKHR") == 0 ? (void *)(intptr_t)clIcdGetPlatformIDsKHR : NULL;
}
