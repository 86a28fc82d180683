/* Bodies: ribs against the literature, the generated thorax over a breath. */
#include "body/bones.h"
#include "body/inside.h"
#include "body/links.h"
#include "body/types.h"
#include "suite.h"
#include "support/angles.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

enum { PARTS_MAX = 160 };

static skg_thorax *thorax;
static skg_thorax_part part[PARTS_MAX];
static int64_t parts;
static skg_body *body;

static void make(int simple, const skg_body_options *options) {
    skg_thorax_options kind;
    skg_thorax_options_init(&kind);
    kind.simple = simple;
    ck_skg(skg_thorax_create(&kind, &thorax));
    ck_skg(skg_thorax_part_count(thorax, &parts));
    ck_skg(skg_body_create(NULL, options, &body));
    for (int64_t i = 0; i < parts; i++) {
        skg_thorax_part_init(part + i);
        ck_skg(skg_thorax_part_get(thorax, i, part + i));
        skg_organ organ;
        skg_organ_init(&organ);
        organ.mesh = part[i].mesh;
        organ.label = part[i].label;
        organ.inside = part[i].inside;
        ck_skg(skg_body_add(body, &organ, NULL));
    }
    ck_skg(skg_body_link(body));
}

static void drop(void) {
    skg_body_release(&body);
    skg_thorax_release(&thorax);
}

static int64_t find(const char *label) {
    for (int64_t i = 0; i < parts; i++)
        if (!strcmp(part[i].label, label)) return i;
    ck_abort_msg("no part %s", label);
    return -1;
}

static skg_body_measure pose(double thoracic, double diaphragmatic) {
    skg_breath_state state;
    skg_breath_state_init(&state);
    state.thoracic = thoracic, state.diaphragmatic = diaphragmatic;
    ck_skg(skg_body_pose(body, &state));
    skg_body_measure measure;
    skg_body_measure_init(&measure);
    ck_skg(skg_body_measure_get(body, &measure));
    return measure;
}

static double *positions(const skg_mesh *mesh, int64_t *count) {
    int64_t triangles;
    ck_skg(skg_mesh_count(mesh, count, &triangles));
    double *p = malloc((size_t)*count * 3 * sizeof *p);
    ck_skg(skg_mesh_positions_get(mesh, p, 0));
    return p;
}

START_TEST(ribs_turn_as_wilson_measured) {
    static const double pump[] = {11, 10, 9, 8, 7}, bucket[] = {13, 12.25, 11.5, 10.75, 10}; /* ribs 3 to 7 */
    make(_i, NULL);
    double full = 1 / 0.17; /* the weight of full inspiration */
    ck_assert_double_eq_tol(skg_rib_fraction(full), 1, 1e-12);
    ck_assert_double_eq(skg_rib_fraction(0), 0);
    /* The fraction is continuous: its slope is below 1 per unit of weight, over 2e-9. */
    ck_assert_double_eq_tol(skg_rib_fraction(0.5 / 0.17 + 1e-9), skg_rib_fraction(0.5 / 0.17 - 1e-9), 1e-8);
    for (int side = 0; side < 2; side++)
        for (int n = 1; n <= 12; n++) {
            char label[40];
            snprintf(label, sizeof label, "rib %d %s", n, side ? "right" : "left");
            skg_body_organ *rib = body->organ + find(label);
            double before[2], after[2];
            skg_rib_plane(rib, NULL, before, before + 1);
            skg_rotation(rib->turn.axis, rib->rigid.rotation);
            memcpy(rib->rigid.centre, rib->turn.head, sizeof rib->turn.head);
            memset(rib->rigid.shift, 0, sizeof rib->rigid.shift);
            double tip = 0, worst = 0;
            for (int64_t i = 0; i < rib->vertices; i++) {
                double *d = rib->moved + 3 * i;
                skg_rigid_displace(&rib->rigid, rib->rest + 3 * i, d);
                tip = fmax(tip, d[2]);
            }
            for (int64_t i = 1; i < rib->vertices; i++) { /* edges keep their length */
                double a = 0, b = 0;
                for (int k = 0; k < 3; k++) {
                    double e = rib->rest[3 * i + k] - rib->rest[k];
                    a += e * e, e += rib->moved[3 * i + k] - rib->moved[k], b += e * e;
                }
                worst = fmax(worst, fabs(sqrt(a) - sqrt(b)));
            }
            /* Edges of up to 250 mm, turned by one rotation. */
            ck_assert_double_le(worst, 16 * DBL_EPSILON * 250);
            skg_rib_plane(rib, rib->moved, after, after + 1);
            if (n >= 3 && n <= 7) {
                ck_assert_double_eq_tol((before[0] - after[0]) / degree, pump[n - 3],
                                        1024 * DBL_EPSILON * 10);
                ck_assert_double_eq_tol((before[1] - after[1]) / degree, bucket[n - 3],
                                        1024 * DBL_EPSILON * 10);
            }
            ck_assert_double_gt(tip, 3); /* inspiration raises every rib */
            if (n == 5) ck_assert_double_eq_tol(tip, 33, 12);
        }
    drop();
}
END_TEST

