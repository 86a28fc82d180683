/** @file
 * For callers with OpenCL objects of their own. This is the only header that needs CL/cl.h: compile with what
 * `pkg-config --cflags --libs skiagraph-opencl` says, or in CMake find_package(skiagraph COMPONENTS opencl)
 * and link skiagraph::opencl.
 *
 * @since 0.1.0 */
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

/** Starts frames behind the caller's events; otherwise as skg_plan_submit. Nothing is waited for. An output whose
 * buffer is a cl_mem stays on the device.
 *
 *     waits       number of events in wait_list
 *     wait_list   [waits] the work starts after these; NULL if waits is 0. None of them may fail: PoCL aborts the
 *                 process if the status of a user event in a wait list is set to an error. End it with CL_COMPLETE
 *                 instead, and discard the outputs
 *     done        result: an event of the last output, which the caller releases; may be NULL */
SKG_API skg_status skg_plan_submit_cl(skg_plan *plan, int64_t count, const skg_frame *frames,
                                      int64_t output_count, const skg_output *outputs, int32_t waits,
                                      const cl_event *wait_list, cl_event *done, skg_job **job);

/** Takes the positions of a part's mesh from device memory, for the frames that are submitted to this plan afterwards.
 * A device copy is enqueued; nothing is waited for, and nothing passes through host memory. Poses stay on the host. The
 * first call for a leaky mesh that has vertices with equal positions on the host waits for the frames before it.
 *
 *     part        number in the scene. All parts with the same mesh move
 *     buffer      float: rows of x, y, z in mm from the mesh's origin (skg_mesh_offsets_get), a row for each vertex.
 *                 It must not change until the copy is made
 *     offset      byte of the buffer at which the rows begin, a multiple of 4
 *     lowest      [3] bounds of all positions, mm from the mesh's origin; copied. Narrow bounds are faster and finer
 *     highest     [3]
 *     waits       number of events in wait_list
 *     wait_list   [waits] the copy is made after these; NULL if waits is 0. None of them may fail (skg_plan_submit_cl)
 *     done        result: an event of the copy, which the caller releases; may be NULL
 *     errors      SKG_ERR_ARGUMENT (part, buffer, bounds); SKG_ERR_UNSUPPORTED for a leaky mesh with SKG_REPAIR_EXACT,
 *                 which traces rays through the positions on the host
 *     stale       SKG_STALE if parts were added to the scene or put elsewhere
 *
 * Triangles, and which way they face, are those of the mesh on the host. Vertices of a closed mesh that have equal
 * positions there move together, with the position of the first of them, so that the mesh stays closed. A vertex
 * outside of the bounds is put on them, and skg_job_wait returns SKG_RANGE with part and vertex. A vertex that is not
 * finite is SKG_ERR_MESH as in other frames. The positions on the host do not change; skg_mesh_positions_set and
 * skg_mesh_offsets_moved make the plan use them again. */
SKG_API skg_status skg_plan_positions_set_cl(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset,
                                             const float *lowest, const float *highest, int32_t waits,
                                             const cl_event *wait_list, cl_event *done);

/** The code of the last OpenCL call that failed in the calling thread; CL_SUCCESS if none did. */
SKG_API cl_int skg_last_cl_error(void);

#ifdef __cplusplus
}
#endif
#endif
