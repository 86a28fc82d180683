/* The core of live: messages, wishes and their plans, images, texts. The transports are tested in tests/cli and
 * tests/python. */
#include "suite.h"
#include "support/run.h"

#include <skiagraph/live.h>

#include <math.h>
#include <string.h>

enum { SIDE = 24 };

/* The head of a frame, before its numbers (docs/live.md). */
typedef struct {
    char mark[4];
    uint32_t number, wish;
    uint16_t columns, rows;
    double low, step, flat_field;
    float ms;
    uint16_t factor;
    uint8_t quantity, notes;
} header;

static skg_scene *scene;
static skg_spectrum *spectrum;
static skg_view view;
static skg_plan_options options;
static skg_live_subject subject;

static void open_scene(void) {
    run_open();
    solid s = solid_blob(60, 40, 20, 1);
    scene = run_scene(&s, NULL);
    solid_free(&s);
    view = run_view(SIDE, 8);
    ck_skg(skg_spectrum_create_mono(100, 1000, &spectrum));
    skg_plan_options_init(&options);
    skg_live_subject_init(&subject);
    subject.context = run_context, subject.scene = scene, subject.spectrum = spectrum;
    subject.options = &options, subject.view = &view;
}

/* Where the device is closed with it, nothing is left: tests forget nothing, so that the library would have. */
static void close_scene(void) {
    int64_t left = -1;
    skg_spectrum_release(&spectrum);
    skg_scene_release(&scene);
    run_close();
    if (run_context) return;
    ck_skg(skg_allocation_count(&left));
    ck_assert_int_eq(left, 0);
}

static skg_live_message *read_text(const char *text) {
    skg_live_message *message = NULL;
    ck_skg(skg_live_message_create(text, (int64_t)strlen(text), &message));
    return message;
}

static const void *bytes_of(const skg_live_letter *letter, int64_t *count) {
    const uint8_t *bytes = NULL;
    ck_skg(skg_live_letter_get(letter, NULL, &bytes, count));
    return bytes;
}

START_TEST(a_wish_is_read) {
    skg_live_message *wish = read_text(
        "{\"wish\": 7, \"settings\": {\"Source.Position\": [1, 2.5, 3, \"mm\"], \"Noise\": true},"
        " \"poses\": {\"3\": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}, \"phase\": 0.25, \"projection\": 4,"
        " \"quantity\": \"photons\", \"bands\": [20, 40, 60], \"channel\": 1, \"drag\": true, \"play\": true}");
    skg_live_asked asked;
    const char *text = NULL;
    skg_live_asked_init(&asked);
    ck_skg(skg_live_message_get(wish, &asked));
    ck_assert(asked.kind == SKG_LIVE_ASKED_WISH && asked.number == 7 && asked.drag && asked.play);
    ck_assert(asked.phase == 0.25 && asked.projection == 4 && asked.quantity == SKG_QUANTITY_PHOTONS);
    ck_assert(asked.bands == 2 && asked.band_kev[2] == 60 && asked.channel == 1);
    ck_assert(asked.setting_count == 2 && asked.pose_count == 1 && asked.parts[0] == 3 &&
              asked.poses[3] == 5);
    ck_assert_str_eq(asked.settings[0], "Source.Position=[1,2.5,3,\"mm\"]");
    ck_assert_str_eq(asked.settings[1], "Noise=true");
    ck_skg(skg_live_message_text_get(wish, &text));
    ck_assert(strstr(text, "\"projection\":4") && !strstr(text, "drag"));
    skg_live_message_release(&wish);
}
END_TEST

/* Whether two wishes differ by what moves source and detector, and by other things. */
static void check_differ(const skg_live_message *a, const skg_live_message *b, int moved, int other) {
    int32_t has_moved = -1, is_other = -1;
    for (int turn = 0; turn < 2; turn++) {
        ck_skg(skg_live_wish_compare(turn ? b : a, turn ? a : b, &has_moved, &is_other));
        ck_assert_int_eq(has_moved, moved);
        ck_assert_int_eq(is_other, other);
    }
}

