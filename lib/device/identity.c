/* The identity of a device: its driver, its name, its versions, as a digest. */
#include "device/cache.h"
#include "device/choice.h"
#include "device/device.h"

#include <skiagraph/version.h>

#include <stdio.h>
#include <string.h>

enum { LONGEST = 4096 };

static void add_device_text(skg_digester *digester, cl_device_id device, cl_device_info what) {
    char text[LONGEST] = "";
    if (clGetDeviceInfo(device, what, sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
    text[LONGEST - 1] = '\0';
    skg_digest_add_text(digester, text);
}

/* Not copied into its caller: the test that makes every call fail once finds one call here. */
__attribute__((noinline)) static void add_platform_text(skg_digester *digester, cl_platform_id platform,
                                                        cl_platform_info what) {
    char text[LONGEST] = "";
    if (clGetPlatformInfo(platform, what, sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
    text[LONGEST - 1] = '\0';
    skg_digest_add_text(digester, text);
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
    skg_driver_environment_add(&digester);
    return skg_digest_end(&digester);
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
    device->caches = skg_driver_has_cache(device->platform);
    return skg_copy_text(path, &device->store);
}
