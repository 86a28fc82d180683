/* Memory of a device, reserved ahead and given back. */
#include "device/device.h"
#include "driver/driver.h"

#include <inttypes.h>

/* Makes a buffer in the place of what there is. data: its contents; NULL: none. */
static skg_status create(skg_device *device, int64_t bytes, cl_mem_flags flags, const void *data,
                         const char *what, skg_buffer *buffer) {
    if (bytes > device->info.max_allocation)
        return skg_fail(SKG_ERR_DEVICE_MEMORY,
                        "%s: %" PRId64 " MiB in one piece, but %s gives at most %" PRId64
                        " MiB; make the image or the scene smaller, or choose another device",
                        what, bytes >> 20, device->info.name, device->info.max_allocation >> 20);
    skg_buffer_release(buffer);
    cl_int code = CL_SUCCESS;
    /* OpenCL copies the data, and takes no pointer to const. */
    cl_mem memory = data ? NULL : skg_pages_take(&device->pages, device->cl, bytes, flags);
    if (!memory) memory = clCreateBuffer(device->cl, flags, (size_t)bytes, (void *)(uintptr_t)data, &code);
    if (code != CL_SUCCESS) {
        skg_cl_fail(code, "clCreateBuffer", __FILE__, __LINE__);
        return skg_fail(SKG_ERR_DEVICE_MEMORY, "%s: %s has no room for %" PRId64 " bytes (%s)", what,
                        device->info.name, bytes, skg_cl_name(code));
    }
    buffer->memory = memory;
    buffer->bytes = bytes;
    return SKG_OK;
}

void skg_buffer_prefetch(skg_context *context, int64_t bytes, int64_t count, const skg_byte_range *ranges) {
    skg_device *device = context->device;
    skg_pages_drop(&device->pages);
    if (device->info.cpu && !device->simulates) skg_pages_prefetch(bytes, count, ranges, &device->pages);
}

void skg_buffer_forget(skg_context *context) {
    skg_pages_drop(&context->device->pages);
}

skg_status skg_buffer_reserve(skg_context *context, skg_buffer *buffer, int64_t bytes, cl_mem_flags flags,
                              const char *what) {
    if (bytes < 1) bytes = 1;
    if (buffer->bytes >= bytes) return SKG_OK;
    return create(context->device, bytes, flags, NULL, what, buffer);
}

skg_status skg_buffer_create(skg_context *context, int64_t bytes, const void *data, const char *what,
                             skg_buffer *buffer) {
    if (bytes < 1) return skg_buffer_reserve(context, buffer, 1, CL_MEM_READ_ONLY, what);
    return create(context->device, bytes, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, data, what, buffer);
}

skg_status skg_buffer_share(skg_context *context, int64_t bytes, void *data, const char *what,
                            skg_buffer *buffer) {
    const cl_mem_flags own = context->device->info.cpu ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
    return create(context->device, bytes, CL_MEM_READ_ONLY | own, data, what, buffer);
}

void skg_buffer_release(skg_buffer *buffer) {
    if (buffer->memory) clReleaseMemObject(buffer->memory);
    *buffer = (skg_buffer){0};
}

skg_status skg_buffer_write(skg_context *context, skg_buffer *buffer, int64_t bytes, const void *data,
                            const char *what) {
    SKG_ASSERT(bytes >= 0 && (bytes == 0 || data));
    SKG_TRY(skg_buffer_reserve(context, buffer, bytes, CL_MEM_READ_ONLY, what));
    if (bytes > 0)
        SKG_CL_TRY(clEnqueueWriteBuffer(context->device->queue, buffer->memory, CL_TRUE, 0, (size_t)bytes,
                                        data, 0, NULL, NULL));
    return SKG_OK;
}

skg_status skg_queue_flush(const skg_context *context) {
    SKG_CL_TRY(clFlush(context->device->queue));
    return SKG_OK;
}

cl_int skg_event_wait(cl_event event) {
    return clWaitForEvents(1, &event);
}
