/* Progress on a terminal while the command works. */
#include "cli/command.h"

#include <pty.h>
#include <time.h>

/* With empty caches the device is tested and programs are compiled, for seconds. The line begins after one second; a busy machine
 * has two more. */
static const double SILENT_S = 3;

static const char scene[] =
    "{\"Source\": {\"Position\": [0, -400, 0, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},"
    "\"Detector\": {\"Position\": [0, 200, 0, \"mm\"], \"UpVector\": [0, 0, 1], \"NumberOfPixels\": [32, 24],"
    "\"Size\": [320, 240, \"mm\"]},"
    "\"Samples\": [{\"Label\": \"cube\", \"Cube\": [60, \"mm\"], \"Material\": [\"mu\", 0.2]}]}";

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

START_TEST(a_cold_start_is_not_silent) {
    char bytes[4096], text[128];
    int terminal = -1, status = -1;
    ssize_t count;
    write_text("s.json", scene);
    const double begin = now();
    double first = 0;
    const pid_t child = forkpty(&terminal, NULL, NULL, NULL);
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        snprintf(text, sizeof text, "%s/cold", folder);
        setenv("SKG_CACHE_DIR", text, 1);
        setenv("POCL_CACHE_DIR", text, 1);
        if (chdir(folder) == 0)
            execl(SKG_COMMAND, "skiagraph", "image", "s.json", "-o", "a.png", (char *)NULL);
        _exit(127);
    }
    while ((count = read(terminal, bytes, sizeof bytes)) > 0)
        if (first == 0) first = now() - begin;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert_int_eq(status, 0);
    close(terminal);
    snprintf(text, sizeof text, "rm -rf %s/cold", folder);
    ck_assert_int_eq(system(text), 0);
    ck_assert_double_lt(first, SILENT_S);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_cold_start_is_not_silent);
}

SKG_SUITE_MAIN("terminal", add_tests)
