/* The tables of an attenuation on the device. */
#include "stage/attenuation.h"

skg_status skg_attenuation_upload(skg_context *context, int32_t is_double, int64_t count,
                                  const double *numbers, skg_buffer *buffer) {
    if (is_double)
        return skg_buffer_write(context, buffer, count * (int64_t)sizeof *numbers, numbers, "attenuation");
    float *rounded = NULL;
    SKG_TRY(skg_alloc(count, sizeof *rounded, "attenuation", &rounded));
    for (int64_t i = 0; i < count; i++) rounded[i] = (float)numbers[i];
    skg_status status =
        skg_buffer_write(context, buffer, count * (int64_t)sizeof *rounded, rounded, "attenuation");
    skg_free(&rounded);
    return status;
}

static skg_status upload_shades(skg_context *context, int32_t is_double, skg_attenuation *attenuation) {
    const skg_shades *shades = attenuation->shades;
    if (skg_attenuation_shades(attenuation) == 0) return SKG_OK;
    const int64_t polynomials = shades->heel + shades->oblique;
    if (polynomials)
        SKG_TRY(skg_attenuation_upload(context, is_double, polynomials * SKG_SHADE_TERMS,
                                       shades->polynomials[0], &attenuation->polynomials));
    if (shades->table_count == 0) return SKG_OK;
    return skg_attenuation_upload(context, is_double, shades->table_count, shades->tables,
                                  &attenuation->tables);
}

skg_status skg_attenuation_create(skg_context *context, int32_t precision, const skg_attenuation *shape,
                                  const skg_attenuation_tables *tables, skg_attenuation *attenuation) {
    const int32_t is_double = precision == SKG_PRECISION_DOUBLE;
    const int64_t count = (int64_t)shape->nodes * shape->planes;
    double *scaled = NULL;
    SKG_TRY(skg_alloc(count, sizeof *scaled, "attenuation", &scaled));
    /* The kernel takes powers of two: exp(-x) = 2^(-x log2 e). */
    for (int64_t i = 0; i < count; i++)
        scaled[i] = tables->coefficients[i] * (shape->shown == SKG_SHOW_EXPONENT ? 1 : -SKG_LOG2_E);
    *attenuation = *shape;
    skg_status status = skg_attenuation_upload(context, is_double, count, scaled, &attenuation->coefficients);
    skg_free(&scaled);
    SKG_TRY(status);
    const int64_t weighted = (int64_t)shape->nodes * shape->channels;
    if (shape->noise)
        SKG_TRY(
            skg_attenuation_upload(context, is_double, weighted, tables->variances, &attenuation->variances));
    SKG_TRY(upload_shades(context, is_double, attenuation));
    if (tables->range)
        SKG_TRY(skg_attenuation_upload(context, is_double, 2 * (int64_t)shape->planes, tables->range,
                                       &attenuation->range));
    return skg_attenuation_upload(context, is_double, weighted, tables->weights, &attenuation->weights);
}

void skg_attenuation_release(skg_attenuation *attenuation) {
    skg_buffer_release(&attenuation->coefficients);
    skg_buffer_release(&attenuation->weights);
    skg_buffer_release(&attenuation->variances);
    skg_buffer_release(&attenuation->range);
    skg_buffer_release(&attenuation->polynomials);
    skg_buffer_release(&attenuation->tables);
}

int64_t skg_attenuation_bytes(const skg_attenuation *attenuation) {
    return attenuation->coefficients.bytes + attenuation->weights.bytes + attenuation->variances.bytes +
           attenuation->range.bytes + attenuation->polynomials.bytes + attenuation->tables.bytes;
}
