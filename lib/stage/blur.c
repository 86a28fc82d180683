/* Stage `blur`: an image convolved with the detector's line spread functions or its point spread function. */
#include "core/maths.h"
#include "stage/readout.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* The share of a work-item, as blur.cl has it: rows of the first pass, vectors of a row, vectors of a run of the second. */
enum { BLUR_ROWS = 4, BLUR_VECTORS = 2, BLUR_RUN = 4 };

/* The most samples that a function may have along either direction. */
enum { SAMPLES_MAX = 4095 };

/* Kernels and weights for images of one type, float or double. */
typedef struct {
    cl_kernel down_kernel, across_kernel, variance_kernel;
    skg_buffer down, across; /* weights */
    int32_t has_weights, reserved;
} blur_type;

struct skg_blur {
    skg_context *context;
    int64_t columns, rows; /* samples */
    int32_t separable, reserved;
    double *down;   /* [rows]; of a point spread function: one sample of 1 */
    double *across; /* [columns]; of a point spread function: [rows][columns] */
    char kind[80];
    blur_type type[2]; /* of float, of double; made on demand */
    skg_buffer workspace;
};

void skg_detector_blur_init_sized(void *blur, int32_t size) {
    const skg_detector_blur defaults = {0};
    skg_struct_init(blur, size, &defaults, sizeof defaults);
}

int64_t skg_blur_samples(const skg_blur *blur) {
    return blur->separable ? blur->columns + blur->rows : blur->columns * blur->rows;
}

static skg_status check_count(const char *what, int64_t count) {
    if (count < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "the %s has %" PRId64 " samples; give at least one", what, count);
    if (count % 2 == 0)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "the %s has %" PRId64
                        " samples; an even number has no middle and would shift the image by half a pixel, "
                        "give an odd one",
                        what, count);
    if (count > SAMPLES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "the %s has %" PRId64 " samples; at most %d", what, count,
                        SAMPLES_MAX);
    return SKG_OK;
}

/* Copies the samples in reverse order, as a convolution reads them, and scales them to sum 1. */
static skg_status copy_turned(const char *what, int64_t count, const double *samples, double **turned) {
    double sum = 0, magnitude = 0;
    if (!samples) return skg_fail(SKG_ERR_ARGUMENT, "the %s has no samples: NULL", what);
    for (int64_t i = 0; i < count; i++) {
        if (!isfinite(samples[i]))
            return skg_fail(SKG_ERR_ARGUMENT, "sample %" PRId64 " of the %s is not finite: %g", i, what,
                            samples[i]);
        sum += samples[i];
        magnitude += fabs(samples[i]);
    }
    /* Samples that cancel leave not 0 but a rounding error of this size. */
    if (!(sum > 1e-12 * magnitude) || !isfinite(magnitude))
        return skg_fail(SKG_ERR_ARGUMENT, "the samples of the %s sum to %g; the sum has to be above 0", what,
                        sum);
    SKG_TRY(skg_alloc(count, sizeof **turned, what, turned));
    for (int64_t i = 0; i < count; i++) (*turned)[i] = samples[count - 1 - i] / sum;
    return SKG_OK;
}

static skg_status read_shape(const skg_detector_blur *shape, skg_blur *blur) {
    static const double one = 1;
    skg_detector_blur ours = {.size = sizeof ours};
    SKG_TRY(skg_struct_read(shape, "skg_detector_blur", &ours, sizeof ours));
    const int separable = blur->separable = ours.point == NULL;
    blur->columns = ours.columns;
    blur->rows = ours.rows;
    if (!separable && (ours.along_row || ours.along_column))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "both line and point spread functions are given; give one kind of them");
    SKG_TRY(check_count(separable ? "line spread function along the rows" : "point spread function's row",
                        ours.columns));
    SKG_TRY(check_count(
        separable ? "line spread function along the columns" : "point spread function's column", ours.rows));
    if (!separable) {
        SKG_TRY(copy_turned("point spread function", ours.columns * ours.rows, ours.point, &blur->across));
        return copy_turned("point spread function's column", 1, &one, &blur->down);
    }
    SKG_TRY(copy_turned("line spread function along the rows", ours.columns, ours.along_row, &blur->across));
    return copy_turned("line spread function along the columns", ours.rows, ours.along_column, &blur->down);
}

