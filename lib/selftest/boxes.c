/* Boxes with formulas for their path lengths. */
#include "selftest/selftest.h"

#include <math.h>

enum { CORNERS = 8, FACES = 12 };

skg_box skg_box_turned(const double *centre, const double *half, const double *angles) {
    const double c[3] = {cos(angles[0]), cos(angles[1]), cos(angles[2])};
    const double s[3] = {sin(angles[0]), sin(angles[1]), sin(angles[2])};
    skg_box box = {.axes = {c[1] * c[2], c[1] * s[2], -s[1], /* x */
                            s[0] * s[1] * c[2] - c[0] * s[2], s[0] * s[1] * s[2] + c[0] * c[2],
                            s[0] * c[1], /* y */
                            c[0] * s[1] * c[2] + s[0] * s[2], c[0] * s[1] * s[2] - s[0] * c[2], c[0] * c[1]}};
    for (int k = 0; k < 3; k++) box.centre[k] = centre[k], box.half[k] = half[k];
    return box;
}

void skg_box_corner(const skg_box *box, int number, double *position) {
    for (int k = 0; k < 3; k++) {
        position[k] = box->centre[k];
        for (int axis = 0; axis < 3; axis++)
            position[k] += (number >> axis & 1 ? 1 : -1) * box->half[axis] * box->axes[3 * axis + k];
    }
}

skg_status skg_boxes_mesh(skg_context *context, const skg_box *boxes, int64_t count, int32_t split,
                          skg_mesh **mesh) {
    /* Anticlockwise as seen from outside. The first face has the corners 0 and 2 of the edge that is split. */
    static const int32_t faces[FACES][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_status status = SKG_OK;
    int64_t vertices = CORNERS * count, triangles = FACES * count;
    *mesh = NULL;
    SKG_TRY_CLEANUP(skg_alloc(3 * (vertices + 1), sizeof *positions, "boxes", &positions));
    SKG_TRY_CLEANUP(skg_alloc(3 * (triangles + 1), sizeof *corners, "boxes", &corners));
    for (int64_t b = 0; b < count; b++) {
        for (int n = 0; n < CORNERS; n++) skg_box_corner(&boxes[b], n, positions + 3 * (CORNERS * b + n));
        for (int f = 0; f < FACES; f++)
            for (int k = 0; k < 3; k++)
                corners[3 * (FACES * b + f) + k] = (int32_t)(CORNERS * b) + faces[f][k];
    }
    if (split) { /* (0, 2, 1) becomes (0, m, 1) and (m, 2, 1) */
        for (int k = 0; k < 3; k++) positions[3 * vertices + k] = (positions[k] + positions[6 + k]) / 2;
        corners[1] = (int32_t)vertices;
        corners[3 * triangles] = (int32_t)vertices, corners[3 * triangles + 1] = 2,
                    corners[3 * triangles + 2] = 1;
        vertices++, triangles++;
    }
    status = skg_mesh_create(context, "boxes",
                             &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                .vertices = vertices,
                                                .positions = positions,
                                                .triangles = triangles,
                                                .corners = corners,
                                                .unit_mm = 1},
                             mesh);
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

int skg_box_crossed(const skg_box *box, const double *from, const double *to, double *enters,
                    double *leaves) {
    *enters = 0, *leaves = 1;
    for (int axis = 0; axis < 3; axis++) {
        double start = 0, along = 0;
        for (int k = 0; k < 3; k++) {
            start += (from[k] - box->centre[k]) * box->axes[3 * axis + k];
            along += (to[k] - from[k]) * box->axes[3 * axis + k];
        }
        const double a = (-box->half[axis] - start) / along, b = (box->half[axis] - start) / along;
        *enters = fmax(*enters, fmin(a, b));
        *leaves = fmin(*leaves, fmax(a, b));
    }
    return *enters < *leaves;
}
