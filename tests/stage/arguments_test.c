/* The names of the kernels' arguments (kernels/shared/arguments.h) are those that the OpenCL compiler finds, in this order. */
#include "stage/kernels.h"
#include "suite.h"

#include <skiagraph/plan.h>

#include <string.h>

enum { FILES_MAX = 14, ARGUMENTS_MAX = 32 };

static skg_context *context;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_context(void) {
    skg_context_release(&context);
}

/* Every kernel with the names of its arguments; NULL ends them. */
typedef struct {
    const char *function;
    const char *names[ARGUMENTS_MAX];
} kernel_list;

#define NAME(kernel, name) #name,
#define LIST(kernel, function) {#function, {SKG_ARGUMENTS_##kernel(NAME) NULL}},
static const kernel_list lists[] = {SKG_KERNELS(LIST)};
enum { KERNELS = sizeof lists / sizeof *lists };

#define NAMES "-cl-kernel-arg-info"

/* Sources and flags that are compiled to have these kernels, with all arguments. */
static const struct {
    const char *files[FILES_MAX];
    const char *flags;
    int32_t half;
} programs[] = {
    {{"fine.clh", "project.cl", "place.cl", "pixel.clh", "raster_atomics.cl", "tiles.cl",
      "raster_squares.cl"},
     NAMES,
     0},
    {{"bands.cl", "batch.clh", "deposit.clh", "draw.clh", "collect.clh", "raster_bands.cl",
      "raster_copies.cl"},
     NAMES,
     0},
    {{"fine.clh", "project.cl", "batch.clh", "deposit.clh", "draw.clh", "collect.clh", "raster_passes.cl"},
     NAMES,
     0},
    {{"pixel.clh", "source_plane.cl"}, NAMES, 0},
    {{"pixel.clh", "intervals.clh", "hits.cl", "cell_rays.clh", "cell_values.clh", "volume.cl",
      "source_plane.cl"},
     NAMES,
     0},
    {{"pixel.clh", "raster_half.cl"}, NAMES, 1},
    {{"counts.cl", "leaky.cl"}, NAMES, 0},
    {{"exponential.clh", "random.clh", "noise.clh", "shades.clh", "planes.clh", "quantum.clh", "attenuate.cl",
      "weights.cl"},
     "-D SKG_GENERAL=1 -D SKG_PLANES=16 " NAMES,
     0},
    {{"pixel.clh", "intervals.clh", "hits.cl", "slopes.cl", "gradient.cl"}, "-D SKG_PRIORITY=1 " NAMES, 0},
    {{"intervals.clh", "cell_rays.clh", "volume_slopes.cl"}, NAMES, 0},
    {{"batch.clh", "worth.clh", "gather.clh", "draw.clh", "collect.clh", "tiny.clh", "gather_tiny.clh",
      "gradient_batches.cl"},
     "-D SKG_GATHER=1 " NAMES,
     0},
    {{"batch.clh", "worth.clh", "spread.clh", "draw.clh", "collect.clh", "tiny.clh", "spread_tiny.clh",
      "gradient_batches.cl"},
     "-D SKG_GATHER=1 -D SKG_FORWARD=1 " NAMES,
     0},
    {{"blur.cl"}, NAMES, 0},
    {{"exponential.clh", "random.clh", "noise.clh", "detect.cl"}, "-D SKG_FLAT_FIELD=1 " NAMES, 0},
    {{"exponential.clh", "random.clh", "pile_up.clh", "pulses.cl"}, "-D SKG_MOVES=1 " NAMES, 0},
    {{"blur_variance.cl", "detect_variance.cl"}, "-D SKG_FLAT_FIELD=1 -D SKG_OF_LOGARITHM=1 " NAMES, 0},
    {{"exponential.clh", "random.clh", "noise.clh", "scatter.clh", "walk.clh", "fluorescence.clh",
      "sight.clh", "strips.clh", "arrive.clh", "profile.clh", "emit.clh", "tally.clh", "next_event.clh",
      "scatter.cl"},
     NAMES,
     0},
    {{"exponential.clh", "random.clh", "noise.clh", "scattered.cl"}, NAMES, 0},
    {{"show_shared.h", "show.cl"}, NAMES, 0},
};

static const kernel_list *list_of(const char *function) {
    for (int k = 0; k < KERNELS; k++)
        if (strcmp(lists[k].function, function) == 0) return &lists[k];
    ck_abort_msg("kernel %s is not in kernels/shared/arguments.h", function);
    return NULL;
}

static void compare(cl_kernel kernel, int found[KERNELS]) {
    char function[128] = "", name[128];
    cl_uint count = 0, named = 0;
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof function, function, NULL);
    clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof count, &count, NULL);
    const kernel_list *list = list_of(function);
    while (list->names[named]) named++;
    ck_assert_msg(named == count, "%s has %u arguments, %u are named", function, count, named);
    for (cl_uint a = 0; a < count; a++) {
        const cl_int code = clGetKernelArgInfo(kernel, a, CL_KERNEL_ARG_NAME, sizeof name, name, NULL);
        ck_assert_int_eq(code, CL_SUCCESS);
        ck_assert_msg(strcmp(name, list->names[a]) == 0, "argument %u of %s is %s, not %s", a, function, name,
                      list->names[a]);
    }
    found[list - lists] = 1;
}

START_TEST(arguments_have_the_names_of_their_kernels) {
    int found[KERNELS] = {0};
    for (size_t p = 0; p < sizeof programs / sizeof *programs; p++) {
        const skg_kernel_options options = {
            .bits = 32, .source_plane = 1, .listed = 1, .half = programs[p].half};
        int32_t files = 0;
        cl_uint count = 0;
        cl_program program = NULL;
        cl_kernel kernels[8];
        while (files < FILES_MAX && programs[p].files[files]) files++;
        const skg_program_options more = {.flags = programs[p].flags};
        ck_skg(skg_kernels_get(context, &options, files, programs[p].files, &more, &program));
        ck_assert_int_eq(clCreateKernelsInProgram(program, 8, kernels, &count), CL_SUCCESS);
        ck_assert_int_gt(count, 0);
        for (cl_uint k = 0; k < count; k++) {
            compare(kernels[k], found);
            clReleaseKernel(kernels[k]);
        }
    }
    for (int k = 0; k < KERNELS; k++) ck_assert_msg(found[k], "no kernel %s", lists[k].function);
}
END_TEST

/* The kernels of leaky.cl begin alike, so that one function sets their first arguments. */
START_TEST(kernels_of_leaky_parts_begin_alike) {
    static const char *const batch[] = {SKG_ARGUMENTS_LEAKY_BATCH(NAME)};
    static const char *const kernels[] = {"skg_leaky_add", "skg_leaky_gaps", "skg_leaky_repair",
                                          "skg_leaky_put"};
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++)
        for (int a = 0; a < SKG_LEAKY_BATCH_ARGUMENTS; a++)
            ck_assert_str_eq(list_of(kernels[k])->names[a], batch[a]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, arguments_have_the_names_of_their_kernels);
    tcase_add_test(tests, kernels_of_leaky_parts_begin_alike);
}

SKG_SUITE_MAIN("arguments", add_tests)