START_TEST(the_reference_is_the_file) { /* bit for bit, also after having been elsewhere */
    make(_i, NULL);
    double *before[PARTS_MAX];
    int64_t n;
    for (int64_t i = 0; i < parts; i++) before[i] = positions(part[i].mesh, &n);
    for (int round = 0; round < 2; round++) {
        skg_body_measure m = pose(0, 0);
        /* A difference of two volumes of 1000 ml and more, sums over 1e4 triangles. */
        ck_assert_double_eq_tol(m.tidal_ml, 0, 4096 * DBL_EPSILON * 1000);
        for (int64_t i = 0; i < parts; i++) {
            double *now = positions(part[i].mesh, &n);
            ck_assert_msg(memcmp(now, before[i], (size_t)n * 3 * sizeof(double)) == 0, "%s", part[i].label);
            free(now);
        }
        pose(1, 1);
    }
    for (int64_t i = 0; i < parts; i++) free(before[i]);
    drop();
}
END_TEST

START_TEST(a_quiet_breath) {
    make(_i, NULL);
    double rest = pose(0, 0).lung_ml, last = 0;
    for (int step = 1; step <= 8; step++) {
        double f = step / 8.0;
        skg_body_measure m = pose(f, f);
        ck_assert_int_eq(m.broken_links, 0);
        ck_assert_double_gt(m.tidal_ml, last);
        ck_assert_double_le(fabs(m.lung_density_ratio * m.lung_ml / rest - 1), 1e-12); /* mass */
        last = m.tidal_ml;
    }
    skg_body_measure m = pose(1, 1);
    ck_assert_msg(m.tidal_ml >= 300 && m.tidal_ml <= 800, "tidal volume %g ml", m.tidal_ml);
    for (int half = 0; half < 2; half++)
        ck_assert_msg(m.diaphragm_mm[half] >= 10 && m.diaphragm_mm[half] <= 20, "%g", m.diaphragm_mm[half]);
    ck_assert_msg(m.liver_mm[2] <= -7 && m.liver_mm[2] >= -40, "liver %g mm", m.liver_mm[2]);
    /* The liver is squeezed by q = 0.02 at most: 3/4 q^2. */
    ck_assert_double_le(fabs(m.liver_volume_ratio - 1), 0.001);
    ck_assert_int_eq(m.flipped_triangles, 0); /* P16 */
    ck_assert_double_le(m.conflict_mm, 0.5);
    ck_assert_double_le(skg_lung_hounsfield(-790, m.lung_density_ratio), -790);
    ck_assert_double_eq(skg_lung_hounsfield(-790, 1), -790);
    /* only the ribs, only the diaphragm */
    skg_body_measure ribs = pose(1, 0), belly = pose(0, 1);
    ck_assert_double_gt(ribs.tidal_ml, 20);
    ck_assert_double_gt(belly.tidal_ml, ribs.tidal_ml);
    ck_assert_double_eq(belly.diaphragm_mm[0], 15);
    /* mm: the dome hangs on the tendon; the ribs move its rim only. */
    ck_assert_double_le(fabs(ribs.diaphragm_mm[0]), 3);
    drop();
}
END_TEST

START_TEST(random_access_and_hysteresis) {
    skg_body_options options;
    skg_body_options_init(&options);
    options.hysteresis = _i * 0.5;
    make(_i == 1, &options);
    skg_breath breath;
    skg_breath_init(&breath);
    breath.waveform = SKG_WAVEFORM_ASYMMETRIC;
    skg_breath_state s;
    skg_breath_state_init(&s);
    ck_skg(skg_breath_state_at_phase(&breath, 0.25, &s));
    if (_i > 0) {
        ck_skg_fails(skg_body_pose(body, &s), SKG_ERR_BREATHING, "skg_body_breathe");
        ck_skg(skg_body_breathe(body, &breath));
    }
    int64_t n, liver = find("liver");
    ck_skg(skg_body_pose(body, &s));
    double *first = positions(part[liver].mesh, &n);
    const double others[] = {0.9, 0.1, 0.6, 0.25};
    for (int i = 0; i < 4; i++) {
        ck_skg(skg_breath_state_at_phase(&breath, others[i], &s));
        ck_skg(skg_body_pose(body, &s));
    }
    double *again = positions(part[liver].mesh, &n);
    ck_assert_mem_eq(first, again, (size_t)n * 3 * sizeof(double));
    ck_skg(skg_breath_state_at_phase(&breath, 0.8, &s)); /* the same amplitude, breathing in: 0.3 and 0.8 */
    ck_skg(skg_body_pose(body, &s));
    free(again);
    again = positions(part[liver].mesh, &n);
    ck_skg(skg_breath_state_at_phase(&breath, 0.3, &s));
    ck_skg(skg_body_pose(body, &s));
    free(first);
    first = positions(part[liver].mesh, &n);
    double width = 0;
    for (int64_t i = 0; i < 3 * n; i++) width = fmax(width, fabs(first[i] - again[i]));
    if (_i == 0) ck_assert_double_le(width, 1e-5); /* amplitudes equal to rounding, positions are floats */
    if (_i > 0) ck_assert_double_gt(width, 0.2 * _i);
    free(first);
    free(again);
    drop();
}
END_TEST

