/* Status codes and the text of the last failure.
 *
 * Every call of the library returns a skg_status. SKG_OK is zero; failures are the SKG_ERR_ codes. SKG_STALE
 * and SKG_RANGE are answers, not failures: the call did what could be done and says what the caller should
 * know. */
#ifndef SKIAGRAPH_ERROR_H
#define SKIAGRAPH_ERROR_H

#include <stdint.h>

#if defined(__GNUC__)
#define SKG_API __attribute__((visibility("default")))
#else
#define SKG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef int32_t skg_status;

/* name, value, text */
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
    X(SKG_ERR_FORK, -15, "the context was made before a fork; make a new one in the child")                  \
    X(SKG_ERR_BREATHING, -16, "a body, link or breath is not usable")                                        \
    X(SKG_ERR_INTERNAL, -99, "a fault of the library itself")

enum {
#define SKG_STATUS_ENUM(name, value, text) name = (value),
    SKG_STATUS_LIST(SKG_STATUS_ENUM)
#undef SKG_STATUS_ENUM
};

/* "SKG_ERR_MESH" for -6; "SKG_UNKNOWN" for a value that is no status. Static storage. */
SKG_API const char *skg_status_name(skg_status status);

/* One general sentence on a status; the particular one is skg_last_error(). Static storage. */
SKG_API const char *skg_status_text(skg_status status);

/* The sentence of the last failure in this thread: the thing, the place and the mend. Valid until the next
 * failing call in the same thread; "" before the first failure. Never NULL. */
SKG_API const char *skg_last_error(void);

#ifdef __cplusplus
}
#endif
#endif
