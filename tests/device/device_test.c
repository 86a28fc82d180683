/* Contexts, programs and buffers on a device. */
#include "device/device.h"
#include "driver/driver.h"
#include "suite.h"

#include <skiagraph/context.h>

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

START_TEST(a_device_is_found_and_described) {
    int64_t count = 0;
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_device_count(&count));
    ck_assert_int_ge(count, 1);
    ck_skg(skg_device_get(0, &info));
    ck_assert_int_gt(info.compute_units, 0);
    ck_assert_str_ne(info.name, "");
    ck_skg_fails(skg_device_get(count, &info), SKG_ERR_ARGUMENT, "counted from 0");
}
END_TEST

START_TEST(config_words_choose) {
    skg_context *context = NULL;
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_create("device=0:0 threads=1", &context));
    ck_skg(skg_context_device_get(context, &info));
    ck_assert_int_eq(info.compute_units, 1);
    skg_context_release(&context);
    ck_assert_ptr_null(context);
    ck_skg_fails(skg_context_create("device=Babbage", &context), SKG_ERR_NO_DEVICE, "Babbage");
    ck_skg_fails(skg_context_create("thread=2", &context), SKG_ERR_ARGUMENT, "did you mean threads");
    ck_skg_fails(skg_context_create("threads=zero", &context), SKG_ERR_ARGUMENT, "threads=zero");
    skg_context_release(&context);
}
END_TEST

START_TEST(environment_variable_stands_for_config) {
    skg_context *context = NULL;
    setenv("SKG_DEVICE", "Babbage", 1);
    ck_skg_fails(skg_context_create(NULL, &context), SKG_ERR_NO_DEVICE, "Babbage");
    ck_skg(skg_context_create("device=0:0", &context)); /* config stands before the environment */
    skg_context_release(&context);
    setenv("SKG_DEVICE", "0:0 threads=1", 1);
    ck_skg(skg_context_create(NULL, &context));
    ck_assert_int_eq(context->device->info.compute_units, 1);
    skg_context_release(&context);
}
END_TEST

/* Names and versions: of PoCL 3.0 of the Python registry on a Zen 4, and of others that must not be refused. */
START_TEST(a_pocl_that_ends_the_process_is_known) {
    static const struct {
        const char *driver, *version;
        int fails;
    } cases[] = {
        {"3.0-rc2", "OpenCL 3.0 PoCL HSTR: pthread-x86_64-unknown-linux-gnu-znver3", 1},
        {"3.0-rc2", "OpenCL 3.0 PoCL HSTR: pthread-x86_64-unknown-linux-gnu-generic", 1},
        {"1.8", "OpenCL 2.0 pocl HSTR: pthread-x86_64-pc-linux-gnu-znver2", 1},
        {"3.0-rc2", "OpenCL 3.0 PoCL HSTR: pthread-x86_64-unknown-linux-gnu-icelake-client", 0},
        {"3.1+debian", "OpenCL 3.0 PoCL HSTR: pthread-x86_64-pc-linux-gnu-znver3", 0},
        {"6.0", "OpenCL 3.0 PoCL HSTR: cpu-x86_64-pc-linux-gnu-znver3", 0},
        {"3.0-rc2", "OpenCL 3.0 PoCL HSTR: pthread-aarch64-unknown-linux-gnu-generic", 0},
        {"3.0-rc2", "", 0},
    };
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        skg_device_info info;
        skg_device_info_init(&info);
        snprintf(info.driver, sizeof info.driver, "%s", cases[n].driver);
        snprintf(info.version, sizeof info.version, "%s", cases[n].version);
        ck_assert_int_eq(skg_pocl_fails(&info, 1), cases[n].fails);
        ck_assert_int_eq(skg_pocl_fails(&info, 0), 0);
    }
}
END_TEST

static int64_t environment_hash(void) {
    int64_t hash = 0;
    for (char **word = environ; *word; word++)
        for (const char *at = *word; *at; at++) hash = hash * 31 % 1000000007 + *at;
    return hash;
}

/* PoCL sets HWLOC_PLUGINS_PATH while it is loaded; that is the driver's doing, so the driver is loaded first.
 */
START_TEST(environment_is_left_alone) {
    cl_platform_id platform = NULL;
    cl_device_id any = NULL;
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, NULL), CL_SUCCESS);
    ck_assert_int_eq(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &any, NULL), CL_SUCCESS);
    int64_t before = environment_hash();
    skg_context *context = NULL;
    ck_skg(skg_context_create("device=0:0", &context));
    skg_context_release(&context);
    ck_assert_int_eq(environment_hash(), before);
}
END_TEST

