/** @file
 * Status codes, and the text of the last failure.
 *
 * Every function returns a skg_status, except
 *
 * - skg_X_init, skg_X_init_sized and skg_X_release, which return nothing and cannot fail;
 * - skg_status_name, skg_status_text, skg_last_error and skg_last_cl_error, which explain a failure;
 * - skg_version and skg_version_number;
 * - skg_lung_hounsfield, which is a formula.
 *
 * SKG_OK is 0 and failures (SKG_ERR_...) are negative. SKG_STALE and SKG_RANGE are positive: they are
 * answers, not failures (SKG_FAILED), and the functions that give them say what was done. A function that fails leaves its
 * results as they were, or NULL where it makes a handle.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_ERROR_H
#define SKIAGRAPH_ERROR_H

#include <skiagraph/export.h>

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The result of a call: one of enum skg_status_code. */
typedef int32_t skg_status;

/** Whether a status is a failure. SKG_STALE and SKG_RANGE are none: after SKG_RANGE the result is there, after SKG_STALE it
 * is not, or not all of it. A program that adds parts or swaps them after it planned compares with SKG_STALE as well. */
#define SKG_FAILED(status) ((status) < 0)

/** All status codes: X(name, value, text) for each. */
#define SKG_STATUS_LIST(X)                                                                                   \
    X(SKG_OK, 0, "success")                                                                                  \
    X(SKG_STALE, 1, "the plan cannot absorb this change; plan again")                                        \
    X(SKG_RANGE, 2, "the image is valid, but left the range over which its error bound was verified")        \
    X(SKG_ERR_ARGUMENT, -1, "an argument is not usable")                                                     \
    X(SKG_ERR_MEMORY, -2, "out of host memory")                                                              \
    X(SKG_ERR_FILE, -3, "a file could not be read")                                                          \
    X(SKG_ERR_FORMAT, -4, "the contents of a file are not what they should be")                              \
    X(SKG_ERR_OUTPUT, -5, "an output could not be written")                                                  \
    X(SKG_ERR_MESH, -6, "a mesh is not usable")                                                              \
    X(SKG_ERR_SCENE, -7, "a scene, view or part is not usable")                                              \
    X(SKG_ERR_MATERIAL, -8, "a material is not usable")                                                      \
    X(SKG_ERR_BEAM, -9, "a spectrum or source is not usable")                                                \
    X(SKG_ERR_NO_DEVICE, -10, "no OpenCL device fits")                                                       \
    X(SKG_ERR_DEVICE, -11, "an OpenCL call failed")                                                          \
    X(SKG_ERR_DEVICE_MEMORY, -12, "the device has not enough memory")                                        \
    X(SKG_ERR_BUILD, -13, "a kernel does not compile on this device")                                        \
    X(SKG_ERR_UNSUPPORTED, -14, "this device or version cannot do what was asked")                           \
    X(SKG_ERR_FORK, -15, "OpenCL was started before a fork; start the child process by exec or spawn")       \
    X(SKG_ERR_BREATHING, -16, "a body, link or breath is not usable")                                        \
    X(SKG_ERR_CANCELLED, -17, "the work was cancelled before it was finished")                               \
    X(SKG_ERR_INTERNAL, -99, "a fault of the library itself")

/** The status codes of SKG_STATUS_LIST. */
enum skg_status_code {
/** Defines one code of the list. */
#define SKG_STATUS_ENUM(name, value, text) name = (value),
    SKG_STATUS_LIST(SKG_STATUS_ENUM)
#undef SKG_STATUS_ENUM
};

/** The name of a status: "SKG_ERR_MESH" for -6; "SKG_UNKNOWN" for a value that is no status. The text is
 * static. */
SKG_API const char *skg_status_name(skg_status status);

/** One sentence about a status in general. What went wrong in particular says skg_last_error. The text is
 * static. */
SKG_API const char *skg_status_text(skg_status status);

/** The sentence of the last failure in the calling thread: what failed, where, and how to mend it. The text
 * stays valid until the next call that fails in this thread. Before the first failure it is "". Never
 * NULL. */
SKG_API const char *skg_last_error(void);

#ifdef __cplusplus
}
#endif
#endif
