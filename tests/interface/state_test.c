/* Sets the caller's state to something unusual before the first call. The results have the bits of an ordinary process, and the state is as
 * it was. */
#define _GNU_SOURCE /* feenableexcept, sched_getaffinity */
#include "everything.h"
#include "suite.h"
#include "support/run.h"

#include <errno.h>
#include <fcntl.h>
#include <fenv.h>
#include <locale.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined __SSE__
#include <xmmintrin.h>
#endif

extern char **environ;

enum { LONGEST = 65536, TRAPS = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW };

typedef struct {
    everything done;
    float lengths[32 * 32];
    int64_t devices;
} results;

/* The calls, from the first that starts OpenCL on. */
static void call(results *r) {
    const skg_view view = run_view(32, 4);
    solid sphere = solid_sphere(40, 20, 10);
    memset(r, 0, sizeof *r);
    ck_skg(skg_device_count(&r->devices));
    run_open();
    do_everything(&r->done);
    double *lengths = run_solid(&sphere, NULL, &view, (run_choice){0});
    for (int n = 0; n < 32 * 32; n++) r->lengths[n] = (float)lengths[n];
    free(lengths);
    solid_free(&sphere);
    run_close();
}

/* In a process of its own. */
static void call_ordinarily(results *r) {
    int ends[2], result = -1;
    ck_assert_int_eq(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        call(r);
        _exit(write(ends[1], r, sizeof *r) != (ssize_t)sizeof *r);
    }
    close(ends[1]);
    size_t got = 0;
    for (ssize_t more; got < sizeof *r && (more = read(ends[0], (char *)r + got, sizeof *r - got)) > 0;)
        got += (size_t)more;
    close(ends[0]);
    ck_assert_int_eq(waitpid(child, &result, 0), child);
    ck_assert_msg(WIFEXITED(result) && WEXITSTATUS(result) == 0, "the ordinary process failed");
    ck_assert_uint_eq(got, sizeof *r);
}

static void handler(int number) {
    (void)number;
}

/* PoCL sets HWLOC_PLUGINS_PATH when it is loaded; everything else has to stay. */
static uint64_t hash_environment(void) {
    uint64_t hash = 0;
    for (char **word = environ; *word; word++)
        if (strncmp(*word, "HWLOC_PLUGINS_PATH=", 19) != 0)
            hash += run_hash(*word, (int64_t)strlen(*word)); /* in any order */
    return hash;
}

typedef struct {
    cpu_set_t cpus;
    sigset_t blocked;
    struct sigaction actions[NSIG];
    char locale[512], folder[512];
    locale_t of_thread;
    int rounding, traps, raised, is_open[3];
    unsigned control; /* of SSE */
    mode_t mask;
    uint64_t environment;
    long written; /* to the standard output */
} state;

static void look(state *s) {
    memset(s, 0, sizeof *s);
    ck_assert_int_eq(sched_getaffinity(0, sizeof s->cpus, &s->cpus), 0);
    ck_assert_int_eq(sigprocmask(SIG_BLOCK, NULL, &s->blocked), 0);
    for (int n = 1; n < NSIG; n++) {
        struct sigaction action;
        if (sigaction(n, NULL, &action) != 0) continue;
        s->actions[n].sa_handler = action.sa_handler;
        s->actions[n].sa_flags = action.sa_flags;
    }
    snprintf(s->locale, sizeof s->locale, "%s", setlocale(LC_ALL, NULL));
    s->of_thread = uselocale((locale_t)0);
    s->rounding = fegetround();
    s->traps = fegetexcept();
    s->raised = fetestexcept(FE_ALL_EXCEPT);
#if defined __SSE__
    s->control = _mm_getcsr() & ~0x3fu; /* without the exceptions that were raised */
#endif
    s->mask = umask(0);
    umask(s->mask);
    s->environment = hash_environment();
    ck_assert_ptr_nonnull(getcwd(s->folder, sizeof s->folder));
    for (int n = 0; n < 3; n++) s->is_open[n] = fcntl(n, F_GETFD) != -1;
    s->written = ftell(stdout);
}

/* A daemon has no standard input and no standard error. */
static void redirect(const char *path) {
    close(STDIN_FILENO);
    close(STDERR_FILENO);
    ck_assert_ptr_nonnull(freopen(path, "w", stdout));
    ck_assert_int_eq(setvbuf(stdout, NULL, _IOFBF, LONGEST), 0);
    ck_assert_int_gt(printf("not yet written"), 0);
}

