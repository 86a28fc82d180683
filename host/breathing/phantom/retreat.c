/* Moves a surface back from another one that it meets. */
#include "phantom/contacts.h"

#include "core/maths.h"

/* Choices: the clearance is well below the gaps between organs (skg_thorax_plan), and a step about equal to it. */
static const double clearance = 0.2; /* mm that a surface keeps from the others */
static const double step = 0.25;     /* mm by which a facet that meets another surface draws back at a time */
static const double slope = 0.5;     /* largest difference in retreat of two vertices, over their distance */
enum { STEPS_MAX = 60 };             /* 15 mm in all */

/* Test of skg_grid_any. */
static int meets(const void *unused, const double *triangle, const double *other, int64_t number) {
    (void)unused, (void)number;
    return skg_triangles_meet(triangle, other);
}

/* Outward normals of the vertices, length 1. */
static void find_normals(const skg_mesh_arrays *a, double *normal) {
    for (int64_t t = 0; t < a->triangles; t++) {
        const int32_t *c = a->corners + 3 * t;
        double e[3], f[3], n[3];
        skg_add_scaled(a->positions + 3 * (int64_t)c[1], -1, a->positions + 3 * (int64_t)c[0], e);
        skg_add_scaled(a->positions + 3 * (int64_t)c[2], -1, a->positions + 3 * (int64_t)c[0], f);
        skg_cross(e, f, n);
        for (int k = 0; k < 3; k++)
            skg_add_scaled(normal + 3 * (int64_t)c[k], 1, n, normal + 3 * (int64_t)c[k]);
    }
    for (int64_t i = 0; i < a->vertices; i++) {
        const double size = skg_length(normal + 3 * i);
        skg_scale_vector(size > 0 ? 1 / size : 0, normal + 3 * i, normal + 3 * i);
    }
}

/* How far the vertices have drawn back, along their normals, from the surface as it was made. */
typedef struct {
    const skg_mesh_arrays *mesh;
    const double *normal; /* [vertices][3] as made */
    double *back;         /* [vertices] mm */
    char *meets;          /* [vertices] 1: of a facet that meets another surface */
} retreat;

static void place_at(const retreat *r, int64_t v, double outwards, double place[3]) {
    skg_add_scaled(r->mesh->positions + 3 * v, outwards - r->back[v], r->normal + 3 * v, place);
}

/* Marks the vertices of facets that meet another surface when they are moved outward by the clearance. */
static int find_meeting(const skg_triangle_grid *grid, const retreat *r) {
    const skg_mesh_arrays *a = r->mesh;
    int any = 0;
#pragma omp parallel for schedule(dynamic, 256) reduction(| : any)
    for (int64_t t = 0; t < a->triangles; t++) {
        double grown[9];
        for (int c = 0; c < 3; c++) place_at(r, a->corners[3 * t + c], clearance, grown + 3 * c);
        if (!skg_grid_any(grid, grown, meets, NULL)) continue;
        any = 1;
        for (int c = 0; c < 3; c++) {
#pragma omp atomic write
            r->meets[a->corners[3 * t + c]] = 1;
        }
    }
    return any;
}

/* Draws the marked vertices back by a step, and those near them far enough to keep the slope. */
static void draw_back(const retreat *r) {
    const skg_mesh_arrays *a = r->mesh;
    for (int64_t v = 0; v < a->vertices; v++) {
        if (r->meets[v]) r->back[v] += step;
        r->meets[v] = 0;
    }
    for (int changed = 1; changed;) {
        changed = 0;
        for (int64_t t = 0; t < a->triangles; t++)
            for (int c = 0; c < 3; c++) {
                const int64_t v = a->corners[3 * t + c], w = a->corners[3 * t + (c + 1) % 3];
                double edge[3];
                skg_add_scaled(a->positions + 3 * v, -1, a->positions + 3 * w, edge);
                const double least = r->back[v] - slope * skg_length(edge);
                if (r->back[w] < least - 1e-9) r->back[w] = least, changed = 1;
            }
    }
}

static skg_status retreat_from(const char *name, const skg_triangle_grid *grid, skg_mesh_arrays *arrays) {
    double *normal = NULL, *back = NULL;
    char *meets = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(3 * arrays->vertices, sizeof *normal, name, &normal));
    SKG_TRY_CLEANUP(skg_alloc(arrays->vertices, sizeof *back, name, &back));
    SKG_TRY_CLEANUP(skg_alloc(arrays->vertices, 1, name, &meets));
    find_normals(arrays, normal);
    const retreat r = {arrays, normal, back, meets};
    for (int k = 0; k < STEPS_MAX && find_meeting(grid, &r); k++) draw_back(&r);
    for (int64_t v = 0; v < arrays->vertices; v++) place_at(&r, v, 0, arrays->positions + 3 * v);
cleanup:
    skg_free(&normal);
    skg_free(&back);
    skg_free(&meets);
    return status;
}

skg_status skg_shape_retreat(const char *name, int64_t count, skg_mesh *const *others,
                             skg_mesh_arrays *arrays) {
    skg_triangle_grid grid = {0};
    double low[3], high[3];
    skg_status status = SKG_OK;
    skg_grid_bounds(arrays->vertices, arrays->positions, 2 * clearance, low, high);
    for (int64_t i = 0; i < count; i++) {
        const double *bounds = others[i]->health.bounds;
        if (!skg_grid_apart(low, high, bounds, bounds + 3))
            SKG_TRY_CLEANUP(skg_grid_add_mesh(others[i], low, high, &grid));
    }
    if (grid.count == 0) goto cleanup;
    SKG_TRY_CLEANUP(skg_grid_sort(low, high, &grid));
    SKG_TRY_CLEANUP(retreat_from(name, &grid, arrays));
cleanup:
    skg_grid_free(&grid);
    return status;
}
