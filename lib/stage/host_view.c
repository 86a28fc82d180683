#include "stage/host_view.h"

static skg_status read_copy(skg_context *context, cl_mem buffer, int64_t first, int64_t bytes,
                            const char *what, skg_host_view *view) {
    if (view->capacity < bytes) {
        skg_host_view_release(view);
        SKG_TRY(skg_alloc(bytes, 1, what, &view->copy));
        view->capacity = bytes;
    }
    SKG_CL_TRY(clEnqueueReadBuffer(context->device->queue, buffer, CL_TRUE, (size_t)first, (size_t)bytes,
                                   view->copy, 0, NULL, NULL));
    view->bytes = view->copy;
    return SKG_OK;
}

skg_status skg_host_view_open(skg_context *context, cl_mem buffer, int64_t first, int64_t bytes,
                              const char *what, skg_host_view *view) {
    cl_int code = CL_SUCCESS;
    if (context->device->info.gpu) return read_copy(context, buffer, first, bytes, what, view);
    void *mapped = clEnqueueMapBuffer(context->device->queue, buffer, CL_TRUE, CL_MAP_READ, (size_t)first,
                                      (size_t)bytes, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS) return skg_cl_fail(code, "clEnqueueMapBuffer", __FILE__, __LINE__);
    view->bytes = mapped;
    view->mapped = buffer;
    view->unmap = mapped;
    return SKG_OK;
}

skg_status skg_host_view_close(skg_context *context, skg_host_view *view) {
    const cl_mem mapped = view->mapped;
    view->bytes = NULL;
    view->mapped = NULL;
    if (!mapped) return SKG_OK;
    SKG_CL_TRY(clEnqueueUnmapMemObject(context->device->queue, mapped, view->unmap, 0, NULL, NULL));
    return SKG_OK;
}

void skg_host_view_release(skg_host_view *view) {
    skg_free(&view->copy);
    view->capacity = 0;
}
