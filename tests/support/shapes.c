/* Solids as plain arrays: closed, outward, unless said otherwise. */
#include "support/shapes.h"

#include "support/angles.h"
#include "support/random.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static solid allocate(int64_t vertices, int64_t triangles) {
    return (solid){vertices, triangles, calloc((size_t)(3 * vertices), sizeof(double)),
                   calloc((size_t)(3 * triangles), sizeof(int32_t))};
}

void solid_free(solid *s) {
    free(s->positions);
    free(s->corners);
    *s = (solid){0};
}

static void set(double *at, double x, double y, double z) {
    at[0] = x;
    at[1] = y;
    at[2] = z;
}

static int32_t *corner(int32_t *at, int64_t a, int64_t b, int64_t c) {
    at[0] = (int32_t)a;
    at[1] = (int32_t)b;
    at[2] = (int32_t)c;
    return at + 3;
}

solid solid_box(double x, double y, double z) {
    static const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    solid s = allocate(8, 12);
    for (int k = 0; k < 8; k++)
        set(s.positions + 3 * k, k & 1 ? x / 2 : -x / 2, k & 2 ? y / 2 : -y / 2, k & 4 ? z / 2 : -z / 2);
    int32_t *at = s.corners;
    for (int q = 0; q < 6; q++) {
        at = corner(at, quads[q][0], quads[q][1], quads[q][2]);
        at = corner(at, quads[q][0], quads[q][2], quads[q][3]);
    }
    return s;
}

solid solid_star(int points, int step, double radius, double height) {
    solid s = allocate(2 * (int64_t)points, 4 * (int64_t)points - 4);
    for (int k = 0; k < 2 * points; k++) {
        const double angle = 2 * pi * (k % points * step) / points;
        set(s.positions + 3 * k, radius * cos(angle), radius * sin(angle),
            k < points ? -height / 2 : height / 2);
    }
    int32_t *at = s.corners;
    for (int k = 0; k < points; k++) {
        const int next = (k + 1) % points;
        at = corner(at, k, next, points + next);
        at = corner(at, k, points + next, points + k);
    }
    for (int k = 1; k < points - 1; k++) {
        at = corner(at, 0, k + 1, k);
        at = corner(at, points, points + k, points + k + 1);
    }
    return s;
}

/* Radius in a direction, for bumps. */
typedef struct {
    double height[4], wave[4][3], phase[4];
} bumps;

static double radius_at(const bumps *b, const double *way) {
    double factor = 1;
    for (int k = 0; k < 4; k++)
        factor += b->height[k] *
                  sin(b->wave[k][0] * way[0] + b->wave[k][1] * way[1] + b->wave[k][2] * way[2] + b->phase[k]);
    return factor;
}

static solid bumpy(double radius, int around, int down, const bumps *b) {
    solid s = allocate(2 + (int64_t)around * (down - 1), 2 * (int64_t)around * (down - 1));
    const int64_t south = s.vertices - 1;
    for (int64_t n = 0; n < s.vertices; n++) {
        const double polar = n == 0 ? 0 : n == south ? pi : pi * (double)(1 + (n - 1) / around) / down;
        const double turn = 2 * pi * (double)((n - 1) % around) / around;
        const double way[3] = {n == 0 || n == south ? 0 : sin(polar) * cos(turn),
                               n == 0 || n == south ? 0 : sin(polar) * sin(turn), cos(polar)};
        const double r = radius * radius_at(b, way);
        set(s.positions + 3 * n, r * way[0], r * way[1], r * way[2]);
    }
    int32_t *at = s.corners;
    for (int64_t a = 0; a < around; a++) {
        const int64_t next = (a + 1) % around, last = 1 + (int64_t)around * (down - 2);
        at = corner(at, 0, 1 + a, 1 + next);
        for (int64_t d = 0; d < down - 2; d++) {
            const int64_t row = 1 + d * around;
            at = corner(at, row + a, row + around + a, row + around + next);
            at = corner(at, row + a, row + around + next, row + next);
        }
        at = corner(at, last + a, south, last + next);
    }
    return s;
}

solid solid_sphere(double radius, int around, int down) {
    const bumps none = {.height = {0}};
    return bumpy(radius, around, down, &none);
}

