/** @file
 * Where the library takes its host memory from: by default calloc, realloc and free of the C library.
 *
 * An allocator is one for the process, because meshes, materials and spectra belong to no context. All memory of the
 * library's own comes from it. What other libraries allocate does not: the OpenCL driver, OpenMP, Jansson, Assimp, libpng,
 * libtiff and HDF5. Results are written to memory of the caller, so that nothing which the library allocates has to be
 * freed by anyone else.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_MEMORY_H
#define SKIAGRAPH_MEMORY_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Allocates `bytes` bytes, at least 1, aligned as malloc aligns them; their contents do not matter. Returns NULL if there is
 * no memory: the call of the library then fails with SKG_ERR_MEMORY and gives back what it had. It may be called by several
 * threads at a time, and must not call the library. */
typedef void *(*skg_allocate_function)(int64_t bytes, void *user);

/** Changes the size of memory that it or the allocating function gave, as realloc does: the memory may move, and stays as it
 * was if NULL is returned. `memory` may be NULL. */
typedef void *(*skg_reallocate_function)(void *memory, int64_t bytes, void *user);

/** Takes back memory, which is not NULL. */
typedef void (*skg_release_function)(void *memory, void *user);

/** An allocator. Prepare with skg_allocator_init: that of the C library. Set all three functions or none. */
typedef struct {
    /** Set by skg_allocator_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Allocates. */
    skg_allocate_function allocate;
    /** Changes the size. */
    skg_reallocate_function reallocate;
    /** Releases. */
    skg_release_function release;
    /** Given to all three. */
    void *user;
} skg_allocator;

SKG_INIT(skg_allocator)

/** Sets the allocator of the process, while no other thread is inside a call of the library: before the first call, or when
 * every handle was released.
 *
 *     allocator   copied; NULL: that of the C library
 *     errors      SKG_ERR_ARGUMENT if one of the functions is missing, or if the library still has memory */
SKG_API skg_status skg_allocator_set(const skg_allocator *allocator);

/** Gets the number of pieces of memory that the library has now; 0 when every handle was released. For tests of programs
 * that look for leaks. */
SKG_API skg_status skg_allocation_count(int64_t *count);

#ifdef __cplusplus
}
#endif
#endif
