/* Breathing: elements turned inside out, drivers that contradict each other, cycles of rigid links. */
#include "chainmail/chainmail.h"
#include "hard/catalogue.h"
#include "suite.h"

#include <skiagraph/breathing.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The worst link that is broken, mm. */
static void judge_links(hard_outcome *o, const skg_chain *chain, const double *u) {
    int64_t broken;
    skg_chain_check(chain, u, 1e-9, &broken, &o->worst[1]);
    o->worst[1] = fmax(0, o->worst[1]);
    o->bar[1] = 1e-9;
    o->unit = "mm by which a link is broken";
    if (broken) hard_fault(o, "%lld links broken", (long long)broken);
}

static void conflict(hard_outcome *o) {
    enum { NODES = 200 };
    double rest[3 * NODES], u[3 * NODES] = {0};
    int32_t ends[2 * (NODES - 1)];
    const skg_tissue muscle = {0.7, 1.1, 0.1};
    skg_chain *chain = NULL;
    skg_chain_report report;
    o->name = "drivers that contradict each other";
    o->danger = "an endless loop of corrections; a link broken to please both";
    for (int n = 0; n < NODES; n++) {
        rest[3 * n] = n, rest[3 * n + 1] = rest[3 * n + 2] = 0;
        if (n) ends[2 * n - 2] = n - 1, ends[2 * n - 1] = n;
    }
    ck_skg(skg_chain_create("row", NODES, rest, NODES - 1, ends, &muscle, 1, NULL, &chain));
    ck_skg(skg_chain_drive(chain, 3, (int32_t[3]){0, 100, 199}));
    ck_skg(skg_chain_move(chain, (double[9]){-500, 3, 0, 200, 0, -9, -300, 0, 40}, u, &report));
    if (!(report.conflict_mm > 1)) hard_fault(o, "no conflict was reported");
    hard_check_values(o, u, 3 * NODES, -1e3);
    judge_links(o, chain, u);
    skg_chain_free(&chain);
}

static void rigid_cycle(hard_outcome *o) {
    enum { NODES = 60 };
    double rest[3 * NODES], u[3 * NODES] = {0};
    int32_t ends[2 * NODES];
    const skg_tissue rigid = {1, 1, 0};
    skg_chain *chain = NULL;
    skg_chain_report report;
    o->name = "a cycle of rigid links";
    o->danger = "rounding round the cycle: a cycle of negative length never ends";
    for (int n = 0; n < NODES; n++) {
        rest[3 * n] = 100 * cos(n * 0.1047197551), rest[3 * n + 1] = 100 * sin(n * 0.1047197551);
        rest[3 * n + 2] = 1e-3 * n;
        ends[2 * n] = n, ends[2 * n + 1] = (n + 1) % NODES;
    }
    ck_skg(skg_chain_create("ring", NODES, rest, NODES, ends, &rigid, 1, NULL, &chain));
    ck_skg(skg_chain_drive(chain, 2, (int32_t[2]){0, 30}));
    ck_skg(skg_chain_move(chain, (double[6]){10, 0.1, 0.3, -10, 0.7, 0}, u, &report));
    hard_check_values(o, u, 3 * NODES, -1e3);
    judge_links(o, chain, u);
    skg_chain_free(&chain);
}

static skg_scene *scene_of(skg_thorax *thorax, skg_body *body) {
    int64_t parts = 0;
    skg_scene *scene = NULL;
    ck_skg(skg_thorax_part_count(thorax, &parts));
    ck_skg(skg_scene_create(run_context, &scene));
    for (int64_t n = 0; n < parts; n++) {
        skg_thorax_part part;
        skg_organ organ;
        skg_thorax_part_init(&part);
        ck_skg(skg_thorax_part_get(thorax, n, &part));
        skg_organ_init(&organ);
        organ.inside = part.inside;
        organ.mesh = part.mesh;
        organ.label = part.label;
        ck_skg(skg_body_add(body, &organ, NULL));
        run_part(scene, part.label, part.mesh, 0.05, NULL, part.inside);
    }
    ck_skg(skg_body_link(body));
    return scene;
}

/* The deepest breath that can be asked for, at its depth, of a body whose tendon moves by 100 mm, the most that
 * can be set, instead of 15 mm: the diaphragm is pulled 400 mm downward. */
static void inverted(hard_outcome *o) {
    static char unit[64];
    skg_thorax_options options;
    skg_body_options deep;
    skg_thorax *thorax = NULL;
    skg_body *body = NULL;
    skg_breath_state state;
    skg_body_measure measure;
    o->name = "a breath so deep that elements invert";
    o->danger = "triangles turned inside out; negative lengths";
    skg_thorax_options_init(&options);
    options.triangles = 10000;
    options.simple = 1;
    ck_skg(skg_thorax_create(&options, &thorax));
    skg_body_options_init(&deep);
    deep.tendon_mm[2] = -100;
    ck_skg(skg_body_create(run_context, &deep, &body));
    skg_scene *scene = scene_of(thorax, body);
    skg_breath_state_init(&state);
    state.amplitude = 1;
    state.thoracic = state.diaphragmatic = 4;
    ck_skg(skg_body_pose(body, &state));
    skg_body_measure_init(&measure);
    ck_skg(skg_body_measure_get(body, &measure));
    if (measure.flipped_triangles == 0) hard_fault(o, "nothing is inverted: the case is not hard");
    if (measure.broken_links) hard_fault(o, "%lld links broken", (long long)measure.broken_links);
    o->worst[1] = (double)measure.broken_links;
    o->bar[1] = 0;
    snprintf(unit, sizeof unit, "broken links, with %lld triangles inverted",
             (long long)measure.flipped_triangles);
    o->unit = unit;
    skg_view view = run_view(96, 5);
    view.source[1] = -1000, view.source[2] = 0;
    view.centre[1] = 300, view.centre[2] = 0;
    view.row_step[1] = 0, view.row_step[2] = -5;
    uint64_t first = 0;
    for (int way = 0; way < HARD_WAYS; way++) {
        run_choice choice = hard_ways[way];
        choice.quantity = SKG_QUANTITY_TRANSMISSION;
        skg_plan *plan = run_plan(scene, &view, choice);
        double *got = run_image(plan, &view);
        hard_same_bits(o, way, got, 96 * 96, &first);
        hard_check_values(o, got, 96 * 96, 0);
        if (way == 0) hard_compare_time(o, scene, plan, &view);
        free(got);
        skg_plan_release(&plan);
    }
    skg_scene_release(&scene);
    skg_body_release(&body);
    skg_thorax_release(&thorax);
}

const hard_function hard_bodies[] = {conflict, rigid_cycle, inverted, NULL};
