/* Chain Mail against closed forms and all shortest paths: P1, P2, P4 to P6, P14, P15 of docs/breathing.md#properties. */
#include "chainmail/graph.h"
#include "suite.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { TRIALS = 60 };

START_TEST(closed_form_on_random_graphs) { /* P1, P2, P6: every trial has its own graph */
    graph g;
    uint64_t s = (uint64_t)_i + 77;
    graph_make((uint64_t)_i + 1, 5 + _i % 56, 20 + 3 * _i, &g);
    skg_chain *chain = graph_chain(&g);
    int32_t node[4];
    double target[12], u[3 * GRAPH_NODES] = {0}, before[3 * GRAPH_NODES];
    static double distance[3][GRAPH_NODES * GRAPH_NODES];
    for (int axis = 0; axis < 3; axis++) graph_distances(&g, axis, distance[axis]);
    for (int step = 0; step < 5; step++) { /* each from where the last one ended */
        int64_t count = 1 + (_i + step) % 4, n = g.nodes;
        graph_drivers(&s, n, count, 30, node, target);
        ck_skg(skg_chain_drive(chain, count, node));
        memcpy(before, u, sizeof u);
        skg_chain_report report;
        ck_skg(skg_chain_move(chain, target, u, &report));
        graph_assert_links(chain, u);
        double conflict = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double *D = distance[axis];
            double most = 0;
            for (int64_t i = 0; i < n; i++) {
                double low = -HUGE_VAL, high = HUGE_VAL;
                for (int64_t d = 0; d < count; d++) {
                    low = fmax(low, target[3 * d + axis] - D[i * n + node[d]]);
                    high = fmin(high, target[3 * d + axis] + D[node[d] * n + i]);
                }
                most = fmax(most, low - high);
                double expected = /* halfway where the drivers contradict each other */
                    low > high ? 0.5 * (low + high) : fmin(fmax(before[axis * n + i], low), high);
                ck_assert_double_le(fabs(u[axis * n + i] - expected), graph_rounding);
            }
            conflict = fmax(conflict, most);
            for (int64_t d = 0; d < count; d++) { /* P15: drivers are missed by half the conflict at most */
                double miss = fabs(u[axis * n + node[d]] - target[3 * d + axis]);
                ck_assert_double_le(miss, 0.5 * most + graph_rounding);
                if (most <= graph_rounding) ck_assert_double_eq(miss, 0);
            }
        }
        ck_assert_double_le(fabs(report.conflict_mm - conflict), graph_rounding);
        for (int f = 0; f < 6; f++) ck_assert_int_le(report.settled[f], n);
    }
    skg_chain_free(&chain);
}
END_TEST

/* n + 1 nodes in a row along x, step mm apart. */
static skg_chain *row(int64_t n, double step, skg_tissue tissue, double *rest) {
    int32_t ends[2 * 1024];
    for (int64_t i = 0; i <= n; i++) rest[3 * i] = step * (double)i, rest[3 * i + 1] = rest[3 * i + 2] = 0;
    for (int64_t i = 0; i < n; i++) ends[2 * i] = (int32_t)i, ends[2 * i + 1] = (int32_t)i + 1;
    skg_chain *chain;
    ck_skg(skg_chain_create("row", n + 1, rest, n, ends, &tissue, 1, NULL, &chain));
    int32_t first = 0;
    ck_skg(skg_chain_drive(chain, 1, &first));
    return chain;
}

START_TEST(chain_of_links) { /* P4, P5 */
    double rest[3 * 101];
    double u[3 * 101] = {0}, push[3] = {20, -3, 5};
    skg_chain *chain = row(100, 1, (skg_tissue){0.7, 1.1, 0.1}, rest);
    ck_skg(skg_chain_move(chain, push, u, NULL));
    for (int i = 0; i <= 100; i++) {
        /* A sum of up to 100 links each. */
        ck_assert_double_eq_tol(u[i], fmax(0, 20 - 0.3 * i), 200 * DBL_EPSILON * 20);
        ck_assert_double_eq_tol(u[101 + i], -fmax(0, 3 - 0.1 * i), 200 * DBL_EPSILON * 20);
        ck_assert_double_eq_tol(u[202 + i], fmax(0, 5 - 0.1 * i), 200 * DBL_EPSILON * 20);
    }
    skg_chain_free(&chain);
    chain = row(100, 0.37, (skg_tissue){1, 1, 0}, rest);
    memset(u, 0, sizeof u);
    for (int step = 1; step < 7; step++) {
        double target[3] = {0.1 * step, -0.7 * step, 1.3 / step};
        ck_skg(skg_chain_move(chain, target, u, NULL));
        for (int i = 0; i <= 100; i++)
            for (int k = 0; k < 3; k++) ck_assert_double_eq(u[101 * k + i], target[k]);
    }
    skg_chain_free(&chain);
}
END_TEST

