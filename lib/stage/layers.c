/* Layers of intensities, each with its blur. */
#include "stage/readout.h"

#include "beam/line_spread.h"

#include <math.h>

void skg_depth_blur_init_sized(void *blur, int32_t size) {
    const skg_depth_blur defaults = {0};
    skg_struct_init(blur, size, &defaults, sizeof defaults);
}

static skg_status add(skg_context *context, const skg_detector_blur *blur, skg_layers *layers) {
    SKG_TRY(skg_blur_create(context, blur, &layers->blurs[layers->count]));
    layers->count++;
    return SKG_OK;
}

skg_status skg_layers_create(skg_context *context, const skg_detector_blur *blur,
                             const skg_depth_blur *depths, skg_layers *layers) {
    skg_depth_blur ours;
    if (blur) return add(context, blur, layers);
    if (!depths) return SKG_OK;
    skg_depth_blur_init(&ours);
    SKG_TRY(skg_struct_read(depths, "skg_depth_blur", &ours, sizeof ours));
    for (int64_t d = 0; d < ours.count; d++) {
        skg_detector_blur one;
        skg_detector_blur_init(&one);
        SKG_TRY(skg_struct_read_at(ours.blur, d, "skg_detector_blur", &one, sizeof one));
        const skg_status status = add(context, &one, layers);
        if (status != SKG_OK) return skg_fail(status, "depth %d: %s", (int)d + 1, skg_last_error());
    }
    return SKG_OK;
}

/* The transfer function of a checked blur along rows (0) or columns (1). */
static skg_status find_transfer(const skg_detector_blur *blur, int direction, double *transfer) {
    const int64_t count = direction == 0 ? blur->columns : blur->rows;
    double *line = NULL;
    SKG_TRY(skg_alloc(count, sizeof *line, "blur", &line));
    for (int64_t j = 0; j < blur->rows; j++)
        for (int64_t i = 0; i < blur->columns; i++)
            line[direction == 0 ? i : j] +=
                blur->point ? blur->point[j * blur->columns + i] : blur->along_row[i] * blur->along_column[j];
    skg_transfer_of(count, line, transfer);
    skg_free(&line);
    return SKG_OK;
}

skg_status skg_layers_add_noise(skg_context *context, const skg_detector_blur *blur, const skg_dqe *dqe,
                                const double pixel_mm[2], skg_layers *layers) {
    static const double one = 1;
    const skg_frequency_table table = {dqe->count, dqe->per_mm, dqe->dqe};
    skg_detector_blur shape = {
        .size = sizeof shape, .columns = 1, .rows = 1, .along_row = &one, .along_column = &one};
    double lines[2][SKG_LINE_SAMPLES_MAX];
    int64_t samples[2];
    if (blur)
        SKG_TRY(skg_struct_read(blur, "skg_detector_blur", &shape, sizeof shape));
    else
        SKG_TRY(add(context, &shape, layers)); /* the means */
    for (int d = 0; d < 2; d++) {
        double transfer[SKG_TRANSFER_STEPS + 1];
        SKG_TRY(skg_frequency_table_check("DQE", &table, pixel_mm[d]));
        SKG_TRY(find_transfer(&shape, d, transfer));
        for (int k = 0; k <= SKG_TRANSFER_STEPS; k++)
            transfer[k] *= sqrt(dqe->dqe[0] /
                                skg_frequency_table_at(&table, 0.5 / pixel_mm[d] * k / SKG_TRANSFER_STEPS));
        SKG_TRY(skg_line_spread_fit("noise power of the DQE", transfer, lines[d], &samples[d]));
    }
    const skg_detector_blur noise = {.size = sizeof noise,
                                     .columns = samples[0],
                                     .rows = samples[1],
                                     .along_row = lines[0],
                                     .along_column = lines[1]};
    return add(context, &noise, layers);
}

void skg_layers_release(skg_layers *layers) {
    for (int32_t l = 0; l < layers->count; l++) skg_blur_release(&layers->blurs[l]);
    skg_buffer_release(&layers->images);
    layers->count = 0;
}

int64_t skg_layers_bytes(const skg_layers *layers) {
    int64_t bytes = layers->images.bytes;
    for (int32_t l = 0; l < layers->count; l++) bytes += skg_blur_bytes(layers->blurs[l]);
    return bytes;
}

skg_status skg_layers_place(skg_context *context, skg_layers *layers, int32_t used,
                            const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                            skg_image_place *place) {
    SKG_ASSERT(used >= 0 && columns > 0 && rows > 0 && channels > 0);
    *place = *image;
    if (used <= 1) return SKG_OK;
    const int64_t element = image->output_double ? sizeof(cl_double) : sizeof(cl_float);
    SKG_TRY(skg_buffer_reserve(context, &layers->images, used * channels * rows * columns * element,
                               CL_MEM_READ_WRITE, "layers"));
    *place = (skg_image_place){.memory = layers->images.memory,
                               .output_double = image->output_double,
                               .row_stride = columns,
                               .channel_stride = rows * columns};
    return SKG_OK;
}

skg_status skg_layers_blur(skg_layers *layers, int32_t used, const skg_image_place *place,
                           const skg_image_place *image, int64_t columns, int64_t rows, int64_t channels,
                           skg_stage_log *log) {
    skg_image_place from = *place, to = *image;
    for (int32_t l = 0; l < used; l++) {
        from.offset = place->offset + l * channels * place->channel_stride;
        to.add = l > 0;
        SKG_TRY(skg_blur_run(layers->blurs[l], &from, &to, columns, rows, channels, log));
    }
    return SKG_OK;
}

skg_status skg_layers_blur_variance(skg_layers *layers, int32_t used, int32_t apart,
                                    const skg_image_place *place, const skg_image_place *image,
                                    int64_t columns, int64_t rows, int64_t channels, skg_stage_log *log) {
    skg_image_place from = *place, to = *image;
    for (int32_t l = 0; l < used; l++) {
        skg_blur *blur = layers->blurs[apart ? layers->count - 1 : l];
        from.offset = place->offset + l * channels * place->channel_stride;
        to.add = l > 0;
        SKG_TRY(skg_blur_run_variance(blur, &from, &to, columns, rows, channels, log));
    }
    return SKG_OK;
}
