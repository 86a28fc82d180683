/* Draws breathing-modes.png and diaphragm-displacement.png into a folder: the simple thorax, breathing
 * with the diaphragm, with the ribs and with both, as Figures 7 and 11 of Vidal and Villard (2016). */
#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = 3, PANEL = 300, MARGIN = 26, PARTS_MAX = 100 };

static const char *const mode_name[MODES] = {"diaphragmatic", "thoracic", "combined"};
static const double thoracic[MODES] = {0, 1, 1}, diaphragmatic[MODES] = {1, 0, 1};

static void check(skg_status status) {
    if (status == SKG_OK) return;
    fprintf(stderr, "figures: %s\n", skg_last_error());
    exit(1);
}

static void *get(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (!memory) fprintf(stderr, "figures: out of memory\n"), exit(1);
    return memory;
}

static skg_thorax *thorax;
static skg_body *body;
static skg_thorax_part part[PARTS_MAX];
static int64_t parts;

static void make_body(void) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.simple = 1;
    check(skg_thorax_create(&options, &thorax));
    check(skg_thorax_part_count(thorax, &parts));
    check(skg_body_create(NULL, NULL, &body));
    for (int64_t i = 0; i < parts; i++) {
        skg_organ organ;
        skg_organ_init(&organ);
        skg_thorax_part_init(part + i);
        check(skg_thorax_part_get(thorax, i, part + i));
        organ.mesh = part[i].mesh, organ.label = part[i].label, organ.inside = part[i].inside;
        check(skg_body_add(body, &organ, NULL));
    }
    check(skg_body_link(body));
}

static void pose(double ribs, double belly) {
    skg_breath_state state;
    skg_breath_state_init(&state);
    state.thoracic = ribs, state.diaphragmatic = belly;
    check(skg_body_pose(body, &state));
}

/* Positions and corners of a part as it is posed; the caller frees both. */
static int64_t read_mesh(const skg_mesh *mesh, double **positions, int32_t **corners, int64_t *triangles) {
    int64_t vertices;
    check(skg_mesh_count(mesh, &vertices, triangles));
    *positions = get((size_t)vertices * 3, sizeof **positions);
    *corners = get((size_t)*triangles * 3, sizeof **corners);
    check(skg_mesh_positions_get(mesh, *positions, 0));
    check(skg_mesh_triangles_get(mesh, *corners, 0));
    return vertices;
}

/* mm to pixels of a panel: from the front (x, z), from the side (y, z) or from above (x, y, the back on top).
 */
typedef struct {
    int across, up;
    double left, top, scale;
} projection;

static const projection front = {0, 2, -225, 225, PANEL / 450.0}, side = {1, 2, -265, 225, PANEL / 450.0},
                        above = {0, 1, -150, 70, PANEL / 300.0};

static void corner_at(const projection *view, const double *p, double *x, double *y) {
    *x = (p[view->across] - view->left) * view->scale;
    *y = (view->top - p[view->up]) * view->scale;
}

/* The shadow of every part whose label begins so, as a mask at twice the panel's resolution. */
static cairo_surface_t *shadow(const char *label, const projection *view) {
    cairo_surface_t *mask = cairo_image_surface_create(CAIRO_FORMAT_A8, 2 * PANEL, 2 * PANEL);
    cairo_t *c = cairo_create(mask);
    cairo_set_antialias(c, CAIRO_ANTIALIAS_NONE);
    cairo_scale(c, 2, 2);
    for (int64_t i = 0; i < parts; i++) {
        double *p, x, y;
        int32_t *corner;
        int64_t triangles;
        if (strncmp(part[i].label, label, strlen(label)) != 0) continue;
        read_mesh(part[i].mesh, &p, &corner, &triangles);
        for (int64_t t = 0; t < triangles; t++) {
            for (int k = 0; k < 3; k++) {
                corner_at(view, p + 3 * (int64_t)corner[3 * t + k], &x, &y);
                cairo_line_to(c, x, y);
            }
            cairo_close_path(c);
            cairo_fill(c);
        }
        free(p);
        free(corner);
    }
    cairo_destroy(c);
    cairo_surface_flush(mask);
    return mask;
}