START_TEST(wishes_are_changed_and_compared) {
    static const struct {
        const char *changes;
        int moved, other;
    } cases[] = {{"{\"phase\": 0.5}", 0, 0},
                 {"{\"poses\": {\"0\": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}", 0, 0},
                 {"{\"settings\": {\"source.position\": [1, 0, 0, \"mm\"], \"Noise\": true}}", 1, 0},
                 {"{\"settings\": {}}", 0, 1},
                 {"{\"settings\": {\"Noise\": false}}", 0, 1},
                 {"{\"quantity\": \"energy\"}", 0, 1},
                 {"{\"bands\": [20, 40]}", 0, 1}};
    skg_live_message *wish = read_text("{\"wish\": 1, \"settings\": {\"Noise\": true}, \"drag\": true}"),
                     *changed = NULL;
    skg_live_asked asked;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ck_skg(skg_live_message_change(wish, cases[i].changes, &changed));
        check_differ(wish, changed, cases[i].moved, cases[i].other);
        skg_live_message_release(&changed);
    }
    ck_skg(skg_live_message_change(wish, "{\"wish\": 9}", &changed));
    skg_live_asked_init(&asked);
    ck_skg(skg_live_message_get(changed, &asked));
    ck_assert(asked.number == 9 && asked.drag && asked.setting_count == 1);
    skg_live_message_release(&changed);
    ck_skg_fails(skg_live_message_change(wish, "{\"phase\": 2}", &changed), SKG_ERR_ARGUMENT, "below 1");
    ck_assert_ptr_null(changed);
    skg_live_message_release(&wish);
}
END_TEST

START_TEST(what_is_no_message_is_refused) {
    static const struct {
        const char *text, *says;
    } wrong[] = {
        {"7", "no JSON"},
        {"[]", "no JSON object"},
        {"{\"wish\": 1, \"wish\": 2}", "duplicate"},
        {"{}", "has the key wish, ack, probe"},
        {"{\"wish\": 4294967296}", "no number of a wish"},
        {"{\"wish\": 1, \"poses\": {\"0\": [1]}}", "16 numbers"},
        {"{\"wish\": 1, \"settings\": {\"a=b\": 1}}", "no key of a scene file"},
        {"{\"look\": {\"size\": [2, 2], \"target\": [0, 0, 0], \"distance\": [1], \"from\": [0, 1, 0], \"up\": [0, 0, 1]}}",
         "\"distance\" is missing, unknown or out of range"}};
    char deep[200];
    skg_live_message *message = NULL;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        ck_skg_fails(skg_live_message_create(wrong[i].text, (int64_t)strlen(wrong[i].text), &message),
                     SKG_ERR_ARGUMENT, wrong[i].says);
        ck_assert_ptr_null(message);
    }
    memset(deep, '[', sizeof deep);
    ck_skg_fails(skg_live_message_create(deep, sizeof deep, &message), SKG_ERR_ARGUMENT, "nested more than");
}
END_TEST

/* The values of a frame. The caller frees them. */
static double *unpack(const skg_live_letter *letter, header *head) {
    int64_t count = 0;
    const unsigned char *bytes = bytes_of(letter, &count);
    memcpy(head, bytes, sizeof *head);
    const int64_t pixels = (int64_t)head->columns * head->rows;
    ck_assert_int_eq(count, (int64_t)sizeof *head + 2 * pixels);
    double *values = calloc((size_t)pixels, sizeof *values);
    ck_assert_ptr_nonnull(values);
    for (int64_t i = 0; i < pixels; i++) {
        uint16_t number;
        memcpy(&number, bytes + sizeof *head + 2 * i, sizeof number);
        values[i] = head->low + head->step * number;
    }
    return values;
}

