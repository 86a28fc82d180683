/* Changes that must not change the answer of Chain Mail, or must change it alike: P3, P7 to P13 of docs/breathing.md#properties. */
#include "chainmail/graph.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

START_TEST(same_bits_whatever_the_order) { /* P3 */
    graph g, h;
    uint64_t s = (uint64_t)_i + 5;
    graph_make((uint64_t)_i + 900, 60, 150, &g);
    h = g;
    int32_t label[GRAPH_NODES], node[3], renamed[3];
    double target[9], u[3 * GRAPH_NODES] = {0}, v[3 * GRAPH_NODES] = {0}, w[3 * GRAPH_NODES] = {0};
    for (int i = 0; i < 60; i++) label[i] = i;
    for (int i = 59; i > 0; i--) {
        int j = (int)(graph_random(&s) * (i + 1)), old = label[i];
        label[i] = label[j], label[j] = old;
    }
    for (int i = 0; i < 60; i++)
        for (int k = 0; k < 3; k++) h.rest[3 * label[i] + k] = g.rest[3 * i + k];
    for (int64_t l = 0; l < g.links; l++) { /* links backwards, each turned round */
        int64_t m = g.links - 1 - l;
        h.ends[2 * l] = label[g.ends[2 * m + 1]], h.ends[2 * l + 1] = label[g.ends[2 * m]];
        h.kind[l] = g.kind[m];
    }
    graph_drivers(&s, 60, 3, 40, node, target);
    for (int d = 0; d < 3; d++) renamed[d] = label[node[d]];
    skg_chain *one = graph_chain(&g), *other = graph_chain(&h);
    ck_skg(skg_chain_drive(one, 3, node));
    ck_skg(skg_chain_drive(other, 3, renamed));
    omp_set_num_threads(1);
    ck_skg(skg_chain_move(one, target, u, NULL));
    omp_set_num_threads(1 + _i % 8);
    ck_skg(skg_chain_move(one, target, w, NULL));
    ck_skg(skg_chain_move(other, target, v, NULL));
    ck_assert_mem_eq(u, w, sizeof u);
    for (int i = 0; i < 60; i++)
        for (int axis = 0; axis < 3; axis++)
            ck_assert_mem_eq(&u[axis * 60 + i], &v[axis * 60 + label[i]], sizeof(double));
    skg_chain_free(&one);
    skg_chain_free(&other);
}
END_TEST

/* Rows and columns of an uneven sheet, each node tied to the next ones along, across and askew. */
static skg_chain *sheet(int32_t side, uint64_t *s) {
    int64_t nodes = (int64_t)side * side, links = 0;
    double *rest = calloc((size_t)nodes * 3, sizeof *rest);
    int32_t *ends = calloc((size_t)nodes * 6, sizeof *ends), *kind = calloc((size_t)nodes * 3, sizeof *kind);
    const skg_tissue tissues[3] = {{0.7, 1.1, 0.1}, {0.9, 1.02, 0.01}, {0.5, 1.5, 0.3}};
    ck_assert(rest && ends && kind);
    for (int32_t i = 0; i < nodes; i++) {
        int32_t x = i % side, y = i / side;
        rest[3 * i] = x + 0.5 * graph_random(s), rest[3 * i + 1] = y + 0.5 * graph_random(s);
        rest[3 * i + 2] = 0.02 * (x * x - y * y) / side + 0.2 * graph_random(s);
        for (int way = 0; way < 3; way++) {
            int32_t across = way != 1, along = way != 0;
            if (x + across >= side || y + along >= side) continue;
            ends[2 * links] = i, ends[2 * links + 1] = i + across + along * side;
            kind[links++] = (int32_t)(3 * graph_random(s));
        }
    }
    skg_chain *chain;
    ck_skg(skg_chain_create("sheet", nodes, rest, links, ends, tissues, 3, kind, &chain));
    free(rest);
    free(ends);
    free(kind);
    return chain;
}

