/* Parts of a device, made once and kept. */
#include "driver/driver.h"

#include <pthread.h>

enum { KEPT_MAX = 64 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct {
    cl_device_id device, part;
    int32_t units;
} kept[KEPT_MAX]; /* guarded by the lock */
static int count;

static cl_int make(cl_device_id device, int32_t units, cl_device_id *part) {
    const cl_device_partition_property how[] = {CL_DEVICE_PARTITION_BY_COUNTS, units,
                                                CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    return clCreateSubDevices(device, how, 1, part, NULL);
}

static cl_int find_or_make(cl_device_id device, int32_t units, cl_device_id *part) {
    for (int n = 0; n < count; n++)
        if (kept[n].device == device && kept[n].units == units) {
            *part = kept[n].part;
            return CL_SUCCESS;
        }
    const cl_int code = make(device, units, part);
    if (code != CL_SUCCESS) return code;
    if (count < KEPT_MAX) {
        kept[count].device = device;
        kept[count].part = *part;
        kept[count++].units = units;
    }
    return CL_SUCCESS;
}

cl_int skg_sub_device_get(cl_device_id device, int32_t units, cl_device_id *part) {
    pthread_mutex_lock(&lock);
    cl_int code = find_or_make(device, units, part);
    if (code == CL_SUCCESS) code = clRetainDevice(*part);
    pthread_mutex_unlock(&lock);
    return code;
}
