/* Views of device memory, for the host to read. */
#include "stage/host_view.h"

skg_status skg_host_view_open(skg_context *context, cl_mem buffer, int64_t first, int64_t bytes,
                              skg_host_view *view) {
    cl_int code = CL_SUCCESS;
    void *mapped = clEnqueueMapBuffer(context->device->queue, buffer, CL_TRUE, CL_MAP_READ, (size_t)first,
                                      (size_t)bytes, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS) return skg_cl_fail(code, "clEnqueueMapBuffer", __FILE__, __LINE__);
    *view = (skg_host_view){.bytes = mapped, .mapped = mapped, .buffer = buffer};
    return SKG_OK;
}

void skg_host_view_close(skg_context *context, skg_host_view *view) {
    if (view->mapped)
        (void)clEnqueueUnmapMemObject(context->device->queue, view->buffer, view->mapped, 0, NULL, NULL);
    *view = (skg_host_view){.bytes = NULL};
}
