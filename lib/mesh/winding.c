/* Meshes that are wound inconsistently. A union-find over the triangles keeps, for each, whether it must be turned if the root of its
 * patch is not; edges of two triangles join. The time is linear in triangles. */
#include "mesh/groups.h"

#include "core/maths.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Boxes and triangles that are looked at, for each triangle of the mesh, to find in which others the patches lie. Beyond, a patch keeps the winding of
 * most of its triangles, and the check of the nesting names it where that is wrong. */
enum { EFFORT = 64 };

typedef struct {
    int64_t first, count;  /* of its triangles in `order` */
    int64_t turned;        /* triangles that are turned where its root is not */
    int32_t open, twisted; /* 1: it has an edge of its own; 1: it is one-sided */
    int32_t turns;         /* 1: its root is turned, too */
    double volume;         /* mm3, signed, with the root as it is */
    double low[3], high[3];
} patch;

typedef struct {
    skg_mesh *mesh;
    int32_t *parent;       /* [triangles] then the number of the patch */
    unsigned char *parity; /* [triangles] 1: wound other than its parent; then than its root */
    unsigned char *marks;  /* [triangles] of roots: MARK_... */
    int32_t *order;        /* [triangles] by patch */
    patch *patches;
    int64_t count;
} winder;

enum { MARK_OPEN = 1, MARK_TWISTED = 2 };

/* The root of a triangle, and whether the triangle is wound other than it. Paths are halved on the way. */
static int32_t root_of(winder *w, int32_t t, unsigned char *other) {
    unsigned char odd = 0;
    while (w->parent[t] != t) {
        const int32_t up = w->parent[t];
        w->parity[t] ^= w->parity[up]; /* a root's is 0 */
        w->parent[t] = w->parent[up];
        odd ^= w->parity[t];
        t = w->parent[t];
    }
    *other = odd;
    return t;
}

static void join(winder *w, int32_t a, int32_t b, unsigned char differ) {
    unsigned char of_a, of_b;
    const int32_t root_a = root_of(w, a, &of_a), root_b = root_of(w, b, &of_b);
    if (root_a == root_b) {
        if ((of_a ^ of_b) != differ) w->marks[root_a] |= MARK_TWISTED;
        return;
    }
    const int32_t to = root_a < root_b ? root_a : root_b, from = root_a < root_b ? root_b : root_a;
    w->parent[from] = to;
    w->parity[from] = of_a ^ of_b ^ differ;
    w->marks[to] |= w->marks[from];
}

static void walk(winder *w, const skg_mesh_groups *edges) {
    unsigned char other;
    for (int64_t v = 0; v < w->mesh->vertices; v++)
        for (int64_t i = edges->start[v], end; i < edges->start[v + 1]; i = end) {
            const uint64_t *key = edges->key + i;
            end = skg_mesh_group_end(edges, v, i);
            if (end - i == 2)
                join(w, skg_mesh_edge_triangle(key[0]), skg_mesh_edge_triangle(key[1]),
                     (unsigned char)((key[0] & 1) == (key[1] & 1)));
            if (end - i == 1) w->marks[root_of(w, skg_mesh_edge_triangle(key[0]), &other)] |= MARK_OPEN;
        }
}

static void corners_of(const skg_mesh *mesh, int64_t triangle, const double origin[3], double corner[3][3]) {
    for (int c = 0; c < 3; c++) {
        const double *p = mesh->positions + 3 * (int64_t)mesh->corners[3 * triangle + c];
        for (int k = 0; k < 3; k++) corner[c][k] = p[k] - origin[k];
    }
}

/* Adds a triangle to the volume and the box of its patch. */
static void measure(const winder *w, patch *own, int32_t t) {
    double corner[3][3], cross[3];
    corners_of(w->mesh, t, w->mesh->origin, corner);
    skg_cross(corner[1], corner[2], cross);
    own->volume += (w->parity[t] ? -1 : 1) * skg_dot(corner[0], cross) / 6;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            own->low[k] = fmin(own->low[k], corner[c][k]);
            own->high[k] = fmax(own->high[k], corner[c][k]);
        }
}

