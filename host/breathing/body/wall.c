/* The wall of the chest follows its bones. */
#include "body/bones.h"

#include "body/links.h"
#include "core/maths.h"

static int is_bone(const skg_body_organ *o, int spine) {
    if (o->role == ROLE_RIB || o->role == ROLE_STERNUM) return 1;
    return spine && (skg_label_begins(o->label, "spine") || skg_label_begins(o->label, "vertebra") ||
                     skg_label_begins(o->label, "discs"));
}

/* The weight of a bone at a distance: about that of the inverse fourth power, which leaves a rib its surroundings and
 * makes the middle between two ribs move by their mean; 0 from reach on. soft is a rib's height. Choices. */
static const double reach_mm = 120, soft_mm = 12;

static double weight_at(double distance) {
    const double near = distance * distance + soft_mm * soft_mm, away = distance / reach_mm;
    return distance < reach_mm ? (1 - away * away) * (1 - away * away) / (near * near) : 0;
}

double skg_wall_bones(const skg_body *body, int spine, const double p[3], int32_t bone[BONES],
                      double weight[BONES]) {
    double distance[BONES + 1], sum = 0;
    int32_t nearest[BONES + 1];
    int found = 0;
    for (int32_t o = 0; o < body->organs; o++) {
        skg_link unused;
        if (!is_bone(body->organ + o, spine)) continue;
        const double within = found > BONES ? distance[BONES] : reach_mm;
        const double d = skg_nearest(body->organ + o, p, within, &unused);
        if (d == HUGE_VAL) continue;
        int at = found > BONES ? BONES : found++;
        for (; at > 0 && distance[at - 1] > d; at--)
            distance[at] = distance[at - 1], nearest[at] = nearest[at - 1];
        distance[at] = d, nearest[at] = o;
    }
    /* Less the weight of the first bone that is left out, so that weights stay continuous where another one is. */
    const double left_out = found > BONES ? weight_at(distance[BONES]) : 0;
    for (int b = 0; b < BONES; b++) {
        bone[b] = b < found ? nearest[b] : -1;
        weight[b] = b < found ? weight_at(distance[b]) : 0;
        sum += weight[b];
        weight[b] -= b < found ? left_out : 0;
    }
    for (int b = 0; b < BONES && sum > 0; b++) weight[b] /= sum;
    return found > 0 ? distance[0] : HUGE_VAL;
}

void skg_wall_prepare(skg_body *body) {
    body->bones_move = 0;
    for (int64_t i = 0; i < body->organs; i++) {
        const skg_body_organ *o = body->organ + i;
        double *m = body->bone_motion + 12 * i;
        if (o->role != ROLE_RIB && o->role != ROLE_STERNUM) continue;
        for (int k = 0; k < 3; k++) {
            for (int j = 0; j < 3; j++) m[4 * k + j] = o->rigid.rotation[3 * k + j] - (j == k);
            m[4 * k + 3] = o->rigid.shift[k] - skg_dot(m + 4 * k, o->rigid.centre);
        }
        for (int k = 0; k < 12; k++) body->bones_move |= m[k] != 0;
    }
}

void skg_wall_displace(const skg_body *body, skg_body_organ *o) {
    for (int64_t i = 0; i < o->vertices; i++) {
        const int64_t n = o->node_of[i];
        const int32_t *bone = o->coupling.bone + BONES * n;
        const double *weight = o->coupling.bone_weight + BONES * n, *p = o->rest + 3 * n;
        for (int k = 0; k < 3; k++) { /* the sums of a row stay in registers */
            double x = 0, y = 0, z = 0, shift = 0;
            for (int b = 0; b < BONES && weight[b] > 0; b++) {
                const double *row = body->bone_motion + 12 * (int64_t)bone[b] + 4 * k, w = weight[b];
                x += w * row[0], y += w * row[1], z += w * row[2], shift += w * row[3];
            }
            o->moved[3 * i + k] = x * p[0] + y * p[1] + z * p[2] + shift;
        }
    }
}
