/* Components whose orientation contradicts their place. Each is compared, from the largest to the smallest, with those
 * that are larger: columns through its box are swept, and the winding number of the larger ones inside of it says
 * whether it lies in the open or inside another. Components that were found to be inverted count as turned for the
 * smaller ones. */
#include "core/context.h"
#include "geometry/overlaps.h"

#include "core/maths.h"
#include "core/text.h"
#include "mesh/mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, COMPONENTS_MAX = 1000 };

/* An outward component is inside another if all of its columns are, up to rounding where surfaces touch. An inward one
 * lies in the open if most of its columns do: turned, it then adds where it subtracted. */
static const double WHOLLY = 0.999, MOSTLY = 0.5;

typedef struct {
    skg_solid solid;
    int64_t number; /* in the order of the first triangles */
    double volume;  /* mm3, signed, of the mesh turned outward as a whole */
    double low[3], high[3];
    int32_t inverted;
} component;

/* The columns of one component. */
typedef struct {
    double length, contradicting;      /* mm, sums over the columns, inside of the component */
    double longest;                    /* mm, contradicting */
    double longest_place[3], place[3]; /* of that stretch; of the longest stretch inside the component */
    double deepest;                    /* mm, that stretch */
} verdict;

static int by_volume(const void *a, const void *b) {
    const component *left = a, *right = b;
    const double x = fabs(left->volume), y = fabs(right->volume);
    if (x != y) return x > y ? -1 : 1;
    return left->number < right->number ? -1 : left->number > right->number;
}

static void measure(component *c, int32_t orientation) {
    const double *at = c->solid.positions;
    double volume = 0;
    for (int k = 0; k < 3; k++) c->low[k] = HUGE_VAL, c->high[k] = -HUGE_VAL;
    for (int64_t t = 0; t < c->solid.triangles; t++) {
        const int32_t *corner = c->solid.corners + 3 * t;
        double p[3][3], cross[3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                const double x = at[3 * (int64_t)corner[i] + k];
                c->low[k] = fmin(c->low[k], x), c->high[k] = fmax(c->high[k], x);
                p[i][k] =
                    x - at[3 * (int64_t)c->solid.corners[0] + k]; /* from a vertex, against cancellation */
            }
        skg_cross(p[1], p[2], cross);
        volume += skg_dot(p[0], cross) / 6;
    }
    c->volume = orientation * volume;
}

/* Sorts the triangles by component. corners: [triangles][3], filled. The caller frees *components. */
static skg_status list_components(const skg_mesh *mesh, const int32_t *number, int64_t count,
                                  const double *positions, int32_t *corners, component **components) {
    int64_t *first = NULL;
    SKG_TRY(skg_alloc(count + 1, sizeof *first, mesh->name, &first));
    skg_status status = skg_alloc(count, sizeof **components, mesh->name, components);
    if (status == SKG_OK) {
        for (int64_t t = 0; t < mesh->triangles; t++) first[number[t] + 1]++;
        for (int64_t c = 0; c < count; c++) {
            first[c + 1] += first[c];
            (*components)[c] = (component){.number = c,
                                           .solid = {.vertices = mesh->vertices,
                                                     .triangles = first[c + 1] - first[c],
                                                     .positions = positions,
                                                     .corners = corners + 3 * first[c],
                                                     .inside = -1}};
        }
        for (int64_t t = 0; t < mesh->triangles; t++)
            memcpy(corners + 3 * first[number[t]]++, mesh->corners + 3 * t, 3 * sizeof *corners);
        for (int64_t c = 0; c < count; c++) measure(&(*components)[c], mesh->orientation);
    }
    skg_free(&first);
    return status;
}

/* The part of a column between two hits, inside of the component. other: the winding number of the larger ones. */
static void judge(int inward, int32_t other, const double *place, double length, verdict *found) {
    found->length += length;
    if (length > found->deepest) {
        found->deepest = length;
        memcpy(found->place, place, sizeof found->place);
    }
    if (inward ? other >= 1 : other <= 0) return;
    found->contradicting += length;
    if (length <= found->longest) return;
    found->longest = length;
    memcpy(found->longest_place, place, sizeof found->longest_place);
}

/* Sweeps the columns. Solid 0 is the component; sign: [solids] 1, or -1 where the triangles face the other way than
 * they should be taken to. */
static void sweep(skg_columns *grid, const int32_t *sign, int inward, verdict *found) {
    for (int64_t cell = 0; cell < grid->side * grid->side; cell++) {
        int32_t own = 0, other = 0;
        skg_columns_sort(grid, cell);
        for (int64_t h = grid->first[cell]; h + 1 < grid->first[cell + 1]; h++) {
            const skg_column_hit *hit = &grid->hits[h];
            *(hit->part == 0 ? &own : &other) += sign[hit->part] * hit->sign;
            const double from = hit->depth, to = grid->hits[h + 1].depth;
            const double place[3] = {skg_column_place(grid, 0, cell % grid->side),
                                     skg_column_place(grid, 1, cell / grid->side), (from + to) / 2};
            if (own != 0) judge(inward, other, place, to - from, found);
        }
    }
}

