/* A set-up that breathes: what its key Breathing says. */
#include "motion/motion_files.h"
#include "support/angles.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Two ribs of boxes, a diaphragm and a lung of spheres: enough of a body, with this key Breathing. */
static skg_status load(const char *breathing) {
    static const char samples[] =
        "  {\"Label\": \"lung right\", \"Sphere\": [16, 40, \"mm\"], \"Material\": [\"mu\", 0.05]},\n"
        "  {\"Label\": \"flat\", \"Sphere\": [17, 60, \"mm\"], \"Material\": [\"mu\", 0.2]},\n"
        "  {\"Label\": \"inside\", \"Sphere\": [8, 5, \"mm\"], \"Material\": [\"mu\", 0.3], \"Parent\": \"lung "
        "right\"}";
    FILE *stream = fopen(path, "w");
    ck_assert_ptr_nonnull(stream);
    fprintf(stream, "%s%s]%s%s}\n", heading, samples, *breathing ? ", \"Breathing\": " : "", breathing);
    ck_assert_int_eq(fclose(stream), 0);
    close_setup();
    return skg_setup_load(NULL, path, 0, NULL, &setup);
}

START_TEST(the_key_is_read) {
    const skg_breathing_section *section;
    ck_skg(load(""));
    section = &setup->breathing; /* quiet breathing where there is no key */
    ck_assert_int_eq(section->breath.waveform, SKG_WAVEFORM_ASYMMETRIC);
    ck_assert(section->breath.period_s == 4 && section->body.tendon_mm[2] == -15 &&
              section->lung_density == 1);
    ck_skg(
        load("{\"Pattern\": \"deep\", \"Waveform\": [1, 0.2, 0, 0.2], \"Period\": 5, \"StartPhase\": 0.5,"
             "\"Thoracic\": 0.5, \"ThoracicLag\": 0.1, \"Reference\": 1, \"Tendon\": [0, 1, -2, \"cm\"],"
             "\"TendonPlane\": [0, 1, 1, 20], \"Hysteresis\": 0.5, \"Relaxation\": 2, \"LungDensity\": false,"
             "\"Organs\": {\"flat\": {\"As\": \"diaphragm\", \"Tissue\": [0.6, 1.2, 0.2]}},"
             "\"Events\": [{\"Hold\": [1, 2]}, {\"Needle\": [[0, 1], [2, 5]]},"
             "{\"Contrast\": \"inside\", \"Share\": [[0, 0.5]]}]}"));
    section = &setup->breathing;
    ck_assert(section->breath.waveform == SKG_WAVEFORM_SAMPLED && section->breath.samples[1] == 0.2);
    ck_assert(section->breath.period_s == 5 && section->breath.start_phase == 0.5);
    ck_assert(section->breath.thoracic == 0.5 && section->breath.diaphragmatic == 2.5);
    ck_assert(section->body.reference_thoracic == 0.5 && section->body.reference_diaphragmatic == 2.5);
    ck_assert(section->body.tendon_mm[1] == 10 && section->body.tendon_plane[3] == 20);
    ck_assert(section->body.hysteresis == 0.5 && section->body.relaxation == 2 && section->lung_density == 0);
    ck_assert(section->organs[0].part == 1 && section->organs[0].organ.alpha_max == 1.2);
    ck_assert(section->breath.hold_count == 1 && section->breath.holds[0].end_s == 2);
    ck_assert(section->needle.count == 2 && section->contrasts[0].part == 2);
}
END_TEST

START_TEST(organs_are_read) {
    ck_skg(load("{\"RibAxes\": \"bones\", \"Organs\": {"
                "\"flat\": {\"As\": \"rib 5 left\", \"Kind\": \"Rigid\", \"Gamma\": 3, \"Lambda\": -2},"
                "\"inside\": {\"Kind\": \"Rigid\", \"Axis\": [0, 0, 2], \"Angle\": 90,"
                "\"Centre\": [1, 2, 3, \"cm\"]},"
                "\"lung right\": {\"Kind\": \"deformable\", \"Links\": [{\"To\": \"flat\", \"Distance\": "
                "[2, \"cm\"], \"RigidDistance\": [5, \"mm\"]}, {\"To\": \"rib\", \"Distance\": [7, "
                "\"mm\"]}]}}}"));
    const skg_breathing_section *section = &setup->breathing;
    ck_assert_int_eq(section->body.rib_axes, SKG_RIB_AXES_BONES);
    for (int64_t i = 0; i < 3; i++) {
        skg_organ organ;
        skg_organ_init(&organ);
        organ.label = "its own", organ.inside = 7;
        skg_setup_describe_organ(section, i, &organ);
        ck_assert_int_eq(organ.inside, 7);
        if (i == 0) {
            ck_assert(organ.kind == SKG_ORGAN_DEFORMABLE && organ.link_count == 2);
            ck_assert_str_eq(organ.links[0].to, "flat");
            ck_assert(organ.links[0].distance_mm == 20 && organ.links[0].rigid_mm == 5);
            ck_assert(organ.links[1].distance_mm == 7 && organ.links[1].rigid_mm == 7);
        }
        if (i == 1) {
            ck_assert_str_eq(organ.label, "rib 5 left");
            ck_assert(organ.kind == SKG_ORGAN_RIGID && isnan(organ.centre_mm[0]));
            ck_assert(organ.gamma_rad == 3 * degree && organ.lambda_rad == -2 * degree);
        }
        if (i == 2) {
            ck_assert_str_eq(organ.label, "its own");
            ck_assert(organ.turn_rad[2] == 90 * degree && organ.centre_mm[1] == 20);
        }
    }
}
END_TEST

