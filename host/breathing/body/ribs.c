/* How ribs turn about their axes with the breath. */
#include "body/bones.h"

#include "core/eigen.h"
#include "core/maths.h"

#include <string.h>

static const double degree = SKG_PI / 180;

/* By how many degrees pump and bucket angle of ribs 1 to 12 fall from relaxed expiration to full inspiration. Ribs 3
 * to 7 are linear between the end points of Wilson et al. (J. Appl. Physiol. 62 (1987) 1872). Ribs 2 and 8 to 10 are
 * extrapolated, and 1, 11 and 12 chosen: assumptions. */
static const double full_range[12][2] = {{8, 6},  {12, 13.5}, {11, 13}, {10, 12.25}, {9, 11.5}, {8, 10.75},
                                         {7, 10}, {6, 9.25},  {5, 8.5}, {4, 7.75},   {3, 6},    {3, 6}};

static double table_angle(int number) {
    return degree * hypot(full_range[number - 1][0], full_range[number - 1][1]);
}

double skg_rib_angle(void) {
    return table_angle(5);
}

/* The factor falls along the ribs, so that the angles fall by so much more. */
double skg_rib_factor(const skg_body_options *options, const skg_body_organ *rib) {
    if (rib->role != ROLE_RIB) return 1;
    const double fall = options->rib_fall_rad * (rib->number - 5) / table_angle(rib->number);
    return options->rib_angle_rad / table_angle(5) - fall;
}

/* Weight 1 is a quiet breath: 0.5 of about 3 l, 17 % of the volume v from rest to full inspiration. Angles grow
 * faster than the volume at first and slower at the end (Beyer et al., Respir. Physiol. Neurobiol. 232 (2016) 57).
 * The curve is a choice: straight to half the volume, from there a parabola of the same slope, 1.25, to 1 at full
 * inspiration, then its tangent. */
double skg_rib_fraction(double weight) {
    double v = 0.17 * weight, s = 2 * v - 1;
    if (v <= 0.5) return 1.25 * v;
    return s < 1 ? 0.625 + 0.625 * s - 0.25 * s * s : 1 + 0.125 * (s - 1);
}

/* Upward normal of the plane through a rib: the least eigenvector of the vertices' scatter. In own-side axes: x to
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

/* Fall of the angles when the normal turns by the rotation vector turn[0] basis[0..2] + turn[1] basis[3..5], in
 * own-side axes. */
static void fall_of(const double normal[3], const double basis[6], const double turn[2], double fall[2]) {
    double before[2], after[2], rotation[9], n[3], vector[3];
    skg_scale_vector(turn[0], basis, vector);
    skg_add_scaled(vector, turn[1], basis + 3, vector);
    skg_rotation(vector, rotation);
    for (int i = 0; i < 3; i++) n[i] = skg_dot(rotation + 3 * i, normal);
    angles(normal, before, before + 1);
    angles(n, after, after + 1);
    for (int k = 0; k < 2; k++) fall[k] = before[k] - after[k];
}

/* The head: the mean of the vertices nearest to the midplane, to within 6 mm, half the height of a rib. */
static void find_head(skg_body_organ *rib) {
    double least = HUGE_VAL, count = 0;
    for (int64_t i = 0; i < rib->vertices; i++) {
        double x = rib->side * rib->rest[3 * i], y = rib->rest[3 * i + 1];
        least =
            fmin(least, x - 0.3 * y); /* the anterior end may be near the midplane too, so the back counts */
    }
    memset(rib->turn.head, 0, sizeof rib->turn.head);
    for (int64_t i = 0; i < rib->vertices; i++)
        if (rib->side * rib->rest[3 * i] - 0.3 * rib->rest[3 * i + 1] < least + 6) {
            skg_add_scaled(rib->turn.head, 1, rib->rest + 3 * i, rib->turn.head);
            count++;
        }
    skg_scale_vector(1 / count, rib->turn.head, rib->turn.head);
}

/* From the body's axes to own-side axes, which on the left are their mirror image, and back. axial: 1 for rotation
 * vectors, which a mirror image reverses. */