/* Of a closed component above or below another one, a column has entered and left as often where it is inside the other:
 * only components whose boxes meet are compared. */
static int meet(const component *a, const component *b) {
    for (int k = 0; k < 3; k++)
        if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return 0;
    return 1;
}

/* Compares component `c` with those before it. solids, sign: scratch of c + 1 elements. */
static skg_status examine(const component *components, int64_t c, int32_t orientation, skg_solid *solids,
                          int32_t *sign, verdict *found) {
    const component *own = &components[c];
    skg_columns grid = {.side = SIDE, .rows = SIDE};
    int64_t count = 1;
    *found = (verdict){0};
    solids[0] = own->solid, sign[0] = orientation;
    for (int64_t i = 0; i < c; i++) {
        if (!meet(own, &components[i])) continue;
        solids[count] = components[i].solid;
        sign[count++] = components[i].inverted ? -orientation : orientation;
    }
    if (count == 1 && own->volume >= 0) return SKG_OK; /* outward in the open */
    for (int k = 0; k < 3; k++) grid.low[k] = own->low[k], grid.high[k] = own->high[k];
    for (int k = 0; k < 2; k++) grid.step[k] = (grid.high[k] - grid.low[k]) / SIDE;
    if (!(grid.step[0] > 0 && grid.step[1] > 0)) return SKG_OK; /* flat, across x or y */
    skg_status status = skg_columns_gather(&grid, count, solids, NULL);
    if (status == SKG_OK) sweep(&grid, sign, own->volume < 0, found);
    skg_columns_free(&grid);
    return status;
}

static void conclude(component *own, const verdict *found, skg_mesh_nesting *nesting) {
    const int inward = own->volume < 0;
    const double share = found->length > 0 ? found->contradicting / found->length : 0;
    /* Touching surfaces differ by rounding, which is far below this share of the component's depth. */
    const double least = 1e-6 * (own->high[2] - own->low[2]);
    own->inverted = share > (inward ? MOSTLY : WHOLLY);
    if (own->inverted) {
        nesting->inverted++;
        if (nesting->first_inverted >= 0 && nesting->first_inverted < own->number) return;
        nesting->first_inverted = own->number;
        nesting->inverted_triangles = own->solid.triangles;
        nesting->inverted_inward = inward;
        memcpy(nesting->inverted_place, found->place, sizeof found->place);
    } else if (inward && found->longest > least) {
        nesting->leaving++;
        if (nesting->first_leaving >= 0 && nesting->leaving_length >= found->longest) return;
        nesting->first_leaving = own->number;
        nesting->leaving_length = found->longest;
        memcpy(nesting->leaving_place, found->longest_place, sizeof found->longest_place);
    } else if (!inward && found->longest > least) {
        nesting->overlapping++;
        if (nesting->first_overlapping >= 0 && nesting->overlapping_length >= found->longest) return;
        nesting->first_overlapping = own->number;
        nesting->overlapping_length = found->longest;
        memcpy(nesting->overlapping_place, found->longest_place, sizeof found->longest_place);
    }
}

skg_status skg_nesting_find(const skg_mesh *mesh, skg_mesh_nesting *nesting, unsigned char *turned) {
    component *components = NULL;
    skg_solid *solids = NULL;
    double *positions = NULL;
    int32_t *number = NULL, *corners = NULL, *sign = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    skg_mesh_nesting_init(nesting);
    if (!mesh->closed) return SKG_OK;
    nesting->components = mesh->health.components;
    if (nesting->components < 2) return SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *number, mesh->name, &number));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, 3 * sizeof *corners, mesh->name, &corners));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, 3 * sizeof *positions, mesh->name, &positions));
    for (int64_t v = 0; v < mesh->vertices; v++) skg_mesh_vertex(mesh, v, positions + 3 * v);
    SKG_TRY_CLEANUP(skg_mesh_components(mesh, number, &count));
    SKG_TRY_CLEANUP(list_components(mesh, number, count, positions, corners, &components));
    qsort(components, (size_t)count, sizeof *components, by_volume);
    const int64_t examined = count < COMPONENTS_MAX ? count : COMPONENTS_MAX;
    SKG_TRY_CLEANUP(skg_alloc(examined, sizeof *solids, mesh->name, &solids));
    SKG_TRY_CLEANUP(skg_alloc(examined, sizeof *sign, mesh->name, &sign));
    for (int64_t c = 0; c < examined; c++) {
        verdict found;
        SKG_TRY_CLEANUP(examine(components, c, mesh->orientation, solids, sign, &found));
        conclude(&components[c], &found, nesting);
    }
    for (int64_t c = 0; turned && c < examined; c++)
        for (int64_t t = 0; components[c].inverted && t < mesh->triangles; t++)
            if (number[t] == components[c].number) turned[t] = 1;
