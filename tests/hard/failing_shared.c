/* OpenCL objects of a caller who shares them with the library. */
#include "hard/failing_shared.h"

#include <stdlib.h>

/* The calls behind failing_calls.c. */
#define REAL(type, name, parameters) type __real_##name parameters
REAL(cl_int, clGetPlatformIDs, (cl_uint most, cl_platform_id *platforms, cl_uint *count));
REAL(cl_int, clGetDeviceIDs,
     (cl_platform_id platform, cl_device_type type, cl_uint most, cl_device_id *devices, cl_uint *count));
REAL(cl_context, clCreateContext,
     (const cl_context_properties *properties, cl_uint count, const cl_device_id *devices, void *says,
      void *user, cl_int *code));
REAL(cl_command_queue, clCreateCommandQueue,
     (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int *code));
REAL(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *code));
REAL(cl_int, clEnqueueMarkerWithWaitList,
     (cl_command_queue queue, cl_uint count, const cl_event *waits, cl_event *event));
REAL(cl_int, clEnqueueReadBuffer,
     (cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset, size_t size, void *to,
      cl_uint count, const cl_event *waits, cl_event *event));
REAL(cl_int, clFinish, (cl_command_queue queue));
REAL(cl_int, clReleaseContext, (cl_context context));
REAL(cl_int, clReleaseCommandQueue, (cl_command_queue queue));
REAL(cl_int, clReleaseMemObject, (cl_mem memory));
REAL(cl_int, clReleaseEvent, (cl_event event));

static void must(int holds) {
    if (!holds) abort();
}

void shared_make(size_t bytes, shared_objects *s) {
    cl_platform_id platform = NULL;
    cl_int code = CL_SUCCESS;
    must(__real_clGetPlatformIDs(1, &platform, NULL) == CL_SUCCESS);
    must(__real_clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &s->device, NULL) == CL_SUCCESS);
    s->context = __real_clCreateContext(NULL, 1, &s->device, NULL, NULL, &code);
    must(code == CL_SUCCESS);
    s->queue = __real_clCreateCommandQueue(s->context, s->device, CL_QUEUE_PROFILING_ENABLE, &code);
    must(code == CL_SUCCESS);
    s->buffer = __real_clCreateBuffer(s->context, CL_MEM_READ_WRITE, bytes, NULL, &code);
    must(code == CL_SUCCESS);
    must(__real_clEnqueueMarkerWithWaitList(s->queue, 0, NULL, &s->start) == CL_SUCCESS);
    must(__real_clFinish(s->queue) == CL_SUCCESS);
}

void shared_free(shared_objects *s) {
    if (!s->context) return;
    __real_clReleaseEvent(s->start);
    __real_clReleaseMemObject(s->buffer);
    __real_clReleaseCommandQueue(s->queue);
    __real_clReleaseContext(s->context);
}

void shared_read(const shared_objects *s, size_t bytes, void *to) {
    must(__real_clEnqueueReadBuffer(s->queue, s->buffer, CL_TRUE, 0, bytes, to, 0, NULL, NULL) == CL_SUCCESS);
}