solid solid_blob(double radius, int around, int down, uint64_t seed) {
    bumps b;
    for (int k = 0; k < 4; k++) {
        b.height[k] = draw(&seed, 0.02, 0.1);
        b.phase[k] = draw(&seed, 0, 2 * pi);
        for (int c = 0; c < 3; c++) b.wave[k][c] = draw(&seed, -7, 7);
    }
    return bumpy(radius, around, down, &b);
}

solid solid_torus(double ring, double tube, int around, int across) {
    solid s = allocate((int64_t)around * across, 2 * (int64_t)around * across);
    int32_t *at = s.corners;
    for (int64_t a = 0; a < around; a++)
        for (int64_t c = 0; c < across; c++) {
            const double turn = 2 * pi * (double)a / around, small = 2 * pi * (double)c / across;
            const double out = ring + tube * cos(small);
            const int64_t next = (a + 1) % around * across, here = a * across, d = (c + 1) % across;
            set(s.positions + 3 * (here + c), out * cos(turn), out * sin(turn), tube * sin(small));
            at = corner(at, here + c, next + c, next + d);
            at = corner(at, here + c, next + d, here + d);
        }
    return s;
}

static void turn_over(solid *s) {
    for (int64_t t = 0; t < s->triangles; t++) {
        const int32_t swap = s->corners[3 * t + 1];
        s->corners[3 * t + 1] = s->corners[3 * t + 2];
        s->corners[3 * t + 2] = swap;
    }
}

solid solid_shell(double outer, double inner, int around, int down) {
    solid s = solid_sphere(outer, around, down), hole = solid_sphere(inner, around, down);
    turn_over(&hole);
    solid_add(&s, &hole);
    solid_free(&hole);
    return s;
}

