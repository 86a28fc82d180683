/* The liver's motion below the diaphragm: course, shear and growth. */
#include "body/shares.h"

#include "body/links.h"
#include "core/maths.h"

/* Where the liver touches the dome: at most this far below it, in mm, and at most so near to the rim. Choices. */
static const double liver_reach = 9, dome_from = 0.5;

skg_status skg_liver_find(const skg_body_organ *diaphragm, skg_body_organ *o) {
    SKG_TRY(skg_alloc(o->vertices, sizeof *o->coupling.base, o->label, &o->coupling.base));
#pragma omp parallel for schedule(dynamic, 64)
    for (int64_t i = 0; i < o->vertices; i++) {
        skg_link link = {.fraction = 1};
        skg_base *base = o->coupling.base + i;
        base->away = skg_nearest(diaphragm, o->rest + 3 * i, liver_reach, &link);
        for (int c = 0; c < 3; c++) base->corner[c] = link.corner[c], base->weight[c] = link.weight[c];
    }
    return SKG_OK;
}

/* The diaphragm's share near a vertex of the liver; below dome_from: the vertex does not touch the dome. */
static double dome_over(const skg_body_organ *diaphragm, const skg_base *base) {
    double share = 0;
    if (base->away == HUGE_VAL) return 0;
    for (int c = 0; c < 3; c++)
        share += base->weight[c] * diaphragm->coupling.share[diaphragm->node_of[base->corner[c]]];
    return share;
}

/* Two directions across the tendon's motion, not of length 1. */
static void across(const double along[3], double first[3], double second[3]) {
    const double any[3] = {fabs(along[0]) <= fabs(along[2]), 0, fabs(along[0]) > fabs(along[2])};
    skg_cross(any, along, second);
    skg_cross(along, second, first);
    skg_scale_vector(1 / skg_length(first), first, first);
    skg_scale_vector(1 / skg_length(second), second, second);
}

/* Axes of the fit of the liver's shear: along the tendon's motion, and two directions across it. */
typedef struct {
    double along[3], axis[2][3], top, mean[3];
} liver_frame;

static void fill_frame(const skg_body *body, skg_body_organ *o, liver_frame *f) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    skg_scale_vector(1 / skg_length(body->options.tendon_mm), body->options.tendon_mm, f->along);
    across(f->along, f->axis[0], f->axis[1]);
    for (int64_t i = 0; i < o->vertices; i++) {
        const double at = skg_dot(f->along, o->rest + 3 * i);
        low = fmin(low, at), high = fmax(high, at);
    }
    f->top = low;
    o->coupling.squeeze = high > low ? body->options.liver_held / (high - low) : 0;
}

/* How far the tendon goes over a vertex, as a part of tendon_mm. */
static double motion_over(const skg_body *body, const double p[3]) {
    const double *tendon = body->options.tendon_mm;
    double motion[3];
    skg_dome_motion(body, p, motion);
    return skg_dot(motion, tendon) / skg_dot(tendon, tendon);
}

/* Whether a vertex touches the dome, and what the liver needs at its top to go there as far as the dome. */
static int touches(const skg_body *body, const skg_body_organ *o, const liver_frame *f, int64_t i,
                   double *needs) {
    if (o->coupling.share[i] < dome_from) return 0;
    *needs = o->coupling.share[i] * motion_over(body, o->rest + 3 * i) +
             o->coupling.squeeze * (skg_dot(f->along, o->rest + 3 * i) - f->top);
    return 1;
}

/* The slope across the tendon's motion that is nearest to what the vertices at the dome need (least squares). */
static void fit_shear(const skg_body *body, skg_body_organ *o, liver_frame *f) {
    double s[3] = {0}, t[2] = {0}, slope[2] = {0}, count = 0, needs;
    for (int64_t i = 0; i < o->vertices; i++) {
        if (!touches(body, o, f, i, &needs)) continue;
        for (int k = 0; k < 2; k++) f->mean[k] += skg_dot(f->axis[k], o->rest + 3 * i);
        f->mean[2] += needs, count++;
    }
    for (int k = 0; k < 3 && count > 0; k++) f->mean[k] /= count;
    for (int64_t i = 0; i < o->vertices; i++) {
        if (!touches(body, o, f, i, &needs)) continue;
        const double x = skg_dot(f->axis[0], o->rest + 3 * i) - f->mean[0];
        const double y = skg_dot(f->axis[1], o->rest + 3 * i) - f->mean[1], more = needs - f->mean[2];
        s[0] += x * x, s[1] += x * y, s[2] += y * y, t[0] += x * more, t[1] += y * more;
    }
    const double det = s[0] * s[2] - s[1] * s[1];
    if (det > 1e-6 * s[0] * s[2]) /* else they lie on a line */
        slope[0] = (s[2] * t[0] - s[1] * t[1]) / det, slope[1] = (s[0] * t[1] - s[1] * t[0]) / det;
    skg_scale_vector(slope[0], f->axis[0], o->coupling.shear);
    skg_add_scaled(o->coupling.shear, slope[1], f->axis[1], o->coupling.shear);
}