static void to_own_side(const skg_body_organ *rib, int axial, const double from[3], double to[3]) {
    const double sign = axial ? -rib->side : 1; /* det M of M = (side, -1, 1) */
    to[0] = sign * rib->side * from[0], to[1] = -sign * from[1], to[2] = sign * from[2];
}

/* Finds, in the span of a basis (own-side axes), the rotation vector that gives the falls of the table. Newton's
 * method starts from 0, near the smallest solution: the pump angle falls with the component across the midplane, the
 * bucket angle with the component along it. 20 steps are more than enough, as convergence is quadratic. */
static skg_status solve_turn(skg_body_organ *rib, const double basis[6]) {
    double normal[3], wanted[2], turn[2] = {0}, sum[3];
    plane_normal(rib, NULL, normal);
    for (int k = 0; k < 2; k++) wanted[k] = degree * full_range[rib->number - 1][k];
    for (int step = 0; step < 20; step++) {
        const double h = 1e-6; /* rad; about the square root of a double's rounding */
        double fall[2], slope[2][2];
        fall_of(normal, basis, turn, fall);
        for (int k = 0; k < 2; k++) {
            double other[2] = {turn[0], turn[1]}, there[2];
            other[k] += h;
            fall_of(normal, basis, other, there);
            for (int j = 0; j < 2; j++) slope[j][k] = (there[j] - fall[j]) / h;
        }
        double det = slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
        double miss[2] = {wanted[0] - fall[0], wanted[1] - fall[1]};
        if (!(fabs(det) > 1e-6)) /* 1 for a level rib; above the rounding of the differences, 1e-10 */
            return skg_fail(SKG_ERR_BREATHING, "%s: its plane is upright; a rib slopes", rib->label);
        turn[0] += (slope[1][1] * miss[0] - slope[0][1] * miss[1]) / det;
        turn[1] += (slope[0][0] * miss[1] - slope[1][0] * miss[0]) / det;
    }
    skg_scale_vector(turn[0], basis, sum);
    skg_add_scaled(sum, turn[1], basis + 3, sum);
    to_own_side(rib, 1, sum, rib->turn.axis);
    return SKG_OK;
}

/* One rotation by both angles of the table about an axis, in the direction that raises the rib. */
static void turn_about(skg_body_organ *rib, const double along[3]) {
    const double *range = full_range[rib->number - 1];
    double mean[3] = {0}, lever[3], motion[3];
    for (int64_t i = 0; i < rib->vertices; i++)
        skg_add_scaled(mean, 1 / (double)rib->vertices, rib->rest + 3 * i, mean);
    skg_add_scaled(mean, -1, rib->turn.head, lever);
    skg_cross(along, lever, motion);
    skg_scale_vector((motion[2] < 0 ? -1 : 1) * degree * hypot(range[0], range[1]), along, rib->turn.axis);
}

/* By the bones: both angles about the axis from head to tubercle; without vertebrae about the two longer principal
 * axes of inertia. */
static skg_status prepare_by_bones(const skg_body *body, skg_body_organ *rib, double head[3]) {
    double along[3], axes[9], basis[6];
    if (skg_rib_bone_axis(body, rib, head, along)) {
        turn_about(rib, along);
        return SKG_OK;
    }
    skg_inertia_axes(rib, axes, head);
    for (int k = 0; k < 2; k++) to_own_side(rib, 1, axes + 3 * k, basis + 3 * k);
    return solve_turn(rib, basis);
}

skg_status skg_rib_prepare(const skg_body *body, skg_body_organ *rib) {
    static const double horizontal[6] = {1, 0, 0, 0, 1, 0};
    const int by_bones = body->options.rib_axes == SKG_RIB_AXES_BONES;
    double given[2][3], head[3];
    memcpy(given[0], rib->turn.axis, sizeof given[0]);
    memcpy(given[1], rib->turn.head, sizeof given[1]);
    find_head(rib);
    if (by_bones)
        SKG_TRY(prepare_by_bones(body, rib, head));
    else
        SKG_TRY(solve_turn(rib, horizontal));
    if (by_bones) memcpy(rib->turn.head, head, sizeof head);
    if (rib->turn.given) memcpy(rib->turn.axis, given[0], sizeof given[0]);
    if (rib->turn.centred) memcpy(rib->turn.head, given[1], sizeof given[1]);
    return SKG_OK;
}