START_TEST(parts_stay_in_place) { /* over a quiet breath */
    static solid s[PARTS_MAX];
    make(_i, NULL);
    double worst = 0;
    char what[120] = "";
    for (int step = 1; step <= 2; step++) {
        pose(0.5 * step, 0.5 * step);
        for (int64_t i = 0; i < parts; i++) solid_make(part[i].mesh, s + i);
        int64_t ducts = find("bile ducts"), liver = find("liver"), needle = find("needle");
        for (int64_t v = 0; v < s[ducts].vertices; v++)
            ck_assert(solid_holds(s + liver, s[ducts].position + 3 * v));
        for (int64_t i = 0; i < parts; i++) /* mm: as between neighbours */
            for (int64_t v = 0; part[i].inside >= 0 && v < s[i].vertices; v++)
                ck_assert_msg(solid_holds(s + part[i].inside, s[i].position + 3 * v) ||
                                  solid_distance(s + part[i].inside, s[i].position + 3 * v) <= 0.5,
                              "%s leaves %s", part[i].label, part[part[i].inside].label);
        for (int64_t i = 0; i < parts; i++)
            for (int64_t j = 0; j < parts; j++) {
                if (i == j || i == needle || j == needle || part[i].inside != part[j].inside) continue;
                double depth = solid_overlap(s + i, s + j, 1);
                if (depth <= worst) continue;
                worst = depth;
                snprintf(what, sizeof what, "%s lies %.2f mm deep in %s", part[i].label, depth,
                         part[j].label);
            }
        /* the needle's tip keeps its place in the liver */
        const skg_body_organ *n = body->organ + needle;
        double tissue[3], least = HUGE_VAL;
        for (int64_t v = 0; v < n->vertices; v++)
            if (memcmp(n->rest + 3 * v, n->needle.tip, sizeof n->needle.tip) == 0) {
                skg_carried_vertex(body, n, v, tissue);
                least = 0;
                for (int k = 0; k < 3; k++)
                    least = fmax(least, fabs(s[needle].position[3 * v + k] - n->needle.tip[k] - tissue[k]));
            }
        /* The tip goes with its tissue: floats of 100 mm. */
        ck_assert_double_le(least, 8 * (double)FLT_EPSILON * 100);
        for (int64_t i = 0; i < parts; i++) solid_free(s + i);
    }
    ck_assert_msg(worst <= 0.5, "%s", what);
    drop();
}
END_TEST

START_TEST(every_part_has_a_rule) { /* and marrow moves with its bone */
    make(0, NULL);
    for (int64_t i = 0; i < parts; i++) {
        const skg_body_organ *o = body->organ + i;
        const char *outer = part[i].inside >= 0 ? part[part[i].inside].label : "";
        ck_assert_msg(o->role != ROLE_STATIC || skg_label_stays(o->label) || skg_label_stays(outer),
                      "%s has no rule", o->label);
    }
    pose(1, 1);
    const skg_body_organ *bone = body->organ + find("rib 6 left");
    const skg_body_organ *marrow = body->organ + find("marrow of rib 6 left");
    for (int64_t i = 0; i < marrow->vertices; i++) {
        double with_bone[3];
        skg_rigid_displace(&bone->rigid, marrow->rest + 3 * i, with_bone);
        for (int k = 0; k < 3; k++) ck_assert_double_eq(marrow->moved[3 * i + k], with_bone[k]);
    }
    const skg_body_organ *bowel = body->organ + find("bowel"), *gas = body->organ + find("bowel gas");
    ck_assert_double_lt(gas->moved[2], -0.5); /* mm: it goes down with the bowel, whose top goes down by 15 */
    ck_assert_double_lt(bowel->moved[2], 0.01);
    drop();
}
END_TEST

