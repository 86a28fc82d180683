/* Names of parts beside the 3D view, with their lines. */
#include "view/picture.h"

#include "common/say.h"
#include "core/maths.h"
#include "map/surface_png.h"

#include <cairo.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Canvas of the labels. */
typedef struct {
    cairo_t *cairo;
    double text; /* height of the text, pixels */
    double columns, rows;
} sheet;

/* Text with a light rim, so that it can be read over anything. */
static void write_text(const sheet *s, double x, double y, const char *text) {
    cairo_move_to(s->cairo, x, y);
    cairo_text_path(s->cairo, text);
    cairo_set_source_rgba(s->cairo, 0.957, 0.961, 0.969, 0.85);
    cairo_set_line_width(s->cairo, 0.3 * s->text);
    cairo_set_line_join(s->cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke_preserve(s->cairo);
    cairo_set_source_rgb(s->cairo, 0.1, 0.11, 0.13);
    cairo_fill(s->cairo);
}

static double text_width(const sheet *s, const char *text) {
    cairo_text_extents_t size;
    cairo_text_extents(s->cairo, text, &size);
    return size.x_advance;
}

static int by_row(const void *a, const void *b) {
    const view_part *const *above = a, *const *below = b;
    return (*above)->dot[1] > (*below)->dot[1] ? 1 : -((*above)->dot[1] < (*below)->dot[1]);
}

/* On which side of the line from a to b a point lies. */
static double side_of(const double a[2], const double b[2], const double point[2]) {
    return (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
}

/* Whether the lines from two names to the dots of these parts cross. */
static int is_crossed(const double names[2][2], const view_part *a, const view_part *b) {
    return side_of(names[0], a->dot, names[1]) * side_of(names[0], a->dot, b->dot) < 0 &&
           side_of(names[1], b->dot, names[0]) * side_of(names[1], b->dot, a->dot) < 0;
}

/* Parts whose lines cross change places. Their lines are shorter together then, so that this ends. y: of the names. */
static void uncross(const view_part **parts, int count, double x, const double *y) {
    for (int is_changed = 1; is_changed;) {
        is_changed = 0;
        for (int j = 1; j < count; j++)
            for (int i = 0; i < j; i++) {
                const double names[2][2] = {{x, y[i]}, {x, y[j]}};
                if (!is_crossed(names, parts[i], parts[j])) continue;
                const view_part *other = parts[i];
                parts[i] = parts[j], parts[j] = other;
                is_changed = 1;
            }
    }
}

/* A name with a line to the dot of its part. */
static void name_part(const sheet *s, const view_part *part, double begin, double end, double y) {
    cairo_set_source_rgba(s->cairo, 0.25, 0.27, 0.3, 0.6);
    cairo_set_line_width(s->cairo, fmax(1, s->text / 16));
    cairo_move_to(s->cairo, end, y);
    cairo_line_to(s->cairo, part->dot[0] + 0.5, part->dot[1] + 0.5);
    cairo_stroke(s->cairo);
    cairo_arc(s->cairo, part->dot[0] + 0.5, part->dot[1] + 0.5, s->text / 6, 0, 7);
    cairo_fill(s->cairo);
    write_text(s, begin, y + 0.35 * s->text, part->label);
}

/* Names in a column beside the parts, each with a line to its part. x: where the names end on the left side, and where they
 * begin on the right. y: room for count. */
static void name_side(const sheet *s, const view_part **parts, int count, int is_right, double x, double *y) {
    const double line = 1.5 * s->text, low = 1.5 * line, high = s->rows - 2.5 * line;
    double least = low;
    for (int i = 0; i < count; i++) {
        /* near its part, but the names after it need room as well */
        y[i] = fmin(fmax(parts[i]->dot[1], least), high - (count - 1 - i) * line);
        least = y[i] + line;
    }
    uncross(parts, count, x, y);
    for (int i = 0; i < count; i++) {
        const double width = text_width(s, parts[i]->label);
        const double begin =
            is_right ? fmin(x, s->columns - width - 0.5 * s->text) : fmax(x - width, 0.5 * s->text);
        name_part(s, parts[i], begin, is_right ? begin - 0.4 * s->text : begin + width + 0.4 * s->text, y[i]);
    }
}

/* The least and the greatest column of the detector in the picture. */
static void find_detector(const cli_session *session, const skg_look *look, double low_high[2]) {
    double corners[4][3], seen[4][2];
    low_high[0] = HUGE_VAL, low_high[1] = -HUGE_VAL;
    if (skg_collimation_corners_get(NULL, &session->view, 0, corners[0]) != SKG_OK ||
        skg_scene_places_get(session->scene, &session->view, look, 4, corners[0], seen[0]) != SKG_OK)
        return;
    for (int i = 0; i < 4; i++)
        low_high[0] = fmin(low_high[0], seen[i][0]), low_high[1] = fmax(low_high[1], seen[i][0]);
}

/* Where a column of names of this width stands: beside the parts, or beyond the detector if it would cover that. NaN: there is
 * no room beyond it. */
static double find_column(const sheet *s, int is_right, double beside, double width,
                          const double detector[2]) {
    const double low = is_right ? beside : beside - width, high = is_right ? beside + width : beside;
    const double gap = 2 * s->text;
    if (high < detector[0] || low > detector[1]) return beside;
    if (is_right) return detector[1] + gap + width < s->columns ? detector[1] + gap : (double)NAN;
    return detector[0] - gap - width > 0 ? detector[0] - gap : (double)NAN;
}

static double widest_name(const sheet *s, const view_places *places) {
    double width = 0;
    for (int64_t i = 0; i < places->named_count; i++)
        width = fmax(width, text_width(s, places->named[i]->label));
    return width;
}

/* Returns how many parts are named. */
static int64_t name_parts(const sheet *s, const cli_session *session, const skg_look *look,
                          const view_places *places) {
    const int capacity = (int)((s->rows - 6 * s->text) / (1.5 * s->text));
    const size_t named = (size_t)places->named_count;
    const view_part **sides = calloc(2 * named + 1, sizeof *sides);
    double *y = calloc(named + 1, sizeof *y);
    double middle = 0, left = HUGE_VAL, right = -HUGE_VAL, detector[2], beside[2], x[2];
    int count[2] = {0, 0};
    if (!sides || !y) {
        free(sides);
        free(y);
        return 0;
    }
    for (size_t i = 0; i < named; i++) {
        middle += places->named[i]->dot[0] / (double)named;
        left = fmin(left, places->named[i]->low_column), right = fmax(right, places->named[i]->high_column);
    }
    find_detector(session, look, detector);
    for (int side = 0; side < 2; side++) {
        beside[side] = side ? right + 2 * s->text : left - 2 * s->text;
        x[side] = find_column(s, side, beside[side], widest_name(s, places), detector);
    }
    if (isnan(x[0]) && isnan(x[1])) memcpy(x, beside, sizeof x);
    for (size_t i = 0; i < named; i++) {
        const int wanted = places->named[i]->dot[0] > middle, side = isnan(x[wanted]) ? !wanted : wanted;
        if (count[side] < capacity) sides[side * (int)named + count[side]++] = places->named[i];
    }
    for (int side = 0; side < 2; side++) {
        qsort(sides + side * (int)named, (size_t)count[side], sizeof *sides, by_row);
        name_side(s, sides + side * (int)named, count[side], side, x[side], y);
    }
    free(sides);
    free(y);
    return count[0] + count[1];
}

static void name_point(const sheet *s, const cli_session *session, const skg_look *look,
                       const double point[3], const char *name) {
    double at[2];
    if (skg_scene_places_get(session->scene, &session->view, look, 1, point, at) != SKG_OK) return;
    const double width = text_width(s, name);
    write_text(s, fmin(fmax(at[0] + 0.8 * s->text, 0), s->columns - width - 2),
               fmax(at[1] - 0.5 * s->text, s->text), name);
}

static void name_markers(const sheet *s, const cli_session *session, const skg_look *look,
                         const view_places *places) {
    static const char *const axes[3] = {"x", "y", "z"};
    const skg_view *view = &session->view;
    double at[3], length = 0;
    view_source(view, places, at);
    name_point(s, session, look, at, view->projection == SKG_PROJECTION_POINT ? "source" : "parallel beam");
    skg_add_scaled(view->centre, -0.5 * (double)view->rows, view->row_step, at);
    name_point(s, session, look, at, "detector");
    for (int k = 0; k < 3; k++) length = fmax(length, places->high[k] - places->low[k]);
    for (int k = 0; k < 3; k++) {
        memcpy(at, places->low, sizeof at);
        at[k] += 0.2 * length;
        name_point(s, session, look, at, axes[k]);
    }
}

static void write_caption(const sheet *s, const cli_session *session, const view_places *places,
                          int64_t named) {
    const skg_view *view = &session->view;
    const double width = skg_length(view->column_step), height = skg_length(view->row_step);
    char text[512], *at = text;
    char *const end = text + sizeof text;
    if (!isnan(places->source_detector))
        at += snprintf(at, (size_t)(end - at),
                       "source to detector %.4g mm, to the centre of the parts %.4g mm; ",
                       places->source_detector, places->source_object);
    at += snprintf(at, (size_t)(end - at),
                   "magnification %.4g; detector %.4g x %.4g mm, %" PRId64 " x %" PRId64 " pixels",
                   places->magnification, width * (double)view->columns, height * (double)view->rows,
                   view->columns, view->rows);
    if (named < places->count)
        snprintf(at, (size_t)(end - at), "; %" PRId64 " of %" PRId64 " parts are named", named,
                 places->count);
    cairo_set_font_size(s->cairo, fmin(s->text, s->text * (s->columns - 2 * s->text) / text_width(s, text)));
    write_text(s, s->text, s->rows - s->text, text);
}

/* Cairo's pixels are numbers with red, green and blue from the 24th bit down. */
static void copy_to(cairo_surface_t *surface, const skg_look *look, const uint8_t *rgba) {
    unsigned char *pixels = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    cairo_surface_flush(surface);
    for (int64_t row = 0; row < look->rows; row++)
        for (int64_t column = 0; column < look->columns; column++) {
            const uint8_t *from = rgba + 4 * (row * look->columns + column);
            const uint32_t pixel = (uint32_t)from[0] << 16 | (uint32_t)from[1] << 8 | from[2];
            memcpy(pixels + row * stride + 4 * column, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
}

static void copy_from(cairo_surface_t *surface, const skg_look *look, uint8_t *rgba) {
    const unsigned char *pixels = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int64_t row = 0; row < look->rows; row++)
        for (int64_t column = 0; column < look->columns; column++) {
            uint8_t *to = rgba + 4 * (row * look->columns + column);
            uint32_t pixel;
            memcpy(&pixel, pixels + row * stride + 4 * column, sizeof pixel);
            for (int k = 0; k < 3; k++) to[k] = (uint8_t)(pixel >> 8 * (2 - k));
        }
}

static int fail(cairo_status_t status) {
    return cli_error(CLI_DEVICE, "the picture cannot be drawn: %s",
                     status == CAIRO_STATUS_SUCCESS ? "out of host memory" : cairo_status_to_string(status));
}

/* A surface with the picture, which the caller destroys whatever its status is. */
static cairo_surface_t *make_surface(const skg_look *look, const uint8_t *rgba) {
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)look->columns, (int)look->rows);
    if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) copy_to(surface, look, rgba);
    return surface;
}

