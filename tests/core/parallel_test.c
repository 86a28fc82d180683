/* Items shared by threads. */
#include "core/threads.h"
#include "suite.h"

#include <string.h>

enum { ITEMS = 1000 };

typedef struct {
    atomic_int done[ITEMS];
    int64_t first_bad; /* this item and all behind it fail */
} record;

static skg_status note(void *user, int64_t item) {
    record *r = user;
    atomic_fetch_add(&r->done[item], 1);
    return item < r->first_bad ? SKG_OK : skg_fail(SKG_ERR_MESH, "item %d", (int)item);
}

START_TEST(each_item_is_done_once) {
    static record r = {.first_bad = ITEMS};
    ck_skg(skg_parallel(ITEMS, note, &r));
    for (int i = 0; i < ITEMS; i++) ck_assert_int_eq(atomic_load(&r.done[i]), 1);
    ck_skg(skg_parallel(0, note, &r));
}
END_TEST

START_TEST(the_first_failure_is_reported) {
    static record r;
    for (int64_t bad = 0; bad < ITEMS; bad += 37) {
        char expected[32];
        memset(&r, 0, sizeof r);
        r.first_bad = bad;
        snprintf(expected, sizeof expected, "item %d", (int)bad);
        ck_skg_fails(skg_parallel(ITEMS, note, &r), SKG_ERR_MESH, expected);
        ck_assert_str_eq(skg_last_error(), expected);
        for (int64_t i = 0; i <= bad; i++) ck_assert_int_eq(atomic_load(&r.done[i]), 1);
    }
}
END_TEST

static skg_status nested(void *user, int64_t item) {
    (void)item;
    return skg_parallel(ITEMS, note, user);
}

START_TEST(an_item_may_be_shared_again) {
    static record r = {.first_bad = ITEMS};
    ck_skg(skg_parallel(4, nested, &r));
    for (int i = 0; i < ITEMS; i++) ck_assert_int_eq(atomic_load(&r.done[i]), 4);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, each_item_is_done_once);
    tcase_add_test(tests, the_first_failure_is_reported);
    tcase_add_test(tests, an_item_may_be_shared_again);
}

SKG_SUITE_MAIN("parallel", add_tests)
