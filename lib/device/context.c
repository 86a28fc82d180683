/* Opens a device, and what its driver has said meanwhile. */
#include "core/text.h"
#include "device/choice.h"
#include "device/device.h"
#include "device/programs.h"
#include "driver/driver.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void CL_CALLBACK skg_driver_says(const char *sentence, const void *data, size_t size, void *user) {
    (void)data;
    (void)size;
    char whole[SKG_MAILBOX_SENTENCE];
    snprintf(whole, sizeof whole, "OpenCL driver: %s", sentence);
    skg_mailbox_put(user, whole);
}

typedef struct {
    char device[128];  /* "": any */
    char driver[1024]; /* "": those of the OpenCL loader */
    char kernels[1024];
    int32_t threads; /* 0: all */
} wanted_device;

static skg_status copy_word(const char *value, size_t length, char *place, size_t size) {
    if (length == 0 || length >= size)
        return skg_fail(SKG_ERR_ARGUMENT, "device words: \"%.*s\" is empty or too long", (int)length, value);
    memcpy(place, value, length);
    place[length] = '\0';
    return SKG_OK;
}

/* A word such as device=gpu. Without a key it is the value of device=. */
typedef struct {
    char key[32];
    const char *value;
    size_t length;
} device_word;

/* Takes the word at *at, and moves *at behind it. A value in double quotes may hold blanks. */
static skg_status take_word(const char **at, device_word *word) {
    const char *equals = **at == '"' ? NULL : memchr(*at, '=', strcspn(*at, " "));
    *word = (device_word){.key = "device", .value = *at};
    if (equals) {
        SKG_TRY(copy_word(*at, (size_t)(equals - *at), word->key, sizeof word->key));
        word->value = equals + 1;
    }
    const int quoted = *word->value == '"';
    word->value += quoted;
    word->length = strcspn(word->value, quoted ? "\"" : " ");
    *at = word->value + word->length;
    if (quoted && (**at != '"' || ((*at)[1] != '\0' && (*at)[1] != ' ')))
        return skg_fail(SKG_ERR_ARGUMENT, "device words: the quote of %s=\"%s has no end before a blank",
                        word->key, word->value);
    *at += quoted;
    return SKG_OK;
}

static skg_status read_threads(const device_word *word, int32_t *threads) {
    char *end = NULL;
    const long count = strtol(word->value, &end, 10);
    if (end != word->value + word->length || count < 1 || count > 4096)
        return skg_fail(SKG_ERR_ARGUMENT, "threads=%.*s is not a number from 1 to 4096", (int)word->length,
                        word->value);
    *threads = (int32_t)count;
    return SKG_OK;
}

static skg_status read_words(const char *words, wanted_device *wanted) {
    static const char *const keys[] = {"device", "driver", "threads", "kernels"};
    const char *at = words;
    while (*at == ' ') at++;
    while (*at) {
        device_word word;
        SKG_TRY(take_word(&at, &word));
        if (skg_same_name(word.key, "device")) {
            SKG_TRY(copy_word(word.value, word.length, wanted->device, sizeof wanted->device));
        } else if (skg_same_name(word.key, "driver")) {
            SKG_TRY(copy_word(word.value, word.length, wanted->driver, sizeof wanted->driver));
        } else if (skg_same_name(word.key, "kernels")) {
            SKG_TRY(copy_word(word.value, word.length, wanted->kernels, sizeof wanted->kernels));
        } else if (skg_same_name(word.key, "threads")) {
            SKG_TRY(read_threads(&word, &wanted->threads));
        } else {
            const char *near = skg_nearest_name(word.key, keys, sizeof keys / sizeof *keys);
            return skg_fail(
                SKG_ERR_ARGUMENT,
                "\"%s\" says nothing about a device%s%s; known: device=, driver=, threads=, kernels=",
                word.key, near ? "; did you mean " : "", near ? near : "");
        }
        while (*at == ' ') at++;
    }
    return SKG_OK;
}

/* Words of config replace those of the environment. If config has a device and no driver, the driver of the environment is
 * ignored too, because the device is one of the loader's. */
static skg_status read_config(const char *config, wanted_device *wanted) {
    wanted_device asked = {0};
    *wanted = (wanted_device){0};
    const char *device = getenv("SKG_DEVICE"), *kernels = getenv("SKG_KERNEL_DIR");
    if (device && read_words(device, wanted) != SKG_OK)
        return skg_fail(SKG_ERR_ARGUMENT, "environment variable SKG_DEVICE=%s: %s", device, skg_last_error());
    if (kernels && !wanted->kernels[0])
        SKG_TRY(copy_word(kernels, strlen(kernels), wanted->kernels, sizeof wanted->kernels));
    if (!config) return SKG_OK;
    SKG_TRY(read_words(config, &asked));
    if (asked.device[0] && !asked.driver[0]) wanted->driver[0] = '\0';
    return read_words(config, wanted);
}