cleanup:
    skg_free(&components);
    skg_free(&solids);
    skg_free(&positions);
    skg_free(&number);
    skg_free(&corners);
    skg_free(&sign);
    return status;
}

void skg_mesh_nesting_init_sized(void *nesting, int32_t size) {
    const skg_mesh_nesting defaults = {.first_inverted = -1, .first_leaving = -1, .first_overlapping = -1};
    skg_struct_init(nesting, size, &defaults, sizeof defaults);
}

skg_status skg_mesh_nesting_get(const skg_mesh *mesh, skg_mesh_nesting *nesting) {
    SKG_PLAIN;
    skg_mesh_nesting ours;
    SKG_NEEDS(mesh);
    SKG_NEEDS(nesting);
    SKG_TRY(skg_nesting_find(mesh, &ours, NULL));
    return skg_struct_write(&ours, sizeof ours, "skg_mesh_nesting", nesting);
}

skg_status skg_mesh_nesting_describe(const skg_mesh_nesting *nesting, int64_t length, char *text) {
    SKG_PLAIN;
    skg_mesh_nesting ours;
    const skg_mesh_nesting *n = &ours;
    SKG_NEEDS(text);
    skg_mesh_nesting_init(&ours);
    SKG_TRY(skg_struct_read(nesting, "skg_mesh_nesting", &ours, sizeof ours));
    if (length < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_mesh_nesting_describe: a text of %" PRId64 " bytes", length);
    const size_t size = (size_t)length;
    const double *p = n->inverted_place, *q = n->leaving_place, *r = n->overlapping_place;
    int used = 0;
    *text = '\0';
    if (n->inverted > 0)
        used = snprintf(text, size,
                        "%" PRId64 " of %" PRId64 " components %s inverted: number %" PRId64 " (%" PRId64
                        " triangles, near (%.4g, %.4g, %.4g) mm) faces %s",
                        n->inverted, n->components, n->inverted == 1 ? "is" : "are", n->first_inverted + 1,
                        n->inverted_triangles, p[0], p[1], p[2],
                        n->inverted_inward ? "inward in the open, where lengths become negative"
                                           : "outward inside another, where lengths count twice");
    if (n->leaving > 0 && used >= 0 && (size_t)used < size)
        snprintf(text + used, size - (size_t)used,
                 "%s%" PRId64 " of %" PRId64 " components %s a cavity that leaves its solid: number %" PRId64
                 " by up to %.4g mm, near (%.4g, %.4g, %.4g) mm, where lengths become negative",
                 used > 0 ? "; " : "", n->leaving, n->components, n->leaving == 1 ? "is" : "are",
                 n->first_leaving + 1, n->leaving_length, q[0], q[1], q[2]);
    used = (int)strlen(text);
    if (n->overlapping > 0 && (size_t)used < size)
        snprintf(text + used, size - (size_t)used,
                 "%s%" PRId64 " of %" PRId64 " components %s a larger one: number %" PRId64
                 " by up to %.4g mm, near (%.4g, %.4g, %.4g) mm, where lengths add",
                 used > 0 ? "; " : "", n->overlapping, n->components,
                 n->overlapping == 1 ? "overlaps" : "overlap", n->first_overlapping + 1,
                 n->overlapping_length, r[0], r[1], r[2]);
    return SKG_OK;
}

static skg_status create_oriented(skg_context *context, const skg_mesh *mesh, skg_mesh **oriented) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_mesh_create_oriented", oriented);
    *oriented = NULL;
    SKG_NEEDS_OF("skg_mesh_create_oriented", mesh);
    skg_mesh_nesting nesting;
    unsigned char *turned = NULL;
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *turned, mesh->name, &turned));
    SKG_TRY_CLEANUP(skg_nesting_find(mesh, &nesting, turned));
    SKG_TRY_CLEANUP(skg_alloc(mesh->vertices, 3 * sizeof *positions, mesh->name, &positions));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, 3 * sizeof *corners, mesh->name, &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(mesh, positions, 3));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(mesh, corners, 3));
    for (int64_t t = 0; t < mesh->triangles; t++) {
        if (!turned[t]) continue;
        const int32_t second = corners[3 * t + 1];
        corners[3 * t + 1] = corners[3 * t + 2];
        corners[3 * t + 2] = second;
    }
    /* Warnings about the given mesh were logged when it was made, unless its winding was left as it was. */
    status = skg_mesh_create(mesh->as_wound ? context : NULL, mesh->name,
                             &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                .vertices = mesh->vertices,
                                                .positions = positions,
                                                .position_stride = 3,
                                                .triangles = mesh->triangles,
                                                .corners = corners,
                                                .triangle_stride = 3,
                                                .unit_mm = 1},
                             oriented);
cleanup:
    skg_free(&turned);
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

skg_status skg_mesh_create_oriented(skg_context *context, const skg_mesh *mesh, skg_mesh **oriented) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create_oriented(context, mesh, oriented));
}
