#include "device/identity.h"
#include "device/device.h"
#include "device/faults.h"
#include "device/platforms.h"
#include "device/store.h"

#include <skiagraph/version.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern char **environ;

enum { LONGEST = 4096 };

static void add_device_text(skg_digester *digester, cl_device_id device, cl_device_info what) {
    char text[LONGEST] = "";
    if (clGetDeviceInfo(device, what, sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
    text[LONGEST - 1] = '\0';
    skg_digest_add_text(digester, text);
}

/* Not copied into its callers: the test that makes every call fail once finds one call here. */
__attribute__((noinline)) static void platform_text(cl_platform_id platform, cl_platform_info what,
                                                    char text[LONGEST]) {
    text[0] = '\0';
    if (clGetPlatformInfo(platform, what, LONGEST, text, NULL) != CL_SUCCESS) text[0] = '\0';
    text[LONGEST - 1] = '\0';
}

static void add_platform_text(skg_digester *digester, cl_platform_id platform, cl_platform_info what) {
    char text[LONGEST];
    platform_text(platform, what, text);
    skg_digest_add_text(digester, text);
}

int skg_platform_is(cl_platform_id platform, const char *part_of_name) {
    char text[LONGEST];
    platform_text(platform, CL_PLATFORM_NAME, text);
    return strstr(text, part_of_name) != NULL;
}

static int starts_with(const char *text, const char *start) {
    return strncmp(text, start, strlen(start)) == 0;
}

/* The name and the features of the first processor that the kernel lists. Other systems than Linux have no such file,
 * and their processors differ by the device's name alone. */
static void add_processor(skg_digester *digester) {
    static const char *const lines[] = {"vendor_id",       "cpu family", "model",
                                        "stepping",        "flags",      "Features",
                                        "CPU implementer", "CPU part",   "CPU architecture"};
    char line[LONGEST];
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (!file) return;
    while (fgets(line, sizeof line, file) && line[0] != '\n')
        for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
            if (starts_with(line, lines[i])) {
                skg_digest_add_text(digester, line);
                break;
            }
    fclose(file);
}

/* Variables that change what PoCL and Intel's runtime compile. Those that only say where and how much are left out.
 * The order of the environment is that of the process, so that another order compiles once more. */
static void add_environment(skg_digester *digester) {
    static const char *const plain[] = {"POCL_CACHE_DIR=", "POCL_AFFINITY=", "POCL_MAX_PTHREAD_COUNT=",
                                        "POCL_DEBUG=",     "POCL_TRACING=",  "POCL_KERNEL_CACHE="};
    for (char **word = environ; word && *word; word++) {
        if (!starts_with(*word, "POCL_") && !starts_with(*word, "CL_CONFIG_")) continue;
        int is_plain = 0;
        for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
            if (starts_with(*word, plain[i])) is_plain = 1;
        if (!is_plain) skg_digest_add_text(digester, *word);
    }
}

skg_digest skg_identity_of(cl_platform_id platform, cl_device_id device) {
    skg_digester digester;
    cl_device_type type = 0;
    skg_digest_start(&digester);
    skg_digest_add_text(&digester, SKG_VERSION);
    add_platform_text(&digester, platform, CL_PLATFORM_NAME);
    add_platform_text(&digester, platform, CL_PLATFORM_VERSION);
    add_device_text(&digester, device, CL_DEVICE_NAME);
    add_device_text(&digester, device, CL_DEVICE_VENDOR);
    add_device_text(&digester, device, CL_DEVICE_VERSION);
    add_device_text(&digester, device, CL_DRIVER_VERSION);
    add_device_text(&digester, device, CL_DEVICE_EXTENSIONS);
    if (clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, NULL) != CL_SUCCESS) type = 0;
    if (type & CL_DEVICE_TYPE_CPU) add_processor(&digester);
    add_environment(&digester);
    return skg_digest_end(&digester);
}

/* PoCL has a cache of its own, unless it is told to do without. */
static int has_cache(cl_platform_id platform) {
    const char *asked = getenv("POCL_KERNEL_CACHE");
    return skg_platform_is(platform, "Portable Computing Language") && !(asked && strcmp(asked, "0") == 0);
}

skg_status skg_device_identify(skg_device *device) {
    char path[SKG_STORE_PATH];
    SKG_TRY(skg_faults_check(&device->info));
    skg_store_find(path);
    /* Oclgrind compiles with the options of its command line, which nobody else knows. */
    device->simulates = skg_platform_is(device->platform, "Oclgrind");
    if (device->simulates) path[0] = '\0';
    device->identity = skg_identity_of(device->platform, device->id);
    device->clang = skg_platform_has_clang(device->platform);
    device->caches = has_cache(device->platform);
    return skg_copy_text(path, &device->store);
}
