/* Ribs: a plane each, an axis in the transverse plane through the head, one angle. */
#include "body/body.h"

#include "scene/vector.h"

#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

/* Fall of pump and bucket angle from the resting level to full inspiration, degrees. Ribs 3 to 7: linear
 * between Wilson's end points (J. Appl. Physiol. 62 (1987) 1872); 2 and 8 to 10 extrapolated, 1, 11 and 12
 * chosen: assumptions. */
static const double full_range[12][2] = {{8, 6},  {12, 13.5}, {11, 13}, {10, 12.25}, {9, 11.5}, {8, 10.75},
                                         {7, 10}, {6, 9.25},  {5, 8.5}, {4, 7.75},   {3, 6},    {3, 6}};

/* Weight 1 is a quiet breath: 17 % of the capacity from rest to full inspiration. Angles grow faster than
 * the volume at first and slower at the end (Beyer et al., Respir. Physiol. Neurobiol. 232 (2016) 57; the
 * shape is a choice). */
double skg_rib_fraction(double weight) {
    double v = 0.17 * weight, s = 2 * v - 1;
    if (v <= 0.5) return 1.25 * v;
    return s < 1 ? 0.625 + 0.625 * s - 0.25 * s * s : 1 + 0.125 * (s - 1);
}

/* Normal of the plane through the rib, upward: the least eigenvector of the vertices' scatter. Frame: x to
 * the rib's own side, y to the front, z up. */
static void plane_normal(const skg_body_organ *rib, const double *displacements, double normal[3]) {
    double mean[3] = {0}, scatter[9] = {0}, values[3], vectors[9];
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < rib->vertices; i++) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = rib->rest[3 * i + k] + (displacements ? displacements[3 * i + k] : 0);
            p[0] *= rib->side, p[1] = -p[1];
            for (int k = 0; k < 3; k++) {
                if (pass == 0) mean[k] += p[k] / (double)rib->vertices;
                for (int j = 0; pass == 1 && j < 3; j++)
                    scatter[3 * j + k] += (p[j] - mean[j]) * (p[k] - mean[k]);
            }
        }
    skg_eigen(3, scatter, values, vectors);
    skg_scale_vector(vectors[8] < 0 ? -1 : 1, vectors + 6, normal);
}

static void angles(const double n[3], double *pump, double *bucket) {
    *pump = atan2(n[1], n[2]), *bucket = atan2(n[0], n[2]);
}

void skg_rib_plane(const skg_body_organ *rib, const double *displacements, double *pump, double *bucket) {
    double n[3];
    plane_normal(rib, displacements, n);
    angles(n, pump, bucket);
}

/* Fall of the angles when the normal turns about (x, y, 0), own-side frame. */
static void fall_of(const double normal[3], const double turn[2], double fall[2]) {
    double before[2], after[2], rotation[9], n[3];
    const double vector[3] = {turn[0], turn[1], 0};
    skg_rotation(vector, rotation);
    for (int i = 0; i < 3; i++) n[i] = skg_dot(rotation + 3 * i, normal);
    angles(normal, before, before + 1);
    angles(n, after, after + 1);
    for (int k = 0; k < 2; k++) fall[k] = before[k] - after[k];
}

/* The head: mean of the vertices nearest to the midplane. */
static void find_head(skg_body_organ *rib) {
    double least = HUGE_VAL, count = 0;
    for (int64_t i = 0; i < rib->vertices; i++) {
        double x = rib->side * rib->rest[3 * i], y = rib->rest[3 * i + 1];
        least = fmin(least, x - 0.3 * y); /* not the anterior end, which may be near the midplane too */
    }
    memset(rib->head, 0, sizeof rib->head);
    for (int64_t i = 0; i < rib->vertices; i++)
        if (rib->side * rib->rest[3 * i] - 0.3 * rib->rest[3 * i + 1] < least + 6) {
            skg_add_scaled(rib->head, 1, rib->rest + 3 * i, rib->head);
            count++;
        }
    skg_scale_vector(1 / count, rib->head, rib->head);
}

/* The horizontal rotation vector that gives the table's falls: Newton from the small-angle answer, in which
 * the pump angle falls by the part across the midplane and the bucket angle by the part along it. */
skg_status skg_rib_prepare(skg_body_organ *rib) {
    double normal[3], wanted[2], turn[2];
    find_head(rib);
    plane_normal(rib, NULL, normal);
    for (int k = 0; k < 2; k++) wanted[k] = degree * full_range[rib->number - 1][k];
    turn[0] = wanted[0], turn[1] = -wanted[1];
    for (int step = 0; step < 20; step++) {
        const double h = 1e-6;
        double fall[2], slope[2][2];
        fall_of(normal, turn, fall);
        for (int k = 0; k < 2; k++) {
            double other[2] = {turn[0], turn[1]}, there[2];
            other[k] += h;
            fall_of(normal, other, there);
            for (int j = 0; j < 2; j++) slope[j][k] = (there[j] - fall[j]) / h;
        }
        double det = slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
        double miss[2] = {wanted[0] - fall[0], wanted[1] - fall[1]};
        if (!(fabs(det) > 1e-6))
            return skg_fail(SKG_ERR_BREATHING, "%s: its plane is upright; a rib slopes", rib->label);
        turn[0] += (slope[1][1] * miss[0] - slope[0][1] * miss[1]) / det;
        turn[1] += (slope[0][0] * miss[1] - slope[1][0] * miss[0]) / det;
    }
    /* to the body's frame, a mirror image of the own-side one on the left: det M = -side, M = (side, -1, 1)
     */
    rib->axis[0] = -turn[0];
    rib->axis[1] = rib->side * turn[1];
    rib->axis[2] = 0;
    return SKG_OK;
}
