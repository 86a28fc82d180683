#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "device/pages.h"

#include <sys/mman.h>
#include <unistd.h>

/* Mapped, so that it goes back to the system with the buffer. */
struct skg_pages {
    char *start;
    size_t bytes;
};

/* Less is not worth a mapping of its own; much more may hold pages that no frame writes to. */
static const int64_t LEAST_BYTES = 1 << 20, MOST_BYTES = 64 << 20;

static void drop(struct skg_pages *pages) {
    if (pages->start) munmap(pages->start, pages->bytes);
    skg_free(&pages);
}

static void CL_CALLBACK dropped(cl_mem memory, void *user) {
    (void)memory;
    drop(user);
}

int skg_pages_wanted(const skg_device *device) {
    return device->info.is_cpu && !device->simulates && !device->pages &&
           device->expected_bytes >= LEAST_BYTES && device->expected_bytes <= MOST_BYTES;
}

void skg_pages_enter(skg_device *device) {
    struct skg_pages *pages = NULL;
    const long page = sysconf(_SC_PAGESIZE);
    const size_t bytes = (size_t)device->expected_bytes;
    if (!skg_pages_wanted(device) || page < 1) return;
    if (skg_alloc(1, sizeof *pages, "pages", &pages) != SKG_OK) return;
    char *start = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) {
        drop(pages);
        return;
    }
    for (size_t at = 0; at < bytes; at += (size_t)page) ((volatile char *)start)[at] = 0;
    *pages = (struct skg_pages){start, bytes};
    device->pages = pages;
}

cl_mem skg_pages_take(skg_device *device, int64_t bytes, cl_mem_flags flags) {
    struct skg_pages *pages = device->pages;
    cl_int code = CL_SUCCESS;
    if (!pages || pages->bytes != (size_t)bytes) return NULL;
    cl_mem memory =
        clCreateBuffer(device->cl, flags | CL_MEM_USE_HOST_PTR, (size_t)bytes, pages->start, &code);
    if (code != CL_SUCCESS) return NULL;
    if (clSetMemObjectDestructorCallback(memory, dropped, pages) != CL_SUCCESS) {
        clReleaseMemObject(memory);
        return NULL;
    }
    device->pages = NULL;
    return memory;
}

void skg_pages_drop(skg_device *device) {
    if (device->pages) drop(device->pages);
    device->pages = NULL;
    device->expected_bytes = 0;
}
