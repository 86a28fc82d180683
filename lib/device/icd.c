/* Drivers that are opened by their path. */
#include "device/choice.h"

#include "device/device.h"
#include "driver/driver.h"

#include <CL/cl_ext.h>

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static skg_platform_list opened; /* guarded by the lock; only grows */

static void add(skg_platform_list *list, cl_platform_id platform) {
    if (list->count < SKG_PLATFORMS_MAX && !skg_platform_listed(list, platform))
        list->items[list->count++] = platform;
}

static skg_status find_loaders(skg_platform_list *list) {
    cl_uint count = 0;
    list->count = 0;
    const cl_int code = clGetPlatformIDs(SKG_PLATFORMS_MAX, list->items, &count);
    if (code == CL_PLATFORM_NOT_FOUND_KHR) return SKG_OK;
    SKG_CL_TRY(code);
    list->count = count < SKG_PLATFORMS_MAX ? (int32_t)count : SKG_PLATFORMS_MAX;
    return SKG_OK;
}

skg_status skg_platforms_find(skg_platform_list *list) {
    SKG_TRY(find_loaders(list));
    pthread_mutex_lock(&lock);
    for (int32_t n = 0; n < opened.count; n++) add(list, opened.items[n]);
    pthread_mutex_unlock(&lock);
    return SKG_OK;
}

int skg_icd_has(cl_platform_id platform) {
    pthread_mutex_lock(&lock);
    const int has = skg_platform_listed(&opened, platform);
    pthread_mutex_unlock(&lock);
    return has;
}

typedef struct {
    const char *path;
    skg_platform_list *list;
    char trouble[512]; /* why the library cannot be used; "": it can */
} opening;

/* A driver offers its function itself, or through the one that finds functions of extensions. */
static clIcdGetPlatformIDsKHR_fn entry_of(void *library) {
    static const char name[] = "clIcdGetPlatformIDsKHR";
    void *(*find)(const char *) = NULL;
    clIcdGetPlatformIDsKHR_fn entry = NULL;
    void *symbol = dlsym(library, name);
    if (!symbol) {
        void *finder = dlsym(library, "clGetExtensionFunctionAddress");
        memcpy(&find, &finder, sizeof find); /* C has no conversion from void * to a function */
        if (find) symbol = find(name);
    }
    memcpy(&entry, &symbol, sizeof entry);
    return entry;
}

/* Version 2 of cl_khr_icd marks the driver's table of functions by this value. A loader of that version calls such a driver
 * through a table of its own, which it makes only for drivers that it has loaded itself. */
static int is_for_loader(cl_platform_id platform) {
    const uint64_t mark = UINT64_C(0x4F50454E434C3331);
    const uint64_t *table = NULL;
    memcpy(&table, platform, sizeof table);
    return table[0] == mark;
}

static void open_library(void *argument) {
    opening *o = argument;
    cl_uint count = 0;
    void *library = dlopen(o->path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        snprintf(o->trouble, sizeof o->trouble, "cannot be loaded: %s", dlerror());
        return;
    }
    clIcdGetPlatformIDsKHR_fn entry = entry_of(library);
    if (!entry) {
        snprintf(o->trouble, sizeof o->trouble, "is a library, but lacks clIcdGetPlatformIDsKHR");
        return;
    }
    const cl_int code = entry(SKG_PLATFORMS_MAX, o->list->items, &count);
    if (code != CL_SUCCESS || count == 0) {
        snprintf(o->trouble, sizeof o->trouble, "has no platform on this machine (%s)", skg_cl_name(code));
        return;
    }
    o->list->count = count < SKG_PLATFORMS_MAX ? (int32_t)count : SKG_PLATFORMS_MAX;
    for (int32_t n = 0; n < o->list->count; n++) {
        if (is_for_loader(o->list->items[n])) {
            snprintf(o->trouble, sizeof o->trouble,
                     "has version 2 of cl_khr_icd, and works through the OpenCL loader only");
            return;
        }
    }
}

skg_status skg_icd_open(const char *path, skg_platform_list *list) {
    skg_platform_list loaders;
    opening o = {.path = path, .list = list};
    list->count = 0;
    SKG_TRY(find_loaders(&loaders));
    pthread_mutex_lock(&lock); /* PoCL starts without a lock */
    skg_status status = skg_opencl_call(open_library, &o);
    if (status == SKG_OK && !o.trouble[0]) status = skg_opencl_touch(list);
    if (status == SKG_OK && !o.trouble[0])
        for (int32_t n = 0; n < list->count; n++)
            if (!skg_platform_listed(&loaders, list->items[n])) add(&opened, list->items[n]);
    pthread_mutex_unlock(&lock);
    SKG_TRY(status);
    if (o.trouble[0])
        return skg_fail(SKG_ERR_NO_DEVICE,
                        "driver=%s %s; give the library of an OpenCL driver, as the files *.icd of "
                        "/etc/OpenCL/vendors name it",
                        path, o.trouble);
    return SKG_OK;
}