START_TEST(organs_move_as_they_are_set) { /* a quarter turn about z through the origin: x becomes y */
    int64_t n, t;
    double before[600], after[600];
    skg_part found;
    skg_part_init(&found);
    ck_skg(load("{\"Waveform\": \"Sine\", \"Organs\": {\"flat\": {\"Kind\": \"Rigid\", \"Axis\": [0, 0, "
                "3], \"Angle\": 90, \"Centre\": [0, 0, 0, \"mm\"]}, \"lung right\": {\"Kind\": "
                "\"Static\"}}}"));
    ck_skg(skg_motion_create(NULL, setup, &motion));
    ck_skg(skg_scene_part_get(setup->scene, 1, &found));
    ck_skg(skg_mesh_count(found.mesh, &n, &t));
    ck_assert_int_le(n, 200);
    ck_skg(skg_mesh_positions_get(found.mesh, before, 0));
    ck_skg(skg_motion_pose_at_phase(motion, 0));
    ck_skg(skg_mesh_positions_get(found.mesh, after, 0));
    for (int64_t i = 0; i < n; i++) { /* floats of some 100 mm */
        ck_assert_double_eq_tol(after[3 * i], -before[3 * i + 1], 4 * 100 * (double)FLT_EPSILON);
        ck_assert_double_eq_tol(after[3 * i + 1], before[3 * i], 4 * 100 * (double)FLT_EPSILON);
        ck_assert_double_eq_tol(after[3 * i + 2], before[3 * i + 2], 4 * 100 * (double)FLT_EPSILON);
    }
    ck_skg(load("{\"Organs\": {\"flat\": {\"Kind\": \"Rigid\"}}}"));
    ck_skg_fails(skg_motion_create(NULL, setup, &motion), SKG_ERR_BREATHING, "flat: rigid");
    ck_skg(load("{\"Organs\": {\"flat\": {\"Kind\": \"Deformable\", \"Links\": [{\"To\": \"ribs\", "
                "\"Distance\": [9, \"mm\"]}]}}}"));
    ck_skg_fails(skg_motion_create(NULL, setup, &motion), SKG_ERR_BREATHING, "flat: linked to \"ribs\"");
}
END_TEST

START_TEST(its_options_can_be_asked_for) {
    skg_body_options options;
    int32_t breathes = -1;
    skg_body_options_init(&options);
    ck_skg(load(""));
    ck_skg(skg_setup_body_options_get(setup, &breathes, &options));
    ck_assert(breathes == 0 && options.relaxation == 0 && options.hysteresis == 0);
    ck_skg(load("{\"Relaxation\": 3, \"Hysteresis\": 0.25}"));
    ck_skg(skg_setup_body_options_get(setup, &breathes, &options));
    ck_assert(breathes == 1 && options.relaxation == 3 && options.hysteresis == 0.25);
    ck_assert_int_eq(skg_setup_body_options_get(NULL, &breathes, &options), SKG_ERR_ARGUMENT);
}
END_TEST

