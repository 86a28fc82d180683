/* Chain Mail on organs: of the generated thorax, and of a real man (SKG_REAL_ORGANS). The properties P1 to P4
 * and P7 to P15 of docs/breathing.md#properties; P5 is tested on a row of links (chain_test.c), P6, all shortest
 * paths, is replaced by a proof of the minimum, P16 is tested on the body (body_test.c). */
#include "chainmail/graph.h"
#include "data.h"
#include "suite.h"

#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const skg_tissue muscle = {0.7, 1.1, 0.1}, rigid = {1, 1, 0};

/* A welded surface. */
typedef struct {
    int64_t nodes, links;
    double *rest;  /* rows of x, y, z, mm */
    int32_t *ends; /* of the links */
    int32_t top;   /* highest node */
} organ;

static const double *sorted; /* positions that compare_places looks at */

static int compare_places(const void *a, const void *b) {
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    for (int k = 0; k < 3; k++)
        if (sorted[3 * p + k] != sorted[3 * q + k]) return sorted[3 * p + k] < sorted[3 * q + k] ? -1 : 1;
    return p < q ? -1 : p > q;
}

/* Vertices in one place become one node; links are the edges between them. */
static void weld(skg_mesh *mesh, organ *o) {
    int64_t vertices, triangles;
    ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
    int32_t *order = calloc((size_t)vertices, sizeof *order),
            *node_of = calloc((size_t)vertices, sizeof *order);
    int32_t *corners = calloc((size_t)triangles * 3, sizeof *corners);
    *o = (organ){.rest = calloc((size_t)vertices * 3, sizeof(double))};
    ck_assert(order && node_of && corners && o->rest);
    ck_skg(skg_mesh_positions_get(mesh, o->rest, 0));
    ck_skg(skg_mesh_triangles_get(mesh, corners, 0));
    for (int32_t i = 0; i < vertices; i++) order[i] = i;
    sorted = o->rest;
    qsort(order, (size_t)vertices, sizeof *order, compare_places);
    for (int64_t n = 0; n < vertices; n++) {
        const double *here = o->rest + 3 * order[n], *last = n ? o->rest + 3 * order[n - 1] : NULL;
        node_of[order[n]] = last && !memcmp(here, last, 3 * sizeof *here) ? node_of[order[n - 1]] : order[n];
    }
    for (int32_t i = 0; i < vertices;
         i++) { /* close up: a node's number is that of its first vertex or less */
        if (node_of[i] != i) {
            node_of[i] = node_of[node_of[i]];
            continue;
        }
        memmove(o->rest + 3 * o->nodes, o->rest + 3 * i, 3 * sizeof(double));
        node_of[i] = (int32_t)o->nodes++;
    }
    ck_skg(skg_chain_links(triangles, corners, node_of, &o->links, &o->ends));
    for (int32_t i = 0; i < o->nodes; i++)
        if (o->rest[3 * i + 2] > o->rest[3 * o->top + 2]) o->top = i;
    free(order);
    free(node_of);
    free(corners);
}

static void drop(organ *o) {
    free(o->rest);
    free(o->ends);
}

/* SKG_REAL_ORGANS is 1 for the program that needs the data. */
#if SKG_REAL_ORGANS
static const char *const organs[] = {"liver", "diaphragm", "lung_r_lower"};

/* Organ number i; path says where it is. 0 where the file is missing. */
static int find_organ(int i, organ *o, char path[DATA_PATH]) {
    char name[64];
    skg_mesh *mesh;
    snprintf(name, sizeof name, "bodyparts3d/%s.obj", organs[i]);
    if (access(data_path(name, path), R_OK) != 0) return 0;
    ck_skg(skg_mesh_load(NULL, path, 1, &mesh));
    weld(mesh, o);
    skg_mesh_release(&mesh);
    return 1;
}
#else
static const char *const organs[] = {"liver", "diaphragm", "lung left", "heart", "skin"};

/* Organ number i of the generated thorax. */
static int find_organ(int i, organ *o, char path[DATA_PATH]) {
    *path = '\0';
    skg_thorax *thorax;
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.triangles = 10000;
    options.simple = 1;
    ck_skg(skg_thorax_create(&options, &thorax));
    skg_thorax_part part;
    skg_thorax_part_init(&part);
    for (int64_t p = 0; !part.label || strcmp(part.label, organs[i]); p++)
        ck_skg(skg_thorax_part_get(thorax, p, &part));
    weld(part.mesh, o);
    skg_thorax_release(&thorax);
    return 1;
}
#endif
enum { ORGANS = sizeof organs / sizeof *organs };

