/* A command that a signal ends leaves no unfinished file. */
#include "cli/command.h"

#include <fcntl.h>
#include <signal.h>
#include <time.h>

/* A file in the folder that is not finished. */
static int unfinished(const char *place) {
    int found = 0;
    DIR *directory = opendir(place);
    for (struct dirent *entry; directory && (entry = readdir(directory));)
        found |= strstr(entry->d_name, ".part-") != NULL;
    if (directory) closedir(directory);
    return found;
}

static pid_t start(const char *place) {
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child) return child;
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 2);
    execl(SKG_COMMAND, "skiagraph", "thorax", "-o", place, "--triangles", "300000", "--quiet", (char *)NULL);
    _exit(127);
}

/* Stops the command while a file is unfinished; 0: it ended before. */
static int stop_within_a_file(pid_t child, const char *place) {
    const struct timespec pause = {.tv_nsec = 100000};
    for (;;) {
        int status;
        if (waitpid(child, &status, WNOHANG) == child) return 0;
        if (unfinished(place)) {
            kill(child, SIGSTOP);
            ck_assert_int_eq(waitpid(child, &status, WUNTRACED), child);
            if (!WIFSTOPPED(status)) return 0;
            if (unfinished(place)) return 1;
            kill(child, SIGCONT);
        }
        nanosleep(&pause, NULL);
    }
}

/* A command that is stopped while a file is unfinished. A busy machine may show no such moment of a run; then it is run again. */
static pid_t start_and_stop(const char *place) {
    pid_t child;
    do child = start(place);
    while (!stop_within_a_file(child, place));
    return child;
}

START_TEST(nothing_unfinished_is_left) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU};
    const int number = numbers[_i];
    int status = 0;
    const pid_t child = start_and_stop(folder);
    kill(child, number);
    kill(child, SIGCONT);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFSIGNALED(status) && WTERMSIG(status) == number);
    ck_assert(!unfinished(folder));
}
END_TEST

START_TEST(what_was_ignored_stays_so) {
    signal(SIGHUP, SIG_IGN);
    int status = 0;
    const pid_t child = start_and_stop(folder);
    signal(SIGHUP, SIG_DFL);
    kill(child, SIGHUP);
    kill(child, SIGCONT);
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, nothing_unfinished_is_left, 0, 5);
    tcase_add_test(tests, what_was_ignored_stays_so);
}

SKG_SUITE_MAIN("interrupt", add_tests)