START_TEST(what_the_key_cannot_say) {
    static const struct {
        const char *breathing, *text;
    } cases[] = {
        {"{\"Frequency\": 1}", "Breathing.Frequency"},
        {"{\"Pattern\": \"deap\"}", "deep"},
        {"{\"Period\": 0}", "Breathing: breath: period_s"},
        {"{\"Reference\": 2}", "Breathing.Reference"},
        {"{\"Waveform\": [1, 2, 0]}", "a sample is 2"},
        {"{\"Organs\": {\"flt\": {}}}", "flat"},
        {"{\"Organs\": [1]}", "is no object"},
        {"{\"RibAxes\": \"bone\"}", "Bones"},
        {"{\"Organs\": {\"flat\": {\"Kind\": \"stiff\"}}}", "Breathing.Organs.flat.Kind"},
        {"{\"Organs\": {\"flat\": {\"Axis\": [0, 0, 1]}}}", "give both"},
        {"{\"Organs\": {\"flat\": {\"Gamma\": 200}}}", "-180 to 180"},
        {"{\"Organs\": {\"flat\": {\"Tissue\": [1.1, 1.1, 0]}}}", "alpha_min <= 1"},
        {"{\"Organs\": {\"flat\": {\"Links\": []}}}", "is empty"},
        {"{\"Organs\": {\"flat\": {\"Links\": [{\"To\": \"rib\"}]}}}", "Distance"},
        {"{\"Organs\": {\"flat\": {\"Links\": [{\"To\": \"rib\", \"Distance\": [0, \"mm\"]}]}}}", "above 0"},
        {"{\"Organs\": {\"flat\": {\"Links\": [{\"To\": \"rib\", \"Distance\": [5, \"mm\"], "
         "\"RigidDistance\": [6, \"mm\"]}]}}}",
         "0 to Distance"},
        {"{\"Events\": [{\"Hold\": [2, 1]}]}", "hold 0"},
        {"{\"Events\": [{\"Hold\": [1, 2], \"Needle\": [[0, 0]]}]}", "is no event"},
        {"{\"Events\": [{\"Contrast\": \"inside\"}]}", "is no event"},
        {"{\"Events\": [{\"Needle\": [[1, 0], [1, 2]]}]}", "times have to rise"},
        {"{\"Events\": [{\"Contrast\": \"inside\", \"Share\": [[1, 2]]}]}", "0 to 1"},
        {"{\"Hysteresis\": 1, \"Events\": [{\"Weight\": [[1, 2]]}]}", "Hysteresis 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        skg_status status = load(cases[i].breathing);
        ck_assert_msg(status < 0, "%s is taken", cases[i].breathing);
        ck_assert_msg(strstr(skg_last_error(), cases[i].text) != NULL, "\"%s\" does not say \"%s\"",
                      skg_last_error(), cases[i].text);
    }
}
END_TEST

START_TEST(parts_move_as_they_are_set) {
    int32_t moves = 0;
    skg_motion_state state;
    ck_skg(load(
        "{\"Waveform\": \"Sine\", \"Organs\": {\"flat\": {\"As\": \"spleen\"}},"
        "\"Events\": [{\"Weight\": [[0, 1], [4, 0]]}, {\"Contrast\": \"inside\", \"Share\": [[0, 0], [2, "
        "1]]}]}"));
    ck_skg(skg_motion_create(NULL, setup, &motion));
    ck_skg(skg_motion_part_moves(motion, 1, &moves));
    ck_assert_int_eq(moves, 1);
    const double rest = height_of("flat");
    ck_skg(skg_motion_pose_at_time(motion, 0));
    ck_assert_double_eq_tol(height_of("flat"), rest - 15, 1e-4); /* with the tendon; float offsets */
    skg_frame frame;
    skg_frame_init(&frame);
    ck_skg(skg_motion_fill(motion, &frame));
    ck_assert(frame.override_count == 2 && frame.override_parts[0] == 0 && frame.override_parts[1] == 2);
    ck_assert(frame.fill_fractions[1] == 0);
    ck_skg(skg_motion_pose_at_time(motion, 1)); /* f = 1/2, weight 3/4 */
    ck_assert_double_eq_tol(height_of("flat"), rest - 15 * 0.375, 1e-4);
    ck_skg(skg_motion_fill(motion, &frame));
    ck_assert(frame.fill_fractions[1] == 0.5);
    ck_skg(skg_motion_pose_at_phase(motion, 0.5));
    ck_assert(height_of("flat") == rest);
    skg_motion_state_init(&state);
    ck_skg(skg_motion_state_get(motion, &state));
    ck_assert(isnan(state.time_s) && isnan(state.needle_mm) && state.phase == 0.5);
    ck_skg(load("{\"Events\": [{\"Needle\": [[0, 0]]}]}"));
    ck_skg_fails(skg_motion_create(NULL, setup, &motion), SKG_ERR_BREATHING, "no needle");
    ck_skg(load("{\"Organs\": {\"lung right\": {\"As\": \"spine\"}}}"));
    ck_skg_fails(skg_motion_create(NULL, setup, &motion), SKG_ERR_BREATHING, "no organ that moves");
}
END_TEST

/* A table beside the scene; the scene that names it. */
static skg_status load_signal(const char *text, const char *more) {
    char file[160], breathing[256];
    snprintf(file, sizeof file, "%s/signal.csv", folder);
    FILE *stream = fopen(file, "w");
    ck_assert_ptr_nonnull(stream);
    fputs(text, stream);
    ck_assert_int_eq(fclose(stream), 0);
    snprintf(breathing, sizeof breathing, "{\"Signal\": \"signal.csv\"%s}", more);
    const skg_status status = load(breathing);
    unlink(file);
    return status;
}

/* As recorders write it: a heading, a clock of its own, and millimetres. */
START_TEST(a_signal_is_read) {
    ck_skg(load_signal("time,marker\n# belt\n1000.5, 12\n1001.5; 16\n1002.0 14\n1003.0,12\n", ""));
    const skg_breath *breath = &setup->breathing.breath;
    static const double points[] = {0, 0, 1, 1, 1.5, 0.5, 2.5, 0};
    ck_assert_int_eq(breath->signal_count, 4);
    for (int i = 0; i < 8; i++) ck_assert_double_eq(breath->signal[i], points[i]);
    int64_t files = 0;
    ck_skg(skg_setup_file_count(setup, &files));
    ck_assert_int_eq(files, 1); /* so that it is part of the set-up's hash */
}
END_TEST

START_TEST(bad_signal_files_are_refused) {
    static const char *const wrong[][3] = {
        {"0,1\n1\n", "", "signal.csv: line 2: two numbers were expected"},
        {"0,1\n1,2,3\n", "", "line 2: there are more than two numbers"},
        {"0,1\nx,2\n", "", "line 2"},
        {"# nothing\n", "", "no line with two numbers"},
        {"0,1\n", "", "has one row"},
        {"0,1\n2,2\n1,3\n", "", "row 3 is at 1 s, the one before at 2 s; sort the rows"},
        {"0,1\n1e999,2\n", "", "row 2: a number is too large"},
        {"0,3\n1,3\n", "", "the amplitude is 3 everywhere"},
        {"0,1\n1,2\n", ", \"Hysteresis\": 0.5", "needs Hysteresis 0"}};
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
        const skg_status status = load_signal(wrong[w][0], wrong[w][1]);
        ck_assert_int_ne(status, SKG_OK);
        ck_assert_msg(strstr(skg_last_error(), wrong[w][2]) && strstr(skg_last_error(), "Signal"), "%s",
                      skg_last_error());
    }
    ck_skg_fails(load("{\"Signal\": \"nowhere.csv\"}"), SKG_ERR_FILE, "nowhere.csv");
    ck_skg_fails(load("{\"Signal\": 3}"), SKG_ERR_FORMAT, "Signal");
    ck_skg_fails(load("{\"Signal\": \"/dev/zero\"}"), SKG_ERR_FILE, "/dev/zero");
}
END_TEST