/* Finds the organ of this loop's number or skips the test. */
#define take_organ(o)                                                                                        \
    do {                                                                                                     \
        char organ_path[DATA_PATH];                                                                          \
        if (!find_organ(_i, &(o), organ_path))                                                               \
            skip_test("%s is missing; SKG_DATA names its folder", organ_path);                               \
    } while (0)

static skg_chain *make(const organ *o, skg_tissue tissue) {
    skg_chain *chain;
    ck_skg(skg_chain_create("organ", o->nodes, o->rest, o->links, o->ends, &tissue, 1, NULL, &chain));
    ck_skg(skg_chain_drive(chain, 1, &o->top));
    return chain;
}

static double *zeros(const organ *o) {
    double *u = calloc((size_t)o->nodes * 3, sizeof *u);
    ck_assert_ptr_nonnull(u);
    return u;
}

/* From rest, a node that moved hangs by a taut link on one that moved more, or is driven: it could not have
 * moved less. Slacks are above 0, so those links lead to drivers. */
static void assert_least(const skg_chain *chain, const double *u) {
    for (int k = 0; k < 3; k++)
        for (int64_t i = 0; i < chain->nodes; i++) {
            const double here = u[k * chain->nodes + i];
            /* mm: a node that has not moved, but for rounding. */
            int held = chain->driver_of[i] >= 0 || fabs(here) <= 1e-9;
            for (int64_t e = chain->first[i]; e < chain->first[i + 1] && !held; e++) {
                const double stretch = u[k * chain->nodes + chain->node[e]] - here;
                held = here > 0 ? stretch >= chain->rise[k][e] - 1e-9 : -stretch >= chain->fall[k][e] - 1e-9;
            }
            ck_assert_msg(held, "node %d moved %g mm on axis %d, and no link asks for it", (int)i, here, k);
        }
}

static const double push[3] = {3, -5, -20}; /* mm */

START_TEST(one_driver) { /* P1, P2, P6, P7, P11, P12, P13 */
    organ o;
    take_organ(o);
    skg_chain *chain = make(&o, muscle), *soft = make(&o, (skg_tissue){0.6, 1.2, 0.15});
    double *u = zeros(&o), *v = zeros(&o);
    skg_chain_report report;
    ck_skg(skg_chain_move(chain, (double[3]){0}, u, NULL));
    for (int64_t i = 0; i < 3 * o.nodes; i++) ck_assert_double_eq(u[i], 0);
    ck_skg(skg_chain_move(chain, push, u, &report));
    graph_assert_links(chain, u);
    assert_least(chain, u);
    ck_assert_double_eq(report.conflict_mm, 0);
    for (int k = 0; k < 3; k++) {
        ck_assert_double_eq(u[k * o.nodes + o.top], push[k]);
        ck_assert_int_le(report.settled[2 * k] + report.settled[2 * k + 1], o.nodes);
    }
    ck_skg(skg_chain_move(soft, push, v, NULL));
    for (int64_t i = 0; i < 3 * o.nodes; i++) ck_assert_double_le(fabs(v[i]), fabs(u[i]));
    memset(v, 0, (size_t)o.nodes * 3 * sizeof *v);
    ck_skg(skg_chain_move(chain, (double[3]){0, 0, push[2]}, v, NULL));
    ck_assert_mem_eq(u + 2 * o.nodes, v + 2 * o.nodes, (size_t)o.nodes * sizeof *u);
    for (int64_t i = 0; i < 2 * o.nodes; i++) ck_assert_double_eq(v[i], 0);
    memset(v, 0, (size_t)o.nodes * 3 * sizeof *v);
    for (int step = 1; step <= 50; step++)
        ck_skg(skg_chain_move(
            chain, (double[3]){push[0] * step / 50, push[1] * step / 50, push[2] * step / 50}, v, NULL));
    for (int64_t i = 0; i < 3 * o.nodes; i++) ck_assert_double_eq_tol(u[i], v[i], 3e-12); /* 50 roundings */
    skg_chain_free(&chain);
    skg_chain_free(&soft);
    free(u);
    free(v);
    drop(&o);
}
END_TEST

enum { DRIVERS = 40 };

/* Nodes spread over the organ. */
static void spread_drivers(const organ *o, int32_t *node) {
    for (int64_t d = 0; d < DRIVERS; d++) node[d] = (int32_t)(d * o->nodes / DRIVERS);
}