/* Numbers the patches in the order of their roots, which are their first triangles, and lists their triangles. */
static skg_status list_patches(winder *w) {
    const int64_t triangles = w->mesh->triangles;
    unsigned char other;
    for (int32_t t = 0; t < triangles; t++) w->count += w->parent[t] == t;
    SKG_TRY(skg_alloc(w->count, sizeof *w->patches, w->mesh->name, &w->patches));
    for (int32_t t = 0; t < triangles; t++) { /* parity before numbers: both need the roots */
        const int32_t root = root_of(w, t, &other);
        w->parity[t] = root == t ? 0 : other;
        w->parent[t] = root;
    }
    int32_t next = 0;
    for (int32_t t = 0; t < triangles; t++) {
        const int is_root = w->parent[t] == t;
        w->order[t] = is_root ? next++ : w->order[w->parent[t]]; /* a root comes first */
        patch *own = &w->patches[w->order[t]];
        if (is_root)
            *own = (patch){.open = (w->marks[t] & MARK_OPEN) != 0,
                           .twisted = (w->marks[t] & MARK_TWISTED) != 0,
                           .low = {DBL_MAX, DBL_MAX, DBL_MAX},
                           .high = {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
        own->count++;
        own->turned += w->parity[t];
        measure(w, own, t);
    }
    memcpy(w->parent, w->order, (size_t)triangles * sizeof *w->parent);
    int64_t first = 0;
    for (int64_t p = 0; p < w->count; p++) {
        w->patches[p].first = first;
        first += w->patches[p].count;
        w->patches[p].count = 0;
    }
    for (int32_t t = 0; t < triangles; t++) {
        patch *own = &w->patches[w->parent[t]];
        w->order[own->first + own->count++] = t;
    }
    return SKG_OK;
}

static int is_mixed(const patch *p) {
    return !p->twisted && p->turned > 0 && p->turned < p->count;
}

/* How many times a patch winds about a place (mm from the mesh's origin): the solid angles of its triangles over 4 pi. */
static double winding_about(const winder *w, const patch *p, const double place[3]) {
    double origin[3], sum = 0;
    for (int k = 0; k < 3; k++) origin[k] = w->mesh->origin[k] + place[k];
    for (int64_t i = p->first; i < p->first + p->count; i++) {
        double corner[3][3];
        corners_of(w->mesh, w->order[i], origin, corner);
        sum +=
            (w->parity[w->order[i]] != p->turns ? -1 : 1) * skg_solid_angle(corner[0], corner[1], corner[2]);
    }
    return sum / (4 * SKG_PI);
}

/* Whether the box of `a` lies in that of `b`. */
static int lies_in(const patch *a, const patch *b) {
    for (int k = 0; k < 3; k++)
        if (a->low[k] < b->low[k] || a->high[k] > b->high[k]) return 0;
    return 1;
}

/* The middle of the first triangle of a patch. */
static void middle_of(const winder *w, const patch *p, double place[3]) {
    double corner[3][3];
    corners_of(w->mesh, w->order[p->first], w->mesh->origin, corner);
    for (int k = 0; k < 3; k++) place[k] = (corner[0][k] + corner[1][k] + corner[2][k]) / 3;
}

/* Chooses which way a closed patch faces. facing: 1, or -1 where the mesh faces inward as a whole. *effort: what may still be
 * looked at. */
static void face(winder *w, patch *own, int facing, int64_t *effort) {
    double place[3], winding = 0;
    middle_of(w, own, place);
    for (int64_t q = 0; q < w->count; q++) {
        const patch *other = &w->patches[q];
        if (--*effort < 0) return;
        if (other == own || other->open || other->twisted || fabs(other->volume) <= fabs(own->volume) ||
            !lies_in(own, other))
            continue;
        *effort -= other->count;
        if (*effort < 0) return;
        winding += winding_about(w, other, place);
    }
    const int wanted = fabs(winding) < 0.5 ? facing : winding > 0 ? -1 : 1;
    own->turns = own->volume * wanted < 0;
}

static int by_volume(const void *a, const void *b) {
    const patch *left = *(patch *const *)a, *right = *(patch *const *)b;
    const double x = fabs(left->volume), y = fabs(right->volume);
    if (x != y) return x > y ? -1 : 1;
    return left < right ? -1 : left > right;
}

/* Decides for each mixed patch whether its root is turned: larger ones first, for they may hold others. */
static skg_status decide(winder *w) {
    patch **mixed = NULL;
    int64_t count = 0, effort = EFFORT * w->mesh->triangles;
    const patch *largest = NULL; /* no other holds it */
    SKG_TRY(skg_alloc(w->count, sizeof *mixed, w->mesh->name, &mixed));
    for (int64_t p = 0; p < w->count; p++) {
        patch *own = &w->patches[p];
        w->mesh->health.one_sided += own->twisted;
        if (!own->open && !own->twisted && (!largest || fabs(own->volume) > fabs(largest->volume)))
            largest = own;
        if (!is_mixed(own)) continue;
        own->turns = 2 * own->turned > own->count;
        if (!own->open) mixed[count++] = own;
    }
    if (count > 1) qsort(mixed, (size_t)count, sizeof(patch *), by_volume);
    const int facing = largest && !is_mixed(largest) && largest->volume < 0 ? -1 : 1;
    for (int64_t i = 0; i < count; i++) face(w, mixed[i], facing, &effort);
    skg_free(&mixed);
    return SKG_OK;
}

/* Turns the triangles. */
static void turn(const winder *w) {
    skg_mesh_health *health = &w->mesh->health;
    for (int64_t t = 0; t < w->mesh->triangles; t++) {
        const patch *own = &w->patches[w->parent[t]];
        int32_t *corner = w->mesh->corners + 3 * t;
        if (!is_mixed(own) || w->parity[t] == own->turns) continue;
        const int32_t second = corner[1];
        corner[1] = corner[2], corner[2] = second;
        if (health->turned++ > 0) continue;
        const double nowhere[3] = {0, 0, 0};
        double place[3][3];
        health->first_turned = t;
        corners_of(w->mesh, t, nowhere, place);
        for (int k = 0; k < 3; k++)
            health->first_turned_position[k] = (place[0][k] + place[1][k] + place[2][k]) / 3;
    }
}

skg_status skg_mesh_wind(skg_mesh *mesh, const skg_mesh_groups *edges) {
    winder w = {.mesh = mesh};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *w.parent, mesh->name, &w.parent));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *w.parity, mesh->name, &w.parity));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *w.marks, mesh->name, &w.marks));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *w.order, mesh->name, &w.order));
    for (int32_t t = 0; t < mesh->triangles; t++) w.parent[t] = t;
    walk(&w, edges);
    SKG_TRY_CLEANUP(list_patches(&w));
    SKG_TRY_CLEANUP(decide(&w));
    turn(&w);
cleanup:
    skg_free(&w.parent);
    skg_free(&w.parity);
    skg_free(&w.marks);
    skg_free(&w.order);
    skg_free(&w.patches);
    return status;
}