/* Outline of a mask: those of its pixels that lie beside others. */
static cairo_surface_t *outline(cairo_surface_t *mask) {
    cairo_surface_t *border = cairo_image_surface_create(CAIRO_FORMAT_A8, 2 * PANEL, 2 * PANEL);
    const unsigned char *from = cairo_image_surface_get_data(mask);
    unsigned char *to = cairo_image_surface_get_data(border);
    const int stride = cairo_image_surface_get_stride(mask);
    for (int y = 1; y + 1 < 2 * PANEL; y++)
        for (int x = 1; x + 1 < 2 * PANEL; x++) {
            const unsigned char *at = from + y * stride + x;
            if (*at && !(at[-1] && at[1] && at[-stride] && at[stride])) {
                to[y * stride + x] = 255;
                to[y * stride + x + 1] = 255; /* two pixels of the fine grid are one of the picture */
            }
        }
    cairo_surface_mark_dirty(border);
    return border;
}

static void draw_outlines(cairo_t *c, double left, double top, const projection *view,
                          const double colour[3]) {
    static const char *const labels[] = {"skin", "rib", "sternum", "diaphragm"};
    for (size_t l = 0; l < sizeof labels / sizeof *labels; l++) {
        cairo_surface_t *mask = shadow(labels[l], view), *border = outline(mask);
        cairo_save(c);
        cairo_translate(c, left, top);
        cairo_scale(c, 0.5, 0.5);
        cairo_set_source_rgb(c, colour[0], colour[1], colour[2]);
        cairo_mask_surface(c, border, 0, 0);
        cairo_restore(c);
        cairo_surface_destroy(border);
        cairo_surface_destroy(mask);
    }
}

static cairo_t *page(int width, int height) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t *c = cairo_create(surface);
    cairo_surface_destroy(surface);
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_paint(c);
    cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, 13);
    return c;
}

static void say(cairo_t *c, double x, double y, const char *text) {
    cairo_set_source_rgb(c, 0.1, 0.1, 0.1);
    cairo_move_to(c, x, y);
    cairo_show_text(c, text);
    cairo_new_path(c); /* text leaves a current point, from which the next path would begin */
}

static void save(cairo_t *c, const char *folder, const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (cairo_surface_write_to_png(cairo_get_target(c), path) != CAIRO_STATUS_SUCCESS) {
        fprintf(stderr, "figures: %s cannot be written\n", path);
        exit(1);
    }
    cairo_destroy(c);
}

/* Twice a quiet breath, so that the millimetres are seen. */
static void draw_modes(const char *folder) {
    static const double exhaled[3] = {0.6, 0.6, 0.6}, inhaled[3] = {0.75, 0.1, 0.1};
    cairo_t *c = page(MODES * PANEL, 2 * PANEL + MARGIN);
    for (int mode = 0; mode < MODES; mode++) {
        const double left = mode * PANEL;
        for (int now = 0; now < 2; now++) {
            pose(now * 2 * thoracic[mode], now * 2 * diaphragmatic[mode]);
            draw_outlines(c, left, MARGIN, &front, now ? inhaled : exhaled);
            draw_outlines(c, left, MARGIN + PANEL, &side, now ? inhaled : exhaled);
        }
        say(c, left + 12, 18, mode_name[mode]);
    }
    save(c, folder, "breathing-modes.png");
}