static void become_unusual(const char *path) {
    cpu_set_t cpus, one;
    sigset_t blocked;
    size_t last = CPU_SETSIZE - 1;
    ck_assert_int_eq(sched_getaffinity(0, sizeof cpus, &cpus), 0);
    while (!CPU_ISSET(last, &cpus)) last--;
    CPU_ZERO(&one);
    CPU_SET(last, &one);
    ck_assert_int_eq(sched_setaffinity(0, sizeof one, &one), 0);
    for (int n = 1; n < NSIG; n++) {
        const struct sigaction action = {.sa_handler = n % 3 ? handler : SIG_IGN, .sa_flags = SA_RESTART};
        if (n != SIGCHLD && n != SIGALRM) sigaction(n, &action, NULL); /* system() and Check need these two */
    }
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGUSR2);
    sigaddset(&blocked, SIGRTMIN);
    ck_assert_int_eq(sigprocmask(SIG_BLOCK, &blocked, NULL), 0);
    umask(0);
    unsetenv("HOME");
    setenv("LC_ALL", "nowhere", 1);
    setenv("TMPDIR", "/nowhere", 1);
    ck_assert_int_eq(chdir("/"), 0);
    redirect(path);
    everything_comma(); /* where that can be made */
    uselocale(duplocale(LC_GLOBAL_LOCALE));
    srand(7);
}

/* Last of all, because it changes what this program computes. */
static void change_arithmetic(void) {
    feraiseexcept(FE_UNDERFLOW | FE_INEXACT); /* the second one by the calculations of this program */
    ck_assert_int_eq(fesetround(FE_UPWARD), 0);
#if defined __SSE__
    _mm_setcsr(_mm_getcsr() | 0x8040); /* subnormal numbers count as 0, as operands and as results */
#endif
    ck_assert_int_ne(feenableexcept(TRAPS), -1);
}

static void compare(const state *before, const state *after) {
    ck_assert(CPU_EQUAL(&after->cpus, &before->cpus));
    ck_assert_mem_eq(&after->blocked, &before->blocked, sizeof after->blocked);
    for (int n = 1; n < NSIG; n++)
        ck_assert_msg(after->actions[n].sa_handler == before->actions[n].sa_handler &&
                          after->actions[n].sa_flags == before->actions[n].sa_flags,
                      "signal %d has another handler", n);
    ck_assert_str_eq(after->locale, before->locale);
    ck_assert_ptr_eq(after->of_thread, before->of_thread);
    ck_assert_int_eq(after->rounding, FE_UPWARD);
    ck_assert_int_eq(after->traps, TRAPS);
    ck_assert_int_eq(after->raised, before->raised);
    ck_assert_uint_eq(after->control, before->control);
    ck_assert_uint_eq(after->mask, before->mask);
    ck_assert_uint_eq(after->environment, before->environment);
    ck_assert_str_eq(after->folder, before->folder);
    for (int n = 0; n < 3; n++) ck_assert_int_eq(after->is_open[n], before->is_open[n]);
    ck_assert_int_eq(after->written, before->written);
}

START_TEST(an_unusual_caller) {
    static results ordinary, unusual;
    static state before, after;
    char path[] = "/tmp/skg_state_XXXXXX", text[64] = "";
    const int file = mkstemp(path);
    ck_assert_int_ge(file, 0);
    call_ordinarily(&ordinary);
    become_unusual(path);
    change_arithmetic();
    look(&before);
    call(&unusual);
    look(&after);
    fesetenv(FE_DFL_ENV);
    const int drawn = rand();
    srand(7);
    ck_assert_int_eq(drawn, rand());
    compare(&before, &after);
    ck_assert_int_eq(read(file, text, sizeof text), 0); /* nothing has been flushed or written there */
    unlink(path);
    ck_assert_int_eq(unusual.devices, ordinary.devices);
    ck_assert_mem_eq(&unusual.done, &ordinary.done, sizeof ordinary.done);
    ck_assert_mem_eq(unusual.lengths, ordinary.lengths, sizeof ordinary.lengths);
    ck_assert(ordinary.lengths[32 * 16 + 16] > 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, an_unusual_caller);
}

SKG_SUITE_MAIN("state", add_tests)