/* A frame of the wish is the image of a plan of its own, within half a step of its numbers and what float rounds. */
static void check_frame(skg_live_plans *plans, const skg_live_message *wish, int64_t number) {
    skg_live_frame frame;
    skg_live_letter *letter = NULL;
    header head;
    skg_live_frame_init(&frame);
    ck_skg(skg_live_frame_make(plans, &subject, wish, NULL, &frame));
    ck_assert(!frame.dropped && !frame.draft && frame.ms > 0 && isnan(frame.scatter_s));
    ck_skg(skg_live_frame_write(plans, number, &letter));
    double *values = unpack(letter, &head);
    const skg_view *shown = subject.shown ? subject.shown : &view;
    ck_assert(head.number == (uint32_t)number && head.columns == shown->columns && head.rows == shown->rows);
    ck_assert(memcmp(head.mark, "SKLF", 4) == 0 && head.factor == 1 && head.notes == 0);
    skg_plan_options its = options;
    skg_plan *plan = NULL;
    its.quantity = SKG_QUANTITY_ATTENUATION;
    ck_skg(skg_plan_create(run_context, scene, shown, spectrum, &its, &plan));
    double *image = run_image(plan, shown), most = 0;
    for (int64_t i = 0; i < shown->columns * shown->rows; i++) {
        /* half a step of 16 bits, and what float rounds of attenuations below 10 */
        ck_assert_double_eq_tol(values[i], image[i], 0.51 * head.step + 1e-6);
        most = fmax(most, image[i]);
    }
    ck_assert_double_gt(most, 1);
    free(values);
    free(image);
    skg_plan_release(&plan);
    skg_live_letter_release(&letter);
}

START_TEST(frames_are_images) {
    skg_live_message *wish = read_text("{\"wish\": 3}");
    skg_live_plans *plans = NULL;
    skg_live_letter *letter = NULL;
    int64_t count = 0;
    ck_skg(skg_live_plans_create(&subject, wish, &plans));
    ck_skg_fails(skg_live_frame_write(plans, 1, &letter), SKG_ERR_ARGUMENT, "no image");
    check_frame(plans, wish, 1);
    ck_skg(skg_live_shot_write(plans, &subject, wish, 1, 0, &letter));
    const char *text = bytes_of(letter, &count);
    ck_assert_int_eq(count, (int64_t)strlen(text));
    ck_assert(strstr(text, "{\"shot\":1,\"wish\":3,") && strstr(text, "\"view\":{") &&
              strstr(text, "\"stages\":{"));
    skg_live_letter_release(&letter);
    ck_skg(skg_live_shot_write(plans, &subject, wish, 1, 1, &letter));
    ck_assert_ptr_null(strstr(bytes_of(letter, &count), "view"));
    skg_live_letter_release(&letter);
    skg_live_plans_release(&plans);
    skg_live_message_release(&wish);
}
END_TEST

/* A part that is added, and a detector with other pixels, are in the next frame. */
START_TEST(a_plan_that_was_outgrown_is_made_anew) {
    skg_live_message *wish = read_text("{\"wish\": 3}");
    skg_live_plans *plans = NULL;
    skg_live_frame frame;
    skg_view other = run_view(SIDE / 2, 16);
    ck_skg(skg_live_plans_create(&subject, wish, &plans));
    skg_live_frame_init(&frame);
    ck_skg(skg_live_frame_make(plans, &subject, wish, NULL, &frame));
    ck_assert_int_eq(frame.again, 1); /* for its time: the first one makes kernels */
    solid s = solid_blob(20, 20, 20, 2);
    skg_mesh *mesh = run_mesh(&s);
    solid_free(&s);
    double aside[16];
    for (int i = 0; i < 16; i++) aside[i] = i % 5 == 0 ? 1 : i == 3 ? 50 : 0;
    run_part(scene, "second", mesh, 1, aside, -1);
    skg_mesh_release(&mesh);
    check_frame(plans, wish, 2);
    subject.shown = &other;
    check_frame(plans, wish, 3);
    skg_live_plans_release(&plans);
    skg_live_message_release(&wish);
}
END_TEST