/* The parts of the anatomical coupling that a scene can set, and values that no body accepts. */
START_TEST(anatomy_is_read) {
    static const char *const wrong[][2] = {
        {"{\"Domes\": [80, 0, 0, \"mm\"]}", "Domes"}, {"{\"MuscleLength\": 0}", "MuscleLength"},
        {"{\"RibAngles\": [60, 0]}", "RibAngles"},    {"{\"RibAngles\": [14, 9]}", "RibAngles"},
        {"{\"LiverFollows\": -1}", "LiverFollows"},   {"{\"LiverHeld\": 2}", "LiverHeld"}};
    ck_skg(load("{\"Domes\": [0.4, -0.2, 0.1, \"cm\"], \"MuscleLength\": 0.7, \"RibAngles\": [18, 0.5],"
                "\"LiverFollows\": 0.9, \"LiverHeld\": 0.1}"));
    const skg_body_options *body = &setup->breathing.body;
    ck_assert(body->dome_left_mm == 4 && body->dome_right_mm == -2 && body->dome_back_mm == 1);
    ck_assert(body->muscle_length == 0.7 && body->liver_follows == 0.9 && body->liver_held == 0.1);
    ck_assert(body->rib_angle_rad == 18 * degree && body->rib_fall_rad == 0.5 * degree);
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
        ck_skg_fails(load(wrong[w][0]), SKG_ERR_BREATHING, wrong[w][1]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, the_key_is_read);
    tcase_add_test(tests, organs_are_read);
    tcase_add_test(tests, organs_move_as_they_are_set);
    tcase_add_test(tests, its_options_can_be_asked_for);
    tcase_add_test(tests, what_the_key_cannot_say);
    tcase_add_test(tests, parts_move_as_they_are_set);
    tcase_add_test(tests, a_signal_is_read);
    tcase_add_test(tests, bad_signal_files_are_refused);
    tcase_add_test(tests, anatomy_is_read);
}

SKG_SUITE_MAIN("motion", add_tests)
