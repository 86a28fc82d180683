/* Calls of OpenCL that start a driver, which not every one does safely. */
#include "core/threads.h"
#include "driver/driver.h"

#include <fenv.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

static atomic_llong starter; /* the process that has begun to start OpenCL; 0: none */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int started;       /* guarded by the lock */
static int32_t cpu_count; /* written once, before `started` */

typedef struct {
    void (*work)(void *argument);
    void *argument;
    skg_cpus caller, allowed;
} errand;

static void *run(void *argument) {
    errand *e = argument;
    fesetenv(FE_DFL_ENV);
    skg_cpus_allowed(&e->caller, &e->allowed);
    skg_cpus_set(&e->allowed);
    e->work(e->argument);
    return NULL;
}

static skg_status call(errand *e) {
    pthread_t thread;
    skg_cpus_get(&e->caller);
    skg_signals_keep();
    const int error = skg_thread_start(&thread, run, e);
    if (error == 0) pthread_join(thread, NULL);
    skg_signals_restore();
    if (error != 0)
        return skg_fail(
            SKG_ERR_DEVICE,
            "no thread can be made in which to call OpenCL (%s); the process or its user may have too many",
            strerror(error));
    return SKG_OK;
}

skg_status skg_opencl_call(void (*work)(void *argument), void *argument) {
    errand e = {.work = work, .argument = argument};
    return call(&e);
}

/* Asks platforms for their devices: by then PoCL has its threads. Errors are left to those who ask again.
 *
 * list   NULL: the known ones of the loader; others are left to those who trust them */
static void touch(void *list) {
    const skg_platform_list *given = list;
    skg_platform_list loaders = {.count = 0};
    cl_uint count = 0, devices = 0;
    if (!given) {
        if (clGetPlatformIDs(SKG_PLATFORMS_MAX, loaders.items, &count) != CL_SUCCESS) return;
        loaders.count = count < SKG_PLATFORMS_MAX ? (int32_t)count : SKG_PLATFORMS_MAX;
    }
    const skg_platform_list *all = given ? given : &loaders;
    for (int32_t n = 0; n < all->count; n++)
        if (given || skg_platform_is_known(all->items[n]))
            clGetDeviceIDs(all->items[n], CL_DEVICE_TYPE_ALL, 0, NULL, &devices);
}

skg_status skg_opencl_touch(skg_platform_list *list) {
    return skg_opencl_call(touch, list);
}

skg_status skg_opencl_start(void) {
    long long process = 0;
    const long long self = (long long)getpid();
    skg_status status = SKG_OK;
    /* A child may have been forked while a thread of its parent held the lock; `starter` was set before that. */
    if (!atomic_compare_exchange_strong(&starter, &process, self) && process != self)
        return skg_fail(
            SKG_ERR_FORK,
            "OpenCL was started by the process that forked this one, and does not survive a fork; start the "
            "child process by exec or spawn, or fork before the first call that uses OpenCL");
    pthread_mutex_lock(&lock);
    if (!started) {
        errand e = {.work = touch};
        status = call(&e);
        cpu_count = skg_cpus_count(&e.allowed);
        started = status == SKG_OK;
    }
    pthread_mutex_unlock(&lock);
    return status;
}

int32_t skg_opencl_cpu_count(void) {
    return cpu_count;
}
