#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "device/pages.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Less is a page; much more takes longer than all else in a plan. */
static const int64_t LEAST_BYTES = 4 << 10, MOST_BYTES = 64 << 20;

struct skg_pages {
    int64_t bytes, count;
    skg_byte_range *ranges;
    size_t *mapping; /* its own size, and from the second page on the buffer; NULL: not yet */
    char *start;     /* of the buffer */
};

static void unmap(size_t *mapping) {
    if (mapping) munmap(mapping, *mapping);
}

static void drop(struct skg_pages *pages) {
    unmap(pages->mapping);
    skg_free(&pages->ranges);
    skg_free(&pages);
}

static void CL_CALLBACK dropped(cl_mem memory, void *user) {
    (void)memory;
    unmap(user);
}

void skg_pages_expect(skg_device *device, int64_t bytes, int64_t count, const skg_byte_range *ranges) {
    struct skg_pages *pages = NULL;
    int64_t written = 0;
    for (int64_t i = 0; i < count; i++) {
        if (ranges[i].from < 0 || ranges[i].to > bytes) return;
        if (ranges[i].to > ranges[i].from) written += ranges[i].to - ranges[i].from;
    }
    if (!device->info.is_cpu || device->simulates || written < LEAST_BYTES || written > MOST_BYTES) return;
    if (skg_alloc(1, sizeof *pages, "pages", &pages) != SKG_OK) return;
    *pages = (struct skg_pages){.bytes = bytes, .count = count};
    if (skg_alloc(count, sizeof *ranges, "pages", &pages->ranges) != SKG_OK) {
        drop(pages);
        return;
    }
    memcpy(pages->ranges, ranges, (size_t)count * sizeof *ranges);
    device->pages = pages;
}

void skg_pages_enter(skg_device *device) {
    struct skg_pages *pages = device->pages;
    const int64_t page = sysconf(_SC_PAGESIZE);
    if (!pages || pages->start || page < 1) return;
    const size_t whole = (size_t)(page + pages->bytes);
    char *mapped = mmap(NULL, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) return;
    pages->mapping = (size_t *)(void *)mapped;
    *pages->mapping = whole;
    char *start = mapped + page;
    for (int64_t i = 0; i < pages->count; i++)
        for (int64_t at = pages->ranges[i].from / page * page; at < pages->ranges[i].to; at += page)
            ((volatile char *)start)[at] = 0;
    pages->start = start;
}

cl_mem skg_pages_take(skg_device *device, int64_t bytes, cl_mem_flags flags) {
    struct skg_pages *pages = device->pages;
    cl_int code = CL_SUCCESS;
    if (!pages || !pages->start || pages->bytes != bytes) return NULL;
    cl_mem memory =
        clCreateBuffer(device->cl, flags | CL_MEM_USE_HOST_PTR, (size_t)bytes, pages->start, &code);
    if (code != CL_SUCCESS) return NULL;
    if (clSetMemObjectDestructorCallback(memory, dropped, pages->mapping) != CL_SUCCESS) {
        clReleaseMemObject(memory);
        return NULL;
    }
    pages->mapping = NULL;
    skg_pages_drop(device);
    return memory;
}

void skg_pages_drop(skg_device *device) {
    if (device->pages) drop(device->pages);
    device->pages = NULL;
}
