/* driver=PATH: a driver that the OpenCL loader does not know. Check runs each test in a process of its own, so that each
 * may tell the loader to find nothing before it looks. */
#define _GNU_SOURCE /* dladdr */
#include "device/device.h"
#include "suite.h"
#include "support/run.h"

#include <skiagraph/context.h>

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { SIDE = 32 };

/* Results that a process which uses the loader hands to another one. */
typedef struct {
    char library[1024]; /* of the loader's first driver */
    int64_t devices;
    double lengths[SIDE * SIDE];
} seen;

static void render(skg_context *context, double *lengths) {
    const skg_view view = run_view(SIDE, 4);
    solid sphere = solid_sphere(40, 20, 10);
    run_context = context;
    double *pixels = run_solid(&sphere, NULL, &view, (run_choice){0});
    memcpy(lengths, pixels, SIDE * SIDE * sizeof *lengths);
    free(pixels);
    solid_free(&sphere);
}

/* The library in which the functions of a platform are: an object of a driver begins with a pointer to their table. */
static void find_library(char *path, size_t size) {
    cl_platform_id platform = NULL;
    void **table = NULL;
    Dl_info info;
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, NULL), CL_SUCCESS);
    memcpy(&table, platform, sizeof table);
    ck_assert_int_ne(dladdr(table[1], &info), 0);
    snprintf(path, size, "%s", info.dli_fname);
}

