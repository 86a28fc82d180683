/* Curved detectors of tests, and their columns as flat detectors, by the definition of the interface. Read in one file of a program. */
#ifndef SKG_TESTS_CURVED_VIEWS_H
#define SKG_TESTS_CURVED_VIEWS_H

#include "support/run.h"

#include <math.h>

enum { COLUMNS = 75, ROWS = 61, PIXELS = COLUMNS * ROWS };

/* Column k of a curved detector as a flat one, by the definition of the interface: on a cylinder that touches the plane of the view in its
 * middle, whose axis is parallel to the rows' step and lies towards the source. */
static skg_view column_of(const skg_view *view, int64_t k) {
    skg_view one = *view;
    double normal[3], across[3], way[3], width = 0, facing = 0;
    const double *c = view->column_step, *r = view->row_step;
    for (int n = 0; n < 3; n++) width += c[n] * c[n];
    width = sqrt(width);
    for (int n = 0; n < 3; n++) {
        const int a = (n + 1) % 3, b = (n + 2) % 3;
        normal[n] = c[a] * r[b] - c[b] * r[a];
        across[n] = c[n] / width;
        way[n] = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY
                     ? -view->source[n]
                     : view->source[n] - view->centre[n];
        facing += normal[n] * way[n];
    }
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    const double angle = ((double)k - (double)(view->columns - 1) / 2) * width / view->radius;
    one.columns = 1;
    one.radius = 0;
    for (int n = 0; n < 3; n++) {
        normal[n] /= facing < 0 ? -length : length;
        one.centre[n] += view->radius * (sin(angle) * across[n] + (1 - cos(angle)) * normal[n]);
        one.column_step[n] = width * (cos(angle) * across[n] + sin(angle) * normal[n]);
    }
    /* The direction of a parallel beam is that of the view, and so is the plane where its rays start. */
    if (one.projection == SKG_PROJECTION_PARALLEL) {
        double square = 0, along = 0;
        for (int n = 0; n < 3; n++) {
            way[n] = view->centre[n] - view->source[n];
            square += way[n] * way[n], along += way[n] * (one.centre[n] - view->source[n]);
        }
        for (int n = 0; n < 3; n++) one.source[n] = one.centre[n] - along / square * way[n];
    }
    return one;
}

typedef struct {
    const char *name;
    double radius, source[3], centre[3];
    int32_t projection;
} geometry;

/* Detectors at z = 200 about. */
static const geometry geometries[] = {
    {"axis through the source", 1200, {0, 0, -1000}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"axis near the detector", 420, {0, 0, -1000}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"axis behind the source", 5000, {0, 0, -700}, {3, -2, 150}, SKG_PROJECTION_POINT},
    {"source beside the middle", 700, {90, -120, -600}, {-20, 15, 200}, SKG_PROJECTION_POINT},
    {"cone from far above", 900, {-30, 260, -640}, {0, 0, 200}, SKG_PROJECTION_POINT},
    {"parallel beam", 380, {40, 90, -600}, {0, 5, 200}, SKG_PROJECTION_PARALLEL},
    {"parallel beam from infinity", 300, {0.2, -0.1, 1}, {0, 5, 200}, SKG_PROJECTION_PARALLEL_FROM_INFINITY},
};
enum { GEOMETRIES = sizeof geometries / sizeof *geometries };

/* Turned about no axis in particular, with columns that grow to one side or the other. */
static skg_view view_of(const geometry *g, int mirrored) {
    skg_view view = run_view(0, 1);
    view.columns = COLUMNS, view.rows = ROWS;
    view.radius = g->radius;
    view.projection = g->projection;
    const double turn = 0.1, tilt = mirrored ? -0.05 : 0.05;
    const double across[3] = {cos(turn), sin(turn) * cos(tilt), sin(turn) * sin(tilt)},
                 down[3] = {-sin(turn), cos(turn) * cos(tilt), cos(turn) * sin(tilt)};
    for (int k = 0; k < 3; k++) {
        view.source[k] = g->source[k], view.centre[k] = g->centre[k];
        view.column_step[k] = (mirrored ? -4.1 : 4.1) * across[k];
        view.row_step[k] = 3.3 * down[k];
    }
    return view;
}

#endif
