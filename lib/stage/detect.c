#include "stage/readout.h"

#include <math.h>

/* What one type of image needs. */
typedef struct {
    cl_kernel kernel;
    skg_buffer factor;
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
        if ((*detector)->type[i].kernel) clReleaseKernel((*detector)->type[i].kernel);
        skg_buffer_release(&(*detector)->type[i].factor);
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

static skg_status get_type(skg_detector *detector, int is_double, detector_type **got) {
    static const char *const files[] = {"exponential.clh", "random.clh", "noise.clh", "detect.cl"};
    const skg_detection *detection = &detector->detection;
    const skg_kernel_options options = {.precision = is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE,
                                        .bits = 32};
    const size_t element = is_double ? sizeof(double) : sizeof(float);
    detector_type *type = *got = &detector->type[is_double];
    cl_program program = NULL;
    float rounded[SKG_CHANNELS_MAX];
    if (type->kernel) return SKG_OK;
    for (int32_t c = 0; c < detection->channels; c++) rounded[c] = (float)detector->factor[c];
    SKG_TRY(skg_buffer_write(detector->context, &type->factor, detection->channels * (int64_t)element,
                             is_double ? (const void *)detector->factor : rounded, "detector"));
    const skg_define defines[] = {{"SKG_ELECTRONIC", detection->electronic > 0},
                                  {"SKG_QUANTISED", detection->step > 0},
                                  {"SKG_FLAT_FIELD", detection->over_flat_field}};
    SKG_TRY(skg_kernels_get(detector->context, &options, 4, files, SKG_DEFINES(defines), &program));
    return skg_kernel_create(program, "skg_detect", &type->kernel);
}

skg_status skg_detector_run(skg_detector *detector, const skg_noise_args *key, double factor,
                            cl_mem flat_field, const skg_image_place *image, int64_t columns, int64_t rows,
                            skg_stage_log *log) {
    const skg_detection *detection = &detector->detection;
    const int is_double = image->output_double != 0;
    detector_type *type = NULL;
    skg_detect_float rounded;
    SKG_TRY(get_type(detector, is_double, &type));
    const skg_detect_double args = {
        /* Each part has its own; their mean has that of one exposure. */
        .electronic = detection->electronic * sqrt((double)key->parts),
        .spacing = detection->step,
        .scale = factor,
        .key = *key,
        .image = skg_image_of(image, columns, rows, detection->channels),
    };
    SKG_ROUND_ARGUMENTS(args, rounded, key);
    const skg_argument arguments[] = {
        SKG_ARGUMENT_WITH(DETECT, args, is_double, args, rounded),
        SKG_ARGUMENT(DETECT, factor, type->factor.memory),
        SKG_ARGUMENT(DETECT, flat_field, flat_field),
        SKG_ARGUMENT(DETECT, image, image->memory),
    };
    const int64_t lanes =
        skg_kernel_lanes(detector->context, is_double ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE);
    /* Large groups: PoCL takes some 20 ns for each. */
    const skg_work_size work = {3, {(columns + lanes - 1) / lanes, rows, detection->channels}, {8, 16, 1}};
    return SKG_LAUNCH(detector->context, type->kernel, "detect", &work, arguments, log);
}
