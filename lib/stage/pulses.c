/* Stage `pulses`: what a detector that counts makes of independent counts. */
#include "stage/readout.h"

#include <string.h>

/* The kernels of one type of image. */
typedef struct {
    cl_kernel kernels[2]; /* of counts, of variances */
    skg_buffer weights;
    int32_t has_weights, reserved;
} pulses_type;

struct skg_pulses {
    skg_context *context;
    int32_t windows, reach, pile_up;
    int32_t first;       /* 0: pulses are not moved to other windows */
    int64_t count;       /* of weights */
    double *weights;     /* as pulses.cl reads them */
    pulses_type type[2]; /* of float, of double; made on demand */
};

_Static_assert(SKG_CHANNELS_COUNTED == SKG_THRESHOLDS_MAX, "arrays of pulses.cl");
_Static_assert(SKG_PILE_UP_PULSES_END == SKG_PILE_UP_PARALYSABLE, "pile-up of pulses.cl");

skg_status skg_pulses_create(skg_context *context, const skg_counter_kernels *kernels, int32_t pile_up,
                             double dead, skg_pulses **pulses) {
    const int64_t count = skg_counter_kernels_size(kernels);
    SKG_TRY(skg_alloc(1, sizeof **pulses, "counting detector", pulses));
    skg_pulses *made = *pulses;
    made->context = context;
    made->windows = kernels->windows, made->reach = kernels->reach, made->pile_up = pile_up;
    made->first = kernels->first;
    made->count = 1 + count;
    const skg_status status =
        skg_alloc(made->count, sizeof *made->weights, "counting detector", &made->weights);
    if (status != SKG_OK) {
        skg_pulses_release(pulses);
        return status;
    }
    made->weights[0] = dead;
    memcpy(made->weights + 1, kernels->means, (size_t)count * sizeof *made->weights);
    return SKG_OK;
}

void skg_pulses_release(skg_pulses **pulses) {
    if (!*pulses) return;
    for (int i = 0; i < 2; i++) {
        pulses_type *type = &(*pulses)->type[i];
        for (int k = 0; k < 2; k++)
            if (type->kernels[k]) clReleaseKernel(type->kernels[k]);
        skg_buffer_release(&type->weights);
    }
    skg_free(&(*pulses)->weights);
    skg_free(pulses);
}

int64_t skg_pulses_bytes(const skg_pulses *pulses) {
    return pulses->type[0].weights.bytes + pulses->type[1].weights.bytes;
}

static skg_status get_weights(const skg_pulses *pulses, int is_double, pulses_type *type) {
    float *rounded = NULL;
    if (type->has_weights) return SKG_OK;
    SKG_TRY(skg_alloc(pulses->count, sizeof *rounded, "counting detector", &rounded));
    for (int64_t i = 0; i < pulses->count; i++) rounded[i] = (float)pulses->weights[i];
    const skg_status status =
        skg_buffer_write(pulses->context, &type->weights,
                         pulses->count * (int64_t)(is_double ? sizeof *pulses->weights : sizeof *rounded),
                         is_double ? (const void *)pulses->weights : rounded, "counting detector");
    skg_free(&rounded);
    type->has_weights = status == SKG_OK;
    return status;
}

static skg_status get_type(skg_pulses *pulses, int is_double, pulses_type **got) {
    static const char *const files[] = {"exponential.clh", "random.clh", "pile_up.clh", "pulses.cl"},
                             *const names[] = {"skg_pulses", "skg_pulses_variance"};
    const skg_kernel_options options = {.precision = is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                        .bits = 32};
    const skg_define defines[] = {{"SKG_MOVES", pulses->first > 0}};
    pulses_type *type = *got = &pulses->type[is_double];
    cl_program program = NULL;
    SKG_TRY(get_weights(pulses, is_double, type));
    if (type->kernels[1]) return SKG_OK;
    SKG_TRY(skg_kernels_get(pulses->context, &options, 4, files, SKG_DEFINES(defines), &program));
    for (int k = 0; k < 2; k++)
        if (!type->kernels[k]) SKG_TRY(skg_kernel_create(program, names[k], &type->kernels[k]));
    return SKG_OK;
}

static skg_pulses_args lay_out(const skg_pulses *pulses, const skg_image_place *from,
                               const skg_image_place *image, int64_t columns, int64_t rows) {
    return (skg_pulses_args){.from = skg_image_of(from, columns, rows, pulses->windows),
                             .to = skg_image_of(image, columns, rows, pulses->windows),
                             .reach = pulses->reach,
                             .pile_up = pulses->pile_up,
                             .first = pulses->first};
}

skg_status skg_pulses_run(skg_pulses *pulses, const skg_noise_args *noise, const skg_image_place *from,
                          const skg_image_place *image, int64_t columns, int64_t rows, skg_stage_log *log) {
    skg_pulses_args args = lay_out(pulses, from, image, columns, rows);
    pulses_type *type = NULL;
    SKG_TRY(get_type(pulses, image->output_double != 0, &type));
    args.noise = noise != NULL;
    if (noise) args.key = *noise;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(PULSES, args, args),
        SKG_ARGUMENT(PULSES, from, from->memory),
        SKG_ARGUMENT(PULSES, weights, type->weights.memory),
        SKG_ARGUMENT(PULSES, to, image->memory),
    };
    const skg_work_size work = {2, {columns, rows}, {16, 16}};
    return SKG_LAUNCH(pulses->context, type->kernels[0], "pulses", &work, arguments, log);
}

skg_status skg_pulses_run_variance(skg_pulses *pulses, const skg_image_place *from,
                                   const skg_image_place *image, int64_t columns, int64_t rows,
                                   skg_stage_log *log) {
    const skg_pulses_args args = lay_out(pulses, from, image, columns, rows);
    pulses_type *type = NULL;
    SKG_TRY(get_type(pulses, image->output_double != 0, &type));
    const skg_argument arguments[] = {
        SKG_ARGUMENT(PULSES_VARIANCE, args, args),
        SKG_ARGUMENT(PULSES_VARIANCE, from, from->memory),
        SKG_ARGUMENT(PULSES_VARIANCE, weights, type->weights.memory),
        SKG_ARGUMENT(PULSES_VARIANCE, to, image->memory),
    };
    const skg_work_size work = {3, {columns, rows, pulses->windows}, {16, 16, 1}};
    return SKG_LAUNCH(pulses->context, type->kernels[1], "pulses", &work, arguments, log);
}
