/* A picture of errors before and after a fit. */
#include "fit/work.h"

#include "common/file.h"
#include "common/say.h"
#include "map/map.h"
#include "map/surface_png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LEFT = 60, TOP = 60, PLOT = 300, BOTTOM = 60, BAR = 26, GAP = 40, KINDS = 3, PANELS = 2, TICKS = 5 };

/* Motion, before, after: colours that colour-blind readers can distinguish (Okabe and Ito). */
static const double colours[KINDS][3] = {{0.7, 0.7, 0.7}, {0.84, 0.37, 0}, {0, 0.45, 0.70}};
static const char *const names[KINDS] = {"motion", "before", "after"};
static const char *const titles[PANELS] = {"Mean distance, mm", "Greatest distance, mm"};

/* A bar's value; NaN: there is none. The motion has no greatest distance. */
static double value_of(const skg_fit_target *t, int panel, int kind) {
    const double means[KINDS] = {t->motion_mm, t->before_mean_mm, t->after_mean_mm};
    const double largest[KINDS] = {(double)NAN, t->before_max_mm, t->after_max_mm};
    return panel == 0 ? means[kind] : largest[kind];
}

static void write_centred(cairo_t *cairo, double x, double y, const char *text) {
    cairo_text_extents_t size;
    cairo_text_extents(cairo, text, &size);
    cairo_move_to(cairo, x - size.width / 2 - size.x_bearing, y);
    cairo_show_text(cairo, text);
}

static void draw_axis(cairo_t *cairo, double left, double width, double end, const char *title) {
    cairo_set_font_size(cairo, 15);
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    cairo_move_to(cairo, left, TOP - 34);
    cairo_show_text(cairo, title);
    cairo_set_font_size(cairo, 12);
    for (int t = 0; t <= TICKS; t++) {
        char text[32];
        const double y = TOP + PLOT - (double)PLOT * t / TICKS;
        cairo_set_source_rgb(cairo, 0.85, 0.85, 0.85);
        cairo_rectangle(cairo, left, y, width, 1);
        cairo_fill(cairo);
        cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
        snprintf(text, sizeof text, "%.4g", end * t / TICKS);
        cairo_move_to(cairo, left - 36, y + 4);
        cairo_show_text(cairo, text);
    }
}

static void draw_bars(cairo_t *cairo, const skg_fit_target *t, int panel, double x, double end) {
    char text[64];
    for (int kind = 0; kind < KINDS; kind++) {
        const double value = value_of(t, panel, kind);
        if (!isfinite(value)) continue;
        const double height = PLOT * value / end;
        cairo_set_source_rgb(cairo, colours[kind][0], colours[kind][1], colours[kind][2]);
        cairo_rectangle(cairo, x + kind * BAR, TOP + PLOT - height, BAR - 4, height);
        cairo_fill(cairo);
        cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
        cairo_set_font_size(cairo, 10);
        snprintf(text, sizeof text, "%.3g", value);
        write_centred(cairo, x + kind * BAR + (BAR - 4) / 2.0, TOP + PLOT - height - 4, text);
    }
    cairo_set_font_size(cairo, 12);
    write_centred(cairo, x + KINDS * BAR / 2.0, TOP + PLOT + 18, t->label);
    snprintf(text, sizeof text, "phase %.3g", t->phase);
    write_centred(cairo, x + KINDS * BAR / 2.0, TOP + PLOT + 34, text);
}

static void draw_legend(cairo_t *cairo) {
    for (int kind = 0; kind < KINDS; kind++) {
        cairo_set_source_rgb(cairo, colours[kind][0], colours[kind][1], colours[kind][2]);
        cairo_rectangle(cairo, LEFT + kind * 80, TOP - 24, 12, 12);
        cairo_fill(cairo);
        cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
        cairo_set_font_size(cairo, 12);
        cairo_move_to(cairo, LEFT + kind * 80 + 16, TOP - 13);
        cairo_show_text(cairo, names[kind]);
    }
}

static void draw(cairo_t *cairo, const skg_fit_target *targets, int64_t count, double panel_width) {
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    for (int panel = 0; panel < PANELS; panel++) {
        const double left = LEFT + panel * (panel_width + LEFT);
        double largest = 0;
        for (int64_t t = 0; t < count; t++)
            for (int kind = 0; kind < KINDS; kind++)
                largest = fmax(largest, value_of(targets + t, panel, kind));
        const double end = cli_map_end(largest);
        draw_axis(cairo, left, panel_width, end, titles[panel]);
        for (int64_t t = 0; t < count; t++)
            draw_bars(cairo, targets + t, panel, left + GAP / 2.0 + (double)t * (KINDS * BAR + GAP), end);
    }
    draw_legend(cairo);
}

int fit_bars_png(const fit_work *work, unsigned char **png, size_t *size) {
    int64_t count = 0;
    skg_status status = skg_fit_target_count(work->fit, &count);
    skg_fit_target *targets = calloc((size_t)count + 1, sizeof *targets);
    if (!targets) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t t = 0; t < count && status == SKG_OK; t++) {
        skg_fit_target_init(targets + t);
        status = skg_fit_target_get(work->fit, t, targets + t);
    }
    const double panel = fmax((double)count * (KINDS * BAR + GAP), 260);
    const int width = (int)(PANELS * (LEFT + panel)) + 20;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, TOP + PLOT + BOTTOM);
    cairo_t *cairo = cairo_create(surface);
    draw(cairo, targets, count, panel);
    const int exit_status = status == SKG_OK ? cli_png_of_surface(surface, png, size) : cli_fail(status);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    free(targets);
    return exit_status;
}

int fit_write_bars(const fit_work *work, const char *path) {
    unsigned char *png = NULL;
    size_t size = 0;
    int exit_status = fit_bars_png(work, &png, &size);
    if (exit_status == CLI_DONE) exit_status = cli_write_file(path, png, size);
    free(png);
    return exit_status;
}
