/* Every named breath of the generated thorax: ribs and diaphragm agree, nothing folds, the liver keeps its volume. */
#include "body/surface.h"
#include "body/types.h"
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>

static const char *const patterns[] = {"quiet",   "diaphragmatic", "thoracic",
                                       "shallow", "deep",          "hyperventilation"};
static skg_thorax *thorax;
static skg_body *body;

static void make(int64_t triangles, int simple, const skg_body_options *options) {
    skg_thorax_options kind;
    int64_t parts;
    skg_thorax_options_init(&kind);
    kind.triangles = triangles, kind.simple = simple;
    ck_skg(skg_thorax_create(&kind, &thorax));
    ck_skg(skg_thorax_part_count(thorax, &parts));
    ck_skg(skg_body_create(NULL, options, &body));
    for (int64_t i = 0; i < parts; i++) {
        skg_thorax_part part;
        skg_organ organ;
        skg_thorax_part_init(&part);
        skg_organ_init(&organ);
        ck_skg(skg_thorax_part_get(thorax, i, &part));
        organ.mesh = part.mesh, organ.label = part.label, organ.inside = part.inside;
        ck_skg(skg_body_add(body, &organ, NULL));
    }
    ck_skg(skg_body_link(body));
}

static void drop(void) {
    skg_body_release(&body);
    skg_thorax_release(&thorax);
}

static skg_body_measure pose(double thoracic, double diaphragmatic) {
    skg_breath_state state;
    skg_body_measure m;
    skg_breath_state_init(&state);
    skg_body_measure_init(&m);
    state.thoracic = thoracic, state.diaphragmatic = diaphragmatic;
    ck_skg(skg_body_pose(body, &state));
    ck_skg(skg_body_measure_get(body, &m));
    return m;
}

static const skg_body_organ *organ_of(skg_role role, const char *label) {
    for (int64_t i = 0; i < body->organs; i++)
        if (body->organ[i].role == role && (!label || skg_label_begins(body->organ[i].label, label)))
            return body->organ + i;
    ck_abort_msg("no %s", label ? label : "such organ");
    return NULL;
}

START_TEST(named_breaths) {
    static const int64_t triangles[] = {10000, 42000};
    make(triangles[_i / 2], _i % 2, NULL);
    for (size_t p = 0; p < sizeof patterns / sizeof *patterns; p++)
        for (int phase = 0; phase < 6; phase++) {
            skg_breath breath;
            skg_breath_state s;
            skg_breath_init(&breath);
            skg_breath_state_init(&s);
            ck_skg(skg_breath_pattern_get(patterns[p], &breath));
            ck_skg(skg_breath_state_at_phase(&breath, phase / 6.0, &s));
            const skg_body_measure m = pose(s.thoracic, s.diaphragmatic);
            ck_assert_int_eq(m.broken_links, 0);
            ck_assert_msg(m.flipped_triangles == 0, "%s: %d folded", patterns[p], (int)m.flipped_triangles);
            /* mm, as parts may overlap in body_test; the paper's model contradicts itself by 10 and more. */
            ck_assert_msg(m.conflict_mm <= 0.5, "%s: %g mm in %s", patterns[p], m.conflict_mm, m.conflict[0]);
            /* 1 %: what the issue of this breath asks for. Squeezed by q = 0.06 it is 3/4 q^2 = 0.3 %. */
            ck_assert_msg(fabs(m.liver_volume_ratio - 1) <= 0.01, "%s: %g", patterns[p],
                          m.liver_volume_ratio);
        }
    drop();
}
END_TEST

START_TEST(ribs_carry_the_rim) { /* and the tendon goes as it is told */
    make(42000, _i, NULL);
    pose(2.5, 2.5);
    const skg_body_organ *d = organ_of(ROLE_DIAPHRAGM, NULL), *rib = organ_of(ROLE_RIB, NULL);
    int64_t rim = 0, tendon = 0;
    double lifted = 0, lowest = HUGE_VAL;
    ck_assert_ptr_nonnull(rib);
    for (int64_t i = 0; i < d->vertices; i++) {
        const double share = d->share[d->node_of[i]];
        ck_assert(share >= 0 && share <= 1);
        if (share == 1) {
            tendon++; /* the product of -15 mm and 2.5 */
            ck_assert_double_eq_tol(d->moved[3 * i + 2], -37.5, 64 * DBL_EPSILON * 37.5);
        } else if (share < 0.02) {
            rim++;
            lifted = fmax(lifted, d->moved[3 * i + 2]);
            lowest = fmin(lowest, d->moved[3 * i + 2]);
        }
    }
    ck_assert(rim > 20 && tendon > 20);
    ck_assert_double_gt(lifted, 8);  /* mm: the front rises with the sternum, by about 14 */
    ck_assert_double_ge(lowest, -1); /* mm: 0.02 of 37.5, beside the spine */
    drop();
}
END_TEST