START_TEST(reach_of_the_papers_tendon) { /* 20 mm in the paper's muscle: 67 mm pushed, 200 mm pulled */
    static double rest[3 * 1001], u[3 * 1001];
    skg_chain *chain = row(1000, 0.25, (skg_tissue){0.7, 1.1, 0.1}, rest);
    for (int way = -1; way <= 1; way += 2) {
        memset(u, 0, sizeof u);
        ck_skg(skg_chain_move(chain, (double[3]){20 * way, 0, 0}, u, NULL));
        double reach = 0;
        for (int i = 0; i <= 1000; i++) /* mm: moved by more than rounding. */
            if (fabs(u[i]) > 1e-9) reach = rest[3 * i];
        double expected = way > 0 ? 20 / 0.3 : 20 / 0.1;
        ck_assert_double_le(fabs(reach - expected), 0.25); /* one link */
    }
    skg_chain_free(&chain);
}
END_TEST

START_TEST(loops_are_play_operators) { /* P14: loop width A + B, same states from the second cycle on */
    double rest[3 * 11], u[3 * 11] = {0}, inhale[2][11], exhale[2][11];
    skg_chain *chain = row(10, 2, (skg_tissue){0.8, 1.1, 0.1}, rest);
    for (int cycle = 0; cycle < 2; cycle++) {
        ck_skg(skg_chain_move(chain, (double[3]){30, 0, 0}, u, NULL));
        memcpy(inhale[cycle], u, sizeof inhale[cycle]);
        ck_skg(skg_chain_move(chain, (double[3]){0, 0, 0}, u, NULL));
        memcpy(exhale[cycle], u, sizeof exhale[cycle]);
    }
    ck_assert_mem_eq(inhale[0], inhale[1], sizeof inhale[0]);
    ck_assert_mem_eq(exhale[0], exhale[1], sizeof exhale[0]);
    for (int i = 0; i <= 10; i++) { /* pushed: 0.4 mm of slack a link; pulled: 0.2 mm */
        ck_assert_double_eq_tol(inhale[1][i] - exhale[1][i], 30 - 0.6 * i, 1e-12);
        ck_assert_double_eq_tol(exhale[1][i], 0.2 * i, 1e-12);
    }
    skg_chain_free(&chain);
}
END_TEST

START_TEST(conflict_is_reported_and_halved) { /* P15, drivers that never overrun each other's nodes */
    double rest[3 * 11], u[3 * 11] = {0};
    skg_chain *chain = row(10, 1, (skg_tissue){0.9, 1.1, 0.1}, rest);
    ck_skg(skg_chain_drive(chain, 2, (int32_t[2]){0, 10}));
    skg_chain_report report;
    ck_skg(skg_chain_move(chain, (double[6]){-2, 0, 0, 1.5, 0, 0}, u, &report));
    ck_assert_double_eq_tol(report.conflict_mm, 2.5, 1e-12); /* 3.5 mm apart, 1 mm of slack */
    ck_assert_int_eq(report.axis, 0);
    ck_assert_double_eq_tol(u[0], -0.75, 64 * DBL_EPSILON);
    ck_assert_double_eq_tol(u[10], 0.25, 64 * DBL_EPSILON);
    graph_assert_links(chain, u);
    skg_chain_free(&chain);
}
END_TEST

START_TEST(relaxation_keeps_links_and_drivers) {
    graph g;
    uint64_t s = 21 + (uint64_t)_i;
    graph_make((uint64_t)_i + 60, 60, 150, &g);
    int32_t node[2];
    double target[6], u[3 * GRAPH_NODES] = {0}, v[3 * GRAPH_NODES];
    graph_drivers(&s, g.nodes, 2, 8, node, target);
    for (int k = 0; k < 3; k++) target[3 + k] = target[k]; /* compatible */
    skg_chain *chain = graph_chain(&g);
    ck_skg(skg_chain_drive(chain, 2, node));
    ck_skg(skg_chain_move(chain, target, u, NULL));
    memcpy(v, u, sizeof u);
    ck_skg(skg_chain_relax(chain, 3, 0.5, v));
    graph_assert_links(chain, v);
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 2; d++) ck_assert_double_eq(v[k * g.nodes + node[d]], target[3 * d + k]);
    double moved = 0;
    for (int64_t i = 0; i < 3 * g.nodes; i++) moved = fmax(moved, fabs(u[i] - v[i]));
    ck_assert_double_gt(moved, 1e-3);
    ck_skg_fails(skg_chain_relax(chain, 1, (double)NAN, v), SKG_ERR_BREATHING, "relaxation");
    skg_chain_free(&chain);
}
END_TEST

