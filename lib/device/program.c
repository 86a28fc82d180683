/* The programs of a context: built, shared, released. */
#include "device/programs.h"
#include "driver/driver.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct skg_program {
    struct skg_program *next;
    char *key;          /* files and options */
    cl_program program; /* NULL: it is to be prefetched */
    char *options;      /* for the compiler, until it is prefetched */
    skg_digest digest;  /* key in the cache */
    int32_t cached;     /* 1: it is in the user's folder, or this process has been counted there */
};

static skg_status make_key(int32_t files, const char *const *names, const char *options, char **key) {
    size_t length = strlen(options) + 1;
    for (int32_t i = 0; i < files; i++) length += strlen(names[i]) + 1;
    SKG_TRY(skg_alloc((int64_t)length, 1, "program", key));
    for (int32_t i = 0; i < files; i++) {
        strcat(*key, names[i]);
        strcat(*key, " ");
    }
    strcat(*key, options);
    return SKG_OK;
}

static skg_status build_failed(const skg_device *device, cl_program program, cl_int code, const char *key) {
    size_t size = 0;
    char *log = NULL;
    skg_cl_fail(code, "clBuildProgram", __FILE__, __LINE__);
    clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    if (size > 1 && skg_alloc((int64_t)size + 1, 1, "build log", &log) == SKG_OK)
        clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, size, log, NULL);
    int silent = !log || strspn(log, " \n\t") == strlen(log);
    skg_status status = skg_fail(
        SKG_ERR_BUILD, "%s from clBuildProgram (%s) on %s: %s", skg_cl_name(code), key, device->info.name,
        silent ? "the driver gives no reason; a kernel cache that cannot be written is the usual one "
                 "(PoCL: set POCL_CACHE_DIR to a folder that can)"
               : log);
    skg_free(&log);
    return status;
}

typedef struct {
    cl_program program;
    cl_device_id id;
    const char *options;
    cl_int code;
} compilation;

static void compile(void *data) {
    compilation *work = data;
    work->code = clBuildProgram(work->program, 1, &work->id, work->options, NULL, NULL);
}

static skg_status build_text(skg_context *context, const skg_program_text *text, const char *key,
                             cl_program *program) {
    skg_device *device = context->device;
    SKG_TRY(skg_program_text_create(device, text, program));
    compilation work = {*program, device->id, text->options, CL_SUCCESS};
    skg_signals_keep();
    skg_watch_call(&device->compiling, context, device->info.name, compile, &work);
    skg_signals_restore();
    if (work.code == CL_SUCCESS) return SKG_OK;
    const skg_status status = build_failed(device, *program, work.code, key);
    clReleaseProgram(*program);
    *program = NULL;
    return status;
}

/* Makes the program of an entry from the cache, or from its text. */
static skg_status build(skg_context *context, const skg_program_text *text, struct skg_program *entry) {
    skg_device *device = context->device;
    entry->program = skg_binary_load(device, &entry->digest, text->options);
    entry->cached = entry->program != NULL;
    if (entry->cached) {
        device->loads++;
        return SKG_OK;
    }
    SKG_TRY(build_text(context, text, entry->key, &entry->program));
    device->builds++;
    return SKG_OK;
}

/* Adds an entry without a program. It takes the key over. */
static skg_status add(skg_device *device, char **key, struct skg_program **entry) {
    SKG_TRY(skg_alloc(1, sizeof **entry, "program", entry));
    (*entry)->key = *key, *key = NULL;
    (*entry)->next = device->programs;
    device->programs = *entry;
    return SKG_OK;
}

skg_status skg_program_get(skg_context *context, int32_t files, const char *const *names, const char *options,
                           cl_program *program) {
    skg_device *device = context->device;
    struct skg_program *entry = NULL;
    skg_program_text text = {0};
    char *key = NULL;
    skg_status status = SKG_OK;
    if (!program && !device->store[0]) return SKG_OK; /* nothing is cached */
    if (program) *program = NULL;
    SKG_TRY(make_key(files, names, options, &key));
    for (entry = device->programs; entry; entry = entry->next)
        if (strcmp(entry->key, key) == 0) break;
    if (entry && (entry->program || !program)) goto cleanup;
    SKG_TRY_CLEANUP(skg_program_text_find(device, files, names, options, key, &text));
    if (!entry) SKG_TRY_CLEANUP(add(device, &key, &entry));
    entry->digest = skg_binary_key(device, &text);
    status = program ? build(context, &text, entry) : skg_copy_text(text.options, &entry->options);
cleanup:
    if (program && status == SKG_OK) *program = entry->program;
    skg_program_text_release(&text);
    skg_free(&key);
    return status;
}

static void prefetch(void *user) {
    skg_device *device = user;
    for (struct skg_program *entry = device->programs; entry; entry = entry->next)
        if (!entry->program && entry->options)
            entry->program = skg_binary_load(device, &entry->digest, entry->options);
    skg_pages_enter(device->pages);
}

void skg_prefetch_begin(skg_context *context) {
    skg_device *device = context->device;
    int wanted = device->pages != NULL;
    for (const struct skg_program *entry = device->programs; entry; entry = entry->next)
        wanted |= entry->options != NULL;
    if (wanted) skg_async_begin(&device->loading, prefetch, device);
}

void skg_prefetch_wait(skg_context *context) {
    skg_device *device = context->device;
    skg_async_end(&device->loading);
    for (struct skg_program *entry = device->programs; entry; entry = entry->next) {
        if (entry->program && entry->options) entry->cached = 1, device->loads++;
        skg_free(&entry->options);
    }
}

static void keep_programs(void *data) {
    const skg_device *device = data;
    for (struct skg_program *entry = device->programs; entry; entry = entry->next) {
        if (!entry->program) continue;
        if (!entry->cached && skg_binary_pays(device, &entry->digest))
            skg_binary_save(device, &entry->digest, entry->program);
        entry->cached = 1;
    }
}

void skg_programs_launched(skg_context *context) {
    if (context->device->store[0]) skg_work_none_call(keep_programs, context->device);
}

void skg_programs_release(skg_device *device, int ours) {
    while (device->programs) {
        struct skg_program *entry = device->programs;
        device->programs = entry->next;
        if (ours && entry->program) clReleaseProgram(entry->program);
        skg_free(&entry->options);
        skg_free(&entry->key);
        skg_free(&entry);
    }
}

skg_status skg_kernel_create(cl_program program, const char *name, cl_kernel *kernel) {
    cl_int code = CL_SUCCESS;
    *kernel = clCreateKernel(program, name, &code);
    if (code == CL_SUCCESS) return SKG_OK;
    skg_cl_fail(code, "clCreateKernel", __FILE__, __LINE__);
    return skg_fail(SKG_ERR_DEVICE, "kernel %s: %s", name, skg_cl_name(code));
}

skg_status skg_kernel_set(cl_kernel kernel, cl_uint index, size_t size, const void *value) {
    cl_int code = clSetKernelArg(kernel, index, size, value);
    if (code == CL_SUCCESS) return SKG_OK;
    char name[128] = "?";
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, NULL);
    skg_cl_fail(code, "clSetKernelArg", __FILE__, __LINE__);
    return skg_fail(SKG_ERR_DEVICE, "%s for argument %u (%zu bytes) of kernel %s", skg_cl_name(code), index,
                    size, name);
}
