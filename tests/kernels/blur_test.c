/* Blur against the sum that defines it, in double. */
#include "stage/readout.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { COLUMNS = 83, ROWS = 37, CHANNELS = 2, SAMPLES = 31 };

static skg_context *context;

static void open_context(void) {
    ck_skg(skg_context_create(NULL, &context));
}

static void close_context(void) {
    skg_context_release(&context);
}

/* An image on the device that stands `offset` into its buffer, its rows and channels apart. */
typedef struct {
    int64_t columns, rows, row_stride, channel_stride, offset, count;
    double *values; /* [count] */
} picture;

static picture make_picture(int64_t columns, int64_t rows, int64_t spare) {
    picture p = {.columns = columns, .rows = rows, .row_stride = columns + spare, .offset = 3 * spare};
    p.channel_stride = p.row_stride * (rows + spare);
    p.count = p.offset + CHANNELS * p.channel_stride;
    p.values = malloc((size_t)p.count * sizeof *p.values);
    ck_assert_ptr_nonnull(p.values);
    uint32_t state = 12345;
    for (int64_t i = 0; i < p.count; i++) {
        state = state * 1664525 + 1013904223;
        p.values[i] = (double)(float)(state >> 8) * 0x1p-24;
    }
    return p;
}

static double *pixel(const picture *p, int64_t channel, int64_t row, int64_t column) {
    return p->values + p->offset + channel * p->channel_stride + row * p->row_stride + column;
}

/* Blurs a copy of the picture in its place on the device. */
static picture blurred(const picture *of, const skg_detector_blur *shape, int is_double) {
    const size_t element = is_double ? sizeof(double) : sizeof(float), bytes = (size_t)of->count * element;
    picture result = *of;
    result.values = malloc((size_t)of->count * sizeof *result.values);
    float *singles = malloc((size_t)of->count * sizeof *singles);
    ck_assert(result.values != NULL && singles != NULL);
    for (int64_t i = 0; i < of->count; i++) singles[i] = (float)of->values[i];
    skg_blur *blur = NULL;
    skg_buffer buffer = {0};
    ck_skg(skg_blur_create(context, shape, &blur));
    ck_skg(skg_buffer_reserve(context, &buffer, (int64_t)bytes, CL_MEM_READ_WRITE, "test"));
    const cl_command_queue queue = context->device->queue;
    ck_assert_int_eq(clEnqueueWriteBuffer(queue, buffer.memory, CL_TRUE, 0, bytes,
                                          is_double ? (const void *)of->values : singles, 0, NULL, NULL),
                     CL_SUCCESS);
    const skg_image_place place = {.memory = buffer.memory,
                                   .output_double = is_double,
                                   .offset = of->offset,
                                   .row_stride = of->row_stride,
                                   .channel_stride = of->channel_stride};
    ck_skg(skg_blur_run(blur, &place, &place, of->columns, of->rows, CHANNELS, NULL));
    ck_assert_int_eq(clEnqueueReadBuffer(queue, buffer.memory, CL_TRUE, 0, bytes,
                                         is_double ? (void *)result.values : singles, 0, NULL, NULL),
                     CL_SUCCESS);
    for (int64_t i = 0; i < of->count && !is_double; i++) result.values[i] = (double)singles[i];
    skg_buffer_release(&buffer);
    skg_blur_release(&blur);
    free(singles);
    return result;
}

static int64_t within(int64_t index, int64_t count) {
    return index < 0 ? 0 : index >= count ? count - 1 : index;
}

static double sample_of(const skg_detector_blur *shape, int64_t row, int64_t column) {
    return shape->point ? shape->point[row * shape->columns + column]
                        : shape->along_row[column] * shape->along_column[row];
}

static double convolved(const picture *p, const skg_detector_blur *shape, int64_t channel, int64_t row,
                        int64_t column) {
    double sum = 0, all = 0;
    for (int64_t j = 0; j < shape->rows; j++)
        for (int64_t i = 0; i < shape->columns; i++) {
            const double sample = sample_of(shape, j, i);
            all += sample;
            sum += sample * *pixel(p, channel, within(row - (j - shape->rows / 2), p->rows),
                                   within(column - (i - shape->columns / 2), p->columns));
        }
    return sum / all;
}

/* Every pixel as the sum says; nothing else is written. */
static void check_against_sum(const skg_detector_blur *shape, int64_t columns, int64_t rows, int is_double) {
    const picture before = make_picture(columns, rows, 5), after = blurred(&before, shape, is_double);
    /* Values up to 1; roundings of two passes of some 30 terms each. */
    const double tolerance = is_double ? 40 * 1.2e-16 : 40 * 6e-8;
    int64_t next = 0;
    for (int64_t c = 0; c < CHANNELS; c++)
        for (int64_t j = 0; j < rows; j++) {
            const int64_t first = pixel(&after, c, j, 0) - after.values;
            for (; next < first; next++) ck_assert_double_eq(after.values[next], before.values[next]);
            for (int64_t i = 0; i < columns; i++, next++)
                ck_assert_double_eq_tol(after.values[next], convolved(&before, shape, c, j, i), tolerance);
        }
    for (; next < before.count; next++) ck_assert_double_eq(after.values[next], before.values[next]);
    free(before.values);
    free(after.values);
}

/* Lopsided, so that a function turned round would show. */
static void fill(int64_t count, double *samples) {
    for (int64_t i = 0; i < count; i++) samples[i] = 1.0 / (double)(1 + (i * 7) % 13) + (double)i * 0.01;
}