static skg_device_words words_of(const wanted_device *wanted) {
    return (skg_device_words){.device = wanted->device[0] ? wanted->device : NULL,
                              .driver = wanted->driver[0] ? wanted->driver : NULL};
}

/* Leaves a warning for the context's log, which the caller has not set yet. */
static void warn_of_workers(const skg_context *context, int32_t cpus) {
    const skg_device_info *info = &context->device->info;
    char sentence[SKG_MAILBOX_SENTENCE];
    const char *variable = skg_driver_threads_variable(info->platform_name);
    snprintf(sentence, sizeof sentence,
             "%s has %" PRId32 " threads, but this process may run on %" PRId32
             " of the CPUs; images are faster if %s is set to %" PRId32 " before the process starts",
             info->name, info->compute_units, cpus,
             variable ? variable : "the driver's variable for its number of threads", cpus);
    skg_mailbox_put(skg_mailbox_address(context->driver), sentence);
}

/* If the process may run on fewer CPUs than the device has compute units, work is divided for those CPUs. A sub-device
 * would be slower: PoCL wakes every worker for each command, and only those of the sub-device may take it. Waking idle
 * workers costs 15 % of a small image with 8 of them for each CPU, and doubles its time with 64: then there is a warning. */
static void fit_to_cpus(skg_context *context) {
    enum { MANY_WORKERS = 8 };
    skg_device_info *info = &context->device->info;
    const int32_t cpus = skg_opencl_cpu_count();
    if (!info->cpu || cpus == 0 || cpus >= info->compute_units) return;
    if (info->compute_units >= MANY_WORKERS * cpus) warn_of_workers(context, cpus);
    info->compute_units = cpus;
}

/* Restricts the context to a sub-device of `threads` compute units, if the device has more. */
static skg_status limit_threads(skg_context *context, int32_t threads) {
    skg_device *device = context->device;
    if (threads >= device->info.compute_units) return SKG_OK;
    cl_device_id part = NULL;
    const cl_int code = skg_sub_device_get(device->id, threads, &part);
    if (code != CL_SUCCESS)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s cannot be limited to threads=%" PRId32 ": %s from clCreateSubDevices",
                        device->info.name, threads, skg_cl_name(code));
    device->id = part;
    device->info.compute_units = threads;
    return SKG_OK;
}

static skg_status new_context(skg_context **context) {
    skg_context *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "context", &made));
    skg_refs_init(&made->refs);
    made->process = (int64_t)getpid();
    skg_status status = skg_alloc(1, sizeof *made->device, "device", &made->device);
    if (status == SKG_OK) status = skg_turn_create(&made->turn);
    if (status == SKG_OK) status = skg_pool_create(&made->jobs);
    if (status == SKG_OK) status = skg_mailbox_create(&made->driver);
    if (status != SKG_OK) {
        skg_turn_release(&made->turn);
        skg_pool_release(&made->jobs);
        skg_free(&made->device);
        skg_free(&made);
    }
    *context = made;
    return status;
}

typedef struct {
    skg_context *context;
    const char *call; /* the last one */
    cl_int code;
} opening;

/* Some drivers make their threads now. */
static void open_queue(void *argument) {
    opening *o = argument;
    skg_device *device = o->context->device;
    cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)device->platform, 0};
    o->call = "clCreateContext";
    /* The loader of Debian refuses platforms that it does not list; without a platform it asks the device's driver. */
    const int listed = !skg_icd_has(device->platform);
    device->cl = clCreateContext(listed ? properties : NULL, 1, &device->id, skg_driver_says,
                                 skg_mailbox_address(o->context->driver), &o->code);
    if (o->code != CL_SUCCESS) return;
    o->call = "clCreateCommandQueue";
    device->profiling = 1;
    device->queue = clCreateCommandQueue(device->cl, device->id, CL_QUEUE_PROFILING_ENABLE, &o->code);
}