START_TEST(hard_cases) {
    double rest[9] = {0, 0, 0, 1, 0, 0, 1, 0, 0}, u[9] = {0};
    int32_t ends[2] = {0, 1}, zero[2] = {1, 2};
    skg_chain *chain;
    const skg_tissue bad[] = {{1.1, 1.2, 0}, {0.9, 0.95, 0},      {-0.1, 1, 0},
                              {0.9, 1, -1},  {(double)NAN, 1, 0}, {0.9, HUGE_VAL, 0}};
    for (int t = 0; t < 6; t++)
        ck_skg_fails(skg_chain_create("bad", 3, rest, 1, ends, bad + t, 1, NULL, &chain), SKG_ERR_BREATHING,
                     "alpha_min <= 1");
    const skg_tissue soft = {0.7, 1.1, 0.1};
    ck_skg_fails(skg_chain_create("far", 3, rest, 1, (int32_t[2]){0, 3}, &soft, 1, NULL, &chain),
                 SKG_ERR_BREATHING, "node 3");
    ck_skg(skg_chain_create("zero", 3, rest, 1, zero, &soft, 1, NULL, &chain));
    ck_skg(skg_chain_move(chain, NULL, u, NULL)); /* no drivers: stays */
    for (int i = 0; i < 9; i++) ck_assert_double_eq(u[i], 0);
    ck_skg_fails(skg_chain_drive(chain, 2, (int32_t[2]){1, 1}), SKG_ERR_BREATHING, "one node");
    ck_skg_fails(skg_chain_drive(chain, 1, (int32_t[1]){-1}), SKG_ERR_BREATHING, "nodes are");
    ck_skg(skg_chain_drive(chain, 2, (int32_t[2]){0, 1}));
    ck_skg_fails(skg_chain_move(chain, (double[6]){0, (double)NAN, 0}, u, NULL), SKG_ERR_BREATHING,
                 "not finite");
    ck_assert_double_eq(u[3], 0);
    ck_skg(skg_chain_move(chain, (double[6]){1, 2, 3, 4, 5, 6}, u, NULL)); /* node 0 has no links */
    for (int k = 0; k < 3; k++) {
        ck_assert_double_eq(u[3 * k], 1 + k);
        ck_assert_double_eq(u[3 * k + 1], 4 + k);
        ck_assert_double_eq(u[3 * k + 2], 4 + k); /* a link of no length is rigid */
    }
    int64_t unreached;
    ck_skg(skg_chain_drive(chain, 1, (int32_t[1]){0}));
    ck_skg(skg_chain_unreached(chain, &unreached));
    ck_assert_int_eq(unreached, 2);
    skg_chain_free(&chain);
    skg_chain_free(&chain);
}
END_TEST

START_TEST(links_of_triangles) {
    int32_t corners[6] = {0, 1, 2, 2, 1, 3}, weld[4] = {0, 1, 2, 0}, *ends;
    int64_t links;
    ck_skg(skg_chain_links(2, corners, NULL, &links, &ends));
    ck_assert_int_eq(links, 5);
    free(ends);
    ck_skg(skg_chain_links(2, corners, weld, &links, &ends));
    ck_assert_int_eq(links, 3);
    free(ends);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, closed_form_on_random_graphs, 0, TRIALS);
    tcase_add_test(tests, chain_of_links);
    tcase_add_test(tests, reach_of_the_papers_tendon);
    tcase_add_test(tests, loops_are_play_operators);
    tcase_add_test(tests, conflict_is_reported_and_halved);
    tcase_add_loop_test(tests, relaxation_keeps_links_and_drivers, 0, 10);
    tcase_add_test(tests, hard_cases);
    tcase_add_test(tests, links_of_triangles);
}

SKG_SUITE_MAIN("chain", add_tests)
