/* Programs that are kept between processes. The tests pretend that the driver has no cache of its own where they want
 * the program to be kept at once. */
#include "device/cache.h"
#include "device/cache_folder.h"
#include "device/choice.h"
#include "device/device.h"
#include "device/programs.h"
#include "suite.h"

#include <sys/wait.h>

static char kernels[64];

static void write_kernel(int value) {
    char path[96];
    snprintf(path, sizeof path, "%s/set.cl", kernels);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    fprintf(file, "__kernel void set(__global int *x) { x[get_global_id(0)] = %d; }\n", value);
    fclose(file);
}

static void set_up(void) {
    make_cache_folder();
    snprintf(kernels, sizeof kernels, "/tmp/skg-kernels-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(kernels));
    write_kernel(7);
}

static void tear_down(void) {
    char path[96];
    snprintf(path, sizeof path, "%s/set.cl", kernels);
    unlink(path);
    rmdir(kernels);
    remove_cache_folder();
}

typedef struct {
    int64_t builds, loads;
    int value;
} outcome;

/* Work of a process: makes the program and runs it. caches: as drivers do that keep kernels themselves. */
static outcome run(const char *options, int caches) {
    const char *names[] = {"set.cl"};
    char config[96];
    skg_context *context = NULL;
    cl_program program = NULL;
    cl_kernel kernel = NULL;
    skg_buffer buffer = {0};
    outcome out = {0};
    snprintf(config, sizeof config, "device=0:0 kernels=%s", kernels);
    ck_skg(skg_context_create(config, &context));
    skg_device *device = context->device;
    device->caches = caches;
    const int64_t builds = device->builds, loads = device->loads;
    ck_skg(skg_program_get(context, 1, names, options, &program));
    ck_skg(skg_kernel_create(program, "set", &kernel));
    ck_skg(skg_buffer_reserve(context, &buffer, 4 * sizeof(int), CL_MEM_READ_WRITE, "values"));
    ck_skg(skg_kernel_set(kernel, 0, sizeof buffer.memory, &buffer.memory));
    const size_t items = 4;
    ck_assert_int_eq(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL),
                     CL_SUCCESS);
    ck_assert_int_eq(clEnqueueReadBuffer(device->queue, buffer.memory, CL_TRUE, 0, sizeof out.value,
                                         &out.value, 0, NULL, NULL),
                     CL_SUCCESS);
    skg_programs_launched(context);
    out.builds = device->builds - builds;
    out.loads = device->loads - loads;
    clReleaseKernel(kernel);
    skg_buffer_release(&buffer);
    skg_context_release(&context);
    return out;
}

#define ck_outcome(call, b, l, v)                                                                            \
    do {                                                                                                     \
        const outcome got = call;                                                                            \
        ck_assert_int_eq(got.builds, b);                                                                     \
        ck_assert_int_eq(got.loads, l);                                                                      \
        ck_assert_int_eq(got.value, v);                                                                      \
    } while (0)

START_TEST(a_program_is_compiled_once) {
    ck_outcome(run("", 0), 1, 0, 7);
    ck_assert_int_eq(count_kept(".program", NULL), 1);
    ck_outcome(run("", 0), 0, 1, 7);
    ck_outcome(run("-D OTHER=1", 0), 1, 0, 7); /* another key for other options */
    write_kernel(8);
    ck_outcome(run("", 0), 1, 0, 8); /* and for another text */
    ck_assert_int_eq(count_kept(".program", NULL), 3);
}
END_TEST

START_TEST(none_keeps_nothing) {
    setenv("SKG_CACHE_DIR", "none", 1);
    ck_outcome(run("", 0), 1, 0, 7);
    ck_outcome(run("", 0), 1, 0, 7);
    ck_assert_int_eq(count_kept("", NULL), 0);
}
END_TEST

/* Programs that cannot be kept are compiled, and nothing fails. */
START_TEST(a_folder_that_cannot_be_written_does_no_harm) {
    setenv("SKG_CACHE_DIR", "/dev/null/cache", 1);
    ck_outcome(run("", 0), 1, 0, 7);
    ck_outcome(run("", 1), 1, 0, 7);
}
END_TEST

/* A driver that keeps kernels itself is asked for them once it pays. */
START_TEST(what_a_driver_keeps_is_kept_by_a_later_process) {
    for (int k = 1; k < SKG_USES_THAT_PAY; k++) {
        ck_outcome(run("", 1), 1, 0, 7);
        ck_assert_int_eq(count_kept(".program", NULL), 0);
        ck_assert_int_eq(count_kept(".uses", NULL), 1);
    }
    ck_outcome(run("", 1), 1, 0, 7);
    ck_assert_int_eq(count_kept(".program", NULL), 1);
    ck_assert_int_eq(count_kept(".uses", NULL), 0);
    ck_outcome(run("", 1), 0, 1, 7);
}
END_TEST

