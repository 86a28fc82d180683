/* Pictures of a radiograph and of what the model makes of it, as PNG. */
#include "register/work.h"

#include "common/say.h"
#include "map/surface_png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Colours that colour-blind readers can distinguish (Okabe and Ito): start, end. */
static const double start_colour[3] = {0.34, 0.71, 0.91}, end_colour[3] = {0.90, 0.62, 0};

static int by_value(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The values below and above which half a percent lies. */
static int find_window(int64_t count, const double *values, double *low, double *high) {
    double *sorted = malloc((size_t)count * sizeof *sorted);
    if (!sorted) return cli_error(CLI_DEVICE, "out of host memory for the page");
    memcpy(sorted, values, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, by_value);
    *low = sorted[count / 200], *high = sorted[count - 1 - count / 200];
    if (!(*high > *low)) *high = *low + 1;
    free(sorted);
    return CLI_DONE;
}

static int grey_png(const skg_view *view, const double *values, double low, double high, register_png *out) {
    const int64_t count = view->rows * view->columns;
    unsigned char *greys = malloc((size_t)count);
    if (!greys) return cli_error(CLI_DEVICE, "out of host memory for the page");
    for (int64_t p = 0; p < count; p++)
        greys[p] = (unsigned char)lround(255 * fmin(fmax((values[p] - low) / (high - low), 0), 1));
    const int exit_status =
        cli_png_of_greys((int)view->columns, (int)view->rows, greys, &out->png, &out->size);
    free(greys);
    return exit_status;
}

/* Sets a pixel of a surface with alpha, which Cairo multiplies with. */
static void set_pixel(cairo_surface_t *surface, int64_t row, int64_t column, const double *colour,
                      double alpha) {
    uint32_t *line = (uint32_t *)(void *)(cairo_image_surface_get_data(surface) +
                                          row * cairo_image_surface_get_stride(surface));
    uint32_t pixel = (uint32_t)lround(255 * alpha) << 24;
    for (int k = 0; k < 3; k++) pixel |= (uint32_t)lround(255 * alpha * colour[k]) << (16 - 8 * k);
    line[column] = pixel;
}

static int finish(cairo_surface_t *surface, register_png *out) {
    cairo_surface_mark_dirty(surface);
    const int exit_status = cli_png_of_surface(surface, &out->png, &out->size);
    cairo_surface_destroy(surface);
    return exit_status;
}

static cairo_surface_t *make_surface(const skg_view *view) {
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)view->columns, (int)view->rows);
    cairo_surface_flush(surface);
    return surface;
}

/* Whether a pixel of a shadow has a neighbour outside of it. */
static int is_edge(const skg_view *view, const double *shadow, int64_t row, int64_t column) {
    static const int64_t dy[4] = {0, 0, 1, -1}, dx[4] = {1, -1, 0, 0};
    if (!(shadow[row * view->columns + column] > 0)) return 0;
    for (int k = 0; k < 4; k++) {
        const int64_t y = row + dy[k], x = column + dx[k];
        if (y < 0 || y >= view->rows || x < 0 || x >= view->columns) continue;
        if (!(shadow[y * view->columns + x] > 0)) return 1;
    }
    return 0;
}

static int contour_png(const skg_view *view, const double *start, const double *end, register_png *out) {
    cairo_surface_t *surface = make_surface(view);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return cli_error(CLI_DEVICE, "out of host memory for the page");
    for (int64_t row = 0; row < view->rows; row++)
        for (int64_t column = 0; column < view->columns; column++) {
            if (is_edge(view, start, row, column)) set_pixel(surface, row, column, start_colour, 0.8);
            if (is_edge(view, end, row, column)) set_pixel(surface, row, column, end_colour, 1);
        }
    return finish(surface, out);
}

/* Blue where the model attenuates less than the radiograph, red where more, clear where they agree. */
static int difference_png(const skg_view *view, const double *values, double most, register_png *out) {
    out->most = most;
    static const double less[3] = {0.02, 0.19, 0.56}, more[3] = {0.65, 0.06, 0.12};
    cairo_surface_t *surface = make_surface(view);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return cli_error(CLI_DEVICE, "out of host memory for the page");
    for (int64_t p = 0; p < view->rows * view->columns; p++) {
        const double share = fmin(fabs(values[p]) / most, 1);
        set_pixel(surface, p / view->columns, p % view->columns, values[p] < 0 ? less : more, share);
    }
    return finish(surface, out);
}

/* On a scale of its own; nothing, if no pixel has any. */
static int structure_png(const skg_view *view, const double *values, register_png *out) {
    double most = 0;
    for (int64_t p = 0; p < view->rows * view->columns; p++) most = fmax(most, fabs(values[p]));
    return most > 0 ? difference_png(view, values, most, out) : CLI_DONE;
}

static int get(const register_work *work, int64_t image, int32_t which, double *values) {
    const skg_status status = skg_registration_picture_get(work->last, image, which, values);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* a, b: [rows][columns], scratch. */
static int make(const register_work *work, int64_t image, double *a, double *b, register_png *pictures) {
    const skg_view *view = &work->images[image].view;
    const int64_t count = view->rows * view->columns;
    double low = 0, high = 1, most = 0, unused;
    int exit_status = get(work, image, SKG_REGISTRATION_PICTURE_FIXED, a);
    if (exit_status == CLI_DONE) exit_status = find_window(count, a, &low, &high);
    if (exit_status == CLI_DONE) exit_status = grey_png(view, a, low, high, &pictures[REGISTER_FIXED]);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_MODEL, a);
    if (exit_status == CLI_DONE) exit_status = grey_png(view, a, low, high, &pictures[REGISTER_MODEL]);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_SHADOW_BEFORE, a);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_SHADOW_AFTER, b);
    if (exit_status == CLI_DONE) exit_status = contour_png(view, a, b, &pictures[REGISTER_CONTOUR]);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_BEFORE, a);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_AFTER, b);
    for (int64_t p = 0; p < count; p++) a[p] = fabs(a[p]);
    if (exit_status == CLI_DONE) exit_status = find_window(count, a, &unused, &most); /* one scale for both */
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_BEFORE, a);
    if (exit_status == CLI_DONE) exit_status = difference_png(view, a, most, &pictures[REGISTER_BEFORE]);
    if (exit_status == CLI_DONE) exit_status = difference_png(view, b, most, &pictures[REGISTER_AFTER]);
    if (exit_status == CLI_DONE) exit_status = get(work, image, SKG_REGISTRATION_PICTURE_STRUCTURE, a);
    if (exit_status == CLI_DONE) exit_status = structure_png(view, a, &pictures[REGISTER_STRUCTURE]);
    return exit_status;
}

int register_pictures(const register_work *work, int64_t image, register_png pictures[REGISTER_PICTURES]) {
    const size_t count = (size_t)(work->images[image].view.rows * work->images[image].view.columns);
    double *a = calloc(count, sizeof *a), *b = calloc(count, sizeof *b);
    const int exit_status =
        a && b ? make(work, image, a, b, pictures) : cli_error(CLI_DEVICE, "out of host memory for the page");
    free(a);
    free(b);
    return exit_status;
}