skg_status skg_blur_create(skg_context *context, const skg_detector_blur *shape, skg_blur **blur) {
    SKG_TRY(skg_alloc(1, sizeof **blur, "blur", blur));
    skg_blur *made = *blur;
    made->context = context;
    skg_status status = read_shape(shape, made);
    if (status != SKG_OK) {
        skg_blur_release(blur);
        return status;
    }
    snprintf(made->kind, sizeof made->kind, "a %s of %" PRId64 " x %" PRId64 " samples",
             made->separable ? "pair of line spread functions" : "point spread function", made->columns,
             made->rows);
    return SKG_OK;
}

const char *skg_blur_kind(const skg_blur *blur) {
    return blur->kind;
}

void skg_blur_release(skg_blur **blur) {
    if (!*blur) return;
    for (int32_t i = 0; i < 2; i++) {
        blur_type *type = &(*blur)->type[i];
        if (type->down_kernel) clReleaseKernel(type->down_kernel);
        if (type->across_kernel) clReleaseKernel(type->across_kernel);
        if (type->variance_kernel) clReleaseKernel(type->variance_kernel);
        skg_buffer_release(&type->down);
        skg_buffer_release(&type->across);
    }
    skg_buffer_release(&(*blur)->workspace);
    skg_free(&(*blur)->down);
    skg_free(&(*blur)->across);
    skg_free(blur);
}

int64_t skg_blur_bytes(const skg_blur *blur) {
    int64_t bytes = blur->workspace.bytes;
    for (int32_t i = 0; i < 2; i++) bytes += blur->type[i].down.bytes + blur->type[i].across.bytes;
    return bytes;
}

/* Uploads weights in the type of the image, with `zeros` zeros before and behind them. */
static skg_status upload(const skg_blur *blur, int is_double, int64_t count, const double *weights,
                         int64_t zeros, skg_buffer *buffer) {
    const size_t element = is_double ? sizeof(double) : sizeof(float);
    void *padded = NULL;
    SKG_TRY(skg_alloc(count + 2 * zeros, element, "blur", &padded));
    for (int64_t i = 0; i < count; i++)
        if (is_double)
            ((double *)padded)[zeros + i] = weights[i];
        else
            ((float *)padded)[zeros + i] = (float)weights[i];
    skg_status status =
        skg_buffer_write(blur->context, buffer, (count + 2 * zeros) * (int64_t)element, padded, "blur");
    skg_free(&padded);
    return status;
}

static skg_status get_program(const skg_blur *blur, int is_double, const char *file, cl_program *program) {
    const skg_kernel_options options = {.precision = is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                        .bits = 32};
    return skg_kernels_get(blur->context, &options, 1, &file, NULL, program);
}

static skg_status get_weights(const skg_blur *blur, int is_double, blur_type *type) {
    const int64_t down = blur->separable ? blur->rows : 1;
    if (type->has_weights) return SKG_OK;
    SKG_TRY(upload(blur, is_double, down, blur->down, BLUR_ROWS - 1, &type->down));
    SKG_TRY(upload(blur, is_double, blur->columns * (blur->separable ? 1 : blur->rows), blur->across, 0,
                   &type->across));
    type->has_weights = 1;
    return SKG_OK;
}

static skg_status get_type(skg_blur *blur, int is_double, blur_type **got) {
    blur_type *type = *got = &blur->type[is_double];
    cl_program program = NULL;
    if (type->across_kernel) return SKG_OK;
    SKG_TRY(get_program(blur, is_double, "blur.cl", &program));
    SKG_TRY(get_weights(blur, is_double, type));
    if (!type->down_kernel) SKG_TRY(skg_kernel_create(program, "skg_blur_down", &type->down_kernel));
    return skg_kernel_create(program, "skg_blur_across", &type->across_kernel);
}

/* Where both passes work; `image` and `add` are set for each. */
static skg_blur_args lay_out(const skg_blur *blur, int64_t lanes, int64_t columns) {
    const int64_t left = blur->columns / 2, above = blur->separable ? 0 : blur->rows / 2;
    /* The last run of a row in the second pass may end past the image, and reads `left` samples beyond its end like every
     * other. */
    const int64_t stride =
        skg_round_up(skg_round_up(columns, BLUR_RUN * lanes) + 2 * left, BLUR_VECTORS * lanes);
    return (skg_blur_args){.stride = (SKG_INT)stride,
                           .left = (SKG_INT)left,
                           .above = (SKG_INT)above,
                           .taps = blur->separable ? (SKG_INT)blur->rows : 1,
                           .down = blur->separable ? 1 : (SKG_INT)blur->rows,
                           .across = (SKG_INT)blur->columns};
}