int view_label(const cli_session *session, const skg_look *look, const view_places *places, uint8_t *rgba) {
    cairo_surface_t *surface = make_surface(look, rgba);
    cairo_status_t status = cairo_surface_status(surface);
    if (status == CAIRO_STATUS_SUCCESS) {
        sheet s = {
            .cairo = cairo_create(surface), .columns = (double)look->columns, .rows = (double)look->rows};
        s.text = fmax(9, fmin(s.columns / 80, s.rows / 50));
        cairo_select_font_face(s.cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(s.cairo, s.text);
        const int64_t named = name_parts(&s, session, look, places);
        name_markers(&s, session, look, places);
        write_caption(&s, session, places, named);
        status = cairo_status(s.cairo);
        cairo_destroy(s.cairo);
        cairo_surface_flush(surface);
        if (status == CAIRO_STATUS_SUCCESS) copy_from(surface, look, rgba);
    }
    cairo_surface_destroy(surface);
    return status == CAIRO_STATUS_SUCCESS ? CLI_DONE : fail(status);
}

int view_encode(const skg_look *look, const uint8_t *rgba, unsigned char **bytes, size_t *count) {
    cairo_surface_t *surface = make_surface(look, rgba);
    const int exit_status = cli_png_of_surface(surface, bytes, count);
    cairo_surface_destroy(surface);
    return exit_status;
}
