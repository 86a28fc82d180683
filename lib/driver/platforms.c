/* The platforms that are known, and what each needs. */
#include "driver/driver.h"

#include <stdio.h>
#include <string.h>

enum { LONGEST = 256 };

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

int skg_platform_is(cl_platform_id platform, const char *part_of_name) {
    char name[LONGEST];
    skg_platform_name(platform, name, sizeof name);
    return strstr(name, part_of_name) != NULL;
}
