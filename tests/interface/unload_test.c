/* A program that loads the library, uses OpenMP and OpenCL through it, and closes it: their threads must not return into
 * code that is gone. */
#include "suite.h"

#include <skiagraph/context.h>
#include <skiagraph/thorax.h>

#include <dlfcn.h>
#include <string.h>
#include <time.h>

/* A function by its name; ISO C has no conversion from void * to a function. */
static void find(void *library, const char *name, void *function, size_t size) {
    void *found = dlsym(library, name);
    ck_assert_msg(found != NULL, "%s: %s", name, dlerror());
    memcpy(function, &found, size);
}

START_TEST(closing_leaves_it_in_place) {
    const struct timespec pause = {0, 50000000};
    skg_status (*count)(int64_t *);
    skg_status (*create)(const skg_thorax_options *, skg_thorax **);
    void (*release)(skg_thorax **);
    void (*prepare)(void *, int32_t);
    skg_thorax_options options;
    skg_thorax *thorax = NULL;
    int64_t devices = 0;
    void *library = dlopen(SKG_LIBRARY, RTLD_NOW);
    ck_assert_msg(library != NULL, "%s", dlerror());
    find(library, "skg_device_count", &count, sizeof count);
    find(library, "skg_thorax_create", &create, sizeof create);
    find(library, "skg_thorax_release", &release, sizeof release);
    find(library, "skg_thorax_options_init_sized", &prepare, sizeof prepare);
    ck_assert_int_eq(count(&devices), SKG_OK);
    prepare(&options, (int32_t)sizeof options);
    options.triangles = 10000;
    ck_assert_int_eq(create(&options, &thorax), SKG_OK); /* by OpenMP's threads */
    release(&thorax);
    ck_assert_int_eq(dlclose(library), 0);
    void *still = dlopen(SKG_LIBRARY, RTLD_NOW | RTLD_NOLOAD);
    ck_assert_ptr_nonnull(still);
    nanosleep(&pause, NULL); /* the threads spin, then sleep: in code that is there */
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, closing_leaves_it_in_place);
}

SKG_SUITE_MAIN("unload", add_tests)
