/* The files that `material` and `beam` write: curves against energy as .png or .svg, tables as .csv. */
#include "verbs/plot.h"

#include "common/file.h"
#include "common/say.h"
#include "core/maths.h"

#include <cairo-svg.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 900, HEIGHT = 600, LEFT = 90, RIGHT = 30, TOP = 50, BOTTOM = 70 };

/* Black, then colours that colour-blind readers can distinguish (Okabe and Ito). */
static const double colours[][3] = {
    {0.1, 0.1, 0.1}, {0, 0.45, 0.70}, {0, 0.62, 0.45}, {0.84, 0.37, 0}, {0.80, 0.47, 0.65}};
enum { COLOURS = sizeof colours / sizeof *colours };

typedef struct {
    double low, high; /* values at the two ends */
    double from, to;  /* pixels at the two ends */
    int is_log;
} axis;

static double place(const axis *a, double value) {
    double part =
        a->is_log ? log(value / a->low) / log(a->high / a->low) : (value - a->low) / (a->high - a->low);
    return a->from + part * (a->to - a->from);
}

static int is_drawn(const cli_plot *plot, double x, double y) {
    return isfinite(x) && isfinite(y) && !(plot->is_log && (x <= 0 || y <= 0));
}

/* The ranges of the values that are drawn. A logarithmic y axis shows seven decades at most. */
static void find_axes(const cli_plot *plot, axis *x, axis *y) {
    *x = (axis){HUGE_VAL, -HUGE_VAL, LEFT, WIDTH - RIGHT, plot->is_log};
    *y = (axis){HUGE_VAL, -HUGE_VAL, HEIGHT - BOTTOM, TOP, plot->is_log};
    for (int c = 0; c < plot->count; c++)
        for (int64_t i = 0; i < plot->curves[c].count; i++) {
            double u = plot->curves[c].x[i], v = plot->curves[c].y[i];
            if (!is_drawn(plot, u, v)) continue;
            x->low = fmin(x->low, u), x->high = fmax(x->high, u);
            y->low = fmin(y->low, v), y->high = fmax(y->high, v);
        }
    if (!(x->low < x->high)) x->low = 1, x->high = 10;
    if (plot->is_log) {
        if (!(y->low <= y->high)) y->low = y->high = 1;
        y->low = fmax(y->low, 1e-7 * y->high) / 1.3, y->high *= 1.3;
    } else {
        y->low = 0, y->high = y->high > 0 ? 1.05 * y->high : 1;
    }
}

