/* Drivers that are known to fail on this machine, and how. */
#include "driver/driver.h"

#include <stdio.h>
#include <string.h>

/* LLVM's name of the processor, with which PoCL ends the version of its device; NULL if there is none. */
static const char *processor_of(const skg_device_info *info) {
    static const char before[] = "pthread-x86_64-";
    const char *triple = strstr(info->version, before);
    if (!triple) return NULL;
    const char *name = strstr(triple, "-gnu-");
    return name ? name + strlen("-gnu-") : NULL;
}

int skg_pocl_fails(const skg_device_info *info, int has_avx512) {
    int major = 0, minor = 0;
    const char *processor = processor_of(info);
    if (!has_avx512 || !processor || sscanf(info->driver, "%d.%d", &major, &minor) != 2) return 0;
    if (major > 3 || (major == 3 && minor >= 1)) return 0;
    return strncmp(processor, "znver", strlen("znver")) == 0 || strcmp(processor, "generic") == 0 ||
           strcmp(processor, "x86-64") == 0;
}

static int has_avx512(void) {
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_cpu_supports("avx512f") != 0;
#else
    return 0;
#endif
}

skg_status skg_faults_check(const skg_device_info *info) {
    if (strcmp(info->platform_name, "Portable Computing Language") != 0 ||
        !skg_pocl_fails(info, has_avx512()))
        return SKG_OK;
    return skg_fail(
        SKG_ERR_DEVICE,
        "PoCL %s takes %s for \"%s\", a processor without AVX-512, but it has AVX-512: its compiler would end the "
        "process. Install PoCL 3.1 or later (apt-get install pocl-opencl-icd), or another OpenCL driver for CPUs",
        info->driver, info->name, processor_of(info));
}
