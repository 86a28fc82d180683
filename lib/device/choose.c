/* Which devices there are, what they say of themselves, and which one is taken. */
#include "core/text.h"
#include "device/cache.h"
#include "device/choice.h"
#include "device/device.h"
#include "device/self_tests.h"
#include "driver/driver.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Devices beyond these are not seen. */
enum { DEVICES_MAX = 64 };

typedef struct {
    cl_platform_id platform;
    cl_device_id device;
    int32_t platform_number, device_number;
} found_device;

/* Which platforms are asked for their devices. */
enum { ASK_TRUSTED = -1, ASK_ALL = -2 }; /* otherwise the number of one */

typedef struct {
    cl_platform_id platform;
    cl_device_id devices[DEVICES_MAX];
    cl_uint count;
    cl_int code;
} asking;

static void ask(void *argument) {
    asking *a = argument;
    a->code = clGetDeviceIDs(a->platform, CL_DEVICE_TYPE_ALL, DEVICES_MAX, a->devices, &a->count);
}

/* A platform without devices returns an error. One that is not known was not started yet (start.c). */
static skg_status add_devices(cl_platform_id platform, int32_t number, found_device *found, int32_t *count) {
    asking a = {.platform = platform};
    if (skg_platform_is_known(platform))
        ask(&a);
    else
        SKG_TRY(skg_opencl_call(ask, &a));
    if (a.code != CL_SUCCESS) return SKG_OK;
    for (cl_uint d = 0; d < a.count && d < DEVICES_MAX && *count < DEVICES_MAX; d++)
        found[(*count)++] = (found_device){platform, a.devices[d], number, (int32_t)d};
    return SKG_OK;
}

/* Lists the devices of trusted platforms, then, if asked for, those of the others: so a device has the same place in both lists.
 * A machine without a platform has no devices, which is no failure. only: platforms to be asked; NULL: all. */
static skg_status find_devices(int which, const skg_platform_list *only, const char *store,
                               found_device *found, int32_t *count) {
    skg_platform_list platforms;
    *count = 0;
    SKG_TRY(skg_platforms_find(&platforms));
    for (int trusted = 1; trusted >= 0; trusted--)
        for (int32_t p = 0; p < platforms.count; p++) {
            if (which >= 0 && which != p) continue;
            if (only && !skg_platform_listed(only, platforms.items[p])) continue;
            if (trusted != skg_platform_is_trusted(store, platforms.items[p])) continue;
            if (trusted || which != ASK_TRUSTED) SKG_TRY(add_devices(platforms.items[p], p, found, count));
        }
    return SKG_OK;
}

static void device_text(cl_device_id device, cl_device_info what, char *text, size_t size) {
    text[0] = '\0';
    if (clGetDeviceInfo(device, what, size, text, NULL) != CL_SUCCESS) snprintf(text, size, "?");
    text[size - 1] = '\0';
}

/* Bounds on implausible answers of drivers: 0 compute units, or 2^64-1 bytes for "no limit". Work is divided by the one and buffers are
 * compared with the other, so both stay numbers that a device can have. */
static int32_t believable_units(cl_uint units) {
    enum { MOST_UNITS = 1 << 20 };
    return units < 1 ? 1 : units > MOST_UNITS ? MOST_UNITS : (int32_t)units;
}

static int64_t believable_bytes(cl_ulong bytes) {
    return bytes > INT64_MAX ? INT64_MAX : (int64_t)bytes;
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
    info->known = skg_platform_is_known(platform);
    info->gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    info->cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    info->compute_units = believable_units(units);
    info->float_width = (int32_t)width;
    info->double_precision = twice != 0;
    info->correct_division = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    info->memory = believable_bytes(memory);
    info->max_allocation = believable_bytes(allocation);
    info->local_memory = believable_bytes(local);
    device_text(device, CL_DEVICE_NAME, info->name, sizeof info->name);
    device_text(device, CL_DEVICE_VERSION, info->version, sizeof info->version);
    device_text(device, CL_DRIVER_VERSION, info->driver, sizeof info->driver);
    skg_platform_name(platform, info->platform_name, sizeof info->platform_name);
    return SKG_OK;
}

void skg_device_info_init_sized(void *info, int32_t size) {
    const skg_device_info defaults = {0};
    skg_struct_init(info, size, &defaults, sizeof defaults);
}

skg_status skg_device_count(int64_t *count) {
    SKG_NEEDS(count);
    SKG_TRY(skg_opencl_start());
    found_device found[DEVICES_MAX];
    char store[SKG_STORE_PATH];
    int32_t all = 0;
    skg_store_find(store);
    SKG_TRY(find_devices(ASK_ALL, NULL, store, found, &all));
    *count = all;
    return SKG_OK;
}

