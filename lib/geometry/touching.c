/* Parts that touch: groups of those whose boxes meet and that have flat faces in one plane. They count pixels from one pixel and move
 * edges alike. */
#include "core/maths.h"
#include "geometry/bounds.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* More parts are one group, so that no frame looks for pairs among them for long. */
enum { MOST = 1024 };

/* Boxes and planes as near as this share of the parts' sides meet: the vertices of a file may be floats. One less the cosine between
 * normals: faces of a common plane that are made of rounded vertices. */
static const double NEAR = 1e-6, TURNED = 1e-9;

static int by_low_end(const void *a, const void *b) {
    const skg_touching *left = a, *right = b;
    if (left->low[0] != right->low[0]) return left->low[0] < right->low[0] ? -1 : 1;
    return left->part < right->part ? -1 : left->part > right->part;
}

static double margin_of(const skg_touching *a, const skg_touching *b) {
    double sides = 0;
    for (int k = 0; k < 3; k++) sides += (a->high[k] - a->low[k]) + (b->high[k] - b->low[k]);
    return NEAR * sides;
}

static int meet_along(const skg_touching *a, const skg_touching *b, int axis) {
    const double margin = margin_of(a, b);
    return !(a->low[axis] > b->high[axis] + margin) && !(b->low[axis] > a->high[axis] + margin);
}

/* A corner of a flat face in the world, and the face's normal of length 1. */
static void place_plane(const skg_touching *of, int32_t plane, double corner[3], double normal[3]) {
    double at[3][3], local[3], u[3], v[3];
    for (int c = 0; c < 3; c++) {
        skg_mesh_vertex(of->mesh, of->layout->planes[plane][c], local);
        skg_pose_point(of->pose, local, at[c]);
    }
    skg_add_scaled(at[1], -1, at[0], u);
    skg_add_scaled(at[2], -1, at[0], v);
    skg_cross(u, v, normal);
    skg_scale_vector(1 / skg_length(normal), normal, normal);
    for (int k = 0; k < 3; k++) corner[k] = at[0][k];
}

static int share_plane(const skg_touching *a, const skg_touching *b) {
    const double margin = margin_of(a, b);
    double to[SKG_MESH_PLANES][3], other[SKG_MESH_PLANES][3];
    for (int32_t k = 0; k < b->layout->plane_count; k++) place_plane(b, k, to[k], other[k]);
    for (int32_t i = 0; i < a->layout->plane_count; i++) {
        double from[3], normal[3];
        place_plane(a, i, from, normal);
        for (int32_t k = 0; k < b->layout->plane_count; k++) {
            double way[3];
            if (!(fabs(skg_dot(normal, other[k])) > 1 - TURNED)) continue;
            skg_add_scaled(to[k], -1, from, way);
            if (fabs(skg_dot(way, normal)) <= margin) return 1;
        }
    }
    return 0;
}

static int32_t root_of(skg_touching *boxes, int32_t box) {
    while (boxes[box].root != box) box = boxes[box].root = boxes[boxes[box].root].root;
    return box;
}

static void place_box(skg_touching *box) {
    double middle[3], at[3];
    for (int k = 0; k < 3; k++)
        middle[k] =
            box->mesh->origin[k] + 0.5 * ((double)box->mesh->lowest[k] + (double)box->mesh->highest[k]);
    skg_pose_point(box->pose, middle, at);
    for (int r = 0; r < 3; r++) {
        double half = 0;
        for (int k = 0; k < 3; k++)
            half += 0.5 * fabs(box->pose[4 * r + k]) *
                    ((double)box->mesh->highest[k] - (double)box->mesh->lowest[k]);
        box->low[r] = at[r] - half, box->high[r] = at[r] + half;
    }
}

void skg_touching_find(int64_t count, skg_touching *boxes, int32_t *groups) {
    for (int64_t i = 0; i < count; i++) place_box(&boxes[i]);
    qsort(boxes, (size_t)count, sizeof *boxes, by_low_end);
    for (int32_t i = 0; i < count; i++) boxes[i].root = count > MOST ? 0 : i;
    for (int32_t i = 0; i < count && count <= MOST; i++)
        for (int32_t k = i + 1; k < count && meet_along(&boxes[i], &boxes[k], 0); k++) {
            const int32_t a = root_of(boxes, i), b = root_of(boxes, k);
            if (a == b || !meet_along(&boxes[i], &boxes[k], 1) || !meet_along(&boxes[i], &boxes[k], 2))
                continue;
            if (share_plane(&boxes[i], &boxes[k])) boxes[a > b ? a : b].root = a < b ? a : b;
        }
    for (int32_t i = 0; i < count; i++) groups[boxes[i].part] = boxes[root_of(boxes, i)].part;
}

