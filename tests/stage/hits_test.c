/* The count of a frame's hits, which may exceed 32 bits. */
#include "stage/hits.h"
#include "suite.h"

#include <skiagraph/plan.h>

#include <string.h>

static skg_context *context;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_context(void) {
    skg_context_release(&context);
}

START_TEST(bytes_of_hits) {
    const skg_hit_count none = {0, 0}, one = {1, 0}, half = {0x80000000u, 0}, most = {0xffffffffu, 0};
    const skg_hit_count more = {0, 1}, many = {5, 3};
    int64_t bytes = 0;
    ck_skg(skg_hits_bytes(&none, 0, &bytes));
    ck_assert_int_eq(bytes, 8); /* a buffer holds something */
    ck_skg(skg_hits_bytes(&one, 1, &bytes));
    ck_assert_int_eq(bytes, 16);
    ck_skg(skg_hits_bytes(&half, 0, &bytes)); /* negative as an int */
    ck_assert_int_eq(bytes, INT64_C(1) << 34);
    ck_skg(skg_hits_bytes(&most, 1, &bytes));
    ck_assert_int_eq(bytes, INT64_C(0xffffffff) * 16);
    ck_skg_fails(skg_hits_bytes(&more, 0, &bytes), SKG_ERR_DEVICE_MEMORY, "4294967296 times");
    ck_skg_fails(skg_hits_bytes(&many, 0, &bytes), SKG_ERR_DEVICE_MEMORY, "12884901893 times");
}
END_TEST

/* Runs skg_hits_place on made-up counts of 4 pixels. */
static void place(const cl_int counts[4], cl_uint starts[4], skg_hit_count *total) {
    static const char *const files[] = {"pixel.clh", "intervals.clh", "hits.cl"};
    const skg_kernel_options options = {.bits = 32};
    const skg_hits_args args = {.layout.columns = 2, .window = {0, 0, 2, 2}};
    const skg_work_size work = {2, {2, 2}, {2, 1}};
    const skg_hit_count none = {0, 0};
    cl_command_queue queue = context->device->queue;
    skg_buffer buffers[3] = {{0}, {0}, {0}};
    cl_program program = NULL;
    for (int k = 0; k < 3; k++)
        ck_skg(skg_buffer_reserve(context, &buffers[k], 16, CL_MEM_READ_WRITE, "hits"));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(HITS_PLACE, args, args),
        SKG_ARGUMENT(HITS_PLACE, counts, buffers[0].memory),
        SKG_ARGUMENT(HITS_PLACE, starts, buffers[1].memory),
        SKG_ARGUMENT(HITS_PLACE, total, buffers[2].memory),
    };
    ck_skg(skg_kernels_get(context, &options, 3, files, NULL, &program));
    clEnqueueWriteBuffer(queue, buffers[0].memory, CL_TRUE, 0, 16, counts, 0, NULL, NULL);
    clEnqueueWriteBuffer(queue, buffers[1].memory, CL_TRUE, 0, 16, (const cl_uint[4]){0}, 0, NULL, NULL);
    clEnqueueWriteBuffer(queue, buffers[2].memory, CL_TRUE, 0, sizeof none, &none, 0, NULL, NULL);
    ck_skg(SKG_LAUNCH_ONCE(context, program, "skg_hits_place", "priority", &work, arguments, NULL));
    clEnqueueReadBuffer(queue, buffers[1].memory, CL_TRUE, 0, 16, starts, 0, NULL, NULL);
    clEnqueueReadBuffer(queue, buffers[2].memory, CL_TRUE, 0, sizeof *total, total, 0, NULL, NULL);
    for (int k = 0; k < 3; k++) skg_buffer_release(&buffers[k]);
}

START_TEST(device_counts_beyond_32_bits) {
    const cl_int few[4] = {3, 0, 5, 0}, half[4] = {0x40000000, 0x40000000, 7, 0};
    const cl_int many[4] = {0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff};
    skg_hit_count total;
    cl_uint starts[4];
    place(few, starts, &total);
    ck_assert_uint_eq(total.low, 8);
    ck_assert_uint_eq(total.high, 0);
    ck_assert((starts[0] == 0 && starts[2] == 3) || (starts[0] == 5 && starts[2] == 0));
    place(half, starts, &total);
    ck_assert_uint_eq(total.low, 0x80000007u);
    ck_assert_uint_eq(total.high, 0);
    place(many, starts, &total);
    ck_assert_uint_eq(total.low, 0xfffffffcu); /* 4 (2^31 - 1) = 2^33 - 4 */
    ck_assert_uint_eq(total.high, 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, bytes_of_hits);
    tcase_add_test(tests, device_counts_beyond_32_bits);
}

SKG_SUITE_MAIN("hits", add_tests)