skg_status skg_device_get(int64_t index, skg_device_info *info) {
    SKG_TRY(skg_opencl_start());
    found_device found[DEVICES_MAX];
    char store[SKG_STORE_PATH];
    int32_t all = 0;
    skg_store_find(store);
    SKG_TRY(find_devices(ASK_ALL, NULL, store, found, &all));
    if (index < 0 || index >= all)
        return skg_fail(SKG_ERR_ARGUMENT, "device %" PRId64 " of %" PRId32 " (counted from 0)", index, all);
    skg_device_info ours;
    SKG_TRY(skg_device_inform(found[index].platform_number, found[index].device_number, found[index].platform,
                              found[index].device, &ours));
    return skg_struct_write(&ours, sizeof ours, "skg_device_info", info);
}

/* Whether the word is PLATFORM:DEVICE. */
static int is_number(const char *wanted, int *platform, int *device) {
    int end = 0;
    return wanted && sscanf(wanted, "%d:%d%n", platform, device, &end) == 2 && wanted[end] == '\0';
}

/* Whether the word leaves the choice to the library: none, auto, cpu or gpu. */
static int is_open(const char *wanted) {
    return !wanted || skg_same_name(wanted, "auto") || skg_same_name(wanted, "gpu") ||
           skg_same_name(wanted, "cpu");
}

/* Whether `wanted` names this device: auto or NULL (any), cpu, gpu, PLATFORM:DEVICE, or a part of its name in any
 * case. */
static int fits(const char *wanted, const skg_device_info *info) {
    if (!wanted || skg_same_name(wanted, "auto")) return 1;
    if (skg_same_name(wanted, "gpu")) return info->gpu;
    if (skg_same_name(wanted, "cpu")) return info->cpu;
    int platform = 0, device = 0;
    if (is_number(wanted, &platform, &device)) return platform == info->platform && device == info->device;
    for (const char *at = info->name; *at; at++) {
        size_t i = 0;
        while (wanted[i] && at[i] && tolower((unsigned char)wanted[i]) == tolower((unsigned char)at[i])) i++;
        if (!wanted[i]) return 1;
    }
    return 0;
}

/* The knowledge of a device by which it is chosen. */
typedef struct {
    skg_device_info info;
    skg_verdict verdict; /* of the test "core" */
    int32_t tested;      /* 1: the verdict is known */
    int32_t number;      /* in the list; -1: no device */
} candidate;

static int failed(const candidate *one) {
    return one->tested && !one->verdict.good;
}

static int is_untested(const candidate *one) {
    return !one->tested && !one->info.known;
}

/* Devices that failed come last, then those that are neither known nor tested. GPUs come before other devices. Then the
 * measured speed decides if both are measured, otherwise the number of compute units. */
static int better(const candidate *a, const candidate *b) {
    if (failed(a) != failed(b)) return failed(b);
    if (is_untested(a) != is_untested(b)) return is_untested(b);
    if (a->info.gpu != b->info.gpu) return a->info.gpu > b->info.gpu;
    if (a->tested && b->tested && a->verdict.score > 0 && b->verdict.score > 0)
        return a->verdict.score > b->verdict.score;
    return a->info.compute_units > b->info.compute_units;
}

typedef struct {
    const char *device; /* value of device=, or NULL */
    const char *driver; /* value of driver=, or NULL */
    skg_platform_list of_driver;
    char store[SKG_STORE_PATH];
    found_device found[DEVICES_MAX];
    int32_t all;
} survey;

/* Opens the driver of driver=. */
static skg_status start_survey(const skg_device_words *words, survey *s) {
    s->device = words->device;
    s->driver = words->driver;
    s->of_driver.count = 0;
    s->all = 0;
    skg_store_find(s->store);
    return s->driver ? skg_icd_open(s->driver, &s->of_driver) : SKG_OK;
}

/* With driver=, a device has to be one of that driver's. Without it, a driver that was opened before has no part in the
 * choice, so that a configuration means the same whatever was opened; but the numbers of the list name every device. */
static int in_reach(const survey *s, cl_platform_id platform) {
    int numbers[2];
    return s->driver || !skg_icd_has(platform) || is_number(s->device, &numbers[0], &numbers[1]);
}

/* The best of the devices that these platforms have. Of a platform that is not known, only one that has passed its test is taken,
 * unless the words name it. */
