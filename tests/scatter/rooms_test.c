/* The judge of rooms judged: photons that are counted where they arrive, and the expected contributions of interactions. */
#include "rooms.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COUNTED = 300000, EXPECTED = 30000 };

static const room *find(const char *name) {
    for (int i = 0; i < rooms_count; i++)
        if (strstr(rooms[i].name, name)) return &rooms[i];
    ck_abort_msg("no room %s", name);
}

/* Boxes, rods in a box, several materials and energies, lead, and a world: all ways of the code but balls. */
START_TEST(both_methods_agree) {
    static const char *const names[] = {"lead .5 mm", "hand", "ten materials", "casting", "world of air"};
    const room *r = find(names[_i]);
    const room_truth a = room_follow(r, ROOM_ANALOGUE, _i < 3 ? COUNTED : 4 * COUNTED, 5),
                     b = room_follow(r, ROOM_EXPECTED, EXPECTED, 6);
    printf("%s: %.5f +- %.5f, %.5f +- %.5f\n", r->name, a.ratio, a.ratio_sigma, b.ratio, b.ratio_sigma);
    fflush(stdout);
    /* four standard errors */
    ck_assert_double_eq_tol(a.ratio, b.ratio, 4 * hypot(a.ratio_sigma, b.ratio_sigma));
    double square = 0; /* over its expectation, which is 1 +- sqrt(2 / ROOM_BLOCKS) = .35 */
    for (int k = 0; k < ROOM_BLOCKS; k++)
        square +=
            pow(a.scatter[k] - b.scatter[k], 2) / (pow(a.sigma[k], 2) + pow(b.sigma[k], 2)) / ROOM_BLOCKS;
    /* four of those */
    ck_assert_double_lt(square, 1 + 4 * 0.35);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, both_methods_agree, 0, 5);
}

SKG_SUITE_MAIN("scatter/rooms", add_tests)
