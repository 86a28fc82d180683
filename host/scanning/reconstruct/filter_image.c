/* Weights and filters the rows of a projection, and continues rows that the detector cuts. */
#include "core/maths.h"
#include "core/threads.h"
#include "reconstruct/reconstruction.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* Columns at an edge that the continuation of a row is fitted to. */
enum { FITTED = 16 };

/* How a row goes on beyond an edge. The square of a projection of an ellipse, over that of the cosine of the ray in the fan, is a
 * parabola along the row: it is fitted to the outermost columns, and followed to where it ends. */
typedef struct {
    int is_cut, is_ellipse;
    double parabola[3]; /* of the columns beyond the edge */
} continuation;

/* Fits a parabola to `count` values at 0, -1, -2, ... by least squares: sums of powers, and Cramer's rule. */
static void fit_parabola(const double *values, int64_t count, double parabola[3]) {
    double m[5] = {0}, v[3] = {0};
    for (int64_t k = 0; k < count; k++) {
        double power = 1;
        for (int i = 0; i < 5; i++, power *= -(double)k) {
            m[i] += power;
            if (i < 3) v[i] += power * values[k];
        }
    }
    const double rows[3][3] = {{m[0], m[1], m[2]}, {m[1], m[2], m[3]}, {m[2], m[3], m[4]}};
    double cofactors[3];
    skg_cross(rows[1], rows[2], cofactors);
    const double whole = skg_dot(rows[0], cofactors);
    for (int i = 0; i < 3; i++) {
        double columns[3][3];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) columns[r][c] = c == i ? v[r] : rows[r][c];
        skg_cross(columns[1], columns[2], cofactors);
        parabola[i] = skg_dot(columns[0], cofactors) / whole;
    }
}

/* most: columns up to which the parabola has to end. cosines: of the outermost columns */
static void find_continuation(const float *edge, int64_t next, const double *cosines, int64_t count,
                              int64_t most, continuation *on) {
    double squares[FITTED];
    for (int64_t k = 0; k < count; k++) {
        const double value = (double)edge[k * next] / cosines[k];
        squares[k] = value * value;
    }
    fit_parabola(squares, count, on->parabola);
    const double *q = on->parabola;
    const double inside = q[1] * q[1] - 4 * q[2] * q[0];
    on->is_ellipse = count > 3 && q[2] < 0 && q[0] > 0 && (q[1] + sqrt(inside)) / (-2 * q[2]) <= (double)most;
}

/* The value `steps` columns beyond an edge: of an ellipse, otherwise the mirror image about the edge, which ends at 0, under a cosine
 * that does so at the last column. next: from one column to the next, into the detector. */
static double beyond(const continuation *on, const float *edge, int64_t next, int64_t steps, int64_t columns,
                     int64_t most, double cosine) {
    const double x = (double)steps, *q = on->parabola;
    if (on->is_ellipse) {
        const double square = q[0] + x * (q[1] + x * q[2]);
        const int is_behind = 2 * q[2] * x + q[1] > 0; /* the parabola rises: its top lies beyond the edge */
        return square > 0 || is_behind ? cosine * sqrt(fmax(square, 0)) : 0;
    }
    if (most == 0 || steps >= columns) return 0;
    for (int64_t k = 1; k < steps; k++)
        if ((double)edge[k * next] >= 2 * (double)edge[0]) return 0;
    const double mirrored = 2 * (double)edge[0] - (double)edge[steps * next];
    const double share = cos(0.5 * SKG_PI * x / (double)(most + 1));
    return mirrored > 0 ? mirrored * share * share : 0;
}

/* Whether a row is cut off: the mean of the outermost columns is above a share of the largest value. */
static int is_cut(const float *edge, int64_t next, int64_t columns, double largest) {
    enum { MEAN_OF = 4 };
    static const double SHARE = 0.05;
    const int64_t count = columns < MEAN_OF ? columns : MEAN_OF;
    double sum = 0;
    for (int64_t k = 0; k < count; k++) sum += (double)edge[k * next];
    return sum > SHARE * largest * (double)count;
}

/* Data common to all rows of a projection. */
typedef struct {
    const skg_orbit_pose *pose;
    const float *image;
    double largest;
    int open[2]; /* 1: this side has to show air, and is continued if it does not */
} projection;

static double cosine_of(const skg_orbit_pose *pose, int64_t row, int64_t column, double *ray) {
    skg_orbit_ray(pose, row, column, ray);
    return skg_dot(ray, pose->forward) / skg_length(ray);
}