/* A driver that compiles for a binary what runs just then may end the process. */
START_TEST(nothing_is_kept_while_kernels_may_run) {
    skg_work_begin();
    ck_outcome(run("", 0), 1, 0, 7);
    ck_assert_int_eq(count_kept(".program", NULL), 0);
    skg_work_end();
    ck_outcome(run("", 0), 1, 0, 7);
    ck_assert_int_eq(count_kept(".program", NULL), 1);
}
END_TEST

/* PoCL's cache is on unless the user says otherwise. */
START_TEST(pocl_keeps_kernels_itself) {
    static const char *const asked[] = {NULL, "1", "0"};
    for (int k = 0; k < 3; k++) {
        skg_context *context = NULL;
        if (asked[k]) setenv("POCL_KERNEL_CACHE", asked[k], 1);
        ck_skg(skg_context_create("device=0:0", &context));
        const int pocl = skg_platform_is(context->device->platform, "Portable Computing Language");
        ck_assert_int_eq(context->device->caches, pocl && k < 2);
        skg_context_release(&context);
    }
}
END_TEST

/* A whole file with content that the driver rejects: it is compiled, and what is kept is replaced. */
START_TEST(what_the_driver_rejects_is_compiled) {
    char path[512], name[SKG_DIGEST_TEXT];
    ck_outcome(run("", 0), 1, 0, 7);
    ck_assert_int_eq(count_kept(".program", path), 1);
    const char *slash = strrchr(path, '/');
    memcpy(name, slash + 1, SKG_DIGEST_TEXT - 1);
    skg_digest key;
    for (size_t i = 0; i < sizeof key.bytes; i++) {
        unsigned byte = 0;
        ck_assert_int_eq(sscanf(name + 2 * i, "%2x", &byte), 1);
        key.bytes[i] = (uint8_t)byte;
    }
    static const char words[] = "this was never a program of any driver";
    ck_assert_int_eq(skg_store_write(cache_folder, &key, SKG_KEPT_PROGRAM, words, sizeof words), 1);
    ck_outcome(run("", 0), 1, 0, 7);
    ck_outcome(run("", 0), 0, 1, 7);
}
END_TEST

/* Not the fork of a context, but processes beside each other that compile and keep the same program. */
START_TEST(processes_beside_each_other_share_the_folder) {
    enum { PROCESSES = 4 };
    pid_t children[PROCESSES];
    for (int i = 0; i < PROCESSES; i++) {
        children[i] = fork();
        if (children[i] == 0) {
            const outcome got = run("", 0);
            _exit(got.value == 7 && got.builds + got.loads == 1 ? 0 : 1);
        }
    }
    for (int i = 0; i < PROCESSES; i++) {
        int result = -1;
        ck_assert_int_eq(waitpid(children[i], &result, 0), children[i]);
        ck_assert(WIFEXITED(result) && WEXITSTATUS(result) == 0);
    }
    ck_assert_int_eq(count_kept(".program", NULL), 1);
    ck_assert_int_eq(count_kept(".part", NULL), 0);
    ck_outcome(run("", 0), 0, 1, 7);
}
END_TEST

/* The environment changes what PoCL compiles, but not all of it does. */
START_TEST(the_environment_is_part_of_the_key) {
    ck_outcome(run("", 0), 1, 0, 7);
    setenv("POCL_MAX_PTHREAD_COUNT", "1", 1);
    ck_outcome(run("", 0), 0, 1, 7);
    setenv("POCL_SKG_TEST", "1", 1);
    ck_outcome(run("", 0), 1, 0, 7);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_program_is_compiled_once);
    tcase_add_test(tests, none_keeps_nothing);
    tcase_add_test(tests, a_folder_that_cannot_be_written_does_no_harm);
    tcase_add_test(tests, what_a_driver_keeps_is_kept_by_a_later_process);
    tcase_add_test(tests, nothing_is_kept_while_kernels_may_run);
    tcase_add_test(tests, pocl_keeps_kernels_itself);
    tcase_add_test(tests, what_the_driver_rejects_is_compiled);
    tcase_add_test(tests, processes_beside_each_other_share_the_folder);
    tcase_add_test(tests, the_environment_is_part_of_the_key);
}

SKG_SUITE_MAIN("binaries", add_tests)
