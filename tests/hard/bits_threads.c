/* Writes the bits of images to the file named by SKG_BITS_FILE: run with different numbers of threads, the
 * files must be equal (threads.cmake). */
#include "hard/scenes.h"
#include "suite.h"

#include <stdio.h>
#include <string.h>

START_TEST(write_bits) {
    const char *path = getenv("SKG_BITS_FILE");
    ck_assert_msg(path != NULL, "SKG_BITS_FILE is not set");
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    for (int which = 0; which < HARD_SCENES; which++) {
        hard_scene h = hard_make(which);
        for (int32_t precision = 0; precision < (run_has_double() ? 2 : 1); precision++) {
            uint64_t first = 0;
            for (int32_t strategy = SKG_STRATEGY_AUTO; strategy <= SKG_STRATEGY_ATOMICS; strategy++) {
                double *image = run_solid(&h.body, h.pose, &h.view,
                                          (run_choice){.strategy = strategy, .precision = precision});
                const uint64_t hash = run_hash(image, h.view.rows * h.view.columns * (int64_t)sizeof *image);
                if (strategy == SKG_STRATEGY_AUTO) first = hash;
                ck_assert_msg(hash == first, "%s, precision %d: strategy %d gives other bits", h.name,
                              (int)precision, (int)strategy);
                fprintf(file, "%016llx %s, precision %d, strategy %d\n", (unsigned long long)hash, h.name,
                        (int)precision, (int)strategy);
                free(image);
            }
        }
        hard_free(&h);
    }
    ck_assert_int_eq(fclose(file), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, write_bits);
}

SKG_SUITE_MAIN("bits_threads", add_tests)
