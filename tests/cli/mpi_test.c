/* A scan that the processes of an MPI job share. */
#include "cli/command.h"

#include "cli/scene.h"
#include "support/random.h"

#include <signal.h>
#include <time.h>

enum { BYTES_MAX = 1 << 25 };

static char bytes[BYTES_MAX], before[BYTES_MAX];

static const char scan[] = "--set 'Scan={\"NumberOfProjections\":300,\"FinalAngle\":360}' "
                           "--set 'Detector.NumberOfPixels=[130,98]'";

static void set_up_scan(void) {
    set_up();
    write_text("scene.json", scene);
}

static void tear_down_scan(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

static size_t read_file(const char *name, char *to) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_msg(stream != NULL, "no %s", name);
    const size_t count = fread(to, 1, BYTES_MAX, stream);
    fclose(stream);
    return count;
}

/* mpirun with the ranks' environment; it replaces the shell, so that the ranks are its children. Under ASan leaks are not
 * reported there: what Open MPI's plugins keep has no name any more when they are unloaded, so none can be suppressed. */
static pid_t start(const char *words) {
    char line[2048];
    snprintf(
        line, sizeof line,
        "cd %s && export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 POCL_MAX_PTHREAD_COUNT=1 "
        "ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 && "
        "exec %s --oversubscribe -n 2 %s scan scene.json %s %s >.said 2>.complained </dev/null",
        folder, SKG_MPIRUN, SKG_COMMAND, scan, words);
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", line, (char *)NULL);
        _exit(127);
    }
    return child;
}

static int wait_for(pid_t child) {
    int status = 0;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    return status;
}

/* A rank of mpirun: a child process that runs the command. 0: none. */
static pid_t find_rank(pid_t parent) {
    pid_t found = 0;
    DIR *directory = opendir("/proc");
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        char path[300], text[512];
        int its = 0;
        char name[64] = "";
        if (entry->d_name[0] < '0' || entry->d_name[0] > '9') continue;
        snprintf(path, sizeof path, "/proc/%s/stat", entry->d_name);
        FILE *stream = fopen(path, "rb");
        if (!stream) continue;
        text[fread(text, 1, sizeof text - 1, stream)] = '\0';
        fclose(stream);
        if (sscanf(text, "%*d (%63[^)]) %*c %d", name, &its) == 2 && its == (int)parent &&
            strcmp(name, "skiagraph") == 0)
            found = (pid_t)atoi(entry->d_name);
    }
    if (directory) closedir(directory);
    return found;
}

/* Open MPI 4.1 may wait for ever if a rank is killed while the ranks find each other. Whatever it started is then killed, too:
 * what counts is what the next job finds. */
static void end_job(pid_t child) {
    enum { TENTHS = 300 };
    const struct timespec tenth = {.tv_nsec = 100000000};
    for (int k = 0; k < TENTHS; k++) {
        const pid_t ended = waitpid(child, NULL, WNOHANG);
        ck_assert(ended == 0 || ended == child);
        if (ended == child) return;
        nanosleep(&tenth, NULL);
    }
    for (pid_t rank; (rank = find_rank(child)) > 0; nanosleep(&tenth, NULL)) kill(rank, SIGKILL);
    kill(child, SIGKILL);
    wait_for(child);
}

START_TEST(two_ranks_make_the_scan_of_one) {
    ck_run(0, "scan scene.json %s -o whole.mha --quiet", scan);
    const int status = wait_for(start("-o shared.mha --quiet"));
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "mpirun: %d", status);
    const size_t size = read_file("whole.mha", before);
    ck_assert_uint_eq(read_file("shared.mha", bytes), size);
    ck_assert_mem_eq(bytes, before, size);
    ck_assert(!has_file("shared.mha.progress") && !has_file("shared.mha.lock"));
}
END_TEST

/* A rank is killed at random moments; what was finished stays, and the same command finishes the scan. */
START_TEST(a_killed_rank_loses_nothing) {
    enum { KILLS = 5 };
    uint64_t state = 5;
    ck_run(0, "scan scene.json %s -o whole.mha --quiet", scan);
    for (int kills = 0; kills < KILLS; kills++) {
        const pid_t child = start("-o shared.mha --quiet");
        const struct timespec pause = {.tv_nsec = (long)draw(&state, 3e8, 9e8)};
        nanosleep(&pause, NULL);
        const pid_t rank = find_rank(child);
        if (rank > 0) kill(rank, SIGKILL);
        end_job(child);
    }
    const int status = wait_for(start("-o shared.mha --quiet"));
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "mpirun: %d", status);
    const size_t size = read_file("whole.mha", before);
    ck_assert_uint_eq(read_file("shared.mha", bytes), size);
    ck_assert_mem_eq(bytes, before, size);
}
END_TEST

/* Clipped pixels of all ranks are one sum, and one warning. */
START_TEST(two_ranks_warn_once) {
    static const char bright[] = "--set 'Detector.GreyValues={\"Full\":100000}'";
    static const char sentence[] = " pixels of the projections are at 65535";
    char words[200];
    ck_run(0, "scan scene.json %s %s -o alone.mha", scan, bright);
    const char *alone = strstr(complained, "warning: ");
    ck_assert_msg(alone && strstr(alone, sentence), "%s", complained);
    snprintf(words, sizeof words, "%s -o shared.mha", bright);
    const int status = wait_for(start(words));
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "mpirun: %d", status);
    bytes[read_file(".complained", bytes)] = '\0';
    const char *first = strstr(bytes, "warning: "), *said_at = first ? strstr(first, sentence) : NULL;
    ck_assert_msg(said_at && !strstr(said_at + 1, sentence), "%s", bytes);
    ck_assert_int_eq(strtol(first + 9, NULL, 10), strtol(alone + 9, NULL, 10));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scan, tear_down_scan);
    tcase_add_test(tests, two_ranks_make_the_scan_of_one);
    tcase_add_test(tests, a_killed_rank_loses_nothing);
    tcase_add_test(tests, two_ranks_warn_once);
}

SKG_SUITE_MAIN("mpi", add_tests)