skg_status skg_context_open(const char *config, uint64_t without, skg_context **context, int32_t *index) {
    *context = NULL;
    skg_context *made = NULL;
    skg_status status = SKG_OK;
    wanted_device wanted;
    SKG_TRY(read_config(config, &wanted));
    SKG_TRY(skg_opencl_start());
    SKG_TRY(new_context(&made));
    skg_device *device = made->device;
    opening o = {.context = made};
    const skg_device_words words = words_of(&wanted);
    SKG_TRY_CLEANUP(skg_device_choose(&words, without, &device->platform, &device->id, &device->info, index));
    if (wanted.threads > 0)
        SKG_TRY_CLEANUP(limit_threads(made, wanted.threads));
    else
        fit_to_cpus(made);
    if (wanted.kernels[0]) SKG_TRY_CLEANUP(skg_copy_text(wanted.kernels, &device->kernel_dir));
    SKG_TRY_CLEANUP(skg_opencl_call(open_queue, &o));
    if (o.code != CL_SUCCESS) SKG_TRY_CLEANUP(skg_cl_fail(o.code, o.call, __FILE__, __LINE__));
    SKG_TRY_CLEANUP(skg_device_identify(device));
    *context = made;
    return SKG_OK;
cleanup:
    skg_context_release(&made);
    return status;
}

skg_status skg_device_untested(const char *config, int32_t *untested) {
    wanted_device wanted;
    SKG_NEEDS(untested);
    *untested = 0;
    SKG_TRY(read_config(config, &wanted));
    SKG_TRY(skg_opencl_start());
    const skg_device_words words = words_of(&wanted);
    return skg_device_doubt(&words, untested);
}

skg_status skg_device_locate(const char *config, cl_platform_id *platform, cl_device_id *device,
                             skg_device_info *info) {
    wanted_device wanted;
    int32_t index = 0;
    SKG_TRY(read_config(config, &wanted));
    SKG_TRY(skg_opencl_start());
    const skg_device_words words = words_of(&wanted);
    return skg_device_choose(&words, 0, platform, device, info, &index);
}

skg_status skg_device_find(const char *config, skg_device_info *info) {
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    skg_device_info ours;
    SKG_TRY(skg_device_locate(config, &platform, &device, &ours));
    return skg_struct_write(&ours, sizeof ours, "skg_device_info", info);
}

skg_status skg_context_create_cl(cl_context cl, cl_device_id id, cl_command_queue queue,
                                 skg_context **context) {
    SKG_PLAIN;
    SKG_NEEDS(context);
    SKG_NEEDS(cl);
    SKG_NEEDS(id);
    SKG_NEEDS(queue);
    *context = NULL;
    cl_context queue_context = NULL;
    cl_device_id queue_device = NULL;
    cl_command_queue_properties properties = 0;
    cl_platform_id platform = NULL;
    SKG_TRY(skg_opencl_start());
    SKG_CL_TRY(clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof queue_context, &queue_context, NULL));
    SKG_CL_TRY(clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof queue_device, &queue_device, NULL));
    SKG_CL_TRY(clGetCommandQueueInfo(queue, CL_QUEUE_PROPERTIES, sizeof properties, &properties, NULL));
    SKG_CL_TRY(clGetDeviceInfo(id, CL_DEVICE_PLATFORM, sizeof platform, &platform, NULL));
    if (queue_context != cl || queue_device != id)
        return skg_fail(SKG_ERR_ARGUMENT, "the queue was not made on this context and device");
    if (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)
        return skg_fail(SKG_ERR_ARGUMENT, "the queue runs out of order; give an in-order queue");
    skg_context *made = NULL;
    SKG_TRY(new_context(&made));
    skg_device *device = made->device;
    device->platform = platform;
    device->profiling = (properties & CL_QUEUE_PROFILING_ENABLE) != 0;
    clRetainDevice(id), device->id = id;
    clRetainContext(cl), device->cl = cl;
    clRetainCommandQueue(queue), device->queue = queue;
    skg_status status = skg_device_inform(-1, -1, platform, id, &device->info);
    if (status == SKG_OK) status = skg_device_identify(device);
    if (status != SKG_OK)
        skg_context_release(&made);
    else
        *context = made;
    return status;
}

void skg_context_release(skg_context **context) {
    if (!context || !*context) return;
    skg_context *last = *context;
    *context = NULL;
    if (!skg_unref(&last->refs)) return;
    skg_device *device = last->device;
    int ours = last->process == (int64_t)getpid(); /* a child process must not call OpenCL */
    skg_programs_release(device, ours);
    skg_pages_drop(&device->pages);
    if (ours && device->queue) clReleaseCommandQueue(device->queue);
    if (ours && device->cl) clReleaseContext(device->cl);
    if (ours && device->id) clReleaseDevice(device->id); /* does nothing unless it is a sub-device */
    skg_free(&device->kernel_dir);
    skg_free(&device->store);
    skg_mailbox_release(&last->driver);
    skg_turn_release(&last->turn);
    skg_pool_release(&last->jobs);
    skg_free(&last->device);
    skg_free(&last);
}

skg_status skg_context_device_get(skg_context *context, skg_device_info *info) {
    SKG_TRY(skg_context_enter(context));
    return skg_struct_write(&context->device->info, sizeof context->device->info, "skg_device_info", info);
}
