/* Stage `detect`: electronic noise, steps, ratios, logarithms. */
#include "stage/readout.h"

#include <math.h>

/* The kernels of one type of image. */
typedef struct {
    cl_kernel kernels[2];   /* with noise and steps, and of the mean */
    cl_kernel variances[2]; /* of values, and of their -ln */
    skg_buffer factor;
    int32_t has_factor, reserved;
} detector_type;

struct skg_detector {
    skg_context *context;
    skg_detection detection;
    double *factor;        /* [channels] */
    detector_type type[2]; /* of float, of double; made on demand */
};

skg_status skg_detector_create(skg_context *context, const skg_detection *detection, const double *factors,
                               skg_detector **detector) {
    SKG_TRY(skg_alloc(1, sizeof **detector, "detector", detector));
    (*detector)->context = context;
    (*detector)->detection = *detection;
    skg_status status = skg_alloc(detection->channels, sizeof *factors, "detector", &(*detector)->factor);
    for (int32_t c = 0; c < detection->channels && status == SKG_OK; c++) (*detector)->factor[c] = factors[c];
    if (status != SKG_OK) skg_detector_release(detector);
    return status;
}

void skg_detector_release(skg_detector **detector) {
    if (!*detector) return;
    for (int32_t i = 0; i < 2; i++) {
        detector_type *type = &(*detector)->type[i];
        for (int k = 0; k < 2; k++) {
            if (type->kernels[k]) clReleaseKernel(type->kernels[k]);
            if (type->variances[k]) clReleaseKernel(type->variances[k]);
        }
        skg_buffer_release(&type->factor);
    }
    skg_free(&(*detector)->factor);
    skg_free(detector);
}

int64_t skg_detector_bytes(const skg_detector *detector) {
    return detector->type[0].factor.bytes + detector->type[1].factor.bytes;
}

int skg_detector_wants_flat_field(const skg_detector *detector) {
    return detector->detection.over_flat_field;
}

skg_noise_args skg_noise_key(int64_t seed, int64_t index, int32_t parts) {
    const uint64_t words[2] = {(uint64_t)seed, (uint64_t)index};
    skg_noise_args key = {.parts = parts > 1 ? parts : 1};
    for (int k = 0; k < 2; k++) {
        key.seed[k] = (cl_int)(uint32_t)(words[0] >> 32 * k);
        key.frame[k] = (cl_int)(uint32_t)(words[1] >> 32 * k);
    }
    return key;
}

/* The program of these files with these options. */
static skg_status get_program(const skg_detector *detector, int is_double, int32_t count,
                              const char *const *files, const skg_program_options *more,
                              cl_program *program) {
    const skg_kernel_options options = {.precision = is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                        .bits = 32};
    return skg_kernels_get(detector->context, &options, count, files, more, program);
}

static skg_status get_factor(skg_detector *detector, int is_double) {
    const skg_detection *detection = &detector->detection;
    skg_buffer *factor = &detector->type[is_double].factor;
    const size_t element = is_double ? sizeof(double) : sizeof(float);
    float rounded[SKG_CHANNELS_MAX];
    if (detector->type[is_double].has_factor) return SKG_OK;
    for (int32_t c = 0; c < detection->channels; c++) rounded[c] = (float)detector->factor[c];
    SKG_TRY(skg_buffer_write(detector->context, factor, detection->channels * (int64_t)element,
                             is_double ? (const void *)detector->factor : rounded, "detector"));
    detector->type[is_double].has_factor = 1;
    return SKG_OK;
}

static skg_status get_kernel(skg_detector *detector, int is_double, int of_mean, cl_kernel *kernel) {
    static const char *const files[] = {"exponential.clh", "random.clh", "noise.clh", "detect.cl"};
    const skg_detection *detection = &detector->detection;
    cl_kernel *made = &detector->type[is_double].kernels[of_mean];
    cl_program program = NULL;
    if (!*made) {
        const skg_define defines[] = {{"SKG_ELECTRONIC", !of_mean && detection->electronic > 0},
                                      {"SKG_QUANTISED", !of_mean && detection->step > 0},
                                      {"SKG_FLAT_FIELD", detection->over_flat_field}};
        SKG_TRY(get_factor(detector, is_double));
        SKG_TRY(get_program(detector, is_double, 4, files, SKG_DEFINES(defines), &program));
        SKG_TRY(skg_kernel_create(program, "skg_detect", made));
    }
    *kernel = *made;
    return SKG_OK;
}

