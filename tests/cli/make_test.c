/* The verb make: bodies as meshes. */
#include "cli/command.h"

START_TEST(every_kind_is_written_and_closed) {
    static const char *const kinds[] = {"foam", "fibres", "gyroid", "lines", "star", "steps"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        ck_run(0, "make %s -o body.ply --json", kinds[k]);
        json_t *object = said_json();
        ck_assert_str_eq(json_string_value(member(object, "kind")), kinds[k]);
        ck_assert(json_number_value(member(object, "volume_mm3")) > 0);
        json_decref(object);
        ck_run(0, "mesh body.ply --json");
    }
}
END_TEST

START_TEST(flags_say_what_is_made) {
    ck_run(0, "make steps --heights 1,2,10 --length 30 --width 10 -o wedge.stl");
    ck_assert_ptr_nonnull(strstr(said, "volume 1300 mm3; wrote wedge.stl"));
    ck_run(0, "make foam --box 10,20,30 --radius 1 --count 7 --seed 3 --segments 8 -o foam.ply");
    ck_assert_ptr_nonnull(strstr(said, "7 components"));
    ck_run(0, "make lines --per-mm 1,4 --bars 3 --thickness 0.1 -o lines.ply");
    ck_assert_ptr_nonnull(strstr(said, "6 components"));
}
END_TEST

START_TEST(what_cannot_be_made_is_refused) {
    ck_run_fails(2, "unknown kind of body foan; did you mean foam?", "make foan -o a.ply");
    ck_run_fails(2, "no mesh is named", "make foam");
    ck_run_fails(2, "written as .ply or .stl", "make foam -o a.obj");
    ck_run_fails(2, "separated by commas", "make steps --heights 1,x -o a.ply");
    ck_run_fails(2, "give X,Y,Z or one edge", "make foam --box 1,2 -o a.ply");
    ck_run_fails(2, "heights have to rise", "make steps --heights 2,1 -o a.ply");
    ck_run_fails(3, "no place is left for sphere", "make foam --fraction 0.6 -o a.ply");
    ck_assert_int_eq(has_file("a.ply"), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, every_kind_is_written_and_closed);
    tcase_add_test(tests, flags_say_what_is_made);
    tcase_add_test(tests, what_cannot_be_made_is_refused);
}

SKG_SUITE_MAIN("make", add_tests)