/* --- in the picture */

/* Pictures: parts many times as large, or without a bound, are taken by themselves: others would lose their digits. */
static const double LARGEST = 16;

int skg_touching_is_huge(const skg_camera *camera, const double columns[2], const double rows[2]) {
    const double most = LARGEST * (double)(camera->columns > camera->rows ? camera->columns : camera->rows);
    return !(columns[0] >= -most && columns[1] <= most && rows[0] >= -most && rows[1] <= most);
}

void skg_touching_join(skg_touching_group *group, const double columns[2], const double rows[2],
                       double noise) {
    const double *const places[2] = {columns, rows};
    for (int k = 0; k < 2; k++) {
        group->low[k] = group->members ? fmin(group->low[k], places[k][0]) : places[k][0];
        group->high[k] = group->members ? fmax(group->high[k], places[k][1]) : places[k][1];
    }
    group->noise = group->members ? fmax(group->noise, noise) : noise;
    group->members++;
}

/* The middle of a stretch of pixels, on the detector. */
static int32_t middle_of(double low, double high, int64_t count) {
    const double middle = floor(0.5 * (low + high) + 0.5), last = (double)(count - 1);
    return (int32_t)(middle > 0 ? middle < last ? middle : last : 0);
}

/* The coordinates of a part that reaches the plane of the source have no bound, but most edges that cross the detector end near it. */
void skg_touching_measure(const skg_camera *camera, skg_touching_group *group) {
    const int64_t size[2] = {camera->columns, camera->rows};
    const double all = (double)(size[0] > size[1] ? size[0] : size[1]);
    group->farthest = 0;
    for (int k = 0; k < 2; k++) {
        const double low = group->low[k], high = group->high[k];
        const int bounded = isfinite(low) && isfinite(high);
        group->pixel[k] = bounded ? middle_of(low, high, size[k]) : (int32_t)(size[k] / 2);
        const double far = bounded ? fmax(group->pixel[k] - low, high - group->pixel[k]) : 16 * all;
        group->farthest = fmax(group->farthest, far);
    }
}

/* In single precision, four halves of the last bit of the largest coordinate. In double, half a million of them, which no image shows: so
 * the depths of a face that is wider than that agree within a millionth. Positions far from the origin of their mesh have been rounded
 * before, and corners of a flat face no longer lie in a plane: their rounding counts likewise, up to what an image would show. */
double skg_touching_shift(const skg_touching_group *group, int32_t is_double) {
    const double own =
        is_double ? 0x1p-32 * fmax(group->farthest, 64) : 2 * (double)FLT_EPSILON * group->farthest;
    return fmax(own, fmin((is_double ? 0x1p21 : 0x1p18) * group->noise, 0x1p-10));
}

double skg_touching_noise(const skg_camera *camera, const skg_mesh *mesh, const double *pose,
                          const skg_scale_part *at) {
    const double t = camera->parallel ? 1 : 0.5 * (at->low_depth + at->high_depth);
    const double middle[2] = {0.5 * (at->low_column + at->high_column), 0.5 * (at->low_row + at->high_row)};
    double most = 0;
    for (int r = 0; r < 2; r++) {
        double noise = 0;
        for (int k = 0; k < 3; k++) {
            const double along[3] = {pose[k], pose[4 + k], pose[8 + k]};
            const double deep = camera->parallel ? 0 : middle[r] * skg_dot(camera->matrix[2], along);
            const double far = fmax(fabs(mesh->origin[k] + (double)mesh->lowest[k]),
                                    fabs(mesh->origin[k] + (double)mesh->highest[k]));
            noise += fabs(skg_dot(camera->matrix[r], along) - deep) * far;
        }
        most = fmax(most, 0.5 * DBL_EPSILON * noise / t);
    }
    return isfinite(most) ? most : 0;
}
