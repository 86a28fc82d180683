/* A Check program in one line: SKG_SUITE_MAIN("name", add_tests) with add_tests(TCase *). */
#ifndef SKG_TESTS_SUITE_H
#define SKG_TESTS_SUITE_H

#include <check.h>
#include <stdlib.h>

#define SKG_SUITE_MAIN(name, add_tests)                                                                      \
    int main(void) {                                                                                         \
        Suite *suite = suite_create(name);                                                                   \
        TCase *tests = tcase_create(name);                                                                   \
        add_tests(tests);                                                                                    \
        suite_add_tcase(suite, tests);                                                                       \
        SRunner *runner = srunner_create(suite);                                                             \
        srunner_run_all(runner, CK_ENV);                                                                     \
        int failed = srunner_ntests_failed(runner);                                                          \
        srunner_free(runner);                                                                                \
        return failed ? EXIT_FAILURE : EXIT_SUCCESS;                                                         \
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