static void check_lines(int64_t columns, int64_t rows, int is_double) {
    double along_row[SAMPLES], along_column[SAMPLES];
    skg_detector_blur shape;
    skg_detector_blur_init(&shape);
    fill(SAMPLES, along_row);
    fill(7, along_column);
    shape.columns = SAMPLES, shape.along_row = along_row;
    shape.rows = 7, shape.along_column = along_column;
    check_against_sum(&shape, columns, rows, is_double);
}

START_TEST(line_spread_single) {
    check_lines(COLUMNS, ROWS, 0);
    check_lines(64, 16, 0);
    check_lines(1, 1, 0); /* smaller than the function */
}
END_TEST

START_TEST(line_spread_double) {
    if (!context->device->info.double_precision) return;
    check_lines(COLUMNS, ROWS, 1);
}
END_TEST

START_TEST(point_spread) {
    double samples[9 * 5];
    skg_detector_blur shape;
    skg_detector_blur_init(&shape);
    fill(9 * 5, samples);
    shape.columns = 9, shape.rows = 5, shape.point = samples;
    check_against_sum(&shape, COLUMNS, ROWS, 0);
    check_against_sum(&shape, 3, 40, 0);
    if (context->device->info.double_precision) check_against_sum(&shape, COLUMNS, ROWS, 1);
}
END_TEST

/* The open field continues beyond the border: a uniform image stays as it is, and a step at a row's end is
 * blurred by what lies inside alone. */
START_TEST(border) {
    const double box[5] = {1, 1, 1, 1, 1}, one = 1;
    const skg_detector_blur shape = {
        .size = sizeof shape, .columns = 5, .rows = 1, .along_row = box, .along_column = &one};
    picture p = make_picture(COLUMNS, ROWS, 0);
    for (int64_t i = 0; i < p.count; i++) p.values[i] = 12345;
    picture after = blurred(&p, &shape, 0);
    /* five fifths of 12345, each rounded */
    for (int64_t i = 0; i < p.count; i++)
        ck_assert_double_eq_tol(after.values[i], 12345, 2 * (double)FLT_EPSILON * 12345);
    free(after.values);
    *pixel(&p, 0, 4, 0) = 12345 + 5;
    after = blurred(&p, &shape, 0);
    ck_assert_double_eq_tol(*pixel(&after, 0, 4, 0), 12345 + 3,
                            2 * (double)FLT_EPSILON * 12345); /* itself and twice beyond */
    ck_assert_double_eq_tol(*pixel(&after, 0, 4, 1), 12345 + 2, 2 * (double)FLT_EPSILON * 12345);
    ck_assert_double_eq_tol(*pixel(&after, 0, 4, 2), 12345 + 1, 2 * (double)FLT_EPSILON * 12345);
    ck_assert_double_eq_tol(*pixel(&after, 0, 4, 3), 12345, 2 * (double)FLT_EPSILON * 12345);
    free(after.values);
    free(p.values);
}
END_TEST

/* Area of the disc of radius 1 about the origin left of x, over pi. */
static double left_of(double x) {
    return x <= -1 ? 0 : x >= 1 ? 1 : 0.5 + (x * sqrt(1 - x * x) + asin(x)) / acos(-1);
}

/* An edge behind a disc-shaped point spread function: the share of the disc on the bright side. */
START_TEST(disc) {
    enum { RADIUS = 12, SIDE = 2 * RADIUS + 3, FINE = 40 };
    static double samples[SIDE * SIDE];
    for (int j = 0; j < SIDE * FINE; j++)
        for (int i = 0; i < SIDE * FINE; i++) {
            const double x = (i + 0.5) / FINE - SIDE / 2.0, y = (j + 0.5) / FINE - SIDE / 2.0;
            samples[j / FINE * SIDE + i / FINE] += x * x + y * y < RADIUS * RADIUS;
        }
    const skg_detector_blur shape = {.size = sizeof shape, .columns = SIDE, .rows = SIDE, .point = samples};
    const picture p = make_picture(COLUMNS, ROWS, 0);
    for (int64_t i = 0; i < p.count; i++) p.values[i] = i % COLUMNS >= COLUMNS / 2 ? 1000 : 0;
    const picture after = blurred(&p, &shape, 0);
    /* The edge lies between pixels COLUMNS / 2 - 1 and COLUMNS / 2; of the disc, pixels FINE times finer. */
    for (int i = 0; i < COLUMNS; i++)
        ck_assert_double_eq_tol(*pixel(&after, 1, ROWS / 2, i),
                                1000 * left_of((i - COLUMNS / 2 + 0.5) / RADIUS), 1000.0 / FINE / RADIUS / 4);
    free(after.values);
    free(p.values);
}
END_TEST

START_TEST(refused) {
    double samples[4] = {1, 2, 1, 0};
    skg_detector_blur shape;
    skg_blur *blur = NULL;
    skg_detector_blur_init(&shape);
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "0 samples; give at least one");
    shape.along_row = shape.along_column = samples;
    shape.columns = 3, shape.rows = 4;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "half a pixel");
    shape.rows = 3, samples[1] = -2;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "sum to 0");
    samples[1] = (double)NAN;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "sample 1");
    samples[1] = 2, shape.along_column = NULL;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT,
                 "along the columns has no samples");
    shape.point = samples;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "give one kind");
    shape.along_row = NULL, shape.columns = 4097;
    ck_skg_fails(skg_blur_create(context, &shape, &blur), SKG_ERR_ARGUMENT, "at most 4095");
    ck_assert_ptr_null(blur);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_context, close_context);
    tcase_add_test(tests, line_spread_single);
    tcase_add_test(tests, line_spread_double);
    tcase_add_test(tests, point_spread);
    tcase_add_test(tests, border);
    tcase_add_test(tests, disc);
    tcase_add_test(tests, refused);
}

SKG_SUITE_MAIN("blur", add_tests)