/* Enqueues a kernel over `across` x `down` work-items of each channel. */
#define RUN(blur, kernel, across, down, channels, arguments, log)                                            \
    SKG_LAUNCH((blur)->context, kernel, "blur",                                                              \
               (&(const skg_work_size){                                                                      \
                   3, {across, down, channels}, {4, 16, 1}}), /* large groups, as in detect.c */             \
               arguments, log)

static skg_status run_down(const skg_blur *blur, const blur_type *type, const skg_blur_args *args,
                           int64_t lanes, cl_mem image, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_ARGUMENT(BLUR_DOWN, args, *args),
        SKG_ARGUMENT(BLUR_DOWN, image, image),
        SKG_ARGUMENT(BLUR_DOWN, weights, type->down.memory),
        SKG_ARGUMENT(BLUR_DOWN, workspace, blur->workspace.memory),
    };
    return RUN(blur, type->down_kernel, args->stride / (BLUR_VECTORS * lanes),
               ((int64_t)args->high + BLUR_ROWS - 1) / BLUR_ROWS, args->image.channels, arguments, log);
}

static skg_status run_across(const skg_blur *blur, const blur_type *type, const skg_blur_args *args,
                             int64_t lanes, cl_mem image, skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_ARGUMENT(BLUR_ACROSS, args, *args),
        SKG_ARGUMENT(BLUR_ACROSS, workspace, blur->workspace.memory),
        SKG_ARGUMENT(BLUR_ACROSS, weights, type->across.memory),
        SKG_ARGUMENT(BLUR_ACROSS, image, image),
    };
    return RUN(blur, type->across_kernel, (args->image.columns + BLUR_RUN * lanes - 1) / (BLUR_RUN * lanes),
               args->image.rows, args->image.channels, arguments, log);
}

skg_status skg_blur_run(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                        int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log) {
    const int is_double = image->output_double != 0;
    const int64_t lanes =
        skg_kernel_lanes(blur->context, is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE);
    skg_blur_args args = lay_out(blur, lanes, columns);
    blur_type *type = NULL;
    args.high = (SKG_INT)rows + 2 * args.above;
    SKG_TRY(get_type(blur, is_double, &type));
    SKG_TRY(skg_buffer_reserve(blur->context, &blur->workspace,
                               (int64_t)args.stride * args.high * channels *
                                   (int64_t)(is_double ? sizeof(cl_double) : sizeof(cl_float)),
                               CL_MEM_READ_WRITE, "blur"));
    args.image = skg_image_of(from, columns, rows, channels);
    SKG_TRY(run_down(blur, type, &args, lanes, from->memory, log));
    args.image = skg_image_of(image, columns, rows, channels);
    args.add = image->add;
    return run_across(blur, type, &args, lanes, image->memory, log);
}

/* --- variances */

static skg_status run_variance(const skg_blur *blur, const blur_type *type,
                               const skg_blur_variance_args *args, cl_mem from, cl_mem weights, cl_mem to,
                               skg_stage_log *log) {
    const skg_argument arguments[] = {
        SKG_ARGUMENT(BLUR_VARIANCE, args, *args),
        SKG_ARGUMENT(BLUR_VARIANCE, from, from),
        SKG_ARGUMENT(BLUR_VARIANCE, weights, weights),
        SKG_ARGUMENT(BLUR_VARIANCE, to, to),
    };
    return RUN(blur, type->variance_kernel, args->to.columns, args->to.rows, args->to.channels, arguments,
               log);
}