/* Six times the volume of a tetrahedron from the origin, or of a triangle's share of a solid's. */
static double triple(const double *a, const double *b, const double *c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

double solid_volume(const solid *s) {
    double volume = 0;
    for (int64_t t = 0; t < s->triangles; t++) {
        const int32_t *n = s->corners + 3 * t;
        volume += triple(s->positions + 3 * n[0], s->positions + 3 * n[1], s->positions + 3 * n[2]) / 6;
    }
    return volume;
}

solid solid_tetrahedra(int64_t count, double size, const double box[3], uint64_t seed) {
    static const int regular[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    static const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    solid s = allocate(4 * count, 4 * count);
    int32_t *at = s.corners;
    for (int64_t n = 0; n < count; n++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = draw(&seed, -box[k], box[k]);
        for (int v = 0; v < 4; v++)
            for (int k = 0; k < 3; k++)
                s.positions[3 * (4 * n + v) + k] =
                    centre[k] + size * (0.5 * regular[v][k] + draw(&seed, -0.2, 0.2));
        for (int f = 0; f < 4; f++)
            at = corner(at, 4 * n + faces[f][0], 4 * n + faces[f][1], 4 * n + faces[f][2]);
    }
    return s;
}

/* A point on the ray of a pixel at path parameter t (0 source, 1 pixel), then up to `ulps` float steps off. */
static void near_ray(double *at, const skg_view *view, double column, double row, double t, int ulps,
                     uint64_t *seed) {
    const double c = column - (double)(view->columns - 1) / 2, r = row - (double)(view->rows - 1) / 2;
    for (int k = 0; k < 3; k++) {
        const double pixel = view->centre[k] + c * view->column_step[k] + r * view->row_step[k];
        float x = (float)(view->projection == SKG_PROJECTION_POINT
                              ? view->source[k] + t * (pixel - view->source[k])
                              : pixel + (t - 1) * (view->centre[k] - view->source[k]));
        const int64_t steps = draw_below(seed, 2 * ulps + 1) - ulps;
        for (int64_t n = 0; n < steps || n < -steps; n++) x = nextafterf(x, steps > 0 ? FLT_MAX : -FLT_MAX);
        at[k] = (double)x;
    }
}

solid solid_octahedra(int64_t count, const skg_view *view, int ulps, int least, uint64_t seed) {
    solid s = allocate(6 * count, 8 * count);
    int32_t *at = s.corners;
    for (int64_t n = 0; n < count; n++) {
        double *p = s.positions + 18 * n;
        const double t = draw(&seed, 0.4, 0.7), deep = draw(&seed, 0.002, 0.02);
        const double c = (double)(6 + draw_below(&seed, view->columns - 12));
        const double r = (double)(6 + draw_below(&seed, view->rows - 12));
        for (int v = 0; v < 6; v++) { /* 0, 1: +- columns; 2, 3: +- rows; 4, 5: +- along */
            const double way = v % 2 ? -1 : 1;
            const double side = (double)(least + draw_below(&seed, 4)),
                         skew = (double)(draw_below(&seed, 3) - 1);
            const double dc = v / 2 == 0 ? way * side : v / 2 == 1 ? skew : 0;
            const double dr = v / 2 == 1 ? way * side : v / 2 == 0 ? skew : 0;
            near_ray(p + 3 * v, view, c + dc, r + dr, t + (v / 2 == 2 ? way : draw(&seed, -0.5, 0.5)) * deep,
                     ulps, &seed);
        }
        for (int f = 0; f < 8; f++) {
            const int64_t x = 6 * n + (f & 1), y = 6 * n + 2 + (f >> 1 & 1), z = 6 * n + 4 + (f >> 2);
            const int odd = (f & 1) ^ (f >> 1 & 1) ^ (f >> 2);
            at = corner(at, x, odd ? z : y, odd ? y : z);
        }
    }
    if (solid_volume(&s) < 0) turn_over(&s);
    return s;
}

solid solid_plates(int count, double x, double y, double thickness, double gap) {
    solid s = solid_box(x, y, thickness);
    for (int n = 1; n < count; n++) {
        solid plate = solid_box(x, y, thickness);
        solid_shift(&plate, 0, 0, n * (thickness + gap));
        solid_add(&s, &plate);
        solid_free(&plate);
    }
    solid_shift(&s, 0, 0, -(count - 1) * (thickness + gap) / 2);
    return s;
}

void solid_move(solid *s, const double m[12]) {
    for (int64_t n = 0; n < s->vertices; n++) {
        double *p = s->positions + 3 * n, moved[3];
        for (int k = 0; k < 3; k++)
            moved[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
        memcpy(p, moved, sizeof moved);
    }
}

void solid_shift(solid *s, double x, double y, double z) {
    const double m[12] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
    solid_move(s, m);
}

void solid_round(solid *s) {
    for (int64_t n = 0; n < 3 * s->vertices; n++) s->positions[n] = (double)(float)s->positions[n];
}

void solid_add(solid *to, const solid *other) {
    solid s = allocate(to->vertices + other->vertices, to->triangles + other->triangles);
    memcpy(s.positions, to->positions, (size_t)(3 * to->vertices) * sizeof(double));
    memcpy(s.positions + 3 * to->vertices, other->positions, (size_t)(3 * other->vertices) * sizeof(double));
    memcpy(s.corners, to->corners, (size_t)(3 * to->triangles) * sizeof(int32_t));
    for (int64_t n = 0; n < 3 * other->triangles; n++)
        s.corners[3 * to->triangles + n] = other->corners[n] + (int32_t)to->vertices;
    solid_free(to);
    *to = s;
}

solid solid_copy(const solid *from) {
    solid s = allocate(from->vertices, from->triangles);
    memcpy(s.positions, from->positions, (size_t)(3 * from->vertices) * sizeof(double));
    memcpy(s.corners, from->corners, (size_t)(3 * from->triangles) * sizeof(int32_t));
    return s;
}

solid solid_shuffled(const solid *from, uint64_t seed) {
    solid s = solid_copy(from);
    for (int64_t t = s.triangles - 1; t > 0; t--) {
        int32_t *here = s.corners + 3 * t, *there = s.corners + 3 * draw_below(&seed, t + 1), kept[3];
        memcpy(kept, here, sizeof kept);
        memmove(here, there, sizeof kept);
        memcpy(there, kept, sizeof kept);
    }
    return s;
}

solid solid_unwelded(const solid *from) {
    solid s = allocate(3 * from->triangles, from->triangles);
    for (int64_t n = 0; n < 3 * from->triangles; n++) {
        memcpy(s.positions + 3 * n, from->positions + 3 * from->corners[n], 3 * sizeof(double));
        s.corners[n] = (int32_t)n;
    }
    return s;
}