START_TEST(many_drivers) { /* P1, P2, P3, P14, P15 */
    organ o;
    take_organ(o);
    skg_chain *chain = make(&o, muscle);
    double target[3 * DRIVERS], *u = zeros(&o), *v = zeros(&o);
    int32_t node[DRIVERS];
    skg_chain_report report;
    spread_drivers(&o, node);
    ck_skg(skg_chain_drive(chain, DRIVERS, node));
    /* shrunk by a twentieth about the origin: every link would hold, so that the drivers agree */
    for (int d = 0; d < DRIVERS; d++)
        for (int k = 0; k < 3; k++) target[3 * d + k] = -0.05 * o.rest[3 * node[d] + k];
    ck_skg(skg_chain_move(chain, target, u, &report));
    graph_assert_links(chain, u);
    assert_least(chain, u);
    ck_assert_double_eq(report.conflict_mm, 0);
    for (int d = 0; d < DRIVERS; d++)
        for (int k = 0; k < 3; k++) ck_assert_double_eq(u[k * o.nodes + node[d]], target[3 * d + k]);
    /* there and back: from the second cycle on the same state */
    for (int cycle = 0; cycle < 3; cycle++) {
        for (int half = 1; half >= 0; half--) {
            double part[3 * DRIVERS];
            for (int i = 0; i < 3 * DRIVERS; i++) part[i] = half * target[i];
            ck_skg(skg_chain_move(chain, part, u, NULL));
            graph_assert_links(chain, u);
        }
        for (int64_t i = 0; i < 3 * o.nodes && cycle == 2; i++) /* steps add what rounding leaves */
            ck_assert_double_eq_tol(u[i], v[i], 1e-12);
        memcpy(v, u, (size_t)o.nodes * 3 * sizeof *u);
    }
    /* each its own way */
    uint64_t s = 5;
    for (int i = 0; i < 3 * DRIVERS; i++) target[i] = 30 * graph_random(&s) - 15;
    ck_skg(skg_chain_move(chain, target, u, &report));
    graph_assert_links(chain, u);
    ck_assert_double_gt(report.conflict_mm, 1);
    for (int d = 0; d < DRIVERS; d++)
        for (int k = 0; k < 3; k++)
            ck_assert_double_le(fabs(u[k * o.nodes + node[d]] - target[3 * d + k]),
                                0.5 * report.conflict_mm + graph_rounding);
    skg_chain_free(&chain);
    free(u);
    free(v);
    drop(&o);
}
END_TEST

/* The organ with its nodes in another order, scaled by 2 and with x and y mirrored. */
static void disguise(const organ *o, organ *other, int32_t *label) {
    uint64_t s = 17;
    for (int32_t i = 0; i < o->nodes; i++) label[i] = i;
    for (int64_t i = o->nodes - 1; i > 0; i--) {
        const int64_t j = (int64_t)(graph_random(&s) * (double)(i + 1));
        const int32_t old = label[i];
        label[i] = label[j], label[j] = old;
    }
    *other = *o;
    other->rest = zeros(o);
    other->ends = calloc((size_t)o->links * 2, sizeof *o->ends);
    ck_assert_ptr_nonnull(other->ends);
    for (int64_t i = 0; i < o->nodes; i++)
        for (int k = 0; k < 3; k++) other->rest[3 * label[i] + k] = (k < 2 ? -2 : 2) * o->rest[3 * i + k];
    for (int64_t l = 0; l < 2 * o->links; l++) other->ends[l] = label[o->ends[2 * o->links - 1 - l]];
    other->top = label[o->top];
}

START_TEST(disguised) { /* P3, P4, P8, P9: one driver, so that every path starts in one place */
    organ o, other;
    take_organ(o);
    int32_t *label = calloc((size_t)o.nodes, sizeof *label);
    ck_assert_ptr_nonnull(label);
    disguise(&o, &other, label);
    skg_chain *one = make(&o, muscle), *two = make(&other, muscle), *stiff = make(&o, rigid);
    double *u = zeros(&o), *v = zeros(&o);
    ck_skg(skg_chain_move(one, push, u, NULL));
    ck_skg(skg_chain_move(two, (double[3]){-2 * push[0], -2 * push[1], 2 * push[2]}, v, NULL));
    for (int64_t i = 0; i < o.nodes; i++)
        for (int k = 0; k < 3; k++)
            ck_assert_double_eq(v[k * o.nodes + label[i]], (k < 2 ? -2 : 2) * u[k * o.nodes + i]);
    memset(u, 0, (size_t)o.nodes * 3 * sizeof *u);
    ck_skg(skg_chain_move(stiff, push, u, NULL));
    int64_t apart;
    ck_skg(skg_chain_unreached(stiff, &apart));
    for (int64_t i = 0; i < o.nodes; i++) {
        const int moved = u[i] != 0;
        apart -= !moved;
        for (int k = 0; k < 3; k++) ck_assert_double_eq(u[k * o.nodes + i], moved ? push[k] : 0);
    }
    ck_assert_int_eq(apart, 0); /* all that hangs together moved */
    skg_chain_free(&one);
    skg_chain_free(&two);
    skg_chain_free(&stiff);
    free(label);
    free(u);
    free(v);
    drop(&o);
    drop(&other);
}
END_TEST

