/* The catalogue of hard cases, one line each. Exit status 1 when one fails. HARD_CASE=NUMBER: only that one.
 */
#include "hard/catalogue.h"
#include "suite.h"

#include <stdio.h>
#include <string.h>

static void print_errors(const hard_outcome *o) {
    if (o->worst[0] >= 0) printf(" | single %.1e of %.1e", o->worst[0], o->bar[0]);
    if (o->worst[1] >= 0)
        printf(" | %s%.1e of %.1e", o->worst[0] >= 0 ? "double " : "", o->worst[1], o->bar[1]);
    if (*o->unit) printf(" %s", o->unit);
}

START_TEST(a_case) {
    hard_outcome o;
    const char *wanted = getenv("HARD_CASE");
    if (wanted && atoi(wanted) != _i) return;
    hard_case_run(_i, &o);
    printf("%-46s | %s", o.name, o.danger);
    print_errors(&o);
    if (o.slower > 0) printf(" | time x%.1f", o.slower);
    if (*o.fault)
        printf(" | FAILS: %s\n", o.fault);
    else
        printf(" | holds\n");
    fflush(stdout);
    ck_assert_msg(!*o.fault, "%s: %s", o.name, o.fault);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, a_case, 0, hard_case_count());
}

SKG_SUITE_MAIN(
    "hard cases: what could go wrong, worst error of the bar, time against an ordinary scene, verdict",
    add_tests)