/* How a row goes on beyond its first (side 0) or last column. */
static continuation look_beyond(const skg_fdk *fdk, const projection *p, int64_t row, int side) {
    continuation on = {0};
    double cosines[FITTED], ray[3];
    const int64_t next = side ? -1 : 1, first = side ? fdk->columns - 1 : 0;
    const int64_t count = fdk->columns / 4 < FITTED ? fdk->columns / 4 : FITTED;
    const float *edge = p->image + row * fdk->columns + first;
    on.is_cut = p->open[side] && is_cut(edge, next, fdk->columns, p->largest);
    if (!on.is_cut || fdk->options.truncation != SKG_FDK_TRUNCATION_EXTRAPOLATE) return on;
    for (int64_t k = 0; k < count; k++) cosines[k] = cosine_of(p->pose, row, first + k * next, ray);
    find_continuation(edge, next, cosines, count, fdk->pad[side], &on);
    return on;
}

/* Weights each ray by its share and by the cosine of its angle with the plane across the axis, then filters the row. Returns whether
 * it is cut off. */
static int filter_row(skg_fdk *fdk, const projection *p, int64_t row, double *work) {
    double *weighted = work + 2 * (fdk->filter.fine + fdk->filter.length);
    const float *values = p->image + row * fdk->columns;
    const int64_t last = fdk->columns - 1, padded = fdk->pad[0] + fdk->columns + fdk->pad[1];
    const int goes_on = fdk->options.truncation == SKG_FDK_TRUNCATION_EXTRAPOLATE;
    const continuation on[2] = {look_beyond(fdk, p, row, 0), look_beyond(fdk, p, row, 1)};
    for (int64_t c = 0; c < padded; c++) {
        const int64_t column = c - fdk->pad[0];
        const int side = column > last, is_inside = column >= 0 && column <= last;
        double ray[3];
        weighted[c] = 0;
        if (!is_inside && !(goes_on && on[side].is_cut)) continue;
        const double cosine = cosine_of(p->pose, row, column, ray);
        const double place = fdk->orbit.displaced ? skg_orbit_place(p->pose, row, column) : 0;
        const double value =
            is_inside ? (double)values[column]
            : side    ? beyond(&on[1], values + last, -1, column - last, fdk->columns, fdk->pad[1], cosine)
                      : beyond(&on[0], values, 1, -column, fdk->columns, fdk->pad[0], cosine);
        weighted[c] = value * cosine * skg_orbit_weight(&fdk->orbit, p->pose, ray, place);
    }
    skg_row_filter_apply(&fdk->filter, padded, weighted, work, fdk->image + row * fdk->fine);
    return on[0].is_cut || on[1].is_cut;
}

static void look_at(const skg_fdk *fdk, const skg_orbit_pose *pose, const float *image, projection *p) {
    *p = (projection){.pose = pose, .image = image, .open = {1, 1}};
    if (fdk->orbit.displaced) p->open[skg_fdk_near_is_first(fdk, pose) ? 0 : 1] = 0;
    for (int64_t i = 0; i < fdk->rows * fdk->columns; i++) p->largest = fmax(p->largest, (double)image[i]);
}

/* Rows that a thread filters with the same memory. */
enum { ROWS_TOGETHER = 16 };

typedef struct {
    skg_fdk *fdk;
    const projection *image;
    atomic_llong truncated;
} filtering;

/* A skg_item_work. */
static skg_status filter_rows(void *user, int64_t block) {
    filtering *f = user;
    skg_fdk *fdk = f->fdk;
    const int64_t end = (block + 1) * ROWS_TOGETHER;
    int64_t truncated = 0;
    double *work = NULL;
    SKG_TRY(skg_alloc(2 * (fdk->filter.fine + fdk->filter.length) + fdk->pad[0] + fdk->columns + fdk->pad[1],
                      sizeof *work, "filter", &work));
    for (int64_t row = block * ROWS_TOGETHER; row < end && row < fdk->rows; row++)
        truncated += filter_row(fdk, f->image, row, work);
    skg_free(&work);
    f->truncated += truncated;
    return SKG_OK;
}

skg_status skg_fdk_filter(skg_fdk *fdk, const skg_orbit_pose *pose, const float *image) {
    projection p;
    look_at(fdk, pose, image, &p);
    filtering f = {.fdk = fdk, .image = &p};
    SKG_TRY(skg_parallel((fdk->rows + ROWS_TOGETHER - 1) / ROWS_TOGETHER, filter_rows, &f));
    fdk->truncated += f.truncated;
    return SKG_OK;
}