START_TEST(halved_links) { /* P10 */
    organ o, fine;
    take_organ(o);
    fine = (organ){.nodes = o.nodes + o.links, .links = 2 * o.links, .top = o.top};
    fine.rest = zeros(&fine);
    fine.ends = calloc((size_t)o.links * 4, sizeof *fine.ends);
    ck_assert_ptr_nonnull(fine.ends);
    memcpy(fine.rest, o.rest, (size_t)o.nodes * 3 * sizeof(double));
    for (int64_t l = 0; l < o.links; l++) {
        const int32_t middle = (int32_t)(o.nodes + l), *end = o.ends + 2 * l;
        for (int k = 0; k < 3; k++)
            fine.rest[3 * middle + k] = 0.5 * (o.rest[3 * end[0] + k] + o.rest[3 * end[1] + k]);
        memcpy(fine.ends + 4 * l, (int32_t[4]){end[0], middle, middle, end[1]}, 4 * sizeof(int32_t));
    }
    skg_chain *coarse = make(&o, muscle), *finer = make(&fine, muscle);
    double *u = zeros(&o), *v = zeros(&fine);
    ck_skg(skg_chain_move(coarse, push, u, NULL));
    ck_skg(skg_chain_move(finer, push, v, NULL));
    for (int k = 0; k < 3; k++)
        for (int64_t i = 0; i < o.nodes; i++)
            ck_assert_double_eq_tol(u[k * o.nodes + i], v[k * fine.nodes + i],
                                    1e-10); /* 1e3 links of rounding */
    skg_chain_free(&coarse);
    skg_chain_free(&finer);
    free(u);
    free(v);
    drop(&o);
    drop(&fine);
}
END_TEST

START_TEST(two_drivers_apart) { /* P15: by how much they contradict each other, from one driver's reach */
    organ o;
    take_organ(o);
    skg_chain *chain = make(&o, muscle);
    double *u = zeros(&o);
    int32_t other = 0;
    for (int32_t i = 0; i < o.nodes; i++)
        if (o.rest[3 * i + 2] < o.rest[3 * other + 2]) other = i;
    const double far = 1e3; /* mm: farther than any slack reaches */
    ck_skg(skg_chain_move(chain, (double[3]){0, 0, far}, u, NULL));
    const double slack = far - u[2 * o.nodes + other];
    if (slack < far) { /* in one piece with the top */
        memset(u, 0, (size_t)o.nodes * 3 * sizeof *u);
        ck_skg(skg_chain_drive(chain, 2, (int32_t[2]){o.top, other}));
        skg_chain_report report;
        const double up = slack, down = -7;
        ck_skg(skg_chain_move(chain, (double[6]){0, 0, up, 0, 0, down}, u, &report));
        ck_assert_double_eq_tol(report.conflict_mm, 7, 1e-9); /* 1e3 mm over 1e3 links */
        ck_assert_int_eq(report.axis, 2);
        /* as above, on both sides */
        ck_assert_double_eq_tol(u[2 * o.nodes + o.top], up - 3.5, 1e-9);
        ck_assert_double_eq_tol(u[2 * o.nodes + other], down + 3.5, 1e-9);
        graph_assert_links(chain, u);
    }
    skg_chain_free(&chain);
    free(u);
    drop(&o);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, one_driver, 0, ORGANS);
    tcase_add_loop_test(tests, many_drivers, 0, ORGANS);
    tcase_add_loop_test(tests, disguised, 0, ORGANS);
    tcase_add_loop_test(tests, halved_links, 0, ORGANS);
    tcase_add_loop_test(tests, two_drivers_apart, 0, ORGANS);
}

SKG_SUITE_MAIN("chain on organs", add_tests)
