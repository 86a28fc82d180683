/* Packs images into numbers of 16 bits. This file is compiled for vectors: a frame of 512 x 512 pixels passes through it each time. */
#include "live/plans.h"

#include "core/text.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LANES = 8 };

/* Bounds of the values so far, in lanes, which compilers turn into vectors. */
typedef struct {
    float low[LANES], high[LANES];
    float beyond[LANES]; /* 0: all are finite */
} range;

static void widen(range *of, int k, float value) {
    const int is_finite = fabsf(value) <= FLT_MAX;
    const float least = is_finite ? value : INFINITY, most = is_finite ? value : -INFINITY;
    of->low[k] = least < of->low[k] ? least : of->low[k];
    of->high[k] = most > of->high[k] ? most : of->high[k];
    of->beyond[k] += is_finite ? 0.0F : 1.0F;
}

/* The least and the largest finite value; both 0 if there is none. Returns whether all are finite. */
static int find_range(const float *values, int64_t count, float *low, float *high) {
    const int64_t whole = count / LANES * LANES;
    range of;
    for (int k = 0; k < LANES; k++) of.low[k] = INFINITY, of.high[k] = -INFINITY, of.beyond[k] = 0;
    for (int64_t i = 0; i < whole; i += LANES)
        for (int k = 0; k < LANES; k++) widen(&of, k, values[i + k]);
    for (int64_t i = whole; i < count; i++) widen(&of, 0, values[i]);
    for (int k = 1; k < LANES; k++) {
        of.low[0] = of.low[k] < of.low[0] ? of.low[k] : of.low[0];
        of.high[0] = of.high[k] > of.high[0] ? of.high[k] : of.high[0];
        of.beyond[0] += of.beyond[k];
    }
    const int is_empty = !(of.low[0] <= of.high[0]);
    *low = is_empty ? 0 : of.low[0], *high = is_empty ? 0 : of.high[0];
    return of.beyond[0] == 0;
}

/* Writes (value - low) / step, rounded, from 0 to 65535; what is no number as 65535. step: 0: all are written as 0, but what is no
 * number or larger. */
static void write_numbers(const float *values, int64_t count, float low, double step, uint16_t *numbers) {
    const float scale = step > 0 ? (float)(1 / step) : 0;
    for (int64_t i = 0; i < count; i++) {
        float number = (values[i] - low) * scale + 0.5F;
        number = number <= UINT16_MAX ? number : UINT16_MAX;
        number = number > 0 ? number : 0;
        numbers[i] = (uint16_t)(int32_t)number;
    }
}

skg_status skg_live_pack(const float *values, skg_live_header *header, skg_live_letter **letter) {
    const int64_t count = (int64_t)header->columns * header->rows;
    unsigned char *bytes = NULL;
    float low, high;
    if (!find_range(values, count, &low, &high)) header->notes |= SKG_LIVE_INFINITE;
    header->low = (double)low;
    header->step = ((double)high - (double)low) / UINT16_MAX;
    SKG_TRY(
        skg_live_bytes_letter((int64_t)sizeof *header + count * (int64_t)sizeof(uint16_t), letter, &bytes));
    write_numbers(values, count, low, header->step, (uint16_t *)(void *)(bytes + sizeof *header));
    memcpy(bytes, header, sizeof *header);
    return SKG_OK;
}

skg_status skg_live_frame_write(const skg_live_plans *plans, int64_t number, skg_live_letter **letter) {
    SKG_PLAIN;
    SKG_NEEDS(plans);
    SKG_NEEDS(letter);
    *letter = NULL;
    if (!plans->is_shown) return skg_fail(SKG_ERR_ARGUMENT, "live: there is no image to write");
    skg_live_header header = plans->header;
    header.number = (uint32_t)number;
    return skg_live_pack(plans->values + plans->shown_channel * plans->shown.columns * plans->shown.rows,
                         &header, letter);
}

skg_status skg_live_image_write(const char *mark, int64_t columns, int64_t rows, int32_t quantity,
                                double flat_field, const float *values, skg_live_letter **letter) {
    SKG_PLAIN;
    SKG_NEEDS(mark);
    SKG_NEEDS(values);
    SKG_NEEDS(letter);
    *letter = NULL;
    if (strlen(mark) != 4 || columns < 1 || rows < 1 || columns > UINT16_MAX || rows > UINT16_MAX)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "live: an image for pages has a mark of 4 characters, and 1 to %d columns and rows",
                        UINT16_MAX);
    skg_live_header header = {.columns = (uint16_t)columns,
                              .rows = (uint16_t)rows,
                              .flat_field = flat_field,
                              .factor = 1,
                              .quantity = (uint8_t)quantity};
    memcpy(header.mark, mark, sizeof header.mark);
    return skg_live_pack(values, &header, letter);
}
