#define _GNU_SOURCE /* madvise, MAP_ANONYMOUS */
#include "device/pages.h"

#include <sys/mman.h>

/* Buffers from half a huge page on: with smaller ones, more memory is cleared than is entered page by page. */
enum { HUGE_PAGE = 1 << 21, LEAST = HUGE_PAGE / 2 };

typedef struct {
    void *start;
    size_t bytes;
} pages;

/* Maps whole huge pages. What is mapped beside them to align them is given back. */
static int map(int64_t bytes, pages *made) {
    const size_t page = HUGE_PAGE, wanted = ((size_t)bytes + page - 1) / page * page;
    char *start = mmap(NULL, wanted + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) return 0;
    const size_t before = (page - (uintptr_t)start % page) % page;
    if (before > 0) munmap(start, before);
    munmap(start + before + wanted, page - before);
    *made = (pages){start + before, wanted};
#ifdef MADV_HUGEPAGE
    (void)madvise(made->start, wanted, MADV_HUGEPAGE); /* a wish; nothing depends on it */
#endif
    return 1;
}

static void drop(pages *mapped) {
    munmap(mapped->start, mapped->bytes);
    skg_free(&mapped);
}

static void CL_CALLBACK dropped(cl_mem memory, void *user) {
    (void)memory;
    drop(user);
}

cl_mem skg_pages_buffer(const skg_device *device, int64_t bytes, cl_mem_flags flags) {
    pages *mapped = NULL;
    cl_int code = CL_SUCCESS;
    if (!device->is_cpu || bytes < LEAST) return NULL;
    if (skg_alloc(1, sizeof *mapped, "pages", &mapped) != SKG_OK) return NULL;
    if (!map(bytes, mapped)) {
        skg_free(&mapped);
        return NULL;
    }
    cl_mem memory =
        clCreateBuffer(device->cl, flags | CL_MEM_USE_HOST_PTR, (size_t)bytes, mapped->start, &code);
    if (code == CL_SUCCESS && clSetMemObjectDestructorCallback(memory, dropped, mapped) == CL_SUCCESS)
        return memory;
    if (code == CL_SUCCESS) clReleaseMemObject(memory);
    drop(mapped);
    return NULL;
}