START_TEST(same_bits_for_any_number_of_threads) {
    double *first[PARTS_MAX];
    int64_t n;
    for (int threads = 1; threads <= 4; threads++) {
        omp_set_num_threads(threads);
        make(_i, NULL);
        pose(0.8, 1.2);
        for (int64_t i = 0; i < parts; i++) {
            double *now = positions(part[i].mesh, &n);
            if (threads == 1) first[i] = now;
            if (threads == 1) continue;
            ck_assert_msg(memcmp(now, first[i], (size_t)n * 3 * sizeof *now) == 0, "%s", part[i].label);
            free(now);
        }
        drop();
    }
    for (int64_t i = 0; i < parts; i++) free(first[i]);
}
END_TEST

START_TEST(reference_in_the_middle) { /* meshes made at half a breath: motion goes both ways from there */
    skg_body_options options;
    skg_body_options_init(&options);
    options.reference_thoracic = options.reference_diaphragmatic = 0.5;
    make(_i, &options);
    /* As in the_reference_is_the_file. */
    ck_assert_double_eq_tol(pose(0.5, 0.5).tidal_ml, 0, 4096 * DBL_EPSILON * 1000);
    ck_assert_double_eq_tol(pose(0, 0).diaphragm_mm[0], -7.5, 64 * DBL_EPSILON * 7.5);
    ck_assert_double_lt(pose(0, 0).tidal_ml, -50);
    ck_assert_double_gt(pose(1, 1).tidal_ml, 50);
    drop();
}
END_TEST

START_TEST(the_needle_is_rigid_and_slides) {
    make(_i, NULL);
    int64_t n, needle = find("needle");
    double *rest = positions(part[needle].mesh, &n);
    ck_skg(skg_body_needle_set(body, 110));
    pose(0.7, 0.7);
    double *now = positions(part[needle].mesh, &n), along = 0;
    for (int64_t i = 1; i < n; i++) {
        double a = 0, b = 0;
        for (int k = 0; k < 3; k++)
            a += pow(rest[3 * i + k] - rest[k], 2), b += pow(now[3 * i + k] - now[k], 2);
        ck_assert_double_eq_tol(sqrt(a), sqrt(b), 1e-4); /* floats of 250 mm */
    }
    for (int k = 0; k < 3; k++) along += pow(now[k] - rest[k], 2);
    ck_assert_double_eq_tol(sqrt(along), 110, 15); /* and the tissue moved by up to 11 mm */
    free(rest);
    free(now);
    drop();
}
END_TEST

START_TEST(bad_bodies_are_refused) {
    skg_body_options options;
    skg_body_options_init(&options);
    options.hysteresis = 1.5;
    ck_skg_fails(skg_body_create(NULL, &options, &body), SKG_ERR_BREATHING, "hysteresis");
    ck_skg(skg_body_create(NULL, NULL, &body));
    skg_breath_state state;
    skg_breath_state_init(&state);
    ck_skg_fails(skg_body_pose(body, &state), SKG_ERR_BREATHING, "skg_body_link");
    skg_organ organ;
    skg_organ_init(&organ);
    ck_skg_fails(skg_body_add(body, &organ, NULL), SKG_ERR_ARGUMENT, "mesh");
    ck_skg(skg_mesh_create_cube(10, &organ.mesh));
    organ.label = "table";
    organ.inside = 0;
    ck_skg_fails(skg_body_add(body, &organ, NULL), SKG_ERR_BREATHING, "inside organ 0");
    organ.inside = -1;
    ck_skg(skg_body_add(body, &organ, NULL));
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "no organ that moves");
    organ.label = "liver", organ.alpha_min = 2;
    ck_skg(skg_body_add(body, &organ, NULL));
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "alpha_min <= 1");
    skg_mesh_release(&organ.mesh);
    skg_body_release(&body);
    make(_i, NULL);
    state.thoracic = (double)NAN;
    ck_skg_fails(skg_body_pose(body, &state), SKG_ERR_BREATHING, "weights");
    ck_skg_fails(skg_body_needle_set(body, HUGE_VAL), SKG_ERR_BREATHING, "needle");
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "once");
    drop();
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, every_part_has_a_rule);
    tcase_add_loop_test(tests, same_bits_for_any_number_of_threads, 0, 2);
    tcase_add_loop_test(tests, reference_in_the_middle, 0, 2);
    tcase_add_loop_test(tests, the_needle_is_rigid_and_slides, 0, 2);
    tcase_add_loop_test(tests, bad_bodies_are_refused, 0, 2);
    tcase_add_loop_test(tests, ribs_turn_as_wilson_measured, 0, 2);
    tcase_add_loop_test(tests, the_reference_is_the_file, 0, 2);
    tcase_add_loop_test(tests, a_quiet_breath, 0, 2);
    tcase_add_loop_test(tests, random_access_and_hysteresis, 0, 3);
    tcase_add_loop_test(tests, parts_stay_in_place, 0, 2);
}

SKG_SUITE_MAIN("body", add_tests)
