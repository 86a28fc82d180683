/* The motion of a diaphragm's dome. */
#include "body/shares.h"

#include <math.h>
#include <string.h>

/* The tops of the domes lie halfway from the middle to the sides: a choice. */
static const double top_at = 0.5;

/* 0 in the middle, 1 from the tops outward, smooth at both ends. */
static double rise(double x) {
    const double t = fmin(fmax(x, 0), 1);
    return t * t * (3 - 2 * t);
}

void skg_dome_motion(const skg_body *body, const double p[3], double motion[3]) {
    const skg_body_options *options = &body->options;
    const double left = options->dome_left_mm, right = options->dome_right_mm, back = options->dome_back_mm;
    memcpy(motion, options->tendon_mm, 3 * sizeof *motion);
    if (left == 0 && right == 0 && back == 0) return;
    if (body->diaphragm < 0) return;
    const double *b = body->organ[body->diaphragm].bounds;
    const double x = (p[0] - 0.5 * (b[0] + b[3])) / fmax(top_at * 0.5 * (b[3] - b[0]), 1e-9);
    const double y = (p[1] - 0.5 * (b[1] + b[4])) / fmax(0.5 * (b[4] - b[1]), 1e-9);
    motion[2] -= left * rise(x) + right * rise(-x) + back * fmin(fmax(y, -1), 1);
}