/* Dark blue over green to yellow; t from 0 to 1. */
static void colour_of(double t, double rgb[3]) {
    static const double table[5][3] = {
        {0.27, 0.00, 0.33}, {0.23, 0.32, 0.55}, {0.13, 0.57, 0.55}, {0.37, 0.79, 0.38}, {0.99, 0.91, 0.15}};
    const double at = 4 * fmin(fmax(t, 0), 1);
    const int i = at < 4 ? (int)at : 3;
    for (int k = 0; k < 3; k++) rgb[k] = table[i][k] + (at - i) * (table[i + 1][k] - table[i][k]);
}

static int64_t diaphragm(void) {
    for (int64_t i = 0; i < parts; i++)
        if (!strcmp(part[i].label, "diaphragm")) return i;
    return 0;
}

/* The upper face from above, coloured by how far it has gone. */
static double draw_displacement(cairo_t *c, double left, double most, const double *rest) {
    double *now, largest = 0, x, y;
    int32_t *corner;
    int64_t triangles;
    read_mesh(part[diaphragm()].mesh, &now, &corner, &triangles);
    cairo_save(c);
    cairo_translate(c, left, MARGIN);
    cairo_set_antialias(c, CAIRO_ANTIALIAS_NONE);
    for (int64_t t = 0; t < triangles; t++) {
        const double *p[3];
        double moved = 0, rgb[3];
        for (int k = 0; k < 3; k++) {
            const int64_t v = 3 * (int64_t)corner[3 * t + k];
            p[k] = now + v;
            moved += sqrt(pow(now[v] - rest[v], 2) + pow(now[v + 1] - rest[v + 1], 2) +
                          pow(now[v + 2] - rest[v + 2], 2)) /
                     3;
        }
        largest = fmax(largest, moved);
        if ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]) <
            0.1) /* mm2: edge-on, or below */
            continue;
        colour_of(moved / most, rgb);
        cairo_set_source_rgb(c, rgb[0], rgb[1], rgb[2]);
        for (int k = 0; k < 3; k++) {
            corner_at(&above, p[k], &x, &y);
            cairo_line_to(c, x, y);
        }
        cairo_close_path(c);
        cairo_fill(c);
    }
    cairo_restore(c);
    free(now);
    free(corner);
    return largest;
}

static void draw_scale(cairo_t *c, double left, double top, double most) {
    char text[40];
    for (int i = 0; i < 200; i++) {
        double rgb[3];
        colour_of(1 - i / 199.0, rgb);
        cairo_set_source_rgb(c, rgb[0], rgb[1], rgb[2]);
        cairo_rectangle(c, left, top + i, 14, 1);
        cairo_fill(c);
    }
    for (int i = 0; i <= 4; i++) {
        snprintf(text, sizeof text, "%g mm", most * (1 - i / 4.0));
        say(c, left + 20, top + 50 * i + 5, text);
    }
}

/* A quiet breath. */
static void draw_diaphragm(const char *folder) {
    const double most = 16; /* mm */
    cairo_t *c = page(MODES * PANEL + 90, PANEL * 5 / 6 + MARGIN);
    double *rest;
    int32_t *corner;
    int64_t triangles;
    pose(0, 0);
    read_mesh(part[diaphragm()].mesh, &rest, &corner, &triangles);
    for (int mode = 0; mode < MODES; mode++) {
        char text[80];
        pose(thoracic[mode], diaphragmatic[mode]);
        const double largest = draw_displacement(c, mode * PANEL, most, rest);
        snprintf(text, sizeof text, "%s: up to %.1f mm", mode_name[mode], largest);
        say(c, mode * PANEL + 12, 18, text);
    }
    draw_scale(c, MODES * PANEL + 12, MARGIN + 20, most);
    free(rest);
    free(corner);
    save(c, folder, "diaphragm-displacement.png");
}

int main(int count, char **words) {
    if (count != 2) return fprintf(stderr, "figures FOLDER\n"), 2;
    make_body();
    draw_modes(words[1]);
    draw_diaphragm(words[1]);
    skg_body_release(&body);
    skg_thorax_release(&thorax);
    return 0;
}
