#include "device/device.h"

#include <inttypes.h>

skg_status skg_buffer_reserve(skg_context *context, skg_buffer *buffer, int64_t bytes, cl_mem_flags flags,
                              const char *what) {
    const skg_device *device = context->device;
    if (bytes < 1) bytes = 1;
    if (buffer->bytes >= bytes) return SKG_OK;
    if (bytes > device->info.max_allocation)
        return skg_fail(SKG_ERR_DEVICE_MEMORY,
                        "%s: %" PRId64 " MiB in one piece, but %s gives at most %" PRId64
                        " MiB; make the image or the scene smaller, or choose another device",
                        what, bytes >> 20, device->info.name, device->info.max_allocation >> 20);
    skg_buffer_release(buffer);
    cl_int code = CL_SUCCESS;
    cl_mem memory = clCreateBuffer(device->cl, flags, (size_t)bytes, NULL, &code);
    if (code != CL_SUCCESS) {
        skg_cl_fail(code, "clCreateBuffer", __FILE__, __LINE__);
        return skg_fail(SKG_ERR_DEVICE_MEMORY, "%s: %s has no room for %" PRId64 " bytes (%s)", what,
                        device->info.name, bytes, skg_cl_name(code));
    }
    buffer->memory = memory;
    buffer->bytes = bytes;
    return SKG_OK;
}

void skg_buffer_release(skg_buffer *buffer) {
    if (buffer->memory) clReleaseMemObject(buffer->memory);
    *buffer = (skg_buffer){0};
}

skg_status skg_buffer_write(skg_context *context, skg_buffer *buffer, int64_t bytes, const void *data,
                            const char *what) {
    SKG_TRY(skg_buffer_reserve(context, buffer, bytes, CL_MEM_READ_ONLY, what));
    if (bytes > 0)
        SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, buffer->memory, CL_TRUE, 0, (size_t)bytes,
                                        data, 0, NULL, NULL));
    return SKG_OK;
}
