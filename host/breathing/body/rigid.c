/* Rotations and rigid fits. */
#include "body/rigid.h"

#include "core/eigen.h"
#include "core/maths.h"

#include <string.h>

void skg_rotation(const double vector[3], double rotation[9]) {
    double angle = skg_length(vector), c = cos(angle);
    double s = angle > 1e-8 ? sin(angle) / angle : 1, t = angle > 1e-8 ? (1 - c) / (angle * angle) : 0.5;
    const double *v = vector;
    const double cross[9] = {0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            rotation[3 * i + j] = (i == j ? c : 0) + s * cross[3 * i + j] + t * v[i] * v[j];
}

void skg_rigid_displace(const skg_rigid *rigid, const double point[3], double displacement[3]) {
    double p[3];
    skg_add_scaled(point, -1, rigid->centre, p);
    for (int i = 0; i < 3; i++)
        displacement[i] = skg_dot(rigid->rotation + 3 * i, p) - p[i] + rigid->shift[i];
}

void skg_rigid_fit(int64_t count, const double *points, const double *displacements, skg_rigid *rigid) {
    double s[3][3] = {{0}}, values[4], q[16];
    memset(rigid, 0, sizeof *rigid);
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            rigid->centre[k] += points[3 * i + k] / (double)count;
            rigid->shift[k] += displacements[3 * i + k] / (double)count;
        }
    for (int64_t i = 0; i < count; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) {
                double from = points[3 * i + j] - rigid->centre[j], to = points[3 * i + k] - rigid->centre[k];
                s[j][k] += from * (to + displacements[3 * i + k] - rigid->shift[k]);
            }
    double n[16] = {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1],           s[2][0] - s[0][2],
                    s[0][1] - s[1][0],           s[1][2] - s[2][1],           s[0][0] - s[1][1] - s[2][2],
                    s[0][1] + s[1][0],           s[2][0] + s[0][2],           s[2][0] - s[0][2],
                    s[0][1] + s[1][0],           s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1],
                    s[0][1] - s[1][0],           s[2][0] + s[0][2],           s[1][2] + s[2][1],
                    s[2][2] - s[0][0] - s[1][1]};
    skg_eigen(4, n, values, q);
    double w = q[0], x = q[1], y = q[2], z = q[3];
    const double rotation[9] = {
        w * w + x * x - y * y - z * z, 2 * (x * y - w * z),           2 * (x * z + w * y),
        2 * (x * y + w * z),           w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
        2 * (x * z - w * y),           2 * (y * z + w * x),           w * w - x * x - y * y + z * z};
    memcpy(rigid->rotation, rotation, sizeof rotation);
}