START_TEST(a_forked_child_is_refused) {
    skg_context *context = NULL;
    ck_skg(skg_context_create("device=0:0", &context));
    pid_t child = fork();
    if (child == 0) {
        skg_device_info info;
        skg_device_info_init(&info);
        int told = skg_context_device_get(context, &info) == SKG_ERR_FORK;
        skg_context_release(&context); /* must not hang */
        _exit(told ? 0 : 1);
    }
    int result = -1;
    ck_assert_int_eq(waitpid(child, &result, 0), child);
    ck_assert(WIFEXITED(result) && WEXITSTATUS(result) == 0);
    skg_context_release(&context);
}
END_TEST

/* A folder of kernel files for development, and what a compile error looks like. */
START_TEST(build_errors_name_file_and_line) {
    char folder[] = "/tmp/skg-device-XXXXXX", path[64], config[96];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/bad.cl", folder);
    FILE *file = fopen(path, "w");
    fputs("kernel void ok(void) {}\nkernel void bad(void) { nonsense; }\n", file);
    fclose(file);
    snprintf(config, sizeof config, "device=0:0 kernels=%s", folder);
    skg_context *context = NULL;
    cl_program program = NULL;
    const char *names[] = {"bad.cl"};
    ck_skg(skg_context_create(config, &context));
    ck_skg_fails(skg_program_get(context, 1, names, "", &program), SKG_ERR_BUILD, "bad.cl:2");
    ck_assert_int_eq(skg_last_cl_error(), CL_BUILD_PROGRAM_FAILURE);
    names[0] = "none.cl";
    ck_skg_fails(skg_program_get(context, 1, names, "", &program), SKG_ERR_FILE, "none.cl");
    file = fopen(path, "w");
    fputs("kernel void ok(void) {}\n", file);
    fclose(file);
    names[0] = "bad.cl";
    cl_program again = NULL;
    ck_skg(skg_program_get(context, 1, names, "-D A=1", &program));
    ck_skg(skg_program_get(context, 1, names, "-D A=1", &again));
    ck_assert_ptr_eq(program, again);
    ck_assert_int_eq(context->device->builds, 1);
    cl_kernel kernel = NULL;
    ck_skg_fails(skg_kernel_create(program, "missing", &kernel), SKG_ERR_DEVICE, "missing");
    skg_context_release(&context);
    unlink(path);
    rmdir(folder);
}
END_TEST

START_TEST(buffers_that_cannot_be_are_refused) {
    skg_context *context = NULL;
    skg_buffer buffer = {0};
    ck_skg(skg_context_create("device=0:0", &context));
    ck_skg_fails(skg_buffer_reserve(context, &buffer, INT64_MAX / 2, CL_MEM_READ_WRITE, "lengths"),
                 SKG_ERR_DEVICE_MEMORY, "lengths");
    ck_skg(skg_buffer_reserve(context, &buffer, 0, CL_MEM_READ_WRITE, "nothing"));
    skg_buffer_release(&buffer);
    skg_context_release(&context);
}
END_TEST

static int64_t address_space_pages(void) {
    long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(fscanf(file, "%lld", &pages), 1);
    fclose(file);
    return pages;
}

/* A buffer whose memory was entered before; one of another size; none. What is not taken is freed. */
START_TEST(expected_buffers_hold_what_is_written_and_are_given_back) {
    enum { BYTES = 64 << 20, COUNT = BYTES / sizeof(int32_t) };
    static const skg_byte_range written[] = {{0, 5000}, {BYTES / 2 + 1, BYTES}};
    skg_context *context = NULL;
    int32_t *values = NULL, *back = NULL;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_alloc(COUNT, sizeof *values, "values", &values));
    ck_skg(skg_alloc(COUNT, sizeof *back, "values", &back));
    for (int32_t i = 0; i < COUNT; i++) values[i] = i ^ 0x5a5a5a;
    int64_t before = 0;
    for (int k = 0; k < 60; k++) {
        const size_t bytes = k % 3 ? BYTES : BYTES / 2 + 4;
        skg_buffer buffer = {0};
        if (k == 6) before = address_space_pages();
        skg_buffer_prefetch(context, BYTES, 2, written);
        skg_prefetch_begin(context);
        skg_prefetch_wait(context);
        if (k % 2) {
            ck_skg(skg_buffer_reserve(context, &buffer, (int64_t)bytes, CL_MEM_READ_WRITE, "values"));
            ck_assert_int_eq(buffer.bytes, (int64_t)bytes);
            ck_skg(skg_buffer_write(context, &buffer, (int64_t)bytes, values, "values"));
            memset(back, 0, bytes);
            ck_assert_int_eq(clEnqueueReadBuffer(context->device->queue, buffer.memory, CL_TRUE, 0, bytes,
                                                 back, 0, NULL, NULL),
                             CL_SUCCESS);
            ck_assert_int_eq(memcmp(values, back, bytes), 0);
        }
        skg_buffer_forget(context);
        skg_buffer_release(&buffer);
    }
    /* 54 that stayed would be 3 GiB of addresses; threads and allocators may take some. */
    ck_assert_int_lt(address_space_pages() - before, (1 << 30) / sysconf(_SC_PAGESIZE));
    skg_free(&values);
    skg_free(&back);
    skg_context_release(&context);
}
END_TEST

