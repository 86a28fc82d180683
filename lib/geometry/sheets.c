/* Pieces of a leaky mesh that enclose nothing once their rims are closed: rays that are traced again do not see them. */
#include "geometry/retrace.h"

#include "core/maths.h"

/* Pieces by their vertices, each of which names another one of its piece, or itself. */
typedef struct {
    const skg_mesh *mesh;
    int32_t *of; /* [vertices] */
    /* [vertices] six times the volume, and twice the area, at the vertex that names itself */
    double *volume, *area;
    double origin[3];
} pieces;

static int32_t welded(const skg_mesh *mesh, int32_t vertex) {
    return mesh->weld ? mesh->weld[vertex] : vertex;
}

static int32_t piece_of(const pieces *p, int32_t vertex) {
    while (p->of[vertex] != vertex) {
        p->of[vertex] = p->of[p->of[vertex]];
        vertex = p->of[vertex];
    }
    return vertex;
}

static void join(const pieces *p, int32_t a, int32_t b) {
    const int32_t of_a = piece_of(p, a), of_b = piece_of(p, b);
    p->of[of_a > of_b ? of_a : of_b] = of_a > of_b ? of_b : of_a;
}

static void join_all(const pieces *p, const skg_caps *caps) {
    const skg_mesh *mesh = p->mesh;
    for (int64_t i = 0; i < 3 * mesh->triangles; i++)
        join(p, welded(mesh, mesh->corners[i]), welded(mesh, mesh->corners[i - i % 3]));
    for (int64_t l = 0; l < caps->loops; l++)
        for (int64_t k = caps->first[l]; k < caps->first[l + 1]; k++)
            join(p, caps->vertices[k], caps->vertices[caps->first[l]]);
}

static void add_triangle(const pieces *p, int32_t piece, const double a[3], const double b[3],
                         const double c[3]) {
    double from[3], ab[3], ac[3], normal[3];
    skg_add_scaled(a, -1, p->origin, from);
    skg_add_scaled(b, -1, a, ab);
    skg_add_scaled(c, -1, a, ac);
    skg_cross(ab, ac, normal);
    p->volume[piece] += skg_dot(from, normal);
    p->area[piece] += skg_length(normal);
}

static void add_fan(const pieces *p, const skg_caps *caps, int64_t loop) {
    const int64_t first = caps->first[loop], count = caps->first[loop + 1] - first;
    const int32_t piece = piece_of(p, caps->vertices[first]);
    double mean[3] = {0, 0, 0}, at[2][3];
    for (int64_t k = 0; k < count; k++) {
        skg_mesh_vertex(p->mesh, caps->vertices[first + k], at[0]);
        skg_add_scaled(mean, 1 / (double)count, at[0], mean);
    }
    for (int64_t k = 0; k < count; k++) {
        skg_mesh_vertex(p->mesh, caps->vertices[first + k], at[0]);
        skg_mesh_vertex(p->mesh, caps->vertices[first + (k + 1) % count], at[1]);
        add_triangle(p, piece, mean, at[1], at[0]);
    }
}

static void measure(pieces *p, const skg_caps *caps) {
    const skg_mesh *mesh = p->mesh;
    skg_mesh_vertex(mesh, mesh->corners[0], p->origin);
    for (int64_t t = 0; t < mesh->triangles; t++) {
        double at[3][3];
        for (int k = 0; k < 3; k++) skg_mesh_vertex(mesh, mesh->corners[3 * t + k], at[k]);
        add_triangle(p, piece_of(p, welded(mesh, mesh->corners[3 * t])), at[0], at[1], at[2]);
    }
    for (int64_t l = 0; l < caps->loops; l++) add_fan(p, caps, l);
}

skg_status skg_caps_sheets(const skg_mesh *mesh, const skg_caps *caps, int64_t *count, double *area) {
    /* A cube's volume is .07 of the power 1.5 of its area; rounding of a sheet far from the origin is far below this. */
    static const double FLAT = 1e-7;
    pieces p = {.mesh = mesh};
    skg_status status = SKG_OK;
    *count = 0;
    *area = 0;
    if (mesh->triangles == 0) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *p.of, "caps", &p.of));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *p.volume, "caps", &p.volume));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, sizeof *p.area, "caps", &p.area));
    for (int64_t v = 0; v < mesh->vertices; v++) p.of[v] = (int32_t)v;
    join_all(&p, caps);
    measure(&p, caps);
    for (int64_t v = 0; v < mesh->vertices; v++) {
        if (!(p.area[v] > 0) || fabs(p.volume[v]) > FLAT * p.area[v] * sqrt(p.area[v])) continue;
        ++*count;
        *area += p.area[v] / 4; /* twice, of both sides */
    }
cleanup:
    skg_free(&p.of);
    skg_free(&p.volume);
    skg_free(&p.area);
    return status;
}
