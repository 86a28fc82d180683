/* Judges the lengths in single precision of every pixel of a picture. */
#ifndef BENCH_HARD_JUDGE_H
#define BENCH_HARD_JUDGE_H

#include "support/shapes.h"

/* Counts of pixels, and errors in units of L, the longest path of a picture. */
typedef struct {
    int64_t pixels, met; /* all; those whose ray meets the body */
    int64_t judged;      /* by the ray caster: single and double precision differ by nearly the bar or more */
    int64_t thin;   /* of these, beyond the bar, but between two steep faces that are nearer than the shift */
    int64_t folded; /* of these, beyond that, but among more than two such faces, within their depths */
    int64_t out;    /* of these, out of bar */
    /* of those met: single and double precision differ by more than 3e-5 L and 5e-7 D together */
    int64_t rough;
    double worst, lowest; /* distance from the interval of the judged ones; least length of all */
} hard_verdict;

/* The bars of docs/numerics.md#precision. A pixel is within the bar if its length in single precision is within 3e-5 L of
 * the interval that the exact length takes under shifts of the ray by 4 units in the last place of the coordinate relative
 * to the part. Its length in double precision is a value of this interval, so that only the pixels in which the two
 * differ by more need the caster. share: of the extent D along the rays, by which a length may be off at least. */
void hard_judge(const solid *s, const skg_view *view, double share, const float *single, const double *twice,
                const char *name, hard_verdict *v);

#endif
