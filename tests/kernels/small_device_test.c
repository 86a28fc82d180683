/* A device like a small GPU: 32 KiB of local memory or less, no vectors, no fp64. The real device is asked to behave so; what is
 * looked at is what the library asks of it. Calls are wrapped by the linker. */
#include "device/choice.h"
#include "selftest/selftest.h"
#include "suite.h"

#include <string.h>

/* The least that OpenCL 1.2 allows a device to have is 32 KiB; with 8 KiB, tiles have to shrink. */
static const size_t local_bytes[] = {32 * 1024, 8 * 1024};

static size_t max_local; /* of any kernel that was launched */
static int launched, asked_double;
static cl_device_id device;

/* Local memory that arguments ask for, of the kernels that have some. */
enum { LIMIT = 64 };
static struct {
    cl_kernel kernel;
    cl_uint index;
    size_t bytes;
} arguments[LIMIT];

cl_int __real_clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void *value);
cl_int __wrap_clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void *value);
cl_int __wrap_clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void *value) {
    for (int i = 0; !value && i < LIMIT; i++)
        if (!arguments[i].kernel || (arguments[i].kernel == kernel && arguments[i].index == index)) {
            arguments[i].kernel = kernel, arguments[i].index = index, arguments[i].bytes = size;
            break;
        }
    return __real_clSetKernelArg(kernel, index, size, value);
}

cl_int __real_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                     const size_t *offset, const size_t *global, const size_t *local,
                                     cl_uint count, const cl_event *waits, cl_event *event);
cl_int __wrap_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                     const size_t *offset, const size_t *global, const size_t *local,
                                     cl_uint count, const cl_event *waits, cl_event *event);
cl_int __wrap_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                     const size_t *offset, const size_t *global, const size_t *local,
                                     cl_uint count, const cl_event *waits, cl_event *event) {
    cl_ulong own = 0;
    size_t sum = 0;
    launched++;
    if (clGetKernelWorkGroupInfo(kernel, device, CL_KERNEL_LOCAL_MEM_SIZE, sizeof own, &own, NULL) ==
        CL_SUCCESS)
        sum =
            (size_t)own; /* a driver may count the arguments, too: then the sum is too high, never too low */
    for (int i = 0; i < LIMIT; i++)
        if (arguments[i].kernel == kernel) sum += arguments[i].bytes;
    if (sum > max_local) max_local = sum;
    return __real_clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, count, waits,
                                         event);
}

cl_int __real_clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices,
                             const char *options, void(CL_CALLBACK *built)(cl_program, void *), void *user);
cl_int __wrap_clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices,
                             const char *options, void(CL_CALLBACK *built)(cl_program, void *), void *user);
cl_int __wrap_clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices,
                             const char *options, void(CL_CALLBACK *built)(cl_program, void *), void *user) {
    asked_double |= strstr(options, "SKG_DOUBLE=1") != NULL || strstr(options, "SKG_OUTPUT_DOUBLE=1") != NULL;
    return __real_clBuildProgram(program, count, devices, options, built, user);
}

START_TEST(a_small_gpu_gets_what_it_can_do) {
    skg_context *context = NULL;
    skg_verdict verdict;
    int32_t index = 0;
    ck_skg(skg_context_open("device=0:0", 0, &context, &index));
    skg_device_info *info = &context->device->info;
    device = context->device->id;
    info->local_memory = (int64_t)local_bytes[_i];
    info->float_width = 1;
    info->double_precision = 0;
    info->gpu = 1;
    info->cpu = 0;
    for (int test = 0; test < SKG_SELF_TESTS; test++) {
        if (test == SKG_SELF_TEST_DOUBLE) {
            ck_skg_fails(skg_self_test_run(context, (skg_self_test)test, &verdict), SKG_ERR_UNSUPPORTED,
                         "double");
            ck_assert_int_eq(context->device->self_testing, 0); /* after a failure, too */
            continue;
        }
        ck_skg(skg_self_test_run(context, (skg_self_test)test, &verdict));
        ck_assert_msg(verdict.good, "%s: %s", skg_self_test_name((skg_self_test)test), verdict.reason);
    }
    ck_assert_int_gt(launched, 0);
    ck_assert_uint_gt(max_local, 0); /* the tiles of a GPU stand in local memory */
    ck_assert_uint_le(max_local, local_bytes[_i]);
    ck_assert_int_eq(asked_double, 0);
    skg_context_release(&context);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, a_small_gpu_gets_what_it_can_do, 0, 2);
}

SKG_SUITE_MAIN("small device", add_tests)