/* On a sphere of radius r the distance from a cap is r times the angle. */
START_TEST(distances_over_a_sphere) {
    skg_mesh *mesh;
    skg_organ organ;
    ck_skg(skg_mesh_create_sphere(100, 128, &mesh));
    ck_skg(skg_body_create(NULL, NULL, &body));
    skg_organ_init(&organ);
    organ.mesh = mesh, organ.label = "liver";
    ck_skg(skg_body_add(body, &organ, NULL));
    const skg_body_organ *o = body->organ;
    unsigned char *given = calloc((size_t)o->vertices, 1);
    double *distance = calloc((size_t)o->vertices, sizeof *distance);
    const double edge = 0.9; /* rad */
    for (int64_t i = 0; i < o->vertices; i++)
        given[i] = acos(fmax(-1, fmin(1, o->rest[3 * i + 2] / 100))) < edge;
    ck_skg(skg_surface_distance(o, given, 0, NULL, distance));
    for (int64_t i = 0; i < o->vertices; i++) {
        const double true_distance = 100 * (acos(fmax(-1, fmin(1, o->rest[3 * i + 2] / 100))) - edge);
        if (o->node_of[i] != i || true_distance < 0 || true_distance > 120) continue;
        /* The cap's edge is jagged by a facet, 5 mm; a growing circle makes the distance longer by up to 6 % (12 mm of
         * smoothing over its radius of 80 mm and more, halved), a shrinking one shorter. */
        ck_assert_double_eq_tol(distance[i], true_distance, 5 + 0.08 * true_distance);
    }
    free(given);
    free(distance);
    skg_mesh_release(&mesh);
    skg_body_release(&body);
}
END_TEST

START_TEST(the_papers_model_stays) { /* on request, and with its hysteresis and relaxation */
    skg_body_options options;
    for (int way = 0; way < 3; way++) {
        skg_body_options_init(&options);
        if (way == 0) options.coupling = SKG_COUPLING_PAPER;
        if (way == 1) options.hysteresis = 0.5;
        if (way == 2) options.relaxation = 1;
        make(10000, 1, &options);
        for (int64_t i = 0; i < body->organs; i++) ck_assert_int_eq(body->organ[i].coupled, 0);
        ck_assert_int_gt(organ_of(ROLE_DIAPHRAGM, NULL)->links, 20);
        drop();
    }
    skg_body_options_init(&options);
    options.coupling = 2;
    ck_skg_fails(skg_body_create(NULL, &options, &body), SKG_ERR_BREATHING, "coupling is 2");
    options.coupling = SKG_COUPLING_PAPER;
    make(10000, 1, &options);
    ck_assert_double_gt(pose(2.5, 2.5).conflict_mm, 10); /* as the anatomical coupling avoids */
    drop();
}
END_TEST

START_TEST(a_plane_of_the_caller) { /* says where the tendon is */
    skg_body_options options;
    skg_body_options_init(&options);
    options.tendon_plane[2] = 1, options.tendon_plane[3] = 15; /* above z = -15 mm */
    make(10000, 1, &options);
    pose(0, 1);
    const skg_body_organ *d = organ_of(ROLE_DIAPHRAGM, NULL);
    for (int64_t i = 0; i < d->vertices; i++)
        if (d->rest[3 * i + 2] > -15) ck_assert_double_eq(d->share[d->node_of[i]], 1);
    drop();
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, distances_over_a_sphere);
    tcase_add_loop_test(tests, named_breaths, 0, 4);
    tcase_add_loop_test(tests, ribs_carry_the_rim, 0, 2);
    tcase_add_test(tests, the_papers_model_stays);
    tcase_add_test(tests, a_plane_of_the_caller);
}

SKG_SUITE_MAIN("breaths", add_tests)
