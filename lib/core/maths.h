/* Small maths: functions, random numbers, vectors. Private. */
#ifndef SKG_MATHS_H
#define SKG_MATHS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* --- Constants and small formulas that every room uses. */

/* pi to the precision of a double. C11 does not define M_PI. An angle in degrees times SKG_PI / 180 is in radians. */
#define SKG_PI 3.14159265358979323846

/* The smaller and the larger of two numbers that are numbers: fmin and fmax are calls. */
static inline double skg_lesser(double a, double b) {
    return a < b ? a : b;
}
static inline double skg_greater(double a, double b) {
    return a > b ? a : b;
}

/* The number of pieces of `size` that hold `count` items: the quotient rounded up. */
static inline int64_t skg_divide_up(int64_t count, int64_t size) {
    return (count + size - 1) / size;
}

/* The smallest multiple of `size` that is not below `count`. */
static inline int64_t skg_round_up(int64_t count, int64_t size) {
    return skg_divide_up(count, size) * size;
}

/* The slope of a monotone cubic at a sample: the harmonic mean of the slopes to the samples on both sides, 0 at a maximum or
 * minimum (F. N. Fritsch and J. Butland, SIAM Journal on Scientific and Statistical Computing 5 (1984) 300-304). */
static inline double skg_monotone_slope(double before, double after) {
    return before * after > 0 ? 2 * before * after / (before + after) : 0;
}

/* --- Random numbers for the host. */

/* A random number from 0 to below 1: splitmix64 of Steele, Lea and Flood (2014). */
static inline double skg_draw(uint64_t *state) {
    uint64_t z = *state += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* A normal deviate that the three numbers decide (Box and Muller 1958). */
static inline double skg_deviate(int64_t seed, int64_t index, int64_t pixel) {
    uint64_t state = (uint64_t)seed * 0x9E3779B97F4A7C15u ^ (uint64_t)index;
    state = (uint64_t)(skg_draw(&state) * 0x1p53) ^ (uint64_t)pixel << 20;
    skg_draw(&state);
    const double u = 1 - skg_draw(&state), v = skg_draw(&state);
    return sqrt(-2 * log(u)) * cos(2 * SKG_PI * v);
}

/* --- Vectors of three doubles and poses (4x4 affine matrices of doubles, row by row). *
 * Both are written here because cglm has float only. A float holds 24 bits: a vertex 500 mm from the origin would
 * be known to 0.03 micrometres, and the rounding of a few chained poses would be visible in path lengths. Poses
 * have to take a vertex to the world within 1e-11 of the scene's size, which doubles do. */

static inline double skg_dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The dot product of vectors of any length, added up in rising order. */
static inline double skg_dot_long(int64_t count, const double *a, const double *b) {
    double sum = 0;
    for (int64_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* The dot products of a with four vectors, each added up in rising order: their sums do not wait for one another. */
static inline void skg_dot_four(int64_t count, const double *a, const double *const b[4], double dots[4]) {
    double sums[4] = {0};
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 4; k++) sums[k] += a[i] * b[k][i];
    memcpy(dots, sums, sizeof sums);
}

static inline void skg_cross(const double *a, const double *b, double *product) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    product[0] = x, product[1] = y, product[2] = z;
}

static inline double skg_length(const double *a) {
    return sqrt(skg_dot(a, a));
}

/* result = a + factor b */
static inline void skg_add_scaled(const double *a, double factor, const double *b, double *result) {
    for (int k = 0; k < 3; k++) result[k] = a[k] + factor * b[k];
}

/* The solid angle of a triangle, from -2 pi to 2 pi, as the origin sees it (A. Van Oosterom and J. Strackee, 1983); positive where
 * its corners run so that the normal points away from the origin. */
static inline double skg_solid_angle(const double *a, const double *b, const double *c) {
    double across[3];
    const double of_a = skg_length(a), of_b = skg_length(b), of_c = skg_length(c);
    skg_cross(b, c, across);
    return 2 * atan2(skg_dot(a, across),
                     of_a * of_b * of_c + skg_dot(a, b) * of_c + skg_dot(a, c) * of_b + skg_dot(b, c) * of_a);
}

static inline void skg_scale_vector(double factor, const double *a, double *result) {
    for (int k = 0; k < 3; k++) result[k] = factor * a[k];
}

static inline int skg_all_finite(const double *numbers, int count) {
    for (int k = 0; k < count; k++)
        if (!isfinite(numbers[k])) return 0;
    return 1;
}

static inline void skg_pose_identity(double *m) {
    for (int i = 0; i < 16; i++) m[i] = i % 5 == 0 ? 1 : 0;
}

/* product = a b. The product may be stored over a or b. */
static inline void skg_pose_multiply(const double *a, const double *b, double *product) {
    double m[16];
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            m[4 * r + c] = a[4 * r] * b[c] + a[4 * r + 1] * b[4 + c] + a[4 * r + 2] * b[8 + c] +
                           a[4 * r + 3] * b[12 + c];
    memcpy(product, m, sizeof m);
}

/* The point m (x, y, z, 1). The result may be stored over p. */
static inline void skg_pose_point(const double *m, const double *p, double *result) {
    double x = p[0], y = p[1], z = p[2];
    for (int r = 0; r < 3; r++) result[r] = m[4 * r] * x + m[4 * r + 1] * y + m[4 * r + 2] * z + m[4 * r + 3];
}

/* Determinant of the linear part: the factor on volumes; negative if the pose mirrors. */
static inline double skg_pose_determinant(const double *m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

static inline void skg_pose_translation(double x, double y, double z, double *m) {
    skg_pose_identity(m);
    m[3] = x, m[7] = y, m[11] = z;
}

static inline void skg_pose_scaling(double x, double y, double z, double *m) {
    skg_pose_identity(m);
    m[0] = x, m[5] = y, m[10] = z;
}

/* Right-handed rotation by an angle in radians about an axis of length 1 through the origin (Rodrigues). */
static inline void skg_pose_rotation(double angle, const double *axis, double *m) {
    double c = cos(angle), s = sin(angle), x = axis[0], y = axis[1], z = axis[2];
    skg_pose_identity(m);
    m[0] = c + x * x * (1 - c), m[1] = x * y * (1 - c) - z * s, m[2] = x * z * (1 - c) + y * s;
    m[4] = y * x * (1 - c) + z * s, m[5] = c + y * y * (1 - c), m[6] = y * z * (1 - c) - x * s;
    m[8] = z * x * (1 - c) - y * s, m[9] = z * y * (1 - c) + x * s, m[10] = c + z * z * (1 - c);
}

#endif