/* The growth of the displacement from one point to another that is d away, with the tendon at weight 1: shear and
 * squeeze along the tendon's motion, and half of the squeeze outward in both directions across it. */
static void grow(const skg_body *body, const skg_body_organ *liver, const double d[3], double growth[3]) {
    const double *tendon = body->options.tendon_mm, length = skg_length(tendon),
                 along = skg_dot(tendon, d) / length;
    double outward[3];
    skg_scale_vector(skg_dot(liver->coupling.shear, d) - liver->coupling.squeeze * along, tendon, growth);
    skg_add_scaled(d, -along / length, tendon, outward);
    skg_add_scaled(growth, 0.5 * liver->coupling.squeeze * length, outward, growth);
}

/* The displacement is a linear function of the place, so that the liver keeps its form. Sheared along the tendon's motion
 * it keeps its volume; squeezed by a part q along it and stretched by q / 2 across it, up to 3/4 q^2, which is 0.3 % at
 * q = 0.06. Its share is lifted until it lies below the dome wherever it touches it. */
void skg_liver_course(const skg_body *body, const skg_body_organ *diaphragm, skg_body_organ *o) {
    liver_frame f;
    double centre[3], lift = 0, needs;
    memset(o->coupling.course, 0, (size_t)(3 * o->vertices) * sizeof *o->coupling.course);
    if (skg_length(body->options.tendon_mm) == 0) return;
    memset(&f, 0, sizeof f);
    fill_frame(body, o, &f);
    for (int64_t i = 0; i < o->vertices; i++)
        o->coupling.share[i] = dome_over(diaphragm, o->coupling.base + i);
    fit_shear(body, o, &f);
    const double shift =
        skg_dot(o->coupling.shear, f.axis[0]) * f.mean[0] + skg_dot(o->coupling.shear, f.axis[1]) * f.mean[1];
    for (int64_t i = 0; i < o->vertices; i++)
        if (touches(body, o, &f, i, &needs))
            lift = fmax(lift, needs - (f.mean[2] + skg_dot(o->coupling.shear, o->rest + 3 * i) - shift));
    for (int k = 0; k < 3; k++) centre[k] = 0.5 * (o->bounds[k] + o->bounds[3 + k]);
    const double at_centre = f.mean[2] + lift + skg_dot(o->coupling.shear, centre) - shift -
                             o->coupling.squeeze * (skg_dot(f.along, centre) - f.top);
    for (int64_t i = 0; i < o->vertices; i++) {
        double d[3], *course = o->coupling.course + 3 * i;
        skg_add_scaled(o->rest + 3 * i, -1, centre, d);
        grow(body, o, d, course);
        skg_add_scaled(course, at_centre, body->options.tendon_mm, course);
        skg_scale_vector(body->options.liver_follows, course, course);
    }
}

void skg_liver_carries(const skg_body *body, skg_body_organ *o) {
    const skg_body_organ *liver = o->carried.near && o->coupling.beyond ? body->organ + o->carried.by : NULL;
    if (!liver || !liver->coupled || skg_length(body->options.tendon_mm) == 0) return;
    for (int64_t i = 0; i < o->vertices; i++) {
        double d[3], growth[3];
        memcpy(d, o->rest + 3 * i, sizeof d);
        for (int n = 0; n < CARRIERS; n++)
            skg_add_scaled(d, -o->carried.weight[CARRIERS * i + n],
                           liver->rest + 3 * (int64_t)o->carried.near[CARRIERS * i + n], d);
        grow(body, liver, d, growth);
        skg_scale_vector(body->options.liver_follows, growth, o->coupling.beyond + 3 * i);
    }
}
