#include "device/program.h"
#include "device/binaries.h"
#include "device/signals.h"
#include "device/sources.h"
#include "device/watch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct skg_program {
    struct skg_program *next;
    char *key; /* files and options */
    cl_program program;
    skg_digest digest; /* what it is kept under */
    int32_t kept;      /* 1: it is in the user's folder, or this process has been counted there */
};

enum { MOST_FILES = 16 };

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

static const char *built_in(const char *name) {
    for (int i = 0; i < skg_kernel_source_count; i++)
        if (strcmp(skg_kernel_sources[i].name, name) == 0) return skg_kernel_sources[i].text;
    return NULL;
}

static skg_status read_file(const char *dir, const char *name, char **text) {
    char path[2048];
    if (snprintf(path, sizeof path, "%s/%s", dir, name) >= (int)sizeof path)
        return skg_fail(SKG_ERR_FILE, "%s/%s: the path is too long", dir, name);
    FILE *file = fopen(path, "rb");
    if (!file)
        return skg_fail(SKG_ERR_FILE, "%s: %s (kernels are read from here on demand)", path, strerror(errno));
    skg_status status = SKG_OK;
    size_t used = 0, got = 0;
    int64_t capacity = 0;
    do {
        if ((int64_t)used + 4096 > capacity) {
            capacity = capacity * 2 + 16384;
            SKG_TRY_CLEANUP(skg_realloc(capacity, 1, path, text));
        }
        got = fread(*text + used, 1, 4095, file);
        used += got;
        (*text)[used] = '\0';
    } while (got > 0);
    if (ferror(file)) status = skg_fail(SKG_ERR_FILE, "%s: cannot be read", path);
cleanup:
    fclose(file);
    return status;
}

/* The source of one kernel file, after a #line directive that makes build logs name the file. */
static skg_status load_source(const skg_device *device, const char *name, char **source) {
    char *text = NULL;
    *source = NULL;
    skg_status status = SKG_OK;
    if (device->kernel_dir) SKG_TRY_CLEANUP(read_file(device->kernel_dir, name, &text));
    const char *body = device->kernel_dir ? text : built_in(name);
    if (!body) {
        status = skg_fail(SKG_ERR_INTERNAL, "no kernel file %s is built in", name);
        goto cleanup;
    }
    size_t length = strlen(body) + strlen(name) + 32;
    SKG_TRY_CLEANUP(skg_alloc((int64_t)length, 1, name, source));
    snprintf(*source, length, "#line 1 \"%s\"\n%s\n", name, body);
cleanup:
    skg_free(&text);
    return status;
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

static skg_status build_sources(skg_context *context, int32_t files, char *const *sources,
                                const char *options, const char *key, cl_program *program) {
    skg_device *device = context->device;
    cl_int code = CL_SUCCESS;
    *program = clCreateProgramWithSource(device->cl, (cl_uint)files, (const char **)sources, NULL, &code);
    if (code != CL_SUCCESS) return skg_cl_fail(code, "clCreateProgramWithSource", __FILE__, __LINE__);
    compilation work = {*program, device->id, options, CL_SUCCESS};
    skg_signals_keep();
    skg_watch(context, compile, &work);
    skg_signals_restore();
    if (work.code == CL_SUCCESS) return SKG_OK;
    const skg_status status = build_failed(device, *program, work.code, key);
    clReleaseProgram(*program);
    *program = NULL;
    return status;
}

/* Makes the program of an entry from what was kept, or from its sources. */
static skg_status build(skg_context *context, int32_t files, const char *const *names, const char *options,
                        const char *key, struct skg_program *entry) {
    skg_device *device = context->device;
    char *sources[MOST_FILES] = {0};
    char full[2048];
    skg_status status = SKG_OK;
    if (files > MOST_FILES) return skg_fail(SKG_ERR_INTERNAL, "%s: too many kernel files", key);
    for (int32_t i = 0; i < files; i++) SKG_TRY_CLEANUP(load_source(device, names[i], &sources[i]));
    /* With correctly rounded division, images are equal bit for bit on different devices. */
    if (snprintf(full, sizeof full, "-cl-std=CL1.2%s %s",
                 device->info.correct_division ? " -cl-fp32-correctly-rounded-divide-sqrt" : "",
                 options) >= (int)sizeof full) {
        status = skg_fail(SKG_ERR_INTERNAL, "%s: the options are too long", key);
        goto cleanup;
    }
    entry->digest = skg_binary_key(device, files, sources, full);
    entry->program = skg_binary_load(device, &entry->digest, full);
    entry->kept = entry->program != NULL;
    if (entry->kept) {
        device->loads++;
    } else {
        SKG_TRY_CLEANUP(build_sources(context, files, sources, full, key, &entry->program));
        device->builds++;
    }
cleanup:
    for (int32_t i = 0; i < files && i < MOST_FILES; i++) skg_free(&sources[i]);
    return status;
}

skg_status skg_program_get(skg_context *context, int32_t files, const char *const *names, const char *options,
                           cl_program *program) {
    skg_device *device = context->device;
    struct skg_program *entry = NULL;
    char *key = NULL;
    *program = NULL;
    SKG_TRY(make_key(files, names, options, &key));
    for (entry = device->programs; entry; entry = entry->next)
        if (strcmp(entry->key, key) == 0) {
            skg_free(&key);
            *program = entry->program;
            return SKG_OK;
        }
    skg_status status = skg_alloc(1, sizeof *entry, "program", &entry);
    if (status == SKG_OK) status = build(context, files, names, options, key, entry);
    if (status != SKG_OK) {
        skg_free(&entry);
        skg_free(&key);
        return status;
    }
    entry->key = key;
    entry->next = device->programs;
    device->programs = entry;
    *program = entry->program;
    return SKG_OK;
}

void skg_programs_launched(skg_context *context) {
    const skg_device *device = context->device;
    if (!device->store[0]) return;
    for (struct skg_program *entry = device->programs; entry; entry = entry->next) {
        if (!entry->kept && skg_binary_pays(device, &entry->digest))
            skg_binary_save(device, &entry->digest, entry->program);
        entry->kept = 1;
    }
}

void skg_programs_release(skg_device *device, int ours) {
    while (device->programs) {
        struct skg_program *entry = device->programs;
        device->programs = entry->next;
        if (ours) clReleaseProgram(entry->program);
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
