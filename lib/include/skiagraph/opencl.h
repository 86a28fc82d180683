/** @file
 * For callers with OpenCL objects of their own. This is the only header that needs CL/cl.h: compile with what
 * `pkg-config --cflags --libs skiagraph-opencl` says, or in CMake find_package(skiagraph COMPONENTS opencl)
 * and link skiagraph::opencl. */
#ifndef SKIAGRAPH_OPENCL_H
#define SKIAGRAPH_OPENCL_H

#ifndef CL_TARGET_OPENCL_VERSION
/** The version of OpenCL that the library uses: 1.2. */
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>
#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Makes a context on the caller's OpenCL objects. All three are retained, and released with the context.
 *
 *     queue     in-order
 *     context   result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT if the three do not belong together, or the queue is out of order */
SKG_API skg_status skg_context_create_cl(cl_context cl, cl_device_id device, cl_command_queue queue,
                                         skg_context **context);

/** Starts frames whose images stay on the device; otherwise as skg_plan_submit. Nothing is waited for.
 *
 *     output      type and strides; its data is ignored
 *     buffer      receives the images
 *     offset      byte of the buffer at which they begin, a multiple of an element's size
 *     waits       number of events in wait_list
 *     wait_list   [waits] the work starts after these; NULL if waits is 0
 *     done        result: an event of the last image, which the caller releases; may be NULL */
SKG_API skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                                      const skg_output *output, cl_mem buffer, int64_t offset, int32_t waits,
                                      const cl_event *wait_list, cl_event *done, skg_job **job);

/** Starts frames of path lengths through one part that stay on the device: part and kind as of
 * skg_plan_lengths, everything else as of skg_plan_submit_cl. */
SKG_API skg_status skg_plan_lengths_cl(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                                       const skg_frame *frames, const skg_output *output, cl_mem buffer,
                                       int64_t offset, int32_t waits, const cl_event *wait_list,
                                       cl_event *done, skg_job **job);

/** The code of the last OpenCL call that failed in the calling thread; CL_SUCCESS if none did. */
SKG_API cl_int skg_last_cl_error(void);

#ifdef __cplusplus
}
#endif
#endif
