/* Stage `scattered`: adds the scatter to intensities. */
#include "stage/readout.h"

static skg_status get_kernel(skg_context *context, skg_scattered *stage, int is_double, cl_kernel *kernel) {
    static const char *const files[] = {"exponential.clh", "random.clh", "noise.clh", "scattered.cl"};
    const skg_kernel_options options = {.precision = is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                        .bits = 32};
    cl_program program = NULL;
    if (!stage->kernels[is_double]) {
        SKG_TRY(skg_kernels_get(context, &options, (int32_t)(sizeof files / sizeof *files), files, NULL,
                                &program));
        SKG_TRY(skg_kernel_create(program, "skg_scattered", &stage->kernels[is_double]));
    }
    *kernel = stage->kernels[is_double];
    return SKG_OK;
}

skg_status skg_scattered_run(skg_context *context, skg_scattered *stage, const skg_scattered_image *what,
                             const skg_noise_args *key, const skg_image_place *image, int64_t columns,
                             int64_t rows, skg_stage_log *log) {
    const int is_double = image->output_double != 0;
    const skg_scattered_args args = {.key = *key,
                                     .image = skg_image_of(image, columns, rows, what->channels),
                                     .add = what->add,
                                     .scale = what->scale,
                                     .noise = !what->variance ? 0
                                              : what->apart   ? SKG_NOISE_APART
                                                              : SKG_NOISE_DRAWN};
    cl_kernel kernel = NULL;
    SKG_TRY(get_kernel(context, stage, is_double, &kernel));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(SCATTERED, args, args),
        SKG_ARGUMENT(SCATTERED, mean, what->mean),
        SKG_ARGUMENT(SCATTERED, variance, what->variance),
        SKG_ARGUMENT(SCATTERED, image, image->memory),
    };
    const int64_t lanes = skg_kernel_lanes(context, is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE);
    const skg_work_size work = {
        2, {(columns + lanes - 1) / lanes, rows}, {8, 16}}; /* large groups, as in detect.c */
    return SKG_LAUNCH(context, kernel, "scattered", &work, arguments, log);
}

void skg_scattered_release(skg_scattered *stage) {
    for (int i = 0; i < 2; i++)
        if (stage->kernels[i]) clReleaseKernel(stage->kernels[i]);
    *stage = (skg_scattered){0};
}
