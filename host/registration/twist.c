/* Motions of the body, of source and detector: twists, steps, directions of derivatives. */
#include "registration/types.h"

#include <string.h>

/* sin(x)/x, (1 - cos x)/x^2 and (x - sin x)/x^3; series near 0, whose next terms are below 1e-16 there. */
static void coefficients(double x, double c[3]) {
    const double q = x * x;
    if (x < 1e-3) {
        c[0] = 1 - q / 6, c[1] = 0.5 - q / 24, c[2] = 1.0 / 6 - q / 120;
        return;
    }
    c[0] = sin(x) / x, c[1] = (1 - cos(x)) / q, c[2] = (x - sin(x)) / (q * x);
}

void reg_motion_of(const double *twist, double *motion) {
    const double *t = twist, *w = twist + 3;
    const double angle = skg_length(w);
    double c[3], axis[3] = {1, 0, 0}, wt[3], wwt[3];
    coefficients(angle, c);
    if (angle > 0) skg_scale_vector(1 / angle, w, axis);
    skg_pose_rotation(angle, axis, motion);
    skg_cross(w, t, wt);
    skg_cross(w, wt, wwt);
    for (int k = 0; k < 3; k++) motion[4 * k + 3] = t[k] + c[1] * wt[k] + c[2] * wwt[k];
}

/* The rotation vector of a rotation: from its quaternion, whose largest component is found first (S. W. Shepperd, Journal of Guidance
 * and Control 1 (1978) 223-224). */
static void rotation_vector(const double *m, double *w) {
    const double trace = m[0] + m[5] + m[10];
    const double squares[4] = {1 + trace, 1 + 2 * m[0] - trace, 1 + 2 * m[5] - trace, 1 + 2 * m[10] - trace};
    const double pair[3] = {m[9] - m[6], m[2] - m[8], m[4] - m[1]};
    double q[4]; /* four times q times its largest component */
    int most = 0;
    for (int k = 1; k < 4; k++)
        if (squares[k] > squares[most]) most = k;
    if (most == 0) {
        q[0] = squares[0], q[1] = pair[0], q[2] = pair[1], q[3] = pair[2];
    } else {
        const int i = most - 1;
        q[0] = pair[i];
        for (int k = 0; k < 3; k++) q[1 + k] = k == i ? squares[most] : m[4 * i + k] + m[4 * k + i];
    }
    const double sign = q[0] < 0 ? -1 : 1, length = skg_length(q + 1);
    const double angle = 2 * atan2(length, sign * q[0]);
    for (int k = 0; k < 3; k++) w[k] = length > 0 ? sign * q[1 + k] / length * angle : 0;
}

void reg_twist_of(const double *motion, double *twist) {
    const double p[3] = {motion[3], motion[7], motion[11]};
    double *w = twist + 3, wp[3], wwp[3], c[3];
    rotation_vector(motion, w);
    const double angle = skg_length(w);
    coefficients(angle, c);
    skg_cross(w, p, wp);
    skg_cross(w, wp, wwp);
    /* (1 - x sin x / (2 (1 - cos x))) / x^2, and its limit */
    const double last = angle < 1e-3 ? 1.0 / 12 : (1 - c[0] / (2 * c[1])) / (angle * angle);
    for (int k = 0; k < 3; k++) twist[k] = p[k] - 0.5 * wp[k] + last * wwp[k];
}

int64_t reg_local_count(const skg_registration *r) {
    const int32_t what = r->options.free;
    if (what == SKG_REGISTRATION_FREE_POSE) return REG_POSE;
    return (what & SKG_REGISTRATION_FREE_SOURCE ? 3 : 0) + (what & SKG_REGISTRATION_FREE_DETECTOR ? 6 : 0);
}

int64_t reg_count(const skg_registration *r) {
    return r->options.free == SKG_REGISTRATION_FREE_POSE ? REG_POSE : r->image_count * reg_local_count(r);
}

int64_t reg_first(const skg_registration *r, int64_t image) {
    return r->options.free == SKG_REGISTRATION_FREE_POSE ? 0 : image * reg_local_count(r);
}

/* The motion of a shift and of a turn about a point. */
static void motion_about(const double *point, const double *shift, const double *turn, double *motion) {
    double twist[6] = {0, 0, 0, turn[0], turn[1], turn[2]}, moved[3];
    reg_motion_of(twist, motion);
    skg_pose_point(motion, point, moved);
    for (int k = 0; k < 3; k++) motion[4 * k + 3] += point[k] - moved[k] + shift[k];
}