/* 1, 2 or 5 times a power of ten, such that about `wanted` steps fill the range. */
static double tick_step(double range, int wanted) {
    double rough = range / wanted, power = pow(10, floor(log10(rough))), part = rough / power;
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

static void write_centred(cairo_t *cairo, double x, double y, const char *text) {
    cairo_text_extents_t size;
    cairo_text_extents(cairo, text, &size);
    cairo_move_to(cairo, x - size.width / 2 - size.x_bearing, y);
    cairo_show_text(cairo, text);
}

/* A grid line at a value, with the number if it is labelled. */
static void draw_tick(cairo_t *cairo, const axis *a, double value, int is_labelled) {
    int is_x = a->from < a->to;
    double at = floor(place(a, value)) + 0.5;
    double grey = is_labelled ? 0.8 : 0.92;
    cairo_set_source_rgb(cairo, grey, grey, grey);
    cairo_set_line_width(cairo, 1);
    cairo_move_to(cairo, is_x ? at : LEFT, is_x ? TOP : at);
    cairo_line_to(cairo, is_x ? at : WIDTH - RIGHT, is_x ? HEIGHT - BOTTOM : at);
    cairo_stroke(cairo);
    if (!is_labelled) return;
    char text[32];
    cairo_text_extents_t size;
    snprintf(text, sizeof text, "%.6g", fabs(value) < 1e-9 * (a->high - a->low) ? 0 : value);
    cairo_text_extents(cairo, text, &size);
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    if (is_x)
        write_centred(cairo, at, HEIGHT - BOTTOM + 20, text);
    else {
        cairo_move_to(cairo, LEFT - 8 - size.x_advance, at + size.height / 2);
        cairo_show_text(cairo, text);
    }
}

static void draw_ticks(cairo_t *cairo, const axis *a) {
    if (!a->is_log) {
        double step = tick_step(a->high - a->low, 8);
        for (double k = ceil(a->low / step - 1e-9); k * step <= a->high * (1 + 1e-9); k++)
            draw_tick(cairo, a, k * step, 1);
        return;
    }
    double decades = log10(a->high / a->low);
    for (int power = (int)floor(log10(a->low)); power <= (int)ceil(log10(a->high)); power++)
        for (int digit = 1; digit < 10; digit++) {
            double value = digit * pow(10, power);
            if (value < a->low * (1 - 1e-9) || value > a->high * (1 + 1e-9)) continue;
            int is_labelled = digit == 1 || (decades < 3.5 && (digit == 2 || digit == 5));
            draw_tick(cairo, a, value, is_labelled);
        }
}

static void draw_frame(cairo_t *cairo, const cli_plot *plot, const axis *x, const axis *y) {
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, 14);
    draw_ticks(cairo, x);
    draw_ticks(cairo, y);
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    cairo_rectangle(cairo, LEFT + 0.5, TOP + 0.5, WIDTH - RIGHT - LEFT, HEIGHT - BOTTOM - TOP);
    cairo_stroke(cairo);
    write_centred(cairo, (LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 22, plot->x_label);
    cairo_save(cairo);
    cairo_translate(cairo, 24, (TOP + HEIGHT - BOTTOM) / 2.0);
    cairo_rotate(cairo, -SKG_PI / 2);
    write_centred(cairo, 0, 0, plot->y_label);
    cairo_restore(cairo);
    cairo_set_font_size(cairo, 16);
    write_centred(cairo, (LEFT + WIDTH - RIGHT) / 2.0, 30, plot->title);
    cairo_set_font_size(cairo, 14);
}

static void use_colour(cairo_t *cairo, int curve) {
    const double *c = colours[curve % COLOURS];
    cairo_set_source_rgb(cairo, c[0], c[1], c[2]);
    cairo_set_line_width(cairo, curve == 0 ? 2.5 : 1.8);
}

static void draw_curve(cairo_t *cairo, const cli_plot *plot, int number, const axis *x, const axis *y) {
    const cli_curve *curve = &plot->curves[number];
    int is_open = 0;
    use_colour(cairo, number);
    cairo_new_path(cairo);
    for (int64_t i = 0; i < curve->count; i++) {
        if (!is_drawn(plot, curve->x[i], curve->y[i])) {
            is_open = 0;
            continue;
        }
        double u = place(x, curve->x[i]), v = place(y, curve->y[i]);
        if (is_open)
            cairo_line_to(cairo, u, v);
        else
            cairo_move_to(cairo, u, v);
        is_open = 1;
    }
    if (plot->is_filled && number == 0) {
        cairo_set_source_rgba(cairo, colours[1][0], colours[1][1], colours[1][2], 0.3);
        cairo_fill_preserve(cairo);
        cairo_set_source_rgb(cairo, colours[1][0], colours[1][1], colours[1][2]);
        cairo_set_line_width(cairo, 1.2);
    }
    cairo_stroke(cairo);
}

/* In the upper right corner, which attenuation curves leave free. */
static void draw_legend(cairo_t *cairo, const cli_plot *plot) {
    enum { LINE = 22, SAMPLE = 30, PAD = 10 };
    double widest = 0;
    for (int c = 0; c < plot->count; c++) {
        cairo_text_extents_t size;
        cairo_text_extents(cairo, plot->curves[c].name, &size);
        widest = fmax(widest, size.x_advance);
    }
    double width = widest + SAMPLE + 3 * PAD, left = WIDTH - RIGHT - PAD - width, top = TOP + PAD;
    cairo_rectangle(cairo, left, top, width, plot->count * LINE + PAD);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_fill_preserve(cairo);
    cairo_set_source_rgb(cairo, 0.7, 0.7, 0.7);
    cairo_set_line_width(cairo, 1);
    cairo_stroke(cairo);
    for (int c = 0; c < plot->count; c++) {
        double y = top + PAD / 2.0 + (c + 0.5) * LINE;
        use_colour(cairo, c);
        cairo_move_to(cairo, left + PAD, y);
        cairo_line_to(cairo, left + PAD + SAMPLE, y);
        cairo_stroke(cairo);
        cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
        cairo_move_to(cairo, left + 2 * PAD + SAMPLE, y + 5);
        cairo_show_text(cairo, plot->curves[c].name);
    }
}

static void draw(cairo_t *cairo, const cli_plot *plot) {
    axis x, y;
    find_axes(plot, &x, &y);
    draw_frame(cairo, plot, &x, &y);
    cairo_save(cairo);
    cairo_rectangle(cairo, LEFT, TOP, WIDTH - RIGHT - LEFT, HEIGHT - BOTTOM - TOP);
    cairo_clip(cairo);
    for (int c = plot->count - 1; c >= 0; c--) draw_curve(cairo, plot, c, &x, &y);
    cairo_restore(cairo);
    if (plot->count > 1) draw_legend(cairo, plot);
}

static cairo_status_t take_bytes(void *stream, const unsigned char *bytes, unsigned int count) {
    return fwrite(bytes, 1, count, stream) == count ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static cairo_status_t render(const cli_plot *plot, int is_svg, FILE *stream) {
    cairo_surface_t *surface = is_svg ? cairo_svg_surface_create_for_stream(take_bytes, stream, WIDTH, HEIGHT)
                                      : cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, HEIGHT);
    cairo_t *cairo = cairo_create(surface);
    draw(cairo, plot);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    if (status == CAIRO_STATUS_SUCCESS && !is_svg)
        status = cairo_surface_write_to_png_stream(surface, take_bytes, stream);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status;
}

static int write_picture(const cli_plot *plot, int is_svg, const char *path) {
    char *bytes = NULL;
    size_t count = 0;
    FILE *stream = open_memstream(&bytes, &count);
    if (!stream) return cli_error(CLI_DEVICE, "out of host memory");
    cairo_status_t status = render(plot, is_svg, stream);
    int failed = fclose(stream) != 0, exit_status;
    if (failed || status != CAIRO_STATUS_SUCCESS)
        exit_status = cli_error(CLI_DEVICE, "%s: the plot cannot be drawn: %s", path,
                                failed ? "out of host memory" : cairo_status_to_string(status));
    else
        exit_status = cli_write_file(path, bytes, count);
    free(bytes);
    return exit_status;
}

int cli_check_plots(const cli_arguments *arguments, int *plots) {
    const char *path;
    *plots = 0;
    for (int i = 0; (path = cli_nth_value(arguments, "-o", i)); i++) {
        int is_plot = cli_has_extension(path, ".png") || cli_has_extension(path, ".svg");
        *plots += is_plot;
        if (!is_plot && !cli_has_extension(path, ".csv"))
            return cli_error(CLI_USAGE, "-o %s: the extension is none of .csv, .png and .svg", path);
    }
    return CLI_DONE;
}

int cli_write_plots(const cli_arguments *arguments, const cli_plot *plot, const char *csv) {
    int exit_status = CLI_DONE;
    const char *path;
    for (int i = 0; exit_status == CLI_DONE && (path = cli_nth_value(arguments, "-o", i)); i++) {
        if (cli_has_extension(path, ".csv"))
            exit_status = cli_write_file(path, csv, strlen(csv));
        else
            exit_status = write_picture(plot, cli_has_extension(path, ".svg"), path);
    }
    return exit_status;
}

void cli_report_plots(const cli_arguments *arguments) {
    const char *path;
    if (cli_is_quiet() || cli_given(arguments, "--json")) return;
    for (int i = 0; (path = cli_nth_value(arguments, "-o", i)); i++) printf("wrote %s\n", path);
}