START_TEST(same_bits_for_any_number_of_threads) { /* P1, P2, P3: enough nodes for threads to be used */
    enum { SIDE = 110, NODES = SIDE * SIDE, DRIVERS = 40 };
    static double u[3 * NODES], v[3 * NODES];
    uint64_t s = 99;
    skg_chain *chain = sheet(SIDE, &s);
    int32_t node[DRIVERS];
    double target[3 * DRIVERS];
    graph_drivers(&s, NODES, DRIVERS, 25, node, target);
    for (int d = 0; d < 3 * DRIVERS; d++) target[d] += 10; /* together, but contradictory */
    ck_skg(skg_chain_drive(chain, DRIVERS, node));
    for (int threads = 1; threads <= 16; threads *= 2) {
        double *state = threads == 1 ? u : v;
        skg_chain_report report;
        omp_set_num_threads(threads);
        memset(state, 0, sizeof u);
        for (int step = 0; step < 3; step++) { /* there, relaxed, back, there */
            ck_skg(skg_chain_move(chain, target, state, &report));
            graph_assert_links(chain, state);
            ck_assert_double_gt(report.conflict_mm, 1);
            if (step == 0) ck_skg(skg_chain_relax(chain, 2, 0.5, state));
            for (int f = 0; f < 6; f++) ck_assert_int_le(report.settled[f], NODES);
            for (int d = 0; d < 3 * DRIVERS; d++) target[d] = step == 2 ? target[d] : -target[d];
        }
        ck_assert_mem_eq(state, u, sizeof u);
    }
    skg_chain_free(&chain);
}
END_TEST

START_TEST(axes_shift_mirror) { /* P7, P8, P9, P11 */
    graph g, h;
    uint64_t s = 31 + (uint64_t)_i;
    graph_make((uint64_t)_i + 40, 50, 100, &g);
    h = g;
    for (int64_t i = 0; i < g.nodes;
         i++) { /* halved; x mirrored, so that its directions are searched in the other order */
        h.rest[3 * i] = -0.5 * g.rest[3 * i];
        h.rest[3 * i + 1] = 0.5 * g.rest[3 * i + 1];
        h.rest[3 * i + 2] = 0.5 * g.rest[3 * i + 2];
    }
    int32_t node[2];
    double target[6], other[6], u[3 * GRAPH_NODES] = {0}, v[3 * GRAPH_NODES] = {0}, x[3 * GRAPH_NODES] = {0};
    graph_drivers(&s, g.nodes, 2, 25, node, target);
    skg_chain *one = graph_chain(&g), *two = graph_chain(&h);
    ck_skg(skg_chain_drive(one, 2, node));
    ck_skg(skg_chain_drive(two, 2, node));
    ck_skg(skg_chain_move(one, (double[6]){0}, x, NULL));
    for (int i = 0; i < 3 * GRAPH_NODES; i++) ck_assert_double_eq(x[i], 0);
    for (int i = 0; i < 6; i++) other[i] = 0.5 * (i % 3 ? 1 : -1) * target[i];
    ck_skg(skg_chain_move(one, target, u, NULL));
    ck_skg(skg_chain_move(two, other, v, NULL));
    for (int64_t i = 0; i < g.nodes; i++)
        for (int k = 0; k < 3; k++)
            ck_assert_double_le(fabs(v[k * g.nodes + i] - 0.5 * (k ? 1 : -1) * u[k * g.nodes + i]),
                                k ? 0 : graph_rounding);
    double flat[6] = {target[0], 0, 0, target[3], 0, 0};
    ck_skg(skg_chain_move(one, flat, x, NULL));
    for (int64_t i = 0; i < g.nodes; i++) {
        ck_assert_double_eq(x[i], u[i]);
        ck_assert_double_eq(x[g.nodes + i], 0);
    }
    for (int64_t i = 0; i < 3 * g.nodes; i++) h.rest[i] = g.rest[i] + 1024;
    skg_chain_free(&two);
    two = graph_chain(&h);
    ck_skg(skg_chain_drive(two, 2, node));
    memset(v, 0, sizeof v);
    ck_skg(skg_chain_move(two, target, v, NULL));
    for (int64_t i = 0; i < 3 * g.nodes; i++) ck_assert_double_eq_tol(u[i], v[i], graph_rounding);
    skg_chain_free(&one);
    skg_chain_free(&two);
}
END_TEST