START_TEST(what_the_scene_lacks_is_refused) {
    static const struct {
        const char *wish, *says;
    } wrong[] = {{"{\"wish\": 1, \"channel\": 2}", "no band 2"},
                 {"{\"wish\": 1, \"phase\": 0.5}", "does not breathe"},
                 {"{\"wish\": 1, \"poses\": {\"9\": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}", "no part 9"}};
    skg_live_message *plain = read_text("{\"wish\": 0}"), *probe = read_text("{\"probe\": [24, 3]}");
    skg_live_plans *plans = NULL;
    skg_live_letter *letter = NULL;
    skg_live_frame frame;
    skg_live_frame_init(&frame);
    ck_skg(skg_live_plans_create(&subject, plain, &plans));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        skg_live_message *wish = read_text(wrong[i].wish);
        ck_skg_fails(skg_live_frame_make(plans, &subject, wish, NULL, &frame), SKG_ERR_SCENE, wrong[i].says);
        skg_live_message_release(&wish);
    }
    ck_skg_fails(skg_live_probe_write(&subject, plain, probe, &letter), SKG_ERR_ARGUMENT, "no such pixel");
    ck_skg_fails(skg_live_picture_write(plans, &subject, plain, probe, &letter), SKG_ERR_ARGUMENT, "no look");
    subject.spectrum = NULL;
    ck_skg_fails(skg_live_frame_make(plans, &subject, plain, NULL, &frame), SKG_ERR_ARGUMENT,
                 "needs context");
    skg_live_plans_release(&plans);
    ck_skg_fails(skg_live_plans_create(&subject, probe, &plans), SKG_ERR_ARGUMENT, "no wish");
    skg_live_message_release(&probe);
    skg_live_message_release(&plain);
}
END_TEST

START_TEST(parts_stand_where_a_wish_has_them) {
    skg_live_message *wish =
        read_text("{\"wish\": 1, \"poses\": {\"0\": [1,0,0,5, 0,1,0,-2, 0,0,1,0, 0,0,0,1]}}");
    double base[16], pose[16], box[6], moved[6];
    skg_part part;
    for (int i = 0; i < 16; i++) base[i] = i % 5 == 0 ? 1 : i == 3 ? 30 : 0;
    ck_skg(skg_live_box_get(&subject, box));
    ck_assert(box[0] < -10 && box[3] > 10);
    subject.poses = base;
    ck_skg(skg_live_box_get(&subject, moved));
    for (int k = 0; k < 6; k++)
        ck_assert_double_eq_tol(moved[k], box[k] + (k % 3 == 0 ? 30 : 0), 1e-9); /* rounding */
    ck_skg(skg_live_poses_get(&subject, wish, pose));
    ck_assert(pose[3] == 35 && pose[7] == -2 && pose[15] == 1);
    ck_skg(skg_live_place(&subject, wish));
    skg_part_init(&part);
    ck_skg(skg_scene_part_get(scene, 0, &part));
    ck_assert_mem_eq(part.pose, pose, sizeof pose);
    skg_live_message_release(&wish);
}
END_TEST

START_TEST(larger_pixels_cover_the_same_detector) {
    skg_view coarse = view;
    ck_skg(skg_live_view_coarsen(5, &coarse));
    ck_assert(coarse.columns == 4 && coarse.rows == 4);
    ck_assert_double_eq_tol(4 * coarse.column_step[0], SIDE * view.column_step[0], 1e-9); /* rounding */
    ck_skg(skg_live_view_coarsen(100, &coarse));
    ck_assert(coarse.columns == 1 && coarse.rows == 1);
    ck_skg_fails(skg_live_view_coarsen(0, &coarse), SKG_ERR_ARGUMENT, "1 time");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, open_scene, close_scene);
    tcase_add_test(tests, a_wish_is_read);
    tcase_add_test(tests, wishes_are_changed_and_compared);
    tcase_add_test(tests, what_is_no_message_is_refused);
    tcase_add_test(tests, frames_are_images);
    tcase_add_test(tests, a_plan_that_was_outgrown_is_made_anew);
    tcase_add_test(tests, what_the_scene_lacks_is_refused);
    tcase_add_test(tests, parts_stand_where_a_wish_has_them);
    tcase_add_test(tests, larger_pixels_cover_the_same_detector);
}

SKG_SUITE_MAIN("live_core", add_tests)
