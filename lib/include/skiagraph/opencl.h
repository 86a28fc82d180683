/* For callers with OpenCL objects of their own: the only public header that names them. */
#ifndef SKIAGRAPH_OPENCL_H
#define SKIAGRAPH_OPENCL_H

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>
#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A context on the caller's context, device and in-order queue; all three are retained, and released once
 * with it. Refused when they do not belong together. */
SKG_API skg_status skg_context_create_cl(cl_context cl, cl_device_id device, cl_command_queue queue,
                                         skg_context **context);

/* Like skg_plan_submit, but images go into a buffer on the device: output->data is ignored, `buffer` takes
 * its place from byte `offset` on (a multiple of the element's size). Work starts after the `waits` events of
 * wait_list; *done (NULL: not wanted) is an event of the last image, released by the caller. Nothing is
 * waited for. */
SKG_API skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                                      const skg_output *output, cl_mem buffer, int64_t offset, int32_t waits,
                                      const cl_event *wait_list, cl_event *done, skg_job **job);

/* The OpenCL code of the last failing OpenCL call of this thread; CL_SUCCESS when there was none. */
SKG_API cl_int skg_last_cl_error(void);

#ifdef __cplusplus
}
#endif
#endif
