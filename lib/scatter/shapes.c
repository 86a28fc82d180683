/* The shapes of scattering by free electrons: Klein-Nishina, Thomson. */
#include "scatter/interactions.h"

#include "material/scattering.h"

static const double PI = 3.14159265358979323846;

double skg_klein_nishina(double kev, double cosine) {
    const double left = 1 / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
    return left * left * (left + 1 / left - (1 - cosine * cosine)) / 2;
}

double skg_thomson(double cosine) {
    return (1 + cosine * cosine) / 2;
}

/* Gauss's two points of an interval of length 1: exact for a straight line times a parabola. */
static const double NODE[2] = {0.21132486540518712, 0.78867513459481288};

int64_t skg_shape_weights(const skg_scatter_physics *grid, double kev, double *compton, double *rayleigh) {
    const double back = kev / SKG_HC_KEV_ANGSTROM, scale = grid->momentum_scale;
    const double step = log1p(grid->momentum_high / scale) / (double)(grid->momenta - 1), growth = exp(step);
    const double end = fmin(log1p(back / scale) / step, (double)(grid->momenta - 1));
    const double inner[2] = {exp(NODE[0] * step), exp(NODE[1] * step)};
    double before = 1; /* exp(t), t = ln(1 + x/scale), at the point before the interval */
    int64_t i = 0;
    compton[0] = rayleigh[0] = 0;
    for (; (double)i < end; i++, before *= growth) {
        const double part = fmin(end - (double)i, 1); /* the last interval is cut off */
        compton[i + 1] = rayleigh[i + 1] = 0;
        for (int n = 0; n < 2; n++) {
            const double place = part * NODE[n], risen = before * (part < 1 ? exp(place * step) : inner[n]);
            const double x = scale * (risen - 1), cosine = 1 - 2 * (x / back) * (x / back);
            /* With u = sin^2(theta/2) = (x/back)^2 the solid angle is 4 pi du, and dx = (x + scale) dt. */
            const double solid = part * step * 4 * PI * x * (x + scale) / (back * back);
            const double own[2] = {solid * skg_klein_nishina(kev, cosine), solid * skg_thomson(cosine)};
            compton[i] += (1 - place) * own[0];
            compton[i + 1] += place * own[0];
            rayleigh[i] += (1 - place) * own[1];
            rayleigh[i + 1] += place * own[1];
        }
    }
    return i + 1;
}
