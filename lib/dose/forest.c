/* The triangles of all closed parts of a scene, in boxes within boxes, and what a line crosses. */
#include "dose/pieces.h"

#include "core/maths.h"
#include "mesh/mesh.h"
#include "scene/scene.h"

#include <stdlib.h>

/* Triangles of a box that is not halved further; boxes within boxes, which hold more triangles than fit in memory. */
enum { LEAF = 4, DEEPEST = 64 };

/* --- making it */

typedef struct {
    skg_forest *tree;
    int32_t *order;      /* [count] numbers of triangles */
    double (*middle)[3]; /* [count] */
    double (*given)[9];  /* [count] corners as the parts have them */
    int32_t *given_part;
    int8_t *given_sign;
} planting;

static void bound(const planting *p, skg_forest_node *node, int64_t first, int64_t count) {
    for (int a = 0; a < 3; a++) node->low[a] = HUGE_VAL, node->high[a] = -HUGE_VAL;
    for (int64_t i = first; i < first + count; i++)
        for (int k = 0; k < 9; k++) {
            const double x = p->given[p->order[i]][k];
            node->low[k % 3] = fmin(node->low[k % 3], x), node->high[k % 3] = fmax(node->high[k % 3], x);
        }
}

/* Puts the triangles whose middles are on the lower side first, and returns how many they are. */
static int64_t part_at(const planting *p, int64_t first, int64_t count, int axis, double place) {
    int64_t low = first, high = first + count;
    while (low < high) {
        const int32_t number = p->order[low];
        if (p->middle[number][axis] < place) {
            low++;
            continue;
        }
        p->order[low] = p->order[--high];
        p->order[high] = number;
    }
    return low - first;
}

/* Halves the box of the middles along its longest side; in numbers, where that leaves a half empty. */
static int64_t halve(const planting *p, int64_t first, int64_t count) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int axis = 0;
    for (int64_t i = first; i < first + count; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], p->middle[p->order[i]][a]);
            high[a] = fmax(high[a], p->middle[p->order[i]][a]);
        }
    for (int a = 1; a < 3; a++)
        if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
    const int64_t half = part_at(p, first, count, axis, 0.5 * (low[axis] + high[axis]));
    return half > 0 && half < count ? half : count / 2;
}

static void plant(planting *p, int64_t number, int64_t first, int64_t count, int depth) {
    skg_forest_node *node = &p->tree->nodes[number];
    bound(p, node, first, count);
    if (count <= LEAF || depth == DEEPEST) {
        node->first = (int32_t)first, node->count = (int32_t)count;
        return;
    }
    const int64_t half = halve(p, first, count), children = p->tree->node_count;
    p->tree->node_count += 2;
    node->first = (int32_t)children, node->count = 0;
    plant(p, children, first, half, depth + 1);
    plant(p, children + 1, first + half, count - half, depth + 1);
}

static void gather(const skg_scene *scene, planting *p) {
    int64_t n = 0;
    for (int64_t i = 0; i < scene->count; i++) {
        const skg_scene_part_data *part = &scene->parts[i];
        const int mirrored = skg_pose_determinant(part->pose) < 0;
        for (int64_t t = 0; part->mesh->closed && t < part->mesh->triangles; t++, n++) {
            for (int k = 0; k < 3; k++) {
                double at[3];
                skg_mesh_vertex(part->mesh, part->mesh->corners[3 * t + k], at);
                skg_pose_point(part->pose, at, p->given[n] + 3 * k);
            }
            for (int a = 0; a < 3; a++)
                p->middle[n][a] = (p->given[n][a] + p->given[n][3 + a] + p->given[n][6 + a]) / 3;
            p->given_part[n] = (int32_t)i;
            p->given_sign[n] = (int8_t)((mirrored ? -1 : 1) * part->mesh->orientation);
            p->order[n] = (int32_t)n;
        }
    }
}

static void arrange(const planting *p) {
    skg_forest *tree = p->tree;
    for (int64_t i = 0; i < tree->count; i++) {
        for (int k = 0; k < 9; k++) tree->corners[i][k] = p->given[p->order[i]][k];
        tree->part[i] = p->given_part[p->order[i]];
        tree->sign[i] = p->given_sign[p->order[i]];
    }
}

static skg_status allocate(planting *p) {
    static const char what[] = "dose";
    skg_forest *tree = p->tree;
    SKG_TRY(skg_alloc(tree->count, sizeof *tree->corners, what, &tree->corners));
    SKG_TRY(skg_alloc(tree->count, sizeof *tree->part, what, &tree->part));
    SKG_TRY(skg_alloc(tree->count, sizeof *tree->sign, what, &tree->sign));
    SKG_TRY(skg_alloc(2 * tree->count, sizeof *tree->nodes, what, &tree->nodes));
    SKG_TRY(skg_alloc(tree->count, sizeof *p->order, what, &p->order));
    SKG_TRY(skg_alloc(tree->count, sizeof *p->middle, what, &p->middle));
    SKG_TRY(skg_alloc(tree->count, sizeof *p->given, what, &p->given));
    SKG_TRY(skg_alloc(tree->count, sizeof *p->given_part, what, &p->given_part));
    return skg_alloc(tree->count, sizeof *p->given_sign, what, &p->given_sign);
}

