/* OpenCL objects of a caller who shares them with the library. Their own calls are never counted and never fail. */
#ifndef SKG_TESTS_FAILING_SHARED_H
#define SKG_TESTS_FAILING_SHARED_H

#include <skiagraph/opencl.h>

typedef struct {
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    cl_mem buffer;
    cl_event start; /* complete */
} shared_objects;

/* Of the first device, with a buffer of `bytes` bytes. */
void shared_make(size_t bytes, shared_objects *s);
void shared_free(shared_objects *s);

/* The buffer's bytes, once the queue has come to rest. */
void shared_read(const shared_objects *s, size_t bytes, void *to);

#endif
