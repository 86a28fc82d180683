/* Lengths held against the truth, by the bars of docs/numerics.md#precision: single: rms <= 3e-7 Lmax, 99.9 % within 3e-6
 * Lmax, none beyond 3e-5 Lmax; double: none beyond 1e-11 Lmax. Lmax is the longest true path of a picture. Where the true
 * length changes by more than 1e-6 Lmax under shifts of the ray by 4 units in the last place of a coordinate relative to
 * the part, the truth in single is the interval that it takes under these shifts. */
#ifndef SKG_TESTS_VERDICT_H
#define SKG_TESTS_VERDICT_H

#include "support/caster.h"
#include "support/run.h"

/* Errors of one picture or of many, in units of the Lmax of each. Free with verdict_free. */
typedef struct {
    int64_t count, capacity;
    double *errors;
    double longest; /* Lmax of the last picture, mm */
    int32_t single; /* 1: single precision, whose truth may be an interval; set it before verdict_cast */
} verdict;

void verdict_free(verdict *v);

/* One picture: `count` lengths, and the least and greatest that each may be (high NULL: low is the truth).
 * NAN in the truth ends the test. */
void verdict_add(verdict *v, int64_t count, const double *got, const double *low, const double *high);

/* One picture by the caster, at `count` random pixels of the window [first, last] in columns and rows (or
 * all, where there are no more); wobble as in caster_range. */
typedef struct {
    int64_t first_column, last_column, first_row, last_row;
} window;
void verdict_cast(verdict *v, caster *c, const skg_view *view, const double *got, window where, int64_t count,
                  double wobble, uint64_t *seed);

/* The pixels that the solid's shadow may touch, with one around; the whole detector if it reaches the
 * source's plane. */
window window_of(const solid *s, const double *pose, const skg_view *view);

/* The figures, and whether they are within the bars; `what` is printed when they are not. */
double verdict_rms(const verdict *v);
double verdict_worst(const verdict *v);
double verdict_beyond(const verdict *v, double error); /* fraction with a larger error */
void verdict_check(const verdict *v, int32_t precision, const char *what);

#endif
