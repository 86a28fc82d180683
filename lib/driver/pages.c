/* Writes to pages of memory ahead, so that the first kernel need not wait for them. */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "driver/driver.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Less is a page; much more takes longer than all else in a plan. */
static const int64_t MIN_BYTES = 4 << 10, BYTES_MAX = 64 << 20;

struct skg_pages {
    int64_t bytes, count;
    skg_byte_range *ranges;
    size_t *mapping; /* its own size, and from the second page on the buffer; NULL: not yet */
    char *start;     /* of the buffer */
};

static void unmap(size_t *mapping) {
    if (mapping) munmap(mapping, *mapping);
}

static void CL_CALLBACK dropped(cl_mem memory, void *user) {
    (void)memory;
    unmap(user);
}

void skg_pages_prefetch(int64_t bytes, int64_t count, const skg_byte_range *ranges, skg_pages **pages) {
    skg_pages *made = NULL;
    *pages = NULL;
    int64_t written = 0;
    for (int64_t i = 0; i < count; i++) {
        if (ranges[i].from < 0 || ranges[i].to > bytes) return;
        if (ranges[i].to > ranges[i].from) written += ranges[i].to - ranges[i].from;
    }
    if (written < MIN_BYTES || written > BYTES_MAX) return;
    if (skg_alloc(1, sizeof *made, "pages", &made) != SKG_OK) return;
    *made = (skg_pages){.bytes = bytes, .count = count};
    if (skg_alloc(count, sizeof *ranges, "pages", &made->ranges) != SKG_OK) {
        skg_free(&made);
        return;
    }
    memcpy(made->ranges, ranges, (size_t)count * sizeof *ranges);
    *pages = made;
}

void skg_pages_enter(skg_pages *pages) {
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

cl_mem skg_pages_take(skg_pages **pages, cl_context cl, int64_t bytes, cl_mem_flags flags) {
    skg_pages *from = *pages;
    cl_int code = CL_SUCCESS;
    if (!from || !from->start || from->bytes != bytes) return NULL;
    cl_mem memory = clCreateBuffer(cl, flags | CL_MEM_USE_HOST_PTR, (size_t)bytes, from->start, &code);
    if (code != CL_SUCCESS) return NULL;
    if (clSetMemObjectDestructorCallback(memory, dropped, from->mapping) != CL_SUCCESS) {
        clReleaseMemObject(memory);
        return NULL;
    }
    from->mapping = NULL;
    skg_pages_drop(pages);
    return memory;
}

void skg_pages_drop(skg_pages **pages) {
    if (!*pages) return;
    unmap((*pages)->mapping);
    skg_free(&(*pages)->ranges);
    skg_free(pages);
}