START_TEST(a_callers_queue_is_checked_and_retained) {
    skg_context *ours = NULL, *theirs = NULL;
    ck_skg(skg_context_create("device=0:0", &ours));
    skg_device *device = ours->device;
    ck_skg(skg_context_create_cl(device->cl, device->id, device->queue, &theirs));
    cl_context other = clCreateContext(NULL, 1, &device->id, NULL, NULL, NULL);
    skg_context *wrong = NULL;
    ck_skg_fails(skg_context_create_cl(other, device->id, device->queue, &wrong), SKG_ERR_ARGUMENT, "queue");
    clReleaseContext(other);
    skg_context_release(&ours);
    ck_assert_int_eq(clFinish(theirs->device->queue), CL_SUCCESS); /* still alive: retained */
    skg_context_release(&theirs);
}
END_TEST

/* Calls the driver's callback from a thread of its own; the log notes which thread called it. */
static void *call_back(void *address) {
    skg_driver_says("device lost", NULL, 0, address);
    return NULL;
}

static void say_in_a_thread(void *address) {
    pthread_t thread;
    ck_assert_int_eq(pthread_create(&thread, NULL, call_back, address), 0);
    ck_assert_int_eq(pthread_join(thread, NULL), 0);
}

typedef struct {
    pthread_t thread;
    int sentences;
    char last[128];
} heard;

static void hear(int32_t level, const char *sentence, void *user) {
    heard *h = user;
    ck_assert_int_eq(level, SKG_LOG_WARNING);
    h->thread = pthread_self();
    h->sentences++;
    snprintf(h->last, sizeof h->last, "%s", sentence);
}

/* The driver's thread once read the log of a context while it was set, and of one that was gone. */
START_TEST(the_drivers_words_wait_for_the_contexts_thread) {
    skg_context *context = NULL;
    skg_device_info info;
    heard h = {0};
    skg_device_info_init(&info);
    ck_skg(skg_context_create("device=0:0", &context));
    void *address = skg_mailbox_address(context->driver);
    say_in_a_thread(address); /* kept until there is a log */
    ck_skg(skg_context_log_set(context, hear, &h));
    say_in_a_thread(address);
    ck_assert_int_eq(h.sentences, 0);
    ck_skg(skg_context_device_get(context, &info));
    ck_assert_int_eq(h.sentences, 2);
    ck_assert(pthread_equal(h.thread, pthread_self()));
    ck_assert_str_eq(h.last, "OpenCL driver: device lost");
    skg_context_release(&context);
    say_in_a_thread(address); /* too late: dropped */
    ck_assert_int_eq(h.sentences, 2);
}
END_TEST

START_TEST(every_code_of_opencl_has_a_name) {
    /* OpenCL 1.2 has the codes 0 to -19 and -30 to -68; these are of images, samplers and OpenGL, which are not used. */
    static const cl_int unused[] = {-9, -10, -39, -40, -41, -60, -62, -65};
    const char *unknown = skg_cl_name(-9999), *before = "";
    size_t next = 0;
    for (cl_int code = 0; code >= -68; code--) {
        if (code < -19 && code > -30) continue;
        if (next < sizeof unused / sizeof *unused && code == unused[next]) {
            next++;
            continue;
        }
        const char *name = skg_cl_name(code);
        ck_assert_msg(strncmp(name, "CL_", 3) == 0 && strcmp(name, before) != 0, "code %d is called %s",
                      (int)code, name);
        before = name;
    }
    ck_assert_str_eq(skg_cl_name(-52), "CL_INVALID_KERNEL_ARGS");
    ck_assert_str_eq(skg_cl_name(-20), unknown);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, a_device_is_found_and_described);
    tcase_add_test(tests, config_words_choose);
    tcase_add_test(tests, a_pocl_that_ends_the_process_is_known);
    tcase_add_test(tests, environment_variable_stands_for_config);
    tcase_add_test(tests, environment_is_left_alone);
    tcase_add_test(tests, a_forked_child_is_refused);
    tcase_add_test(tests, build_errors_name_file_and_line);
    tcase_add_test(tests, buffers_that_cannot_be_are_refused);
    tcase_add_test(tests, a_callers_queue_is_checked_and_retained);
    tcase_add_test(tests, expected_buffers_hold_what_is_written_and_are_given_back);
    tcase_add_test(tests, every_code_of_opencl_has_a_name);
    tcase_add_test(tests, the_drivers_words_wait_for_the_contexts_thread);
}

SKG_SUITE_MAIN("device", add_tests)
