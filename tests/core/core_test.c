/* Errors, statuses and memory. */
#include "core/core.h"
#include "core/files.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "suite.h"

#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

START_TEST(every_status_has_name_and_text) {
#define SKG_CHECK_STATUS(name, value, text)                                                                  \
    ck_assert_str_eq(skg_status_name(value), #name);                                                         \
    ck_assert_str_eq(skg_status_text(value), text);
    SKG_STATUS_LIST(SKG_CHECK_STATUS)
    ck_assert_str_eq(skg_status_name(-12345), "SKG_UNKNOWN");
}
END_TEST

START_TEST(errors_are_failures_and_answers_are_none) {
#define SKG_CHECK_FAILED(name, value, text)                                                                  \
    ck_assert_int_eq(SKG_FAILED(name), strncmp(#name, "SKG_ERR_", strlen("SKG_ERR_")) == 0);
    SKG_STATUS_LIST(SKG_CHECK_FAILED)
}
END_TEST

START_TEST(last_error_may_quote_itself) {
    skg_fail(SKG_ERR_FILE, "%s: not there", "a.stl");
    skg_fail(SKG_ERR_SCENE, "scene.json: %s", skg_last_error());
    ck_assert_str_eq(skg_last_error(), "scene.json: a.stl: not there");
}
END_TEST

/* Found by fuzzing: a scene file's text went into the sentence with its line breaks. */
START_TEST(a_sentence_is_one_line) {
    skg_fail(SKG_ERR_FORMAT, "near '%s'", "Num\nber\x1b[2J\x7f");
    ck_assert_str_eq(skg_last_error(), "near 'Num?ber?[2J?'");
    skg_fail(SKG_ERR_SCENE, "part %s", "L\xc3\xa4uchte"); /* UTF-8 stays */
    ck_assert_str_eq(skg_last_error(), "part L\xc3\xa4uchte");
    skg_fail(SKG_ERR_BUILD, "a.cl:1: error\na.cl:2: error");
    ck_assert_ptr_nonnull(strchr(skg_last_error(), '\n'));
}
END_TEST

START_TEST(allocation_checks_its_product) {
    double *p = NULL;
    ck_skg_fails(skg_alloc(INT64_MAX / 4, sizeof *p, "lengths", &p), SKG_ERR_MEMORY, "lengths");
    ck_assert_ptr_null(p);
    ck_skg(skg_alloc(0, sizeof *p, "nothing", &p));
    ck_assert_ptr_nonnull(p);
    skg_free(&p);
    ck_assert_ptr_null(p);
}
END_TEST

typedef struct {
    int32_t size, a, b;
} old_struct;
typedef struct {
    int32_t size, a, b, c;
} new_struct;

START_TEST(structs_grow) {
    old_struct theirs = {sizeof theirs, 1, 2};
    new_struct ours = {sizeof ours, 0, 0, 7};
    ck_skg(skg_struct_read(&theirs, "skg_thing", &ours, sizeof ours));
    ck_assert_int_eq(ours.b, 2);
    ck_assert_int_eq(ours.c, 7);
    ck_assert_int_eq(ours.size, (int)sizeof ours);

    new_struct newer = {sizeof newer, 1, 2, 0};
    old_struct older = {sizeof older, 0, 0};
    ck_skg(skg_struct_read(&newer, "skg_thing", &older, sizeof older));
    newer.c = 3;
    ck_skg_fails(skg_struct_read(&newer, "skg_thing", &older, sizeof older), SKG_ERR_ARGUMENT,
                 "newer library");
    newer.size = 0;
    ck_skg_fails(skg_struct_read(&newer, "skg_thing", &older, sizeof older), SKG_ERR_ARGUMENT,
                 "skg_thing_init");
}
END_TEST

START_TEST(nearest_name_is_a_slip_of_the_finger) {
    const char *known[] = {"Source", "Detector", "Samples"};
    ck_assert_str_eq(skg_nearest_name("detectro", known, 3), "Detector");
    ck_assert_str_eq(skg_nearest_name("SAMPLE", known, 3), "Samples");
    ck_assert_ptr_null(skg_nearest_name("Zebra", known, 3));
}
END_TEST

START_TEST(output_appears_whole_or_not_at_all) {
    char folder[] = "/tmp/skg-core-XXXXXX", path[64];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.txt", folder);
    skg_output_file file;
    ck_skg(skg_output_open(path, &file));
    fputs("half", file.stream);
    skg_output_discard(&file);
    ck_assert_int_ne(access(path, F_OK), 0);
    ck_skg(skg_output_open(path, &file));
    fputs("whole", file.stream);
    ck_skg(skg_output_commit(&file));
    ck_assert_int_eq(access(path, F_OK), 0);
    ck_assert_int_eq(unlink(path), 0);
    ck_assert_int_eq(rmdir(folder), 0); /* nothing else was left there */
    ck_skg_fails(skg_output_open(path, &file), SKG_ERR_OUTPUT, path);
}
END_TEST

/* Two files of one name at once, and what a killed process of the same number left: both have a name of their own. Only
 * where every name is taken there is a sentence, which names the file in the way. */
START_TEST(unfinished_files_have_names_of_their_own) {
    enum { TRIES = 100 };
    char folder[] = "/tmp/skg-core-XXXXXX", path[64], old[128], ending[SKG_PART_ENDING], line[128];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.txt", folder);
    snprintf(old, sizeof old, "%s.part-%ld", path, (long)getpid());
    fclose(fopen(old, "wb"));
    skg_output_file first, second;
    ck_skg(skg_output_open(path, &first));
    ck_skg(skg_output_open(path, &second));
    ck_assert_str_ne(first.temporary, second.temporary);
    fputs("second", second.stream);
    ck_skg(skg_output_commit(&second));
    skg_output_discard(&first);
    ck_assert_int_eq(access(path, F_OK), 0);
    skg_part_ending(ending);
    for (int n = 0; n < TRIES; n++) {
        char number[16] = "";
        if (n > 0) snprintf(number, sizeof number, "-%d", n);
        snprintf(old, sizeof old, "%s%s%s", path, ending, number);
        fclose(fopen(old, "wbx"));
    }
    ck_skg_fails(skg_output_open(path, &first), SKG_ERR_OUTPUT, old);
    ck_assert(skg_part_is_of("scan.h5.part-17-00ab12ef", ".h5") &&
              skg_part_is_of("scan.h5.part-17", "scan.h5"));
    ck_assert(!skg_part_is_of("scan.h5.part-17-mine", ".h5") && !skg_part_is_of("scan.h5.part-", ".h5"));
    ck_assert(!skg_part_is_of("scan.h5", ".h5") && !skg_part_is_of("scan.mha.part-1", ".h5"));
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}
END_TEST

/* Of a process of this machine that has ended, and of none else. */
START_TEST(files_that_nobody_finishes) {
    char own[SKG_PART_ENDING], name[2 * SKG_PART_ENDING];
    int status = 0;
    skg_part_ending(own);
    const char *tag = strrchr(own, '-');
    ck_assert_ptr_nonnull(tag);
    ck_assert_uint_eq(strlen(tag), 13);
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) _exit(0);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    snprintf(name, sizeof name, "a.png.part-%ld%s", (long)child, tag);
    ck_assert(skg_part_is_left(name));
    snprintf(name, sizeof name, "a.png.part-%ld%s-17", (long)child, tag);
    ck_assert(skg_part_is_left(name));
    snprintf(name, sizeof name, "a.png.part-%ld%.5s0badcafe", (long)getpid(),
             tag); /* had our number before */
    ck_assert(skg_part_is_left(name));
    snprintf(name, sizeof name, "a.png%s", own);
    ck_assert(!skg_part_is_left(name));
    snprintf(name, sizeof name, "a.png.part-%ld%s", (long)getppid(), tag);
    ck_assert(!skg_part_is_left(name));
    snprintf(name, sizeof name, "a.png.part-%ld-%s%s", (long)child, tag[1] == '0' ? "1" : "0", tag + 2);
    ck_assert(!skg_part_is_left(name)); /* of another machine */
    snprintf(name, sizeof name, "a.png.part-%ld%s.bak", (long)child, tag);
    ck_assert(!skg_part_is_left(name));
    ck_assert(!skg_part_is_left("a.png") && !skg_part_is_left("a.part-17") && !skg_part_is_left(own));
}
END_TEST

static skg_status needs_a_mesh(const void *mesh) {
    SKG_NEEDS(mesh);
    return SKG_OK;
}

START_TEST(a_missing_argument_is_named) {
    ck_skg(needs_a_mesh(""));
    ck_skg_fails(needs_a_mesh(NULL), SKG_ERR_ARGUMENT, "needs_a_mesh: the argument mesh is NULL");
}
END_TEST

START_TEST(rounding_up_stays_where_it_is_exact) {
    ck_assert_int_eq(skg_round_up(0, 16), 0);
    ck_assert_int_eq(skg_round_up(1, 16), 16);
    ck_assert_int_eq(skg_round_up(32, 16), 32);
    ck_assert_int_eq(skg_divide_up(33, 16), 3);
}
END_TEST

/* A mailbox that is full keeps its oldest sentences and counts the others. */
START_TEST(a_mailbox_is_bounded) {
    skg_mailbox *mailbox = NULL;
    char sentence[SKG_MAILBOX_SENTENCE], longest[2 * SKG_MAILBOX_SENTENCE];
    ck_skg(skg_mailbox_create(&mailbox));
    void *address = skg_mailbox_address(mailbox);
    ck_assert(!skg_mailbox_take(mailbox, sentence));
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    skg_mailbox_put(address, longest);
    for (int i = 1; i < SKG_MAILBOX_CAPACITY + 3; i++) skg_mailbox_put(address, "device lost");
    ck_assert(skg_mailbox_take(mailbox, sentence));
    ck_assert_uint_eq(strlen(sentence), SKG_MAILBOX_SENTENCE - 1);
    for (int i = 1; i < SKG_MAILBOX_CAPACITY; i++) ck_assert(skg_mailbox_take(mailbox, sentence));
    ck_assert_str_eq(sentence, "device lost");
    ck_assert(skg_mailbox_take(mailbox, sentence));
    ck_assert_str_eq(sentence, "3 more sentences were dropped");
    ck_assert(!skg_mailbox_take(mailbox, sentence));
    skg_mailbox_release(&mailbox);
    skg_mailbox_put(address, "nobody reads this");
    ck_skg(skg_mailbox_create(&mailbox)); /* an address is not used again */
    ck_assert(!skg_mailbox_take(mailbox, sentence));
    skg_mailbox_release(&mailbox);
}
END_TEST

START_TEST(structs_are_prepared_to_their_size) {
    const new_struct defaults = {0, 4, 5, 6};
    struct {
        old_struct whole;
        int32_t guard;
    } older = {{9, 9, 9}, 9};
    struct {
        new_struct known;
        int32_t later;
    } newer = {{9, 9, 9, 9}, 9};
    skg_struct_init(&older, sizeof older.whole, &defaults, sizeof defaults);
    ck_assert(older.whole.size == (int)sizeof older.whole && older.whole.a == 4 && older.whole.b == 5);
    ck_assert_int_eq(older.guard, 9);
    skg_struct_init(&newer, sizeof newer, &defaults, sizeof defaults);
    ck_assert(newer.known.size == (int)sizeof newer && newer.known.c == 6 && newer.later == 0);
    skg_struct_init(&older, 3, &defaults, sizeof defaults); /* no room for the size itself */
    ck_assert_int_eq(older.whole.size, (int)sizeof older.whole);
    skg_struct_init(NULL, sizeof older, &defaults, sizeof defaults);
}
END_TEST

START_TEST(arrays_step_by_their_first_element) {
    const new_struct wide[2] = {{sizeof *wide, 1, 2, 0}, {sizeof *wide, 3, 4, 0}};
    old_struct narrow[2] = {{sizeof *narrow, 1, 2}, {sizeof *narrow, 3, 4}};
    new_struct ours = {sizeof ours, 0, 0, 7};
    old_struct older = {sizeof older, 0, 0};
    ck_skg(skg_struct_read_at(narrow, 1, "skg_thing", &ours, sizeof ours));
    ck_assert(ours.a == 3 && ours.b == 4 && ours.c == 7);
    ck_skg(skg_struct_read_at(wide, 1, "skg_thing", &older, sizeof older));
    ck_assert(older.a == 3 && older.b == 4);
    narrow[1].size = 0;
    ck_skg_fails(skg_struct_read_at(narrow, 1, "skg_thing", &ours, sizeof ours), SKG_ERR_ARGUMENT,
                 "element 1 has size 0");
    ck_skg_fails(skg_struct_read_at(NULL, 1, "skg_thing", &ours, sizeof ours), SKG_ERR_ARGUMENT, "NULL");
}
END_TEST

#ifdef SKG_ASSERTIONS
/* An owner too many ends the process, instead of a second free later. */
START_TEST(a_precondition_that_does_not_hold) {
    skg_refs refs;
    skg_refs_init(&refs);
    skg_ref(&refs);
    ck_assert_int_eq(skg_unref(&refs), 0);
    ck_assert_int_eq(skg_unref(&refs), 1);
    (void)skg_unref(&refs);
}
END_TEST
#endif

static void add_tests(TCase *tests) {
#ifdef SKG_ASSERTIONS
    tcase_add_test_raise_signal(tests, a_precondition_that_does_not_hold, SIGABRT);
#endif
    tcase_add_test(tests, every_status_has_name_and_text);
    tcase_add_test(tests, errors_are_failures_and_answers_are_none);
    tcase_add_test(tests, last_error_may_quote_itself);
    tcase_add_test(tests, a_sentence_is_one_line);
    tcase_add_test(tests, allocation_checks_its_product);
    tcase_add_test(tests, structs_grow);
    tcase_add_test(tests, structs_are_prepared_to_their_size);
    tcase_add_test(tests, arrays_step_by_their_first_element);
    tcase_add_test(tests, nearest_name_is_a_slip_of_the_finger);
    tcase_add_test(tests, output_appears_whole_or_not_at_all);
    tcase_add_test(tests, unfinished_files_have_names_of_their_own);
    tcase_add_test(tests, files_that_nobody_finishes);
    tcase_add_test(tests, a_missing_argument_is_named);
    tcase_add_test(tests, rounding_up_stays_where_it_is_exact);
    tcase_add_test(tests, a_mailbox_is_bounded);
}

SKG_SUITE_MAIN("core", add_tests)
