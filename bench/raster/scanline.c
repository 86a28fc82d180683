/* The library's method in C, written for a compiler that vectorises: coverage by crossings of scan lines,
 * depth as one affine function and a division, sums of integers in a private image of each thread. */
#include "contenders.h"
#include "geometry.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum {
    LANES = 8,
    SPARE = 64
}; /* pixels in a run; columns to the right of the image, to which runs may add 0 */

typedef struct {
    float x, y, z, unused; /* 16 bytes: one load */
} corner;

struct scanline {
    const bench_shape *shape;
    float *lengths;
    int threads, columns, rows, stride, chunk, turned;
    int pixel_i, pixel_j;     /* coordinates are relative to the pixel next to the projected centre */
    float centre_x, centre_y; /* of the projected centre, relative to it */
    float centre_t;           /* depth of the centre; 1 at the detector */
    float along_x[3], along_y[3], along_t[3];
    float scale, unscale; /* integers per unit of depth */
    double first[3], column[3], row[3];
    corner *projected;
    int32_t **sums; /* [threads] all 0 between frames */
};

/* The rows of the inverse of [column row first] give the pixel coordinates and the depth of a point. */
static void place_camera(scanline *self, const skg_view *view) {
    double x[3], y[3], t[3], from_source[3];
    for (int k = 0; k < 3; k++) {
        self->column[k] = view->column_step[k];
        self->row[k] = view->row_step[k];
        from_source[k] = -view->source[k];
    }
    to_first_pixel(view, self->first);
    cross(self->row, self->first, x);
    cross(self->first, self->column, y);
    cross(self->column, self->row, t);
    const double volume = dot(self->column, x);
    for (int k = 0; k < 3; k++) x[k] /= volume, y[k] /= volume, t[k] /= volume;
    const double depth = dot(t, from_source), i = dot(x, from_source) / depth,
                 j = dot(y, from_source) / depth;
    self->turned = volume > 0 ? -1 : 1;
    self->pixel_i = (int)lround(i);
    self->pixel_j = (int)lround(j);
    self->centre_x = (float)(i - self->pixel_i);
    self->centre_y = (float)(j - self->pixel_j);
    self->centre_t = (float)depth;
    for (int k = 0; k < 3; k++) {
        self->along_t[k] = (float)t[k];
        self->along_x[k] = (float)(x[k] - i * t[k]);
        self->along_y[k] = (float)(y[k] - j * t[k]);
    }
}

/* Two bits of headroom: sums of four nested shells, each as deep as the mesh, do not overflow. */
static void choose_scale(scanline *self) {
    double furthest = 0;
    for (int64_t v = 0; v < self->shape->vertices; v++) {
        const float *p = self->shape->positions + 3 * v;
        furthest = fmax(furthest, sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])));
    }
    const double along =
        sqrt((double)(self->along_t[0] * self->along_t[0] + self->along_t[1] * self->along_t[1] +
                      self->along_t[2] * self->along_t[2]));
    self->scale = (float)exp2(floor(log2(0x1p28 / (furthest * along))));
    self->unscale = 1 / self->scale;
}

scanline *scanline_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths) {
    scanline *self = bench_alloc(1, sizeof *self);
    self->shape = shape;
    self->lengths = lengths;
    self->threads = threads;
    self->columns = (int)view->columns;
    self->rows = (int)view->rows;
    self->stride = (self->columns + SPARE) / 16 * 16;
    const int64_t chunk = shape->triangles / (16 * threads);
    self->chunk = (int)(chunk < 32 ? 32 : chunk > 2048 ? 2048 : chunk);
    place_camera(self, view);
    choose_scale(self);
    self->projected = bench_alloc((size_t)shape->vertices, sizeof *self->projected);
    self->sums = bench_alloc((size_t)threads, sizeof *self->sums);
    for (int k = 0; k < threads; k++)
        self->sums[k] = bench_alloc((size_t)self->stride * (size_t)self->rows, sizeof **self->sums);
    return self;
}

void scanline_free(scanline *self) {
    if (!self) return;
    for (int k = 0; k < self->threads; k++) free(self->sums[k]);
    free(self->sums);
    free(self->projected);
    free(self);
}

static void project(scanline *self) {
    const float x0 = self->along_x[0], x1 = self->along_x[1], x2 = self->along_x[2], cx = self->centre_x;
    const float y0 = self->along_y[0], y1 = self->along_y[1], y2 = self->along_y[2], cy = self->centre_y;
    const float t0 = self->along_t[0], t1 = self->along_t[1], t2 = self->along_t[2], ct = self->centre_t;
    const float *restrict position = self->shape->positions;
    corner *restrict out = self->projected;
#pragma omp for simd schedule(static)
    for (int64_t v = 0; v < self->shape->vertices; v++) {
        const float *p = position + 3 * v;
        const float r = t0 * p[0] + t1 * p[1] + t2 * p[2], inverse = 1 / (ct + r);
        out[v].x = cx + (x0 * p[0] + x1 * p[1] + x2 * p[2]) * inverse;
        out[v].y = cy + (y0 * p[0] + y1 * p[1] + y2 * p[2]) * inverse;
        out[v].z = r * inverse;
        out[v].unused = 0;
    }
}

static inline float least(float a, float b) {
    return a < b ? a : b;
}
static inline float most(float a, float b) {
    return a > b ? a : b;
}

/* The smallest integer >= x, clamped to [low, high]. */
static inline int ceiling(float x, int low, int high) {
    if (!(x > (float)low)) return low;
    if (!(x < (float)high)) return high;
    const int whole = (int)x;
    return whole + ((float)whole < x);
}