/* The rim of a detector: half its diagonal. */
static double detector_radius(const skg_view *view) {
    return 0.5 * hypot((double)view->columns * skg_length(view->column_step),
                       (double)view->rows * skg_length(view->row_step));
}

static void turn_vector(const double *motion, double *vector) {
    const double v[3] = {vector[0], vector[1], vector[2]};
    for (int k = 0; k < 3; k++) vector[k] = skg_dot(motion + 4 * k, v);
}

static void move_view(const skg_registration *r, const double *step, skg_view *view) {
    if (r->options.free & SKG_REGISTRATION_FREE_SOURCE) {
        skg_add_scaled(view->source, 1, step, view->source);
        step += 3;
    }
    if (!(r->options.free & SKG_REGISTRATION_FREE_DETECTOR)) return;
    double motion[16], turn[3];
    skg_scale_vector(1 / detector_radius(view), step + 3, turn);
    motion_about(view->centre, step, turn, motion);
    skg_pose_point(motion, view->centre, view->centre);
    turn_vector(motion, view->column_step);
    turn_vector(motion, view->row_step);
}

void reg_state_move(const skg_registration *r, const double *step, reg_state *state) {
    if (r->options.free == SKG_REGISTRATION_FREE_POSE) {
        double middle[3], turn[3], motion[16];
        skg_pose_point(state->motion, r->middle, middle);
        skg_scale_vector(1 / r->radius, step + 3, turn);
        motion_about(middle, step, turn, motion);
        skg_pose_multiply(motion, state->motion, state->motion);
        return;
    }
    for (int64_t i = 0; i < r->image_count; i++) move_view(r, step + reg_first(r, i), &state->views[i]);
}

/* The twist about the world's origin of shift k, or of turn k - 3 about a point by what moves the rim by a mm. */
static void unit_twist(const double *point, double radius, int64_t k, double *twist) {
    memset(twist, 0, 6 * sizeof *twist);
    if (k < 3) {
        twist[k] = 1;
        return;
    }
    twist[k] = 1 / radius;
    skg_cross(point, twist + 3, twist); /* the point stays */
}

void reg_direction(const skg_registration *r, const reg_state *state, int64_t image, int64_t k,
                   skg_direction *direction, double *poses, double *source, double *detector) {
    const skg_view *view = &state->views[image];
    skg_direction_init(direction);
    if (r->options.free == SKG_REGISTRATION_FREE_POSE) {
        double middle[3], twist[6];
        skg_pose_point(state->motion, r->middle, middle);
        unit_twist(middle, r->radius, k, twist);
        for (int64_t p = 0; p < r->body.count; p++) memcpy(poses + 6 * r->body.parts[p], twist, sizeof twist);
        direction->poses = poses;
        return;
    }
    if (r->options.free & SKG_REGISTRATION_FREE_SOURCE) {
        if (k < 3) {
            memset(source, 0, 3 * sizeof *source);
            source[k] = 1;
            direction->source = source;
            return;
        }
        k -= 3;
    }
    unit_twist(view->centre, detector_radius(view), k, detector);
    direction->detector = detector;
}

skg_status reg_state_create(const skg_registration *r, reg_state *state) {
    SKG_TRY(skg_alloc(r->image_count, sizeof *state->views, "views of a registration", &state->views));
    SKG_TRY(skg_alloc(r->image_count * REG_NUISANCES, sizeof *state->nuisances, "polynomials",
                      &state->nuisances));
    reg_motion_of(r->options.start, state->motion);
    for (int64_t i = 0; i < r->image_count; i++) state->views[i] = r->images[i].view;
    return SKG_OK;
}

void reg_state_copy(const skg_registration *r, const reg_state *from, reg_state *to) {
    memcpy(to->motion, from->motion, sizeof to->motion);
    to->body_gain = from->body_gain;
    memcpy(to->views, from->views, (size_t)r->image_count * sizeof *to->views);
    memcpy(to->nuisances, from->nuisances, (size_t)(r->image_count * REG_NUISANCES) * sizeof *to->nuisances);
}

void reg_state_free(reg_state *state) {
    skg_free(&state->views);
    skg_free(&state->nuisances);
}
