/* The platforms that this version knows, and what is known of them. Private to the library.
 *
 * A driver that is not known may end, crash or block the process that calls it. The library therefore asks such a platform for
 * its devices only if the caller names one, or if one of them has passed its test on this machine. */
#ifndef SKG_PLATFORMS_H
#define SKG_PLATFORMS_H

#include <CL/cl.h>

#include <stdint.h>

/* Platforms beyond these are not seen. */
enum { SKG_PLATFORMS_MOST = 32 };

typedef struct {
    cl_platform_id items[SKG_PLATFORMS_MOST];
    int32_t count;
} skg_platform_list;

int skg_platform_listed(const skg_platform_list *platforms, cl_platform_id platform);

/* 1: the list has the platform's name. Reads only the name, which the OpenCL loader has read before. */
int skg_platform_is_known(cl_platform_id platform);

/* 1: kernels may use the builtins of clang where `__has_builtin` reports them. Elsewhere that is not enough: Rusticl's front end
 * is clang, and its translator ends the process when it meets some of them. */
int skg_platform_has_clang(cl_platform_id platform);

/* 1: the platform is known, or one of its devices has passed its test. store: the user's folder, "" for none. */
int skg_platform_is_trusted(const char *store, cl_platform_id platform);

/* Keeps that a device of this platform, which is not known, has passed its test. */
void skg_platform_trust(const char *store, cl_platform_id platform);

/* "?" if it has none. */
void skg_platform_name(cl_platform_id platform, char *name, size_t size);

#endif