static inline int swap_if(int turn, corner *a, corner *b) {
    const corner kept = *a;
    *a = turn ? *b : kept;
    *b = turn ? kept : *b;
    return turn;
}

/* A triangle, prepared for its scan lines. */
typedef struct {
    float x0, y0, z0, x1, y1, s02, s01, s12, zi, zj, lowest, highest, factor;
    int sign;
} face;

static inline void set_up(const scanline *self, corner a, corner b, corner c, face *f) {
    const float end = 1 - self->centre_t; /* the path ends at the pixel */
    f->lowest = least(least(least(a.z, b.z), c.z), end);
    f->highest = least(most(most(a.z, b.z), c.z), end);
    int swaps = swap_if(b.y < a.y, &a, &b);
    swaps ^= swap_if(c.y < b.y, &b, &c);
    swaps ^= swap_if(b.y < a.y, &a, &b);
    const float dx1 = b.x - a.x, dy1 = b.y - a.y, dz1 = b.z - a.z;
    const float dx2 = c.x - a.x, dy2 = c.y - a.y, dz2 = c.z - a.z;
    f->x0 = a.x, f->y0 = a.y, f->z0 = a.z, f->x1 = b.x, f->y1 = b.y;
    f->s02 = dx2 / dy2, f->s01 = dx1 / dy1, f->s12 = (c.x - b.x) / (c.y - b.y);
    const float area = fmaf(dx1, dy2, -dx2 * dy1), inverse = fabsf(area) < 1e-14f ? 0 : 1 / area;
    f->zi = fmaf(dz1, dy2, -dz2 * dy1) * inverse;
    f->zj = fmaf(dx1, dz2, -dx2 * dz1) * inverse;
    f->sign = swaps ? -self->turned : self->turned;
}

/* Draws one row between its crossings in whole runs of lanes. Lanes outside the crossings add 0. */
static inline void draw_row(const face *f, float j, float scale, int left, int right, int offset,
                            int32_t *row) {
    const float above = j - f->y0, a = fmaf(above, f->s02, f->x0);
    const float b = j >= f->y1 ? fmaf(j - f->y1, f->s12, f->x1) : fmaf(above, f->s01, f->x0);
    const int from = ceiling(least(a, b), left, right), to = ceiling(most(a, b), left, right);
    const float factor = a < b ? -scale : scale, z0 = fmaf(f->zj, above, f->z0);
    for (int i = from; i < to; i += LANES) {
        int32_t *restrict run = row + offset + i;
#pragma omp simd
        for (int k = 0; k < LANES; k++) {
            float z = fmaf(f->zi, (float)(i + k) - f->x0, z0);
            z = z < f->lowest ? f->lowest : z;
            z = z > f->highest ? f->highest : z;
            const int32_t r = (int32_t)rintf(z / (1 - z) * factor);
            run[k] += i + k < to ? r : 0;
        }
    }
}

static inline void draw(const scanline *self, const int32_t *corners, int32_t *sums) {
    const corner a = self->projected[corners[0]], b = self->projected[corners[1]],
                 c = self->projected[corners[2]];
    const int left = -self->pixel_i, right = self->columns - self->pixel_i;
    const int top = -self->pixel_j, bottom = self->rows - self->pixel_j;
    const int j0 = ceiling(least(least(a.y, b.y), c.y), top, bottom);
    const int j1 = ceiling(most(most(a.y, b.y), c.y), top, bottom);
    if (j0 >= j1) return;
    /* Rounding may put a crossing beyond the end of its edge. */
    const float low = least(least(a.x, b.x), c.x), high = most(most(a.x, b.x), c.x);
    const float margin = 0x1p-20f * most(-low, high);
    if (ceiling(low - margin, left, right) >= ceiling(high + margin, left, right)) return;
    face f;
    set_up(self, a, b, c, &f);
    const float scale = (float)f.sign * self->centre_t * self->scale;
    int32_t *row = sums + (int64_t)(j0 + self->pixel_j) * self->stride;
    for (int j = j0; j < j1; j++, row += self->stride)
        draw_row(&f, (float)j, scale, left, right, self->pixel_i, row);
}

/* Adds the sums of all threads, converts them to mm and sets them to 0. */
static void resolve(scanline *self) {
    const double *first = self->first, *column = self->column, *step = self->row;
    const float a = (float)dot(column, column);
    const int threads = self->threads;
#pragma omp for schedule(static)
    for (int j = 0; j < self->rows; j++) {
        float *restrict out = self->lengths + (int64_t)j * self->columns;
        const int64_t start = (int64_t)j * self->stride;
        double base[3];
        for (int k = 0; k < 3; k++) base[k] = first[k] + j * step[k];
        const float b = (float)(2 * dot(base, column)), c = (float)dot(base, base), unscale = self->unscale;
        int32_t *restrict sum = self->sums[0] + start;
        for (int thread = 1; thread < threads; thread++) {
            int32_t *restrict more = self->sums[thread] + start;
            for (int i = 0; i < self->columns; i++) sum[i] += more[i], more[i] = 0;
        }
        for (int i = 0; i < self->columns; i++) {
            out[i] = (float)sum[i] * unscale * sqrtf(fmaf(fmaf(a, (float)i, b), (float)i, c));
            sum[i] = 0;
        }
    }
}

void scanline_frame(void *contender) {
    scanline *self = contender;
    const int32_t *corners = self->shape->corners;
#pragma omp parallel num_threads(self->threads)
    {
        int32_t *sums = self->sums[omp_get_thread_num()];
        project(self);
#pragma omp for schedule(dynamic, self->chunk)
        for (int64_t triangle = 0; triangle < self->shape->triangles; triangle++)
            draw(self, corners + 3 * triangle, sums);
        resolve(self);
    }
}