START_TEST(subdivided_links_change_nothing) { /* P10 */
    graph g;
    static double rest[3 * (GRAPH_NODES + GRAPH_LINKS)];
    static int32_t ends[4 * GRAPH_LINKS], kind[2 * GRAPH_LINKS];
    uint64_t s = 3 + (uint64_t)_i;
    graph_make((uint64_t)_i + 300, 40, 80, &g);
    int64_t fine = g.nodes + g.links;
    memcpy(rest, g.rest, sizeof g.rest);
    for (int64_t l = 0; l < g.links; l++) {
        int32_t middle = (int32_t)(g.nodes + l);
        for (int k = 0; k < 3; k++)
            rest[3 * middle + k] = 0.5 * (g.rest[3 * g.ends[2 * l] + k] + g.rest[3 * g.ends[2 * l + 1] + k]);
        ends[4 * l] = g.ends[2 * l], ends[4 * l + 1] = ends[4 * l + 2] = middle;
        ends[4 * l + 3] = g.ends[2 * l + 1];
        kind[2 * l] = kind[2 * l + 1] = g.kind[l];
    }
    int32_t node[2];
    double target[6], u[3 * GRAPH_NODES] = {0};
    static double v[3 * (GRAPH_NODES + GRAPH_LINKS)];
    graph_drivers(&s, g.nodes, 2, 25, node, target);
    skg_chain *coarse = graph_chain(&g), *finer;
    ck_skg(skg_chain_create("fine", fine, rest, 2 * g.links, ends, g.tissues, 4, kind, &finer));
    ck_skg(skg_chain_drive(coarse, 2, node));
    ck_skg(skg_chain_drive(finer, 2, node));
    ck_skg(skg_chain_move(coarse, target, u, NULL));
    ck_skg(skg_chain_move(finer, target, v, NULL));
    for (int k = 0; k < 3; k++)
        for (int64_t i = 0; i < g.nodes; i++)
            ck_assert_double_eq_tol(u[k * g.nodes + i], v[k * fine + i], 2 * graph_rounding);
    skg_chain_free(&coarse);
    skg_chain_free(&finer);
}
END_TEST

START_TEST(softer_tissue_moves_less) { /* P12 */
    graph g, h;
    uint64_t s = 8 + (uint64_t)_i;
    graph_make((uint64_t)_i + 500, 50, 60, &g);
    h = g;
    for (int t = 0; t < 4; t++) {
        h.tissues[t].alpha_min *= 0.9;
        h.tissues[t].alpha_max *= 1.1;
        h.tissues[t].beta += 0.05;
    }
    int32_t node[1];
    double target[3], u[3 * GRAPH_NODES] = {0}, v[3 * GRAPH_NODES] = {0};
    graph_drivers(&s, g.nodes, 1, 30, node, target);
    skg_chain *stiff = graph_chain(&g), *soft = graph_chain(&h);
    ck_skg(skg_chain_drive(stiff, 1, node));
    ck_skg(skg_chain_drive(soft, 1, node));
    ck_skg(skg_chain_move(stiff, target, u, NULL));
    ck_skg(skg_chain_move(soft, target, v, NULL));
    for (int64_t i = 0; i < 3 * g.nodes; i++) ck_assert_double_le(fabs(v[i]), fabs(u[i]));
    skg_chain_free(&stiff);
    skg_chain_free(&soft);
}
END_TEST

START_TEST(one_step_is_many) { /* P13: drivers that go straight on */
    graph g;
    uint64_t s = 12 + (uint64_t)_i;
    graph_make((uint64_t)_i + 700, 60, 100, &g);
    int32_t node[1];
    double target[3], u[3 * GRAPH_NODES] = {0}, v[3 * GRAPH_NODES] = {0};
    graph_drivers(&s, g.nodes, 1, 30, node, target);
    skg_chain *chain = graph_chain(&g);
    ck_skg(skg_chain_drive(chain, 1, node));
    ck_skg(skg_chain_move(chain, target, u, NULL));
    for (int step = 1; step <= 50; step++) {
        double part[3];
        for (int k = 0; k < 3; k++) part[k] = target[k] * step / 50.0;
        ck_skg(skg_chain_move(chain, part, v, NULL));
        graph_assert_links(chain, v);
    }
    /* 50 steps of paths of up to 30 mm. */
    for (int64_t i = 0; i < 3 * g.nodes; i++) ck_assert_double_eq_tol(u[i], v[i], 256 * DBL_EPSILON * 30);
    skg_chain_free(&chain);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, same_bits_whatever_the_order, 0, 16);
    tcase_add_test(tests, same_bits_for_any_number_of_threads);
    tcase_add_loop_test(tests, axes_shift_mirror, 0, 10);
    tcase_add_loop_test(tests, subdivided_links_change_nothing, 0, 10);
    tcase_add_loop_test(tests, softer_tissue_moves_less, 0, 10);
    tcase_add_loop_test(tests, one_step_is_many, 0, 10);
}

SKG_SUITE_MAIN("chain invariance", add_tests)
