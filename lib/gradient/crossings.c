/* Where a ray crosses the surface of a part, traced in double on the host. */
#include "gradient/crossings.h"

#include "core/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows that a triangle is listed in beyond its own: more than the rounding of its corners. */
static const double MARGIN = 1e-6;

/* The rows from range[0] to range[1] that a triangle covers. */
static void rows_of(const skg_crossings *c, int64_t triangle, int64_t range[2]) {
    const double rows = (double)c->camera->rows;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *h = c->seen + 3 * (int64_t)c->corners[3 * triangle + k];
        const double row = c->camera->parallel ? h[1] : h[1] / h[2];
        low = fmin(low, row);
        high = fmax(high, row);
    }
    range[0] = (int64_t)fmin(fmax(floor(low + 0.5 - MARGIN), 0), rows);
    range[1] = (int64_t)fmin(fmax(floor(high + 0.5 + MARGIN), -1), rows - 1);
}

/* Counts the triangles of each row, and lists them. */
static skg_status list_triangles(skg_crossings *c, int64_t triangles) {
    const int64_t rows = c->camera->rows;
    int64_t range[2];
    SKG_TRY(skg_alloc(rows + 1, sizeof *c->first, "gradient", &c->first));
    for (int64_t t = 0; t < triangles; t++) {
        rows_of(c, t, range);
        for (int64_t r = range[0]; r <= range[1]; r++) c->first[r]++;
    }
    for (int64_t r = 0, all = 0; r <= rows; r++) {
        const int64_t count = c->first[r];
        all += count;
        c->first[r] = all; /* the end of the row, until its triangles are listed */
    }
    SKG_TRY(skg_alloc(c->first[rows], sizeof *c->triangles, "gradient", &c->triangles));
    for (int64_t t = triangles - 1; t >= 0; t--) {
        rows_of(c, t, range);
        for (int64_t r = range[0]; r <= range[1]; r++) c->triangles[--c->first[r]] = (int32_t)t;
    }
    return SKG_OK;
}

skg_status skg_crossings_make(const skg_camera *camera, const skg_mesh *mesh, const double *pose,
                              int32_t owner, skg_crossings *crossings) {
    *crossings = (skg_crossings){
        .camera = camera,
        .corners = mesh->corners,
        .owner = owner,
        .mirrored = (skg_pose_determinant(pose) < 0) != (mesh->orientation < 0),
    };
    SKG_TRY(skg_alloc(3 * mesh->vertices, sizeof *crossings->seen, "gradient", &crossings->seen));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3];
        skg_mesh_vertex(mesh, v, at);
        skg_pose_point(pose, at, at);
        skg_camera_see(camera, at, crossings->seen + 3 * v);
    }
    return list_triangles(crossings, mesh->triangles);
}

void skg_crossings_release(skg_crossings *crossings) {
    skg_free(&crossings->seen);
    skg_free(&crossings->first);
    skg_free(&crossings->triangles);
}

/* On which side of the edge from a to b the ray passes: positive or not. A ray through the edge is moved by a little along the row,
 * and by much less along the column. The sign of the edge from b to a is the other one. */
static int is_left(const double a[3], const double b[3], const double ray[3], double *side) {
    double across[3];
    skg_cross(a, b, across);
    *side = skg_dot(ray, across);
    return (*side != 0 ? *side : across[0] != 0 ? across[0] : across[1]) > 0;
}

static skg_seen_plane plane_of(const double h[3][3], const double ahead[3]) {
    skg_seen_plane plane;
    double side[2][3];
    for (int k = 0; k < 2; k++) skg_add_scaled(h[k + 1], -1, h[0], side[k]);
    skg_cross(side[0], side[1], plane.p);
    if (skg_dot(plane.p, ahead) < 0) skg_scale_vector(-1, plane.p, plane.p);
    plane.p[3] = -skg_dot(plane.p, h[0]);
    return plane;
}

static skg_status append(skg_crossing_list *list, const skg_crossing *crossing) {
    if (list->count == list->capacity) {
        const int64_t capacity = list->capacity ? 2 * list->capacity : 16;
        SKG_TRY(skg_realloc(capacity, sizeof *list->at, "gradient", &list->at));
        list->capacity = capacity;
    }
    list->at[list->count++] = *crossing;
    return SKG_OK;
}

/* With e_k = ray . (h_i x h_j), i and j the other corners, the hit is the sum of e_k h_k over the sum of e_k. */
skg_status skg_crossings_find(const skg_crossings *c, const double place[2], int64_t row,
                              skg_crossing_list *list) {
    const int parallel = c->camera->parallel;
    const double ray[3] = {place[0], place[1], 1}, along[3] = {0, 0, 1};
    for (int64_t n = c->first[row]; n < c->first[row + 1]; n++) {
        double h[3][3], flat[3][3], e[3], sum = 0, depth = 0;
        int left = 0;
        for (int k = 0; k < 3; k++) {
            memcpy(h[k], c->seen + 3 * (int64_t)c->corners[3 * (int64_t)c->triangles[n] + k], sizeof h[k]);
            memcpy(flat[k], h[k], sizeof flat[k]);
            if (parallel) flat[k][2] = 1;
        }
        for (int k = 0; k < 3; k++) left += is_left(flat[(k + 1) % 3], flat[(k + 2) % 3], ray, &e[k]);
        for (int k = 0; k < 3; k++) sum += e[k], depth += e[k] * h[k][2];
        if ((left != 0 && left != 3) || sum == 0) continue;
        const int faces_away = sum * c->camera->determinant > 0; /* the normal by the order of the corners */
        const skg_crossing crossing = {.depth = depth / sum,
                                       .plane = plane_of((const double(*)[3])h, parallel ? along : ray),
                                       .owner = c->owner,
                                       .enters = faces_away == c->mirrored};
        SKG_TRY(append(list, &crossing));
    }
    return SKG_OK;
}

static int by_depth(const void *a, const void *b) {
    const skg_crossing *x = a, *y = b;
    if (x->depth != y->depth) return x->depth < y->depth ? -1 : 1;
    if (x->owner != y->owner) return x->owner < y->owner ? -1 : 1;
    return x->enters - y->enters;
}

void skg_crossings_sort(skg_crossing_list *list) {
    if (list->count > 1) qsort(list->at, (size_t)list->count, sizeof *list->at, by_depth);
}