static skg_status pick(survey *s, int which, uint64_t without, candidate *best) {
    best->number = -1;
    SKG_TRY(find_devices(which, s->driver ? &s->of_driver : NULL, s->store, s->found, &s->all));
    for (int32_t i = 0; i < s->all; i++) {
        candidate one = {.number = i};
        const found_device *at = &s->found[i];
        if (!in_reach(s, at->platform)) continue;
        const skg_status status =
            skg_device_inform(at->platform_number, at->device_number, at->platform, at->device, &one.info);
        if (status != SKG_OK && which == ASK_TRUSTED && !skg_platform_is_known(at->platform)) continue;
        SKG_TRY(status);
        if (!fits(s->device, &one.info) || without >> i & 1) continue;
        const skg_digest identity = skg_identity_of(at->platform, at->device);
        one.tested =
            skg_verdict_known(s->store, &identity, skg_self_test_name(SKG_SELF_TEST_CORE), &one.verdict);
        if (which == ASK_TRUSTED && !one.info.known && !(one.tested && one.verdict.good)) continue;
        if (best->number < 0 || better(&one, best)) *best = one;
    }
    return SKG_OK;
}

/* A platform that is not asked for its devices unless the caller names one; NULL if there is none. which: see find_devices. */
static cl_platform_id find_untrusted(int which, const char *store) {
    skg_platform_list platforms;
    if (skg_platforms_find(&platforms) != SKG_OK) return NULL;
    for (int32_t p = 0; p < platforms.count; p++)
        if ((which < 0 || which == p) && !skg_platform_is_trusted(store, platforms.items[p]))
            return platforms.items[p];
    return NULL;
}

static skg_status no_device(const survey *s) {
    char name[128] = "";
    if (s->driver)
        return skg_fail(SKG_ERR_NO_DEVICE, "driver=%s has no device%s%s", s->driver,
                        s->device ? " that fits device=" : "", s->device ? s->device : "");
    const cl_platform_id untrusted = find_untrusted(ASK_ALL, s->store);
    if (untrusted) skg_platform_name(untrusted, name, sizeof name);
    if (is_open(s->device) && untrusted)
        return skg_fail(
            SKG_ERR_NO_DEVICE,
            "no device of a known platform fits device=%s; the platform \"%s\" is not known, and no "
            "verdict is cached of a device of it that passed its test. `skiagraph devices` tests such devices in "
            "processes of their own",
            s->device ? s->device : "auto", name);
    if (s->all == 0 && !untrusted)
        return skg_fail(SKG_ERR_NO_DEVICE,
                        "no OpenCL device on this machine; install a driver, for instance PoCL "
                        "(apt-get install pocl-opencl-icd)");
    return skg_fail(SKG_ERR_NO_DEVICE,
                    "no OpenCL device fits device=%s; `skiagraph devices` lists what there is (%" PRId32 ")",
                    s->device ? s->device : "auto", s->all);
}

skg_status skg_device_choose(const skg_device_words *words, uint64_t without, cl_platform_id *platform,
                             cl_device_id *device, skg_device_info *info, int32_t *index) {
    survey s;
    candidate best;
    int number = 0, its_device = 0;
    SKG_TRY(start_survey(words, &s));
    if (s.driver) { /* the caller has named it */
        SKG_TRY(pick(&s, ASK_ALL, without, &best));
    } else if (is_number(s.device, &number, &its_device)) {
        SKG_TRY(pick(&s, number < 0 ? ASK_TRUSTED : number, without, &best));
    } else {
        SKG_TRY(pick(&s, ASK_TRUSTED, without, &best));
        if (best.number < 0 && !is_open(s.device)) SKG_TRY(pick(&s, ASK_ALL, without, &best));
    }
    if (best.number < 0) return no_device(&s);
    *platform = s.found[best.number].platform;
    *device = s.found[best.number].device;
    *info = best.info;
    *index = best.number;
    return SKG_OK;
}

skg_status skg_device_doubt(const skg_device_words *words, int32_t *untested) {
    survey s;
    candidate best;
    int number = 0, its_device = 0;
    *untested = 0;
    SKG_TRY(start_survey(words, &s));
    if (is_open(s.device) && !s.driver) return SKG_OK;
    const int one = is_number(s.device, &number, &its_device);
    if (!s.driver) {
        if (one && number < 0) return SKG_OK; /* no such device */
        if (!one) SKG_TRY(pick(&s, ASK_TRUSTED, 0, &best));
        if (!one && best.number >= 0) return SKG_OK; /* it is known, or has passed */
        *untested = find_untrusted(one ? number : ASK_ALL, s.store) != NULL;
        if (*untested || !one) return SKG_OK;
    }
    SKG_TRY(pick(&s, s.driver ? ASK_ALL : number, 0, &best));
    *untested = best.number >= 0 && is_untested(&best);
    return SKG_OK;
}
