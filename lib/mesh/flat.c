/* How many faces of a mesh are flat: one large triangle, or several in one plane. */
#include "core/maths.h"
#include "mesh/mesh.h"

#include <math.h>

/* Shares of a surface: of one triangle, and of triangles in one plane. A smooth body has no triangle as large, but one of few
 * hundred triangles has larger ones than flat faces of machine parts are. */
static const double ALONE = 0x1p-5, TOGETHER = 0x1p-10;

/* Vertices as near to a plane, as a share of the bounds' diagonal, lie in it: floats in a file have been rounded. */
static const double NEAR = 0x1p-21;

typedef struct {
    double at[3], normal[3]; /* of unit length */
    double area;
} plane;

static plane plane_of(const double v[3][3]) {
    double a[3], b[3];
    plane p = {.at = {v[0][0], v[0][1], v[0][2]}};
    skg_add_scaled(v[1], -1, v[0], a);
    skg_add_scaled(v[2], -1, v[0], b);
    skg_cross(a, b, p.normal);
    const double length = skg_length(p.normal);
    p.area = 0.5 * length;
    for (int k = 0; k < 3; k++) p.normal[k] /= length;
    return p;
}

static int holds(const plane *p, const double v[3][3], double near) {
    for (int c = 0; c < 3; c++) {
        double from[3];
        skg_add_scaled(v[c], -1, p->at, from);
        if (!(fabs(skg_dot(from, p->normal)) <= near)) return 0;
    }
    return 1;
}

/* Triangles of a flat face follow each other in the files that programs write. */
int32_t skg_mesh_flat_faces(const skg_mesh *mesh, int32_t (*vertices)[3]) {
    const double *bounds = mesh->health.bounds, all = mesh->health.area;
    const double diagonal[3] = {bounds[3] - bounds[0], bounds[4] - bounds[1], bounds[5] - bounds[2]};
    const double near = NEAR * skg_length(diagonal);
    plane last = {.area = 0};
    double together = 0;
    int32_t count = 0;
    int listed = 0; /* 1: the plane of the last triangle is among those found */
    for (int64_t t = 0; t < mesh->triangles && count < SKG_MESH_PLANES; t++) {
        double v[3][3];
        for (int c = 0; c < 3; c++) skg_mesh_vertex(mesh, mesh->corners[3 * t + c], v[c]);
        const plane own = plane_of(v);
        if (!(own.area > 0)) continue;
        const int same = last.area > 0 && holds(&last, v, near);
        together = same ? together + own.area : own.area;
        listed &= same;
        if (!listed && (own.area >= ALONE * all || (same && together >= TOGETHER * all))) {
            if (!vertices) return 1;
            for (int c = 0; c < 3; c++) vertices[count][c] = mesh->corners[3 * t + c];
            count++, listed = 1;
        }
        last = own;
    }
    return count;
}
