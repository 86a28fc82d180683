/* A Check program in one line: SKG_SUITE_MAIN("name", add_tests) with add_tests(TCase *). */
#ifndef SKG_TESTS_SUITE_H
#define SKG_TESTS_SUITE_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Exit status of a program that skipped a test and failed none; ctest reports it as skipped. */
enum { SUITE_SKIPPED = 77 };

/* Check runs each test in a child process, so the notes of skipped tests go through a file that all share. */
static inline int suite_notes(void) {
    static FILE *notes;
    if (!notes) notes = tmpfile();
    if (!notes) abort();
    return fileno(notes);
}

/* Ends the calling test, which lacks its data or its program: printf's arguments say what is missing. Such a test stands
 * in a program of its own, so that ctest reports it and not its neighbours as skipped. In a function that a test calls it
 * does not compile, because only the function would end: _i is the argument of Check's tests. */
#define skip_test(...)                                                                                       \
    do {                                                                                                     \
        (void)_i;                                                                                            \
        printf("skipped: ");                                                                                 \
        printf(__VA_ARGS__);                                                                                 \
        printf("\n");                                                                                        \
        fflush(stdout);                                                                                      \
        if (write(suite_notes(), "s", 1) != 1) abort();                                                      \
        return;                                                                                              \
    } while (0)

/* Whether the tests run that take long and whose subject others prove, too: ./check --full sets SKG_FULL. Beside each use stands which
 * others. */
static inline int suite_full(void) {
    return getenv("SKG_FULL") != NULL;
}

/* How many turns of a loop run: all, or the first few. */
static inline int suite_turns(size_t all, int few) {
    return suite_full() ? (int)all : few;
}

#define SKG_SUITE_MAIN(name, add_tests)                                                                      \
    int main(void) {                                                                                         \
        suite_notes();                                                                                       \
        Suite *suite = suite_create(name);                                                                   \
        TCase *tests = tcase_create(name);                                                                   \
        add_tests(tests);                                                                                    \
        suite_add_tcase(suite, tests);                                                                       \
        SRunner *runner = srunner_create(suite);                                                             \
        srunner_run_all(runner, CK_ENV);                                                                     \
        int failed = srunner_ntests_failed(runner);                                                          \
        srunner_free(runner);                                                                                \
        int skipped = lseek(suite_notes(), 0, SEEK_END) > 0;                                                 \
        return failed ? EXIT_FAILURE : skipped ? SUITE_SKIPPED : EXIT_SUCCESS;                               \
    }

/* The call must succeed; its own text is shown when it does not. */
#define ck_skg(call)                                                                                         \
    do {                                                                                                     \
        skg_status ck_status = (call);                                                                       \
        ck_assert_msg(ck_status == SKG_OK, "%s: %s (%s)", #call, skg_status_name(ck_status),                 \
                      skg_last_error());                                                                     \
    } while (0)

/* The call must fail with this status, and its sentence must hold this text. */
#define ck_skg_fails(call, expected, text)                                                                   \
    do {                                                                                                     \
        skg_status ck_status = (call);                                                                       \
        ck_assert_msg(ck_status == (expected), "%s: %s instead of %s (%s)", #call,                           \
                      skg_status_name(ck_status), skg_status_name(expected), skg_last_error());              \
        ck_assert_msg(strstr(skg_last_error(), (text)) != NULL, "%s: \"%s\" does not say \"%s\"", #call,     \
                      skg_last_error(), (text));                                                             \
    } while (0)

#endif
