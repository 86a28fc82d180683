/* From points of the search, whose coordinates go from 0 to 1, to parameters and back. Each coordinate is a parameter over its
 * range, but for the two angles of the plane: where the normal points upward the azimuth means nothing, and a search that
 * comes there would not leave it again. Instead of the angles, the search has the horizontal components of the normal. */
#include "core/maths.h"
#include "fit/types.h"

#include <math.h>

static const double degree = SKG_PI / 180;

/* The least and the greatest horizontal components of the normal within the ranges of its angles. */
typedef struct {
    double low[2], high[2];
} normal_box;

int64_t skg_fit_dimensions(const skg_fit *fit) {
    int64_t count = 0;
    for (int p = 0; p < BODY_PARAMETERS; p++) count += fit->chosen[p];
    return count;
}

/* Whether the normal is searched by its components: both angles are, and it does not point downward, where other normals have
 * the same components. */
static int has_components(const skg_fit *fit) {
    return fit->chosen[BODY_AZIMUTH] && fit->chosen[BODY_ELEVATION] && fit->low[BODY_ELEVATION] >= 0;
}

static void components_of(double azimuth, double elevation, double normal[2]) {
    normal[0] = cos(elevation * degree) * cos(azimuth * degree);
    normal[1] = cos(elevation * degree) * sin(azimuth * degree);
}

static normal_box find_box(const skg_fit *fit) {
    enum { STEPS = 72 };
    normal_box box = {{1, 1}, {-1, -1}};
    const double low = fit->low[BODY_AZIMUTH], high = fit->high[BODY_AZIMUTH];
    for (int s = 0; s <= STEPS; s++)
        for (int end = 0; end < 2; end++) {
            double normal[2];
            components_of(low + (high - low) * s / STEPS, (end ? fit->high : fit->low)[BODY_ELEVATION],
                          normal);
            for (int k = 0; k < 2; k++) {
                box.low[k] = fmin(box.low[k], normal[k]);
                box.high[k] = fmax(box.high[k], normal[k]);
            }
        }
    return box;
}

static double limit(const skg_fit *fit, int p, double value) {
    return fmin(fmax(value, fit->low[p]), fit->high[p]);
}

/* Angles in their ranges from components over their box. */
static void set_angles(const skg_fit *fit, const double *point, double *values) {
    const normal_box box = find_box(fit);
    double normal[2];
    for (int k = 0; k < 2; k++) normal[k] = box.low[k] + point[k] * (box.high[k] - box.low[k]);
    const double middle = 0.5 * (fit->low[BODY_AZIMUTH] + fit->high[BODY_AZIMUTH]);
    const double azimuth = atan2(normal[1], normal[0]) / degree;
    const double turned = azimuth + 360 * round((middle - azimuth) / 360); /* nearest to the range */
    values[BODY_AZIMUTH] = limit(fit, BODY_AZIMUTH, turned);
    values[BODY_ELEVATION] = limit(fit, BODY_ELEVATION, acos(fmin(hypot(normal[0], normal[1]), 1)) / degree);
}

static void set_components(const skg_fit *fit, const double *values, double *point) {
    const normal_box box = find_box(fit);
    double normal[2];
    components_of(limit(fit, BODY_AZIMUTH, values[BODY_AZIMUTH]),
                  limit(fit, BODY_ELEVATION, values[BODY_ELEVATION]), normal);
    for (int k = 0; k < 2; k++)
        point[k] = fmin(fmax((normal[k] - box.low[k]) / (box.high[k] - box.low[k]), 0), 1);
}

void skg_fit_values_at(const skg_fit *fit, const double *point, double *values) {
    const double *at = point;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        if (p == BODY_AZIMUTH && has_components(fit)) set_angles(fit, at, values);
        if (p > BODY_ELEVATION || p < BODY_AZIMUTH || !has_components(fit))
            values[p] = fit->chosen[p] ? fit->low[p] + *at * (fit->high[p] - fit->low[p]) : fit->start[p];
        at += fit->chosen[p];
    }
}

void skg_fit_point_of(const skg_fit *fit, const double *values, double *point) {
    double *at = point;
    for (int p = 0; p < BODY_PARAMETERS; p++) {
        if (p == BODY_AZIMUTH && has_components(fit)) set_components(fit, values, at);
        if (fit->chosen[p] && (p > BODY_ELEVATION || p < BODY_AZIMUTH || !has_components(fit)))
            *at = (limit(fit, p, values[p]) - fit->low[p]) / (fit->high[p] - fit->low[p]);
        at += fit->chosen[p];
    }
}
