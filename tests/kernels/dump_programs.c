/* Preloaded into a program, writes each OpenCL program that it builds from source to the folder $SKG_DUMP: NAME.cl with the
 * options in the first line, behind "//". The name is a hash, so that each program stands there once. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <CL/cl.h>

#include <dlfcn.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Made by clCreateProgramWithSource and not yet built: the text of the program. */
enum { LIMIT = 64 };
static struct {
    cl_program program;
    char *text;
} made[LIMIT];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

typedef cl_program create_call(cl_context, cl_uint, const char **, const size_t *, cl_int *);
typedef void CL_CALLBACK built_call(cl_program, void *);
typedef cl_int build_call(cl_program, cl_uint, const cl_device_id *, const char *, built_call *, void *);

/* The address of the next function of this name, which C does not convert to a pointer to a function. */
static void next_of(const char *name, void *pointer, size_t size) {
    void *found = dlsym(RTLD_NEXT, name);
    /* Python opens the library for itself alone: what is linked with it comes after nothing that is known here. */
    if (!found) found = dlsym(dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL), name);
    if (!found) abort();
    memcpy(pointer, &found, size);
}

static char *joined(cl_uint count, const char **texts, const size_t *lengths) {
    size_t all = 1;
    for (cl_uint i = 0; i < count; i++) all += lengths && lengths[i] ? lengths[i] : strlen(texts[i]);
    char *text = calloc(all, 1);
    for (cl_uint i = 0; text && i < count; i++)
        strncat(text, texts[i], lengths && lengths[i] ? lengths[i] : strlen(texts[i]));
    return text;
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char **texts,
                                     const size_t *lengths, cl_int *code) {
    create_call *call;
    next_of("clCreateProgramWithSource", &call, sizeof call);
    cl_program program = call(context, count, texts, lengths, code);
    const char *folder = getenv("SKG_DUMP");
    if (!program || !folder || !folder[0]) return program;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < LIMIT; i++)
        if (!made[i].program) {
            made[i].program = program;
            made[i].text = joined(count, texts, lengths);
            break;
        }
    pthread_mutex_unlock(&lock);
    return program;
}

static void dump(const char *text, const char *options) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325); /* FNV-1a */
    char path[1024], final[1024];
    for (const char *at = options; *at; at++) hash = (hash ^ (unsigned char)*at) * UINT64_C(0x100000001b3);
    for (const char *at = text; *at; at++) hash = (hash ^ (unsigned char)*at) * UINT64_C(0x100000001b3);
    snprintf(final, sizeof final, "%s/%016llx.cl", getenv("SKG_DUMP"), (unsigned long long)hash);
    snprintf(path, sizeof path, "%s.%ld", final, (long)getpid());
    FILE *file = fopen(path, "w");
    if (!file) return;
    fprintf(file, "// %s\n%s", options, text);
    if (fclose(file) == 0) rename(path, final);
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      built_call *built, void *user) {
    build_call *call;
    next_of("clBuildProgram", &call, sizeof call);
    const cl_int code = call(program, count, devices, options, built, user);
    pthread_mutex_lock(&lock);
    for (int i = 0; i < LIMIT; i++)
        if (program && made[i].program == program) {
            if (code == CL_SUCCESS && made[i].text) dump(made[i].text, options ? options : "");
            free(made[i].text);
            made[i].program = NULL, made[i].text = NULL;
        }
    pthread_mutex_unlock(&lock);
    return code;
}