/* Results of the loader, found by a child; this process has not called OpenCL then. */
static seen *see(void) {
    seen *s = mmap(NULL, sizeof *s, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int result = -1;
    ck_assert_ptr_ne(s, MAP_FAILED);
    const pid_t child = fork();
    if (child == 0) {
        skg_context *context = NULL;
        find_library(s->library, sizeof s->library);
        if (skg_device_count(&s->devices) != SKG_OK || skg_context_create("device=0:0", &context) != SKG_OK)
            _exit(1);
        render(context, s->lengths);
        _exit(0);
    }
    ck_assert_int_eq(waitpid(child, &result, 0), child);
    ck_assert(WIFEXITED(result) && WEXITSTATUS(result) == 0);
    return s;
}

/* Lets the loader find no driver: a folder without files *.icd. */
static void empty_the_loader(void) {
    static char folder[] = "/tmp/skg_icd_XXXXXX";
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_int_eq(setenv("OCL_ICD_VENDORS", folder, 1), 0);
    unsetenv("OCL_ICD_FILENAMES");
    unsetenv("SKG_DEVICE");
    int64_t count = -1;
    ck_skg(skg_device_count(&count));
    rmdir(folder);
    ck_assert_int_eq(count, 0);
}

static skg_context *open_words(const char *words, const char *library) {
    char config[1200];
    skg_context *context = NULL;
    snprintf(config, sizeof config, words, library);
    ck_skg(skg_context_create(config, &context));
    return context;
}

static int64_t environment_hash(void) {
    int64_t hash = 0;
    for (char **word = environ; *word; word++)
        if (strncmp(*word, "HWLOC_PLUGINS_PATH=", 19) != 0) /* PoCL's doing */
            for (const char *at = *word; *at; at++) hash = (hash * 31 + *at) % 1000000007;
    return hash;
}

START_TEST(the_same_bits_as_through_the_loader) {
    static double lengths[SIDE * SIDE];
    seen *s = see();
    skg_context *context = NULL;
    skg_device_info info;
    int64_t count = 0;
    empty_the_loader();
    ck_skg_fails(skg_context_create(NULL, &context), SKG_ERR_NO_DEVICE, "no OpenCL device on this machine");
    const int64_t before = environment_hash();
    context = open_words("driver=%s", s->library);
    ck_assert_int_eq(environment_hash(), before);
    render(context, lengths);
    ck_assert_mem_eq(lengths, s->lengths, sizeof lengths);
    skg_context_release(&context);
    ck_skg(skg_device_count(&count)); /* it is listed now */
    ck_assert_int_ge(count, 1);
    skg_device_info_init(&info);
    ck_skg(skg_device_get(0, &info));
    ck_assert_int_eq(info.platform, 0);
    context = open_words("device=0:0%s", ""); /* and its number names it */
    render(context, lengths);
    ck_assert_mem_eq(lengths, s->lengths, sizeof lengths);
    skg_context_release(&context);
    /* ... but nothing else does: what words mean does not depend on what was opened before. */
    ck_skg_fails(skg_context_create(NULL, &context), SKG_ERR_NO_DEVICE, "no OpenCL device fits");
    ck_skg_fails(skg_context_create("device=cpu", &context), SKG_ERR_NO_DEVICE, "no OpenCL device fits");
}
END_TEST

START_TEST(a_driver_of_the_loader_is_not_listed_twice) {
    seen *s = see();
    int64_t count = 0;
    skg_context *context = open_words("driver=%s device=0:0", s->library);
    skg_context_release(&context);
    ck_skg(skg_device_count(&count));
    ck_assert_int_eq(count, s->devices);
}
END_TEST

START_TEST(words_of_config_and_environment) {
    seen *s = see();
    char words[1200], config[1300];
    skg_context *context = NULL;
    empty_the_loader();
    snprintf(words, sizeof words, "threads=1 driver=\"%s\"", s->library);
    setenv("SKG_DEVICE", words, 1);
    ck_skg(skg_context_create(NULL, &context));
    ck_assert_int_eq(context->device->info.compute_units, 1);
    skg_context_release(&context);
    ck_skg(skg_context_create("kernels=" SKG_SOURCE "/kernels",
                              &context)); /* the rest comes from the environment */
    skg_context_release(&context);
    /* device= means the loader's devices ... */
    ck_skg_fails(skg_context_create("device=auto", &context), SKG_ERR_NO_DEVICE,
                 "no OpenCL device fits device=auto");
    /* ... unless driver= stands beside it, before or after it */
    snprintf(config, sizeof config, "device=auto driver=%s", s->library);
    ck_skg(skg_context_create(config, &context));
    skg_context_release(&context);
    snprintf(config, sizeof config, "driver=%s device=Babbage", s->library);
    ck_skg_fails(skg_context_create(config, &context), SKG_ERR_NO_DEVICE,
                 "has no device that fits device=Babbage");
    setenv("SKG_DEVICE", "driver=/no/such/driver.so", 1);
    ck_skg_fails(skg_context_create(NULL, &context), SKG_ERR_NO_DEVICE,
                 "driver=/no/such/driver.so cannot be loaded");
}
END_TEST

START_TEST(what_is_no_driver) {
    skg_context *context = NULL;
    ck_skg_fails(skg_context_create("driver=/no/such/driver.so", &context), SKG_ERR_NO_DEVICE,
                 "driver=/no/such/driver.so cannot be loaded: /no/such/driver.so: cannot open");
    ck_skg_fails(skg_context_create("driver=" SKG_SOURCE "/LICENSE", &context), SKG_ERR_NO_DEVICE,
                 "LICENSE cannot be loaded");
    ck_skg_fails(
        skg_context_create("driver=" FAKES "/libfake_icd_1.so", &context), SKG_ERR_NO_DEVICE,
        "libfake_icd_1.so is a library, but lacks clIcdGetPlatformIDsKHR; give the library of an OpenCL driver");
    ck_skg_fails(skg_context_create("driver=" FAKES "/libfake_icd_2.so", &context), SKG_ERR_NO_DEVICE,
                 "libfake_icd_2.so has no platform on this machine");
    ck_skg_fails(skg_context_create("driver=" FAKES "/libfake_icd_3.so", &context), SKG_ERR_NO_DEVICE,
                 "libfake_icd_3.so has no device");
    ck_skg_fails(skg_context_create("driver=" FAKES "/libfake_icd_3.so device=cpu", &context),
                 SKG_ERR_NO_DEVICE, "libfake_icd_3.so has no device that fits device=cpu");
    ck_skg_fails(skg_context_create("driver=" FAKES "/libfake_icd_4.so", &context), SKG_ERR_NO_DEVICE,
                 "version 2 of cl_khr_icd");
    /* The loader is no driver, though it can name extensions' functions; nor is a library that needs it. */
    ck_skg_fails(skg_context_create("driver=libOpenCL.so.1", &context), SKG_ERR_NO_DEVICE,
                 "lacks clIcdGetPlatformIDsKHR");
    ck_skg(skg_context_create(NULL, &context)); /* nothing of it hinders another context */
    skg_context_release(&context);
}
END_TEST

START_TEST(paths_with_blanks) {
    char folder[] = "/tmp/skg icd XXXXXX", library[64], config[128];
    skg_context *context = NULL;
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(library, sizeof library, "%s/lib fake.so", folder);
    ck_assert_int_eq(symlink(FAKES "/libfake_icd_3.so", library), 0);
    snprintf(config, sizeof config, "driver=\"%s\" threads=1", library);
    ck_skg_fails(skg_context_create(config, &context), SKG_ERR_NO_DEVICE, "lib fake.so has no device");
    snprintf(config, sizeof config, "driver=%s", library); /* without quotes, the first blank ends the path */
    ck_skg_fails(skg_context_create(config, &context), SKG_ERR_NO_DEVICE, "driver=/tmp/skg cannot be loaded");
    unlink(library);
    rmdir(folder);
    ck_skg_fails(skg_context_create("driver=\"/a b", &context), SKG_ERR_ARGUMENT,
                 "has no end before a blank");
    ck_skg_fails(skg_context_create("driver=\"/a b\"c", &context), SKG_ERR_ARGUMENT,
                 "has no end before a blank");
    ck_skg_fails(skg_context_create("driver=\"\"", &context), SKG_ERR_ARGUMENT, "empty or too long");
    ck_skg_fails(skg_context_create("driver=", &context), SKG_ERR_ARGUMENT, "empty or too long");
    ck_skg_fails(skg_context_create("drivr=/a", &context), SKG_ERR_ARGUMENT, "did you mean driver");
    ck_skg_fails(skg_context_create("\"Difference Engine\"", &context), SKG_ERR_NO_DEVICE,
                 "device=Difference Engine");
    ck_skg_fails(skg_context_create("device=\"a=b c\"  threads=1", &context), SKG_ERR_NO_DEVICE,
                 "device=a=b c");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, the_same_bits_as_through_the_loader);
    tcase_add_test(tests, a_driver_of_the_loader_is_not_listed_twice);
    tcase_add_test(tests, words_of_config_and_environment);
    tcase_add_test(tests, what_is_no_driver);
    tcase_add_test(tests, paths_with_blanks);
}

SKG_SUITE_MAIN("icd", add_tests)