skg_status skg_forest_make(const skg_scene *scene, skg_forest *tree) {
    planting p = {.tree = tree};
    *tree = (skg_forest){0};
    for (int64_t i = 0; i < scene->count; i++)
        if (scene->parts[i].mesh->closed) tree->count += scene->parts[i].mesh->triangles;
    if (tree->count > INT32_MAX / 2)
        return skg_fail(SKG_ERR_UNSUPPORTED, "dose: more than 2^30 triangles; leave out parts");
    if (tree->count == 0) return SKG_OK;
    const skg_status status = allocate(&p);
    if (status == SKG_OK) {
        gather(scene, &p);
        tree->node_count = 1;
        plant(&p, 0, 0, tree->count, 0);
        arrange(&p);
    }
    skg_free(&p.order);
    skg_free(&p.middle);
    skg_free(&p.given);
    skg_free(&p.given_part);
    skg_free(&p.given_sign);
    return status;
}

void skg_forest_free(skg_forest *tree) {
    skg_free(&tree->corners);
    skg_free(&tree->part);
    skg_free(&tree->sign);
    skg_free(&tree->nodes);
}

/* --- what a line crosses */

/* A line, and the axes along which it is seen: z is the one along which it runs most. */
typedef struct {
    double from[3], inverse[3];
    int x, y, z;
    double shear[3]; /* of x and y per z, and 1 / direction along z */
} line;

static line line_of(const double from[3], const double direction[3]) {
    line l = {.z = 0};
    for (int a = 1; a < 3; a++)
        if (fabs(direction[a]) > fabs(direction[l.z])) l.z = a;
    l.x = (l.z + 1) % 3, l.y = (l.z + 2) % 3;
    for (int a = 0; a < 3; a++) l.from[a] = from[a], l.inverse[a] = 1 / direction[a];
    l.shear[0] = direction[l.x] / direction[l.z], l.shear[1] = direction[l.y] / direction[l.z];
    l.shear[2] = 1 / direction[l.z];
    return l;
}

/* Whether the line meets a box, which is widened by what rounding may take off. */
static int meets_box(const line *l, const skg_forest_node *node) {
    double enter = 0, leave = HUGE_VAL;
    for (int a = 0; a < 3; a++) {
        const double low = (node->low[a] - l->from[a]) * l->inverse[a],
                     high = (node->high[a] - l->from[a]) * l->inverse[a];
        /* A line within the plane of a face: 0 times infinity. */
        if (isnan(low) || isnan(high)) continue;
        enter = fmax(enter, fmin(low, high)), leave = fmin(leave, fmax(low, high));
    }
    return enter <= leave * (1 + 8e-16) + 1e-12;
}

/* Which side of the directed edge from b to c the line passes; an edge that it meets belongs to the side that its direction says, so that
 * both triangles at the edge agree. */
static int side_of(const double b[3], const double c[3], double *area) {
    *area = c[0] * b[1] - c[1] * b[0];
    if (*area > 0) return 1;
    if (*area < 0) return 0;
    return b[1] > c[1] || (!(b[1] < c[1]) && b[0] > c[0]);
}

static int meets_triangle(const line *l, const double corners[9], double *at, int *sign) {
    double p[3][3], area[3];
    for (int k = 0; k < 3; k++) {
        const double *corner = corners + 3 * k, z = corner[l->z] - l->from[l->z];
        p[k][0] = corner[l->x] - l->from[l->x] - l->shear[0] * z;
        p[k][1] = corner[l->y] - l->from[l->y] - l->shear[1] * z;
        p[k][2] = z;
    }
    const int side = side_of(p[1], p[2], &area[0]);
    if (side_of(p[2], p[0], &area[1]) != side || side_of(p[0], p[1], &area[2]) != side) return 0;
    const double sum = area[0] + area[1] + area[2];
    const double z =
        sum < 0 || sum > 0 ? (area[0] * p[0][2] + area[1] * p[1][2] + area[2] * p[2][2]) / sum : p[0][2];
    *at = z * l->shear[2];
    /* Seen along z the corners of a triangle that faces the line run clockwise where `area` is above 0. */
    *sign = (side != 0) == (l->shear[2] > 0) ? 1 : -1;
    return *at > 0;
}

static int by_place(const void *a, const void *b) {
    const skg_crossing *x = a, *y = b;
    if (x->at < y->at || x->at > y->at) return x->at < y->at ? -1 : 1;
    return x->sign - y->sign; /* out of one part before into the next */
}

static skg_status add(skg_way *way, double at, int32_t part, int32_t sign) {
    if (way->crossing_count == way->crossing_room) {
        const int64_t room = 2 * way->crossing_room + 64;
        SKG_TRY(skg_realloc(room, sizeof *way->crossings, "dose", &way->crossings));
        way->crossing_room = room;
    }
    way->crossings[way->crossing_count++] = (skg_crossing){at, part, sign};
    return SKG_OK;
}

skg_status skg_way_cross(const skg_forest *tree, const double from[3], const double direction[3],
                         skg_way *way) {
    int32_t stack[DEEPEST + 2] = {0};
    int top = tree->node_count > 0;
    const line l = line_of(from, direction);
    way->crossing_count = 0;
    while (top > 0) {
        const skg_forest_node *node = &tree->nodes[stack[--top]];
        if (!meets_box(&l, node)) continue;
        if (node->count == 0) {
            stack[top++] = node->first, stack[top++] = node->first + 1;
            continue;
        }
        for (int32_t t = node->first; t < node->first + node->count; t++) {
            double at = 0;
            int sign = 0;
            if (meets_triangle(&l, tree->corners[t], &at, &sign))
                SKG_TRY(add(way, at, tree->part[t], sign * tree->sign[t]));
        }
    }
    if (way->crossing_count > 1)
        qsort(way->crossings, (size_t)way->crossing_count, sizeof *way->crossings, by_place);
    return SKG_OK;
}
