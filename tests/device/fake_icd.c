/* Libraries that are not quite an OpenCL driver. FAKE is
 *   1  no function of a driver
 *   2  a driver without a platform
 *   3  a platform without devices; its entry is found through clGetExtensionFunctionAddress only
 *   4  a platform as version 2 of cl_khr_icd has it */
#include <CL/cl.h>
#include <CL/cl_icd.h>

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

#if FAKE == 1
EXPORT int nothing(void);
int nothing(void) {
    return 0;
}
#elif FAKE == 2
EXPORT cl_int clIcdGetPlatformIDsKHR(cl_uint capacity, cl_platform_id *platforms, cl_uint *count);
cl_int clIcdGetPlatformIDsKHR(cl_uint capacity, cl_platform_id *platforms, cl_uint *count) {
    (void)capacity, (void)platforms;
    if (count) *count = 0;
    return -1001;
}
#else
static cl_icd_dispatch table;
static struct { cl_icd_dispatch *dispatch; } platform = {&table};

static cl_int get_platforms(cl_uint capacity, cl_platform_id *platforms, cl_uint *count) {
    if (platforms && capacity > 0) platforms[0] = (cl_platform_id)(void *)&platform;
    if (count) *count = 1;
    return CL_SUCCESS;
}

static cl_int CL_API_CALL get_devices(cl_platform_id which, cl_device_type type, cl_uint capacity,
                                      cl_device_id *devices, cl_uint *count) {
    (void)which, (void)type, (void)capacity, (void)devices;
    if (count) *count = 0;
    return CL_DEVICE_NOT_FOUND;
}

static cl_int CL_API_CALL get_platform_info(cl_platform_id which, cl_platform_info what, size_t size,
                                            void *value, size_t *needed) {
    static const char text[] = "Fake";
    (void)which, (void)what;
    if (value && size >= sizeof text) memcpy(value, text, sizeof text);
    if (needed) *needed = sizeof text;
    return CL_SUCCESS;
}

EXPORT void *clGetExtensionFunctionAddress(const char *name);
void *clGetExtensionFunctionAddress(const char *name) {
    cl_int (*entry)(cl_uint, cl_platform_id *, cl_uint *) = get_platforms;
    void *address = NULL;
    table.clGetPlatformInfo = get_platform_info;
    table.clGetDeviceIDs = get_devices;
#if FAKE == 4
    const uint64_t mark = UINT64_C(0x4F50454E434C3331);
    memcpy(&table.clGetPlatformIDs, &mark, sizeof mark);
#endif
    if (strcmp(name, "clIcdGetPlatformIDsKHR") == 0) memcpy(&address, &entry, sizeof address);
    return address;
}
#endif
