/* Pictures of maps: surfaces in the colours of their distances, from in front and from behind. */
#include "map/map.h"

#include "common/say.h"
#include "map/surface_png.h"

#include <skiagraph/breathing.h>

#include <math.h>
#include <stdio.h>

enum { PANEL = 420, TITLE = 34, SCALE = 110, BAR = 22 };

double cli_map_end(double value) {
    if (!(value > 0)) return 1;
    const double power = pow(10, floor(log10(value))), part = value / power;
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

/* The colours with their values in mm, beside the first row. */
static void draw_scale(cairo_t *cairo, double high_mm) {
    const int left = 2 * PANEL + 12, top = TITLE + 20, length = PANEL - 40, ticks = 5;
    for (int y = 0; y < length; y++) {
        uint8_t rgb[3];
        (void)skg_distance_colour(1 - (y + 0.5) / length, rgb);
        cairo_set_source_rgb(cairo, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
        cairo_rectangle(cairo, left, top + y, BAR, 1);
        cairo_fill(cairo);
    }
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    cairo_set_font_size(cairo, 14);
    for (int t = 0; t <= ticks; t++) {
        char text[32];
        snprintf(text, sizeof text, "%.4g", high_mm * (ticks - t) / ticks);
        cairo_move_to(cairo, left + BAR + 6, top + (double)t * length / ticks + 5);
        cairo_show_text(cairo, text);
    }
    cairo_move_to(cairo, left, top - 10);
    cairo_show_text(cairo, "mm");
}

static void draw_title(cairo_t *cairo, const char *title, int top) {
    static const char *const sides[] = {"from in front", "from behind"};
    cairo_set_source_rgb(cairo, 0.1, 0.1, 0.1);
    cairo_set_font_size(cairo, 16);
    cairo_move_to(cairo, 12, top + 22);
    cairo_show_text(cairo, title);
    cairo_set_font_size(cairo, 12);
    for (int side = 0; side < 2; side++) {
        cairo_move_to(cairo, side * PANEL + 12, top + TITLE + 12);
        cairo_show_text(cairo, sides[side]);
    }
}

static int draw_panels(cairo_surface_t *surface, const cli_map *map, double high_mm, int top) {
    int exit_status = CLI_DONE;
    cairo_surface_flush(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int behind = 0; behind < 2 && exit_status == CLI_DONE; behind++) {
        const panel_pixels to = {.width = PANEL,
                                 .height = PANEL,
                                 .stride = stride,
                                 .pixels = cairo_image_surface_get_data(surface) +
                                           (size_t)(top + TITLE) * (size_t)stride +
                                           (size_t)(4 * behind * PANEL)};
        exit_status = panel_draw(map, behind, high_mm, &to);
    }
    cairo_surface_mark_dirty(surface);
    return exit_status;
}

int cli_map_png(const cli_map *maps, int count, double high_mm, unsigned char **png, size_t *size) {
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, 2 * PANEL + SCALE, count * (TITLE + PANEL));
    cairo_t *cairo = cairo_create(surface);
    int exit_status = CLI_DONE;
    *png = NULL;
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS)
        exit_status = cli_error(CLI_DEVICE, "a picture cannot be drawn: %s",
                                cairo_status_to_string(cairo_status(cairo)));
    for (int m = 0; m < count && exit_status == CLI_DONE; m++) {
        exit_status = draw_panels(surface, maps + m, high_mm, m * (TITLE + PANEL));
        draw_title(cairo, maps[m].title, m * (TITLE + PANEL));
    }
    draw_scale(cairo, high_mm);
    if (exit_status == CLI_DONE) exit_status = cli_png_of_surface(surface, png, size);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return exit_status;
}
