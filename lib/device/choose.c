#include "core/names.h"
#include "device/device.h"
#include "device/identity.h"
#include "device/start.h"
#include "device/store.h"
#include "device/verdict.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Platforms and devices beyond these are not seen. */
enum { MOST_PLATFORMS = 32, MOST_DEVICES = 64 };

typedef struct {
    cl_platform_id platform;
    cl_device_id device;
    int32_t platform_number, device_number;
} found_device;

/* Lists every device of every platform. A machine without a platform has no devices, which is no failure. */
static skg_status find_devices(found_device *found, int32_t *count) {
    cl_platform_id platforms[MOST_PLATFORMS];
    cl_uint platform_count = 0;
    *count = 0;
    cl_int code = clGetPlatformIDs(MOST_PLATFORMS, platforms, &platform_count);
    if (code == -1001 /* CL_PLATFORM_NOT_FOUND_KHR */) return SKG_OK;
    SKG_CL_TRY(code);
    if (platform_count > MOST_PLATFORMS) platform_count = MOST_PLATFORMS;
    for (cl_uint p = 0; p < platform_count; p++) {
        cl_device_id devices[MOST_DEVICES];
        cl_uint device_count = 0;
        code = clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, MOST_DEVICES, devices, &device_count);
        if (code != CL_SUCCESS) continue; /* a platform without devices returns an error */
        for (cl_uint d = 0; d < device_count && d < MOST_DEVICES && *count < MOST_DEVICES; d++)
            found[(*count)++] = (found_device){platforms[p], devices[d], (int32_t)p, (int32_t)d};
    }
    return SKG_OK;
}

static void device_text(cl_device_id device, cl_device_info what, char *text, size_t size) {
    text[0] = '\0';
    if (clGetDeviceInfo(device, what, size, text, NULL) != CL_SUCCESS) snprintf(text, size, "?");
    text[size - 1] = '\0';
}

skg_status skg_device_inform(int32_t platform_number, int32_t device_number, cl_platform_id platform,
                             cl_device_id device, skg_device_info *info) {
    cl_device_type type = 0;
    cl_uint units = 0, width = 0;
    cl_ulong memory = 0, allocation = 0, local = 0;
    cl_device_fp_config single = 0, twice = 0;
    skg_device_info_init(info);
    info->platform = platform_number;
    info->device = device_number;
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, sizeof width, &width, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof memory, &memory, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE, sizeof allocation, &allocation, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_LOCAL_MEM_SIZE, sizeof local, &local, NULL));
    SKG_CL_TRY(clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof single, &single, NULL));
    if (clGetDeviceInfo(device, CL_DEVICE_DOUBLE_FP_CONFIG, sizeof twice, &twice, NULL) != CL_SUCCESS)
        twice = 0;
    info->is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    info->is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    info->compute_units = (int32_t)units;
    info->float_width = (int32_t)width;
    info->has_double = twice != 0;
    info->correct_division = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    info->memory = (int64_t)memory;
    info->max_allocation = (int64_t)allocation;
    info->local_memory = (int64_t)local;
    device_text(device, CL_DEVICE_NAME, info->name, sizeof info->name);
    device_text(device, CL_DEVICE_VERSION, info->version, sizeof info->version);
    device_text(device, CL_DRIVER_VERSION, info->driver, sizeof info->driver);
    if (clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof info->platform_name, info->platform_name,
                          NULL) != CL_SUCCESS)
        snprintf(info->platform_name, sizeof info->platform_name, "?");
    return SKG_OK;
}

void skg_device_info_init_sized(void *info, int32_t size) {
    const skg_device_info defaults = {0};
    skg_struct_init(info, size, &defaults, sizeof defaults);
}

skg_status skg_device_count(int64_t *count) {
    SKG_NEEDS(count);
    SKG_TRY(skg_opencl_start());
    found_device found[MOST_DEVICES];
    int32_t all = 0;
    SKG_TRY(find_devices(found, &all));
    *count = all;
    return SKG_OK;
}

