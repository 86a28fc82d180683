/* Structs that host and device share. */
#include "device/programs.h"
#include "kernels/picture.h"
#include "suite.h"

#include <string.h>

static skg_context *context;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_context(void) {
    skg_context_release(&context);
}

enum { BUFFERS = 7, PLACES = 16 };

/* Layout of skg_shared.h by the device's compiler: sizes, and places of the last fields. */
static const char layout_kernel[] =
    "__kernel void layout(__global int *out, __global const skg_part_entry *p, __global const skg_contribution *w,\n"
    "                     __global const skg_ray_args *r, __global const skg_raster_layout *f,\n"
    "                     __global const skg_attenuate_args *a, __global const skg_detect_args *d) {\n"
    "    out[0] = sizeof(skg_part_entry); out[1] = sizeof(skg_contribution); out[2] = sizeof(skg_ray_args);\n"
    "    out[3] = sizeof(skg_raster_layout);\n"
    "    out[4] = (int)((__global const char *)&p->pixel_i - (__global const char *)p);\n"
    "    out[5] = (int)((__global const char *)&p->contributions - (__global const char *)p);\n"
    "    out[6] = (int)((__global const char *)&w->plane - (__global const char *)w);\n"
    "    out[7] = (int)((__global const char *)&r->unit - (__global const char *)r);\n"
    "    out[8] = (int)((__global const char *)&f->queue - (__global const char *)f);\n"
    "    out[9] = sizeof(skg_attenuate_args); out[10] = sizeof(skg_detect_args);\n"
    "    out[11] = (int)((__global const char *)&a->image - (__global const char *)a);\n"
    "    out[12] = (int)((__global const char *)&d->image - (__global const char *)d);\n"
    "    out[13] = sizeof(skg_blur_args); out[14] = sizeof(skg_hits_args); out[15] = sizeof(skg_leaky_args);\n"
    "}\n";

static const char *built_in(const char *name) {
    for (int i = 0; i < skg_kernel_source_count; i++)
        if (strcmp(skg_kernel_sources[i].name, name) == 0) return skg_kernel_sources[i].text;
    return NULL;
}

static void device_layout(const char *options, int32_t out[PLACES]) {
    const char *sources[4] = {built_in("config.clh"), built_in("types.clh"), built_in("skg_shared.h"),
                              layout_kernel};
    const skg_device *device = context->device;
    cl_int code = CL_SUCCESS;
    cl_program program = clCreateProgramWithSource(device->cl, 4, sources, NULL, &code);
    ck_assert_int_eq(clBuildProgram(program, 1, &device->id, options, NULL, NULL), CL_SUCCESS);
    cl_kernel kernel = NULL;
    skg_buffer buffer = {0};
    skg_stage_log log = {.on = 1};
    ck_skg(skg_kernel_create(program, "layout", &kernel));
    ck_skg(skg_buffer_reserve(context, &buffer, 4096, CL_MEM_READ_WRITE, "layout"));
    const skg_work_size one = {1, {1}, {1}};
    skg_argument arguments[BUFFERS];
    for (cl_uint k = 0; k < BUFFERS; k++)
        arguments[k] = (skg_argument){k, sizeof buffer.memory, &buffer.memory};
    ck_skg(SKG_LAUNCH(context, kernel, "layout", &one, arguments, &log));
    ck_assert_int_eq(clEnqueueReadBuffer(device->queue, buffer.memory, CL_TRUE, 0, PLACES * sizeof *out, out,
                                         0, NULL, NULL),
                     CL_SUCCESS);
    ck_assert_int_eq(log.count, 1);
    skg_stage_log_clear(&log);
    skg_buffer_release(&buffer);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
}

START_TEST(structs_are_laid_out_alike) {
    const int32_t single[PLACES] = {sizeof(skg_part_float),
                                    sizeof(skg_contribution_float),
                                    sizeof(skg_ray_float),
                                    sizeof(skg_raster_layout),
                                    offsetof(skg_part_float, pixel_i),
                                    offsetof(skg_part_float, contributions),
                                    offsetof(skg_contribution_float, plane),
                                    offsetof(skg_ray_float, unit),
                                    offsetof(skg_raster_layout, queue),
                                    sizeof(skg_attenuate_float),
                                    sizeof(skg_detect_float),
                                    offsetof(skg_attenuate_float, image),
                                    offsetof(skg_detect_float, image),
                                    sizeof(skg_blur_args),
                                    sizeof(skg_hits_args),
                                    sizeof(skg_leaky_args)};
    const int32_t twice[PLACES] = {sizeof(skg_part_double),
                                   sizeof(skg_contribution_double),
                                   sizeof(skg_ray_double),
                                   sizeof(skg_raster_layout),
                                   offsetof(skg_part_double, pixel_i),
                                   offsetof(skg_part_double, contributions),
                                   offsetof(skg_contribution_double, plane),
                                   offsetof(skg_ray_double, unit),
                                   offsetof(skg_raster_layout, queue),
                                   sizeof(skg_attenuate_double),
                                   sizeof(skg_detect_double),
                                   offsetof(skg_attenuate_double, image),
                                   offsetof(skg_detect_double, image),
                                   sizeof(skg_blur_args),
                                   sizeof(skg_hits_args),
                                   sizeof(skg_leaky_args)};
    int32_t out[PLACES];
    device_layout("-cl-std=CL1.2", out);
    ck_assert_mem_eq(out, single, sizeof out);
    if (!context->device->info.double_precision) return;
    device_layout("-cl-std=CL1.2 -D SKG_DOUBLE=1 -D SKG_BITS=64 -D SKG_WIDE=4", out);
    ck_assert_mem_eq(out, twice, sizeof out);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, structs_are_laid_out_alike);
}

SKG_SUITE_MAIN("layout", add_tests)