static skg_status get_variance(skg_detector *detector, int is_double, int of_logarithm, cl_kernel *kernel) {
    static const char *const file = "detect_variance.cl";
    cl_kernel *made = &detector->type[is_double].variances[of_logarithm];
    cl_program program = NULL;
    if (!*made) {
        const skg_define defines[] = {{"SKG_FLAT_FIELD", detector->detection.over_flat_field},
                                      {"SKG_OF_LOGARITHM", of_logarithm}};
        SKG_TRY(get_factor(detector, is_double));
        SKG_TRY(get_program(detector, is_double, 1, &file, SKG_DEFINES(defines), &program));
        SKG_TRY(skg_kernel_create(program, "skg_detect_variance", made));
    }
    *kernel = *made;
    return SKG_OK;
}

/* The scalars of both kernels. */
static skg_detect_double scalars_of(const skg_detector *detector, const skg_noise_args *key, double factor,
                                    const skg_image_place *image, int64_t columns, int64_t rows) {
    const skg_detection *detection = &detector->detection;
    return (skg_detect_double){
        /* Each part has its own; their mean has that of one exposure. */
        .electronic = detection->electronic * sqrt((double)key->parts),
        .spacing = detection->step,
        .scale = factor,
        .key = *key,
        .image = skg_image_of(image, columns, rows, detection->channels),
    };
}

skg_status skg_detector_run(skg_detector *detector, const skg_noise_args *key, int32_t of_mean, double factor,
                            cl_mem flat_field, const skg_image_place *image, int64_t columns, int64_t rows,
                            skg_stage_log *log) {
    const int is_double = image->output_double != 0;
    cl_kernel kernel = NULL;
    skg_detect_float rounded;
    SKG_TRY(get_kernel(detector, is_double, of_mean, &kernel));
    const skg_detect_double args = scalars_of(detector, key, factor, image, columns, rows);
    SKG_ROUND_ARGUMENTS(args, rounded, key);
    const skg_argument arguments[] = {
        SKG_ARGUMENT_WITH(DETECT, args, is_double, args, rounded),
        SKG_ARGUMENT(DETECT, factor, detector->type[is_double].factor.memory),
        SKG_ARGUMENT(DETECT, flat_field, flat_field),
        SKG_ARGUMENT(DETECT, image, image->memory),
    };
    const int64_t lanes =
        skg_kernel_lanes(detector->context, is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE);
    /* Large groups: PoCL takes some 20 ns for each. */
    const skg_work_size work = {
        3, {(columns + lanes - 1) / lanes, rows, detector->detection.channels}, {8, 16, 1}};
    return SKG_LAUNCH(detector->context, kernel, "detect", &work, arguments, log);
}

skg_status skg_detector_run_variance(skg_detector *detector, const skg_noise_args *key, double factor,
                                     cl_mem flat_field, cl_mem mean, const skg_image_place *variance,
                                     int64_t columns, int64_t rows, skg_stage_log *log) {
    const int is_double = variance->output_double != 0;
    cl_kernel kernel = NULL;
    skg_detect_float rounded;
    SKG_TRY(get_variance(detector, is_double, mean != NULL, &kernel));
    const skg_detect_double args = scalars_of(detector, key, factor, variance, columns, rows);
    SKG_ROUND_ARGUMENTS(args, rounded, key);
    const skg_argument arguments[] = {
        SKG_ARGUMENT_WITH(DETECT_VARIANCE, args, is_double, args, rounded),
        SKG_ARGUMENT(DETECT_VARIANCE, factor, detector->type[is_double].factor.memory),
        SKG_ARGUMENT(DETECT_VARIANCE, flat_field, flat_field),
        SKG_ARGUMENT(DETECT_VARIANCE, mean, mean),
        SKG_ARGUMENT(DETECT_VARIANCE, variance, variance->memory),
    };
    const skg_work_size work = {3, {columns, rows, detector->detection.channels}, {16, 16, 1}};
    return SKG_LAUNCH(detector->context, kernel, "detect", &work, arguments, log);
}
