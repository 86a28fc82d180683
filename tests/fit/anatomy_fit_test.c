/* Whether a fit finds breaths of the body as it is posed by default: hidden ones, two phases at once, through noise. */
#include "hidden.h"

#include <float.h>
#include <stdlib.h>

static const char *const organs[] = {"diaphragm", "liver"};

/* Settings of a scene for the anatomical coupling. */
enum { SETTINGS = 6, FITTED = 11 };
typedef struct {
    char text[SETTINGS][128];
    const char *setting[SETTINGS];
} breath_of;

static void say(breath_of *b, const double v[FITTED]) {
    snprintf(b->text[0], 128, "Breathing.Tendon=[%.17g, %.17g, %.17g, \"mm\"]", v[0], v[1], v[2]);
    snprintf(b->text[1], 128, "Breathing.Domes=[%.17g, %.17g, %.17g, \"mm\"]", v[3], v[4], v[5]);
    snprintf(b->text[2], 128, "Breathing.MuscleLength=%.17g", v[6]);
    snprintf(b->text[3], 128, "Breathing.RibAngles=[%.17g, %.17g]", v[7], v[8]);
    snprintf(b->text[4], 128, "Breathing.LiverFollows=%.17g", v[9]);
    snprintf(b->text[5], 128, "Breathing.LiverHeld=%.17g", v[10]);
    for (int s = 0; s < SETTINGS; s++) b->setting[s] = b->text[s];
}

/* Breath number 0, 1, ... of a row of random ones: every parameter from the middle 70 % of its range. */
static void draw_breath(int number, breath_of *b) {
    double v[FITTED];
    uint64_t state = 20261123;
    for (int i = 0; i <= number; i++) {
        int n = 0;
        for (int p = 0; p < BODY_PARAMETERS; p++) {
            const skg_parameter_kind *kind = skg_parameter_kinds + p;
            const double margin = 0.15 * (kind->high - kind->low);
            if (kind->by_default) v[n++] = draw(&state, kind->low + margin, kind->high - margin);
        }
        ck_assert_int_eq(n, FITTED);
    }
    say(b, v);
}

static void add_breath(skg_fit *fit, const skg_setup *setup, const breath_of *breath, double phase) {
    for (int o = 0; o < 2; o++)
        add_target(fit, setup,
                   &(surface_of){
                       .label = organs[o], .phase = phase, .count = SETTINGS, .settings = breath->setting});
}