skg_status skg_device_get(int64_t index, skg_device_info *info) {
    SKG_TRY(skg_opencl_start());
    found_device found[MOST_DEVICES];
    int32_t all = 0;
    SKG_TRY(find_devices(found, &all));
    if (index < 0 || index >= all)
        return skg_fail(SKG_ERR_ARGUMENT, "device %" PRId64 " of %" PRId32 " (counted from 0)", index, all);
    skg_device_info ours;
    SKG_TRY(skg_device_inform(found[index].platform_number, found[index].device_number, found[index].platform,
                              found[index].device, &ours));
    return skg_struct_write(&ours, sizeof ours, "skg_device_info", info);
}

/* Whether `wanted` names this device: auto or NULL (any), cpu, gpu, PLATFORM:DEVICE, or a part of its name in any
 * case. */
static int fits(const char *wanted, const skg_device_info *info) {
    if (!wanted || skg_same_name(wanted, "auto")) return 1;
    if (skg_same_name(wanted, "gpu")) return info->is_gpu;
    if (skg_same_name(wanted, "cpu")) return info->is_cpu;
    int platform = 0, device = 0, end = 0;
    if (sscanf(wanted, "%d:%d%n", &platform, &device, &end) == 2 && wanted[end] == '\0')
        return platform == info->platform && device == info->device;
    for (const char *at = info->name; *at; at++) {
        size_t i = 0;
        while (wanted[i] && at[i] && tolower((unsigned char)wanted[i]) == tolower((unsigned char)at[i])) i++;
        if (!wanted[i]) return 1;
    }
    return 0;
}

/* What the choice knows of a device. */
typedef struct {
    skg_device_info info;
    skg_verdict verdict; /* of the test "core" */
    int32_t known;       /* 1: the verdict is known */
    int32_t doubtful;    /* 1: not tested, and of a kind that is known to compute wrongly */
} candidate;

/* Mesa's software rasteriser reports the vector lanes of a processor as its units, and with Rusticl 22 it returns black
 * images. */
static void look_up(const found_device *found, const char *store, candidate *one) {
    const skg_digest identity = skg_identity_of(found->platform, found->device);
    one->known = skg_verdict_known(store, &identity, SKG_TEST_OF_ALL, &one->verdict);
    one->doubtful = !one->known && strstr(one->info.name, "llvmpipe") != NULL;
}

/* Devices that failed come last, then those in doubt. GPUs come before other devices. Then the measured speed decides if
 * both are measured, otherwise the number of compute units. */
static int better(const candidate *a, const candidate *b) {
    const int a_failed = a->known && !a->verdict.good, b_failed = b->known && !b->verdict.good;
    if (a_failed != b_failed) return b_failed;
    if (a->doubtful != b->doubtful) return b->doubtful;
    if (a->info.is_gpu != b->info.is_gpu) return a->info.is_gpu > b->info.is_gpu;
    if (a->known && b->known && a->verdict.score > 0 && b->verdict.score > 0)
        return a->verdict.score > b->verdict.score;
    return a->info.compute_units > b->info.compute_units;
}

skg_status skg_device_choose(const char *wanted, uint64_t without, cl_platform_id *platform,
                             cl_device_id *device, skg_device_info *info, int32_t *index) {
    found_device found[MOST_DEVICES];
    candidate best = {0};
    char store[SKG_STORE_PATH];
    int32_t all = 0, chosen = -1;
    SKG_TRY(find_devices(found, &all));
    if (all == 0)
        return skg_fail(SKG_ERR_NO_DEVICE,
                        "no OpenCL device on this machine; install a driver, for instance PoCL "
                        "(apt-get install pocl-opencl-icd)");
    skg_store_find(store);
    for (int32_t i = 0; i < all; i++) {
        candidate one = {0};
        SKG_TRY(skg_device_inform(found[i].platform_number, found[i].device_number, found[i].platform,
                                  found[i].device, &one.info));
        if (!fits(wanted, &one.info) || without >> i & 1) continue;
        look_up(&found[i], store, &one);
        if (chosen >= 0 && !better(&one, &best)) continue;
        chosen = i;
        best = one;
    }
    if (chosen < 0)
        return skg_fail(SKG_ERR_NO_DEVICE,
                        "no OpenCL device fits device=%s; `skiagraph devices` lists what there is (%" PRId32
                        ")",
                        wanted ? wanted : "auto", all);
    *platform = found[chosen].platform;
    *device = found[chosen].device;
    *info = best.info;
    *index = chosen;
    return SKG_OK;
}
