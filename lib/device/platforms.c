#include "device/platforms.h"
#include "device/verdict.h"

#include <skiagraph/version.h>

#include <stdio.h>
#include <string.h>

enum { LONGEST = 256 };

/* Name of the test whose verdict is kept under the identity of a platform. */
static const char test[] = "platform";

/* Whole names, so that a new driver of a known vendor is a new platform. */
static const struct {
    const char *name;
    int clang; /* 1: it compiles with a clang of its own, as far as machine code */
} list[] = {
    {"Portable Computing Language", 1},         /* PoCL: every test runs on it */
    {"Intel(R) OpenCL", 1},                     /* the CPU runtime: ./check --devices --intel */
    {"Intel(R) OpenCL Graphics", 0},            /* the vendor's own, in wide use */
    {"Intel(R) OpenCL HD Graphics", 0},         /* the same driver before 2022 */
    {"NVIDIA CUDA", 0},                         /* the vendor's own, in wide use */
    {"AMD Accelerated Parallel Processing", 0}, /* the vendor's own, in wide use */
    {"Oclgrind", 0},                            /* a simulator, which nobody has without asking for it */
};

int skg_platform_listed(const skg_platform_list *platforms, cl_platform_id platform) {
    for (int32_t n = 0; n < platforms->count; n++)
        if (platforms->items[n] == platform) return 1;
    return 0;
}

void skg_platform_name(cl_platform_id platform, char *name, size_t size) {
    name[0] = '\0';
    if (clGetPlatformInfo(platform, CL_PLATFORM_NAME, size, name, NULL) != CL_SUCCESS)
        snprintf(name, size, "?");
    name[size - 1] = '\0';
}

/* The place in the list, or -1. */
static int find(cl_platform_id platform) {
    char name[LONGEST];
    skg_platform_name(platform, name, sizeof name);
    for (int n = 0; n < (int)(sizeof list / sizeof *list); n++)
        if (strcmp(name, list[n].name) == 0) return n;
    return -1;
}

int skg_platform_is_known(cl_platform_id platform) {
    return find(platform) >= 0;
}

int skg_platform_has_clang(cl_platform_id platform) {
    const int n = find(platform);
    return n >= 0 && list[n].clang;
}

/* The digest of its names and versions and of the version of this library. Its devices are not asked. */
static skg_digest identity_of(cl_platform_id platform) {
    static const cl_platform_info parts[] = {CL_PLATFORM_NAME, CL_PLATFORM_VENDOR, CL_PLATFORM_VERSION};
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add_text(&digester, SKG_VERSION);
    for (size_t n = 0; n < sizeof parts / sizeof *parts; n++) {
        char text[LONGEST] = "";
        if (clGetPlatformInfo(platform, parts[n], sizeof text, text, NULL) != CL_SUCCESS) text[0] = '\0';
        text[LONGEST - 1] = '\0';
        skg_digest_add_text(&digester, text);
    }
    return skg_digest_end(&digester);
}

int skg_platform_is_trusted(const char *store, cl_platform_id platform) {
    skg_verdict verdict;
    if (skg_platform_is_known(platform)) return 1;
    const skg_digest identity = identity_of(platform);
    return skg_verdict_known(store, &identity, test, &verdict) && verdict.good;
}

void skg_platform_trust(const char *store, cl_platform_id platform) {
    const skg_digest identity = identity_of(platform);
    const skg_verdict verdict = {.good = 1};
    skg_verdict_keep(store, &identity, test, &verdict);
}