/* Eight, one a test. */
START_TEST(hidden_breaths_are_found) {
    skg_setup *setup = load(0, NULL);
    skg_fit *fit = begin(setup, 4000, 0.01, NULL);
    breath_of breath;
    draw_breath(_i, &breath);
    add_breath(fit, setup, &breath, 0);
    const skg_fit_state state = run(fit);
    ck_assert_int_le(state.evaluations, 4000);
    check_found(fit);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* A shallow breath and a moment of it, of one body. */
START_TEST(two_phases) {
    skg_setup *setup = load(0, NULL);
    skg_fit *fit = begin(setup, 4000, 0.01, NULL);
    breath_of breath;
    say(&breath, (double[FITTED]){2, -3, -18, 4, 6, 2, 0.7, 18, 0.3, 0.95, 0.35});
    add_breath(fit, setup, &breath, 0);
    add_breath(fit, setup, &breath, 0.3);
    run(fit);
    check_found(fit);
    ck_assert_double_gt(target_of(fit, 0).motion_mm, target_of(fit, 2).motion_mm);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* Targets of another mesh, four times as fine, with 1 mm of noise: no error is left but that of the noise. */
START_TEST(noise_and_another_mesh) {
    skg_setup *setup = load(0, NULL);
    skg_fit *fit = begin(setup, 1500, 0.001, NULL);
    breath_of breath;
    draw_breath(2, &breath);
    for (int o = 0; o < 2; o++)
        add_target(
            fit, setup,
            &(surface_of){
                .label = organs[o], .count = SETTINGS, .settings = breath.setting, .noise = 1, .divided = 1});
    run(fit);
    ck_skg(skg_fit_finish(fit));
    for (int o = 0; o < 2; o++) {
        skg_distance d;
        skg_mesh *seen,
            *true_surface =
                surface(&(surface_of){.label = organs[o], .count = SETTINGS, .settings = breath.setting});
        const skg_fit_target target = target_of(fit, o);
        skg_distance_init(&d);
        ck_skg(skg_fit_target_mesh_get(fit, o, &seen));
        ck_skg(skg_distance_measure(true_surface, seen, NULL, &d));
        ck_assert_double_gt(d.mean_mm, 0.2);
        /* A tenth more: the search is not at its end, and the organ's own mesh is the coarse one. */
        ck_assert_msg(target.after_mean_mm <= 1.1 * d.mean_mm, "%s: %g mm, noise %g mm", target.label,
                      target.after_mean_mm, d.mean_mm);
        skg_mesh_release(&true_surface);
    }
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* The file poses the organs as the fit did: every key of the coupling, and tissues. */
START_TEST(the_scene_is_what_was_fitted) {
    static const char all[] = "tendon,domes,muscle,ribs,follow,diaphragm,liver";
    skg_setup *setup = load(0, NULL), *fitted;
    skg_fit *fit = begin(setup, 60, 0.001, all);
    skg_motion *motion;
    skg_distance d;
    breath_of breath;
    char path[160];
    draw_breath(1, &breath);
    add_breath(fit, setup, &breath, 0);
    run(fit);
    ck_skg(skg_fit_finish(fit));
    snprintf(path, sizeof path, "%s/fitted.json", folder);
    ck_skg(skg_fit_scene_save(fit, path));
    ck_skg(skg_setup_load(NULL, path, 0, NULL, &fitted));
    ck_assert_int_eq(fitted->breathing.body.coupling, SKG_COUPLING_ANATOMICAL);
    ck_skg(skg_motion_create(NULL, fitted, &motion));
    ck_skg(skg_motion_pose_at_phase(motion, 0));
    skg_distance_init(&d);
    for (int64_t t = 0; t < 2; t++) {
        const skg_fit_target target = target_of(fit, t);
        skg_mesh *mesh;
        ck_skg(skg_fit_target_mesh_get(fit, t, &mesh));
        ck_skg(skg_distance_measure(fitted->scene->parts[target.part].mesh, mesh, NULL, &d));
        ck_assert_double_eq(d.mean_mm, target.after_mean_mm);
        ck_assert_double_eq(d.max_mm, target.after_max_mm);
    }
    skg_motion_release(&motion);
    skg_setup_release(&fitted);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* Options set one after the other give the bits of a body that had them from the beginning. */
START_TEST(values_leave_nothing_behind) {
    skg_setup *setup = load(0, NULL);
    skg_fit *fit = begin(setup, 20, 0.001, "tendon,domes,muscle,ribs,follow");
    breath_of breath;
    double values[BODY_PARAMETERS], *first;
    draw_breath(3, &breath);
    add_breath(fit, setup, &breath, 0);
    ck_skg(skg_fit_begin(fit));
    const skg_body_organ *o = fit->models->body->organ + fit->models->organ[fit->goals[1].part];
    ck_skg(skg_fit_body_pose(fit->models, fit->goals));
    first = calloc((size_t)(3 * o->vertices), sizeof *first);
    memcpy(first, o->moved, (size_t)(3 * o->vertices) * sizeof *first);
    for (int p = 0; p < BODY_PARAMETERS; p++) values[p] = 0.5 * (fit->low[p] + fit->high[p]);
    ck_skg(skg_fit_values_set(fit->models->body, fit->chosen, values));
    ck_skg(skg_fit_body_pose(fit->models, fit->goals));
    ck_assert_mem_ne(first, o->moved, (size_t)(3 * o->vertices) * sizeof *first);
    ck_skg(skg_fit_values_set(fit->models->body, fit->chosen, fit->start));
    ck_skg(skg_fit_body_pose(fit->models, fit->goals));
    for (int64_t i = 0; i < 3 * o->vertices; i++) /* the rib's angle went to degrees and back */
        ck_assert_double_eq_tol(first[i], o->moved[i], 1e4 * DBL_EPSILON);
    free(first);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* A breath without ribs does not determine their angle; the tendon's motion it does. */
START_TEST(what_is_not_determined) {
    static const char *const still[] = {"Breathing.Thoracic=0"};
    skg_setup *setup = load(1, still);
    skg_fit *fit = begin(setup, 30, 0.001, "tendon-z,rib-angle");
    skg_mesh *mesh = surface(&(surface_of){.label = "liver", .count = 1, .settings = still});
    skg_fit_parameter one;
    ck_skg(skg_fit_target_add(fit, part_of(setup, "liver"), 0, mesh));
    skg_mesh_release(&mesh);
    run(fit);
    ck_skg(skg_fit_finish(fit));
    skg_fit_parameter_init(&one);
    ck_skg(skg_fit_parameter_get(fit, BODY_RIB_ANGLE, &one));
    ck_assert_double_eq_tol(one.sigma, 20 / sqrt(12), 256 * DBL_EPSILON);
    ck_assert_int_eq(one.determined, 0);
    ck_skg(skg_fit_parameter_get(fit, BODY_TENDON + 2, &one));
    ck_assert_int_eq(one.determined, 1);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
}
END_TEST

/* Each coupling has its own; a group means those of it that have an effect. */
START_TEST(parameters_belong_to_a_coupling) {
    static const char *const paper[] = {"Breathing.Coupling=Paper"}, *const moves[] = {
                                                                         "Breathing.Relaxation=1"};
    static const char *const wrong[] = {"Breathing.Fit={\"Parameters\": [\"plane-offset\"]}"};
    skg_setup *setup = load(0, NULL);
    skg_fit *fit;
    ck_skg(skg_fit_create(NULL, setup, NULL, &fit));
    ck_assert_int_eq(skg_fit_dimensions(fit), FITTED);
    ck_skg_fails(skg_fit_parameters_choose(fit, "plane-offset"), SKG_ERR_ARGUMENT, "there are tendon-x");
    ck_skg_fails(skg_fit_parameters_choose(fit, "links"), SKG_ERR_ARGUMENT, "diaphragm-ribs has no effect");
    ck_skg_fails(skg_fit_bounds_set(fit, "diaphragm-ribs", 5, 9), SKG_ERR_ARGUMENT, "\"Anatomical\"");
    ck_assert_int_eq(skg_fit_dimensions(fit), FITTED);
    ck_skg(skg_fit_parameters_choose(fit, "tendon,links"));
    ck_assert_int_eq(skg_fit_dimensions(fit), 3);
    skg_fit_release(&fit);
    skg_setup_release(&setup);
    for (int s = 0; s < 2; s++) {
        setup = load(1, s ? moves : paper);
        ck_skg(skg_fit_create(NULL, setup, NULL, &fit));
        ck_assert_int_eq(skg_fit_dimensions(fit), 14);
        ck_skg_fails(skg_fit_parameters_choose(fit, "dome-left"), SKG_ERR_ARGUMENT, "\"Paper\"");
        skg_fit_release(&fit);
        skg_setup_release(&setup);
    }
    setup = load(1, wrong);
    ck_skg_fails(skg_fit_create(NULL, setup, NULL, &fit), SKG_ERR_ARGUMENT, "plane-offset has no effect");
    skg_setup_release(&setup);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, hidden_breaths_are_found, 0, 8);
    tcase_add_test(tests, two_phases);
    tcase_add_test(tests, noise_and_another_mesh);
    tcase_add_test(tests, the_scene_is_what_was_fitted);
    tcase_add_test(tests, values_leave_nothing_behind);
    tcase_add_test(tests, what_is_not_determined);
    tcase_add_test(tests, parameters_belong_to_a_coupling);
}

SKG_SUITE_MAIN("fit: anatomy", add_tests)