skg_status skg_blur_run_variance(skg_blur *blur, const skg_image_place *from, const skg_image_place *image,
                                 int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log) {
    const int is_double = image->output_double != 0;
    blur_type *type = &blur->type[is_double];
    cl_program program = NULL;
    const int64_t bytes =
        rows * columns * channels * (int64_t)(is_double ? sizeof(cl_double) : sizeof(cl_float));
    SKG_TRY(skg_buffer_reserve(blur->context, &blur->workspace, bytes, CL_MEM_READ_WRITE, "blur"));
    const skg_image_place between = {
        .memory = blur->workspace.memory, .row_stride = columns, .channel_stride = rows * columns};
    const skg_blur_variance_args across = {.from = skg_image_of(from, columns, rows, channels),
                                           .to = skg_image_of(&between, columns, rows, channels),
                                           .down = blur->separable ? 1 : (SKG_INT)blur->rows,
                                           .across = (SKG_INT)blur->columns};
    const skg_blur_variance_args down = {.from = across.to,
                                         .to = skg_image_of(image, columns, rows, channels),
                                         .down = blur->separable ? (SKG_INT)blur->rows : 1,
                                         .across = 1,
                                         .first = BLUR_ROWS - 1,
                                         .add = image->add};
    if (!type->variance_kernel) {
        SKG_TRY(get_program(blur, is_double, "blur_variance.cl", &program));
        SKG_TRY(get_weights(blur, is_double, type));
        SKG_TRY(skg_kernel_create(program, "skg_blur_variance", &type->variance_kernel));
    }
    SKG_TRY(run_variance(blur, type, &across, from->memory, type->across.memory, between.memory, log));
    return run_variance(blur, type, &down, between.memory, type->down.memory, image->memory, log);
}

/* --- on the host */

/* Adds the image of a source pixel's weight to where its value came from. The values of a pixel were sums over rows from `row` and
 * columns from `column` on, clamped to the image. */
static void add_taps(const skg_blur *blur, int64_t columns, int64_t rows, int64_t row, int64_t column,
                     double value, double *to) {
    for (int64_t j = 0; j < blur->rows; j++) {
        const int64_t down = row + j - blur->rows / 2;
        double *at = to + (down < 0 ? 0 : down < rows ? down : rows - 1) * columns;
        for (int64_t i = 0; i < blur->columns; i++) {
            const int64_t across = column + i - blur->columns / 2;
            at[across < 0         ? 0
               : across < columns ? across
                                  : columns - 1] += value * blur->across[j * blur->columns + i];
        }
    }
}

/* One direction of a separable blur: `count` lines, whose elements are `step` apart. */
static void add_lines(int64_t taps, const double *weights, int64_t lines, int64_t next, int64_t count,
                      int64_t step, const double *from, double *to) {
    for (int64_t l = 0; l < lines; l++)
        for (int64_t p = 0; p < count; p++) {
            const double value = from[l * next + p * step];
            for (int64_t k = 0; k < taps && value != 0; k++) {
                const int64_t at = p + k - taps / 2;
                to[l * next + (at < 0 ? 0 : at < count ? at : count - 1) * step] += value * weights[k];
            }
        }
}

skg_status skg_blur_transpose(const skg_blur *blur, int64_t columns, int64_t rows, const double *from,
                              double *to) {
    double *half = NULL;
    SKG_ASSERT(from != to); /* what is read later would be changed */
    if (!blur->separable) {
        for (int64_t r = 0; r < rows; r++)
            for (int64_t c = 0; c < columns; c++)
                if (from[r * columns + c] != 0)
                    add_taps(blur, columns, rows, r, c, from[r * columns + c], to);
        return SKG_OK;
    }
    SKG_TRY(skg_alloc(rows * columns, sizeof *half, "blur", &half));
    add_lines(blur->columns, blur->across, rows, columns, columns, 1, from, half);
    add_lines(blur->rows, blur->down, columns, 1, rows, columns, half, to);
    skg_free(&half);
    return SKG_OK;
}

void skg_blur_apply(const skg_blur *blur, int64_t columns, int64_t rows, const double *from, double *to) {
    const int64_t down = blur->rows, across = blur->columns;
    for (int64_t r = 0; r < rows; r++)
        for (int64_t c = 0; c < columns; c++)
            for (int64_t j = 0; j < down; j++) {
                const int64_t row = r + j - down / 2;
                const double *line = from + (row < 0 ? 0 : row < rows ? row : rows - 1) * columns;
                const double *weights = blur->across + (blur->separable ? 0 : j * across);
                double sum = 0;
                for (int64_t i = 0; i < across; i++) {
                    const int64_t column = c + i - across / 2;
                    sum += weights[i] * line[column < 0 ? 0 : column < columns ? column : columns - 1];
                }
                to[r * columns + c] += (blur->separable ? blur->down[j] : 1) * sum;
            }
}
