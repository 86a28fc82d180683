/* Axes of organs: ribs by their bones, others by their inertia. */
#include "body/bones.h"

#include "core/eigen.h"
#include "core/maths.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Number of a thoracic vertebra: 5 for "vertebra t05" or "vertebra_T5". 0: none. */
static long thoracic_number(const char *label) {
    if (!skg_label_begins(label, "vertebra")) return 0;
    const char *at = label + strlen("vertebra");
    while (*at && !isalnum((unsigned char)*at)) at++;
    return tolower((unsigned char)*at) == 't' ? strtol(at + 1, NULL, 10) : 0;
}

static const skg_body_organ *vertebra(const skg_body *body, int number) {
    for (int64_t i = 0; i < body->organs; i++)
        if (number > 0 && thoracic_number(body->organ[i].label) == number) return body->organ + i;
    return NULL;
}

/* The centre of a vertebra's body: the mean of the vertices in the front two fifths of the vertebra (a choice). */
static void body_centre(const skg_body_organ *bone, double centre[3]) {
    const double *bounds = bone->bounds;
    double count = 0;
    memset(centre, 0, 3 * sizeof *centre);
    for (int64_t i = 0; i < bone->vertices; i++)
        if (bone->rest[3 * i + 1] < bounds[1] + 0.4 * (bounds[4] - bounds[1])) {
            skg_add_scaled(centre, 1, bone->rest + 3 * i, centre);
            count++;
        }
    skg_scale_vector(1 / count, centre, centre);
}

/* The tip of the transverse process is the vertex farthest to the side. */
static const double *process_tip(const skg_body_organ *bone, int side) {
    int64_t best = 0;
    for (int64_t i = 1; i < bone->vertices; i++)
        if (side * bone->rest[3 * i] > side * bone->rest[3 * best]) best = i;
    return bone->rest + 3 * best;
}

/* Adds up the rib's vertices that are at most 3 mm farther from a point than the nearest one, as those of a joint
 * are. */
static void add_nearest(const skg_body_organ *rib, const double point[3], double sum[3], double *count) {
    double least = HUGE_VAL, d[3];
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < rib->vertices; i++) {
            skg_add_scaled(rib->rest + 3 * i, -1, point, d);
            if (pass == 0) least = fmin(least, skg_length(d));
            if (pass == 0 || skg_length(d) > least + 3) continue;
            skg_add_scaled(sum, 1, rib->rest + 3 * i, sum);
            ++*count;
        }
}

int skg_rib_bone_axis(const skg_body *body, const skg_body_organ *rib, double head[3], double along[3]) {
    const skg_body_organ *own = vertebra(body, rib->number), *above = vertebra(body, rib->number - 1);
    double centre[3], tubercle[3] = {0}, count = 0;
    if (!own) return 0;
    memset(head, 0, 3 * sizeof *head);
    body_centre(own, centre);
    add_nearest(rib, centre, head, &count);
    if (above) {
        body_centre(above, centre);
        add_nearest(rib, centre, head, &count);
    }
    skg_scale_vector(1 / count, head, head);
    count = 0;
    add_nearest(rib, process_tip(own, rib->side), tubercle, &count);
    skg_scale_vector(1 / count, tubercle, tubercle);
    skg_add_scaled(tubercle, -1, head, along);
    const double length = skg_length(along);
    if (!(length > 5)) return 0; /* mm; head and tubercle are 12 to 32 mm apart, so they were not found */
    skg_scale_vector(1 / length, along, along);
    return 1;
}

/* Each triangle's area counts at its centroid. */
void skg_inertia_axes(const skg_body_organ *o, double axes[9], double end[3]) {
    double mean[3] = {0}, area = 0, scatter[9] = {0}, values[3], least = HUGE_VAL, most = -HUGE_VAL;
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t t = 0; t < o->triangles; t++) {
            const double *p[3];
            double e[3], f[3], n[3], c[3];
            for (int k = 0; k < 3; k++) p[k] = o->rest + 3 * (int64_t)o->corner[3 * t + k];
            skg_add_scaled(p[1], -1, p[0], e);
            skg_add_scaled(p[2], -1, p[0], f);
            skg_cross(e, f, n);
            const double weight = 0.5 * skg_length(n);
            for (int k = 0; k < 3; k++) c[k] = (p[0][k] + p[1][k] + p[2][k]) / 3;
            if (pass == 0) area += weight, skg_add_scaled(mean, weight, c, mean);
            for (int k = 0; pass == 1 && k < 9; k++)
                scatter[k] += weight * (c[k / 3] - mean[k / 3]) * (c[k % 3] - mean[k % 3]);
        }
        if (pass == 0) skg_scale_vector(1 / area, mean, mean);
    }
    skg_eigen(3, scatter, values, axes);
    /* Of a rib, towards the spine and a little to the back, as its anterior end may be near the midplane too. */
    const double back[3] = {-o->side, o->side ? 0.3 : 1, 0};
    if (skg_dot(axes, back) < 0) skg_scale_vector(-1, axes, axes);
    for (int64_t i = 0; i < o->vertices; i++) {
        const double at = skg_dot(axes, o->rest + 3 * i) - skg_dot(axes, mean);
        least = fmin(least, at), most = fmax(most, at);
    }
    /* The mean of the last tenth of the length lies in the bone; the axis of a bent rib does not. */
    double count = 0;
    memset(end, 0, 3 * sizeof *end);
    for (int64_t i = 0; i < o->vertices; i++)
        if (skg_dot(axes, o->rest + 3 * i) - skg_dot(axes, mean) >= most - 0.1 * (most - least)) {
            skg_add_scaled(end, 1, o->rest + 3 * i, end);
            count++;
        }
    skg_scale_vector(1 / count, end, end);
}
