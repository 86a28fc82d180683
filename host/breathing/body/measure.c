/* Measures of a body: lung volume and density, depth of the needle. */
#include "body/posed.h"

#include "body/types.h"
#include "core/maths.h"
#include "core/text.h"

void skg_body_measure_init_sized(void *measure, int32_t size) {
    const skg_body_measure defaults = {0};
    skg_struct_init(measure, size, &defaults, sizeof defaults);
}

double skg_lung_hounsfield(double hounsfield, double density_ratio) {
    return (hounsfield + 1000) * density_ratio - 1000;
}

/* Volume as posed in mm3, by the divergence theorem. Relative to the first vertex, so that nothing cancels. */
static double volume_now(const skg_body_organ *o) {
    double volume = 0;
    for (int64_t t = 0; t < o->triangles; t++) {
        double p[3][3], n[3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) {
                int64_t at = 3 * (int64_t)o->corner[3 * t + c] + k;
                p[c][k] = o->rest[at] + o->moved[at] - o->rest[k];
            }
        skg_cross(p[0], p[1], n);
        volume += skg_dot(n, p[2]) / 6;
    }
    return o->mesh->orientation < 0 ? -volume : volume;
}

static void measure_lungs(const skg_body *body, double *now_ml, double *rest_ml) {
    *now_ml = *rest_ml = 0;
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *o = body->organ + i;
        if (!skg_label_begins(o->label, "lung")) continue;
        *now_ml += 1e-3 * volume_now(o);
        *rest_ml += 1e-3 * o->volume;
    }
}

double skg_body_lung_ratio(const skg_body *body) {
    double now, rest;
    measure_lungs(body, &now, &rest);
    return rest > 0 ? rest / now : 1;
}

double skg_body_needle_depth(const skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *o = body->organ + i;
        double way[3];
        if (o->role != ROLE_NEEDLE) continue;
        skg_add_scaled(o->needle.pivot, -1, o->needle.tip, way);
        return skg_length(way);
    }
    return (double)NAN;
}

static void normal_of(const skg_body_organ *o, int64_t t, int now, double n[3]) {
    double p[3][3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            int64_t at = 3 * (int64_t)o->corner[3 * t + c] + k;
            p[c][k] = o->rest[at] + (now ? o->moved[at] : 0);
        }
    skg_add_scaled(p[1], -1, p[0], p[1]);
    skg_add_scaled(p[2], -1, p[0], p[2]);
    skg_cross(p[1], p[2], n);
}

static void measure_diaphragm(const skg_body_organ *o, skg_body_measure *m) {
    double top[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t i = 0; i < o->vertices; i++) {
        int half = o->rest[3 * i] < 0;
        if (o->rest[3 * i + 2] <= top[half]) continue;
        top[half] = o->rest[3 * i + 2];
        m->diaphragm_mm[half] = -o->moved[3 * i + 2];
    }
}

/* A link counts as broken from here on: paths of 1000 links over 1000 mm round to 1e-10. */
static const double broken_mm = 1e-9;

static void measure_organ(const skg_body *body, const skg_body_organ *o, skg_body_measure *m) {
    for (int64_t t = 0; t < o->triangles; t++) {
        double before[3], after[3];
        normal_of(o, t, 0, before);
        normal_of(o, t, 1, after);
        m->flipped_triangles += skg_dot(before, after) < 0;
    }
    if (skg_label_begins(o->label, "liver")) {
        for (int64_t i = 0; i < o->vertices; i++)
            skg_add_scaled(m->liver_mm, 1 / (double)o->vertices, o->moved + 3 * i, m->liver_mm);
        m->liver_volume_ratio = volume_now(o) / o->volume;
    }
    if (o->role == ROLE_DIAPHRAGM) measure_diaphragm(o, m);
    if (!o->soft.chain) return;
    if (o->soft.report.conflict_mm > m->conflict_mm) {
        m->conflict_mm = o->soft.report.conflict_mm;
        m->conflict[0] = o->label;
        skg_conflict_partners(body, o, m->conflict + 1);
    }
    int64_t broken;
    double worst;
    for (int64_t i = 0; o->coupled && i < o->vertices; i++) /* of others it is what the chain was moved to */
        for (int k = 0; k < 3; k++) o->soft.state[k * o->vertices + i] = o->moved[3 * i + k];
    skg_chain_check(o->soft.chain, o->soft.state, broken_mm, &broken, &worst);
    m->broken_links += broken;
}

skg_status skg_body_measure_get(const skg_body *body, skg_body_measure *theirs) {
    SKG_PLAIN;
    if (!body || !body->linked) return skg_fail(SKG_ERR_BREATHING, "body: call skg_body_link first");
    skg_body_measure m;
    skg_body_measure_init(&m);
    double lung_rest;
    m.liver_volume_ratio = 1;
    for (int64_t i = 0; i < body->organs; i++) measure_organ(body, body->organ + i, &m);
    measure_lungs(body, &m.lung_ml, &lung_rest);
    m.lung_density_ratio = skg_body_lung_ratio(body);
    m.tidal_ml = m.lung_ml - lung_rest;
    return skg_struct_write(&m, sizeof m, "skg_body_measure", theirs);
}
