/* The camera of a curved detector: a flat one on the touching plane, in whose rows the detector's columns stand as lines.
 *
 * Its columns are the rows of the detector, and its rows the columns. It covers what every pixel sees, so that what holds for
 * all of its rays holds for those of the detector. Row k of the raster is the line y = Y(k), and pixel i stands on it at
 * x = i + more(k) (i - middle) + moved(k) (skg_shared.h). */
#include "geometry/optics.h"

#include "core/maths.h"

#include <math.h>
#include <string.h>

/* The angle of a column, which may lie between two. */
static double angle_of(const skg_bends *bends, double column) {
    return (column - bends->middle_column) * bends->curve.angle;
}

/* mm along `down` at which a row is seen on a line. */
static double place_of(const skg_bends *bends, const skg_curvature_line *line, double row) {
    const double down = (row - bends->middle_row) * bends->curve.height;
    return bends->curve.along + line->scale * (down - bends->curve.along) + line->moved;
}

/* The rectangle of the touching plane that the pixels cover: to and from mm of columns, then of rows. */
static void find_rectangle(const skg_bends *bends, const skg_view *view, double low[2], double high[2]) {
    const double columns[3] = {-0.5, bends->middle_column, (double)view->columns - 0.5};
    low[0] = low[1] = HUGE_VAL, high[0] = high[1] = -HUGE_VAL;
    for (int k = 0; k < 3; k++) { /* scales are the least in the middle, and grow to both sides */
        const double column = fmin(fmax(columns[k], columns[0]), columns[2]);
        const skg_curvature_line line = skg_curvature_line_at(&bends->curve, angle_of(bends, column));
        low[0] = fmin(low[0], line.place), high[0] = fmax(high[0], line.place);
        for (int end = 0; end < 2; end++) {
            const double at = place_of(bends, &line, end ? (double)view->rows - 0.5 : -0.5);
            low[1] = fmin(low[1], at), high[1] = fmax(high[1], at);
        }
    }
}

void skg_bends_find(const skg_view *view, const double *source, double shift_column, double shift_row,
                    skg_view *flat, skg_bends *bends) {
    double low[2], high[2];
    *bends = (skg_bends){.middle_column = 0.5 * (double)(view->columns - 1) - shift_column,
                         .middle_row = 0.5 * (double)(view->rows - 1) - shift_row,
                         .area = skg_length(view->column_step) * skg_length(view->row_step)};
    skg_curvature_find(view, source, &bends->curve);
    find_rectangle(bends, view, low, high);
    bends->first_line = low[0], bends->line_step = (high[0] - low[0]) / (double)view->columns;
    bends->first_place = low[1], bends->place_step = (high[1] - low[1]) / (double)view->rows;
    *flat = *view;
    flat->radius = 0;
    flat->columns = view->rows, flat->rows = view->columns;
    skg_scale_vector(bends->place_step, bends->curve.down, flat->column_step);
    skg_scale_vector(bends->line_step, bends->curve.across, flat->row_step);
    skg_add_scaled(view->centre, 0.5 * (low[0] + high[0]), bends->curve.across, flat->centre);
    skg_add_scaled(flat->centre, 0.5 * (low[1] + high[1]), bends->curve.down, flat->centre);
}

void skg_bends_row(const skg_camera *camera, double row, skg_bent_line *bent) {
    const skg_bends *bends = &camera->bends;
    const skg_curvature *curve = &bends->curve;
    const skg_curvature_line line = skg_curvature_line_at(curve, angle_of(bends, row));
    const double middle = skg_bends_middle(camera), away = line.depth / curve->distance;
    bent->y = (line.place - bends->first_line) / bends->line_step - 0.5;
    bent->more = line.scale * curve->height / bends->place_step - 1;
    bent->moved = (place_of(bends, &line, middle) - bends->first_place) / bends->place_step - 0.5 - middle;
    bent->t = 1 - (curve->parallel ? line.depth * curve->steep / skg_length(camera->first) : away);
    bent->fall = curve->parallel ? 0 : cbrt(curve->distance * curve->distance * line.facing) * line.scale;
}

double skg_bends_middle(const skg_camera *camera) {
    const skg_bends *bends = &camera->bends;
    return bends->middle_row + (bends->curve.parallel ? 0 : bends->curve.along / bends->curve.height);
}

/* Numbers of the table go to memory of either precision. */
static void put(void *lines, int is_double, int64_t at, double value) {
    if (is_double)
        ((double *)lines)[at] = value;
    else
        ((float *)lines)[at] = (float)value;
}

void skg_bends_table(const skg_camera *camera, int is_double, void *lines) {
    const double middle = skg_bends_middle(camera), high = (double)(float)middle;
    const double turn = floor(fmin(fmax(camera->bends.middle_column, 0), (double)camera->rows - 1));
    const double head[SKG_LINES_HEAD] = {(double)camera->rows, turn, high, middle - high};
    for (int k = 0; k < SKG_LINES_HEAD; k++) put(lines, is_double, k, head[k]);
    for (int64_t r = 0; r < camera->rows; r++) {
        skg_bent_line bent;
        skg_bends_row(camera, (double)r, &bent);
        const double whole = rint(bent.y), end = camera->parallel ? bent.t - 1 : 1 / bent.t;
        const double row[SKG_LINES_ROW] = {whole, bent.y - whole, bent.more, bent.moved,
                                           end,   bent.fall,      bent.t};
        for (int k = 0; k < SKG_LINES_ROW; k++)
            put(lines, is_double, SKG_LINES_HEAD + SKG_LINES_ROW * r + k, row[k]);
    }
}

/* The column of the detector at which a line stands: lines are in order. */
static double row_at(const skg_camera *camera, double y) {
    double low = -1, high = (double)camera->rows;
    if (!isfinite(y)) return y;
    while (high - low > 0x1p-6) {
        const double middle = 0.5 * (low + high);
        skg_bent_line bent;
        skg_bends_row(camera, middle, &bent);
        if (bent.y < y)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

void skg_bends_extent(const skg_camera *camera, double columns[2], double rows[2]) {
    const double middle = skg_bends_middle(camera);
    double low = HUGE_VAL, high = -HUGE_VAL;
    rows[0] = row_at(camera, rows[0]) - 0x1p-6;
    rows[1] = row_at(camera, rows[1]) + 0x1p-6;
    if (!isfinite(columns[0]) || !isfinite(columns[1])) return;
    const double first = fmin(fmax(rows[0], -0.5), (double)camera->rows - 0.5);
    const double last = fmin(fmax(rows[1], first), (double)camera->rows - 0.5);
    const double turn = fmin(fmax(camera->bends.middle_column, first), last);
    const double at[3] = {first, turn, last};
    for (int k = 0; k < 3; k++) {
        skg_bent_line bent;
        skg_bends_row(camera, at[k], &bent);
        const double rest = bent.moved - bent.more * middle;
        low = fmin(low, (columns[0] - rest) / (1 + bent.more));
        high = fmax(high, (columns[1] - rest) / (1 + bent.more));
    }
    columns[0] = low - 0x1p-6, columns[1] = high + 0x1p-6;
}
