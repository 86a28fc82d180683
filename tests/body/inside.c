/* Whether points lie in a closed mesh, and how deep: for tests only. */
#include "body/inside.h"

#include "suite.h"

#include <math.h>
#include <string.h>

static int column(const solid *s, double value, int axis) {
    int c = (int)(SOLID_GRID * (value - s->low[axis]) / (s->high[axis] - s->low[axis] + 1e-9));
    return c < 0 ? 0 : c >= SOLID_GRID ? SOLID_GRID - 1 : c;
}

static void cells(const solid *s, int64_t t, int range[4]) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 2; k++) {
            double v = s->position[3 * s->corner[3 * t + c] + k];
            low[k] = fmin(low[k], v), high[k] = fmax(high[k], v);
        }
    for (int k = 0; k < 2; k++) range[2 * k] = column(s, low[k], k), range[2 * k + 1] = column(s, high[k], k);
}

void solid_make(const skg_mesh *mesh, solid *s) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(mesh, &health));
    ck_skg(skg_mesh_count(mesh, &s->vertices, &s->triangles));
    s->position = malloc((size_t)s->vertices * 3 * sizeof(double));
    s->corner = malloc((size_t)s->triangles * 3 * sizeof(int32_t));
    ck_skg(skg_mesh_positions_get(mesh, s->position, 0));
    ck_skg(skg_mesh_triangles_get(mesh, s->corner, 0));
    memcpy(s->low, health.bounds, sizeof s->low);
    memcpy(s->high, health.bounds + 3, sizeof s->high);
    s->first = calloc(SOLID_GRID * SOLID_GRID + 1, sizeof(int32_t));
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t t = 0; t < s->triangles; t++) {
            int r[4];
            cells(s, t, r);
            for (int x = r[0]; x <= r[1]; x++)
                for (int y = r[2]; y <= r[3]; y++)
                    if (pass == 0)
                        s->first[x * SOLID_GRID + y + 1]++;
                    else
                        s->list[s->first[x * SOLID_GRID + y]++] = (int32_t)t;
        }
        if (pass == 1) break;
        for (int c = 0; c < SOLID_GRID * SOLID_GRID; c++) s->first[c + 1] += s->first[c];
        s->list = malloc((size_t)s->first[SOLID_GRID * SOLID_GRID] * sizeof(int32_t) + 1);
    }
    memmove(s->first + 1, s->first, SOLID_GRID * SOLID_GRID * sizeof(int32_t));
    s->first[0] = 0;
}

void solid_free(solid *s) {
    free(s->position);
    free(s->corner);
    free(s->first);
    free(s->list);
}

int solid_holds(const solid *s, const double p[3]) {
    for (int k = 0; k < 3; k++)
        if (p[k] < s->low[k] || p[k] > s->high[k]) return 0;
    /* off the vertices that rings put at equal x and y */
    double px = p[0] + 1.234567e-7, py = p[1] + 2.345678e-7;
    int cell = column(s, p[0], 0) * SOLID_GRID + column(s, p[1], 1), odd = 0;
    for (int32_t i = s->first[cell]; i < s->first[cell + 1]; i++) {
        const double *v[3];
        double side[3];
        for (int c = 0; c < 3; c++) v[c] = s->position + 3 * s->corner[3 * s->list[i] + c];
        for (int c = 0; c < 3; c++) {
            const double *a = v[c], *b = v[(c + 1) % 3];
            side[c] = (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
        }
        if (!((side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0)))
            continue;
        double sum = side[0] + side[1] + side[2];
        odd ^= (side[0] * v[2][2] + side[1] * v[0][2] + side[2] * v[1][2]) / sum > p[2];
    }
    return odd;
}

static double segment_distance(const double *a, const double *b, const double *p) {
    double along = 0, length = 0, d = 0;
    for (int k = 0; k < 3; k++)
        along += (p[k] - a[k]) * (b[k] - a[k]), length += (b[k] - a[k]) * (b[k] - a[k]);
    double t = length > 0 ? fmin(fmax(along / length, 0), 1) : 0;
    for (int k = 0; k < 3; k++) d += pow(p[k] - a[k] - t * (b[k] - a[k]), 2);
    return sqrt(d);
}

static double triangle_distance(const double *const v[3], const double *p) {
    double e[3], f[3], n[3], q[3], least = HUGE_VAL;
    for (int k = 0; k < 3; k++) e[k] = v[1][k] - v[0][k], f[k] = v[2][k] - v[0][k], q[k] = p[k] - v[0][k];
    for (int k = 0; k < 3; k++) n[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
    double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double ee = 0, ef = 0, ff = 0, qe = 0, qf = 0, qn = 0;
    for (int k = 0; k < 3; k++) {
        ee += e[k] * e[k], ef += e[k] * f[k], ff += f[k] * f[k];
        qe += q[k] * e[k], qf += q[k] * f[k], qn += q[k] * n[k];
    }
    double det = ee * ff - ef * ef, s = (ff * qe - ef * qf) / det, t = (ee * qf - ef * qe) / det;
    if (det > 0 && s >= 0 && t >= 0 && s + t <= 1) return fabs(qn) / sqrt(nn);
    for (int c = 0; c < 3; c++) least = fmin(least, segment_distance(v[c], v[(c + 1) % 3], p));
    return least;
}

double solid_distance(const solid *s, const double p[3]) {
    double least = HUGE_VAL;
    for (int64_t t = 0; t < s->triangles; t++) {
        const double *v[3];
        for (int c = 0; c < 3; c++) v[c] = s->position + 3 * s->corner[3 * t + c];
        least = fmin(least, triangle_distance(v, p));
    }
    return least;
}

double solid_overlap(const solid *a, const solid *b, int64_t stride) {
    double deepest = 0;
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return 0;
    for (int64_t i = 0; i < a->vertices; i += stride) {
        const double *p = a->position + 3 * i;
        if (solid_holds(b, p)) deepest = fmax(deepest, solid_distance(b, p));
    }
    return deepest;
}
