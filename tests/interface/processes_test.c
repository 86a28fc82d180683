/* Threads, forks and signals around the start of OpenCL. Check runs each test in a process of its own, so every test sees
 * the first start. */
#define _GNU_SOURCE /* sched_setaffinity */
#include "suite.h"
#include "support/run.h"
#include "support/threads.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static int32_t units_of(skg_context *context) {
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(context, &info));
    return info.compute_units;
}

/* --- threads */

typedef struct {
    pthread_barrier_t *together;
    skg_context *context;
    skg_status status;
} opener;

static void *open_context(void *argument) {
    opener *o = argument;
    pthread_barrier_wait(o->together);
    o->status = skg_context_create(NULL, &o->context);
    return NULL;
}

/* PoCL 3.1 crashes if two threads start it. */
START_TEST(threads_that_start_at_once) {
    enum { THREADS = 4 };
    pthread_barrier_t together;
    pthread_t threads[THREADS];
    opener openers[THREADS];
    pthread_barrier_init(&together, NULL, THREADS);
    for (int n = 0; n < THREADS; n++) {
        openers[n] = (opener){.together = &together};
        ck_assert_int_eq(pthread_create(&threads[n], NULL, open_context, &openers[n]), 0);
    }
    for (int n = 0; n < THREADS; n++) {
        ck_assert_int_eq(pthread_join(threads[n], NULL), 0);
        ck_assert_int_eq(openers[n].status, SKG_OK);
        skg_context_release(&openers[n].context);
    }
    pthread_barrier_destroy(&together);
}
END_TEST

/* Renders on a context, which compiles and launches. */
static void render(skg_context *context) {
    const skg_view view = run_view(32, 4);
    solid sphere = solid_sphere(40, 20, 10);
    run_context = context;
    free(run_solid(&sphere, NULL, &view, (run_choice){0}));
    solid_free(&sphere);
}

/* Signals that the driver's threads must not take from the program; those of a fault stay open. */
START_TEST(threads_of_the_driver) {
    static thread_state before[THREADS_MAX], after[THREADS_MAX];
    skg_context *context = NULL;
    const int had = threads_list(before);
    int made = 0;
    ck_skg(skg_context_create(NULL, &context));
    render(context);
    const int has = threads_list(after);
    for (int n = 0; n < has; n++) {
        int old = 0;
        for (int k = 0; k < had; k++) old |= before[k].id == after[n].id;
        if (old) continue;
        made++;
        const int taken[] = {SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM, SIGCHLD};
        for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
            ck_assert_msg(after[n].blocked >> (taken[k] - 1) & 1, "signal %d is open", taken[k]);
        ck_assert_msg(!(after[n].blocked >> (SIGSEGV - 1) & 1), "SIGSEGV is blocked");
    }
    for (int n = 0; n < had; n++)
        for (int k = 0; k < has; k++)
            if (before[n].id == after[k].id) ck_assert_uint_eq(before[n].blocked, after[k].blocked);
    skg_context_release(&context);
    if (made == 0) skip_test("this driver makes no threads that /proc shows");
}
END_TEST

/* --- CPUs */

/* The CPUs of this thread, the first of them alone in `one`. */
static int cpus_of_this(cpu_set_t *all, cpu_set_t *one) {
    size_t first = 0;
    ck_assert_int_eq(sched_getaffinity(0, sizeof *all, all), 0);
    while (!CPU_ISSET(first, all)) first++;
    CPU_ZERO(one);
    CPU_SET(first, one);
    return CPU_COUNT(all);
}

static int is_pocl(void) {
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_device_get(0, &info));
    return strstr(info.platform_name, "Portable Computing Language") != NULL;
}

static void hear(int32_t level, const char *sentence, void *user) {
    ck_assert_int_eq(level, SKG_LOG_WARNING);
    snprintf(user, 256, "%s", sentence);
}

/* A rank that is bound to one core of a node with eight. PoCL makes as many workers as there are cores. */
START_TEST(a_rank_on_one_core) {
    static thread_state states[THREADS_MAX];
    cpu_set_t all, one, now;
    skg_context *context = NULL;
    char warning[256] = "";
    const int cpus = cpus_of_this(&all, &one);
    setenv("POCL_MAX_PTHREAD_COUNT", "8", 1);
    ck_assert_int_eq(sched_setaffinity(0, sizeof one, &one), 0);
    ck_skg(skg_context_create("device=cpu", &context));
    ck_skg(skg_context_log_set(context, hear, warning));
    ck_assert_int_eq(units_of(context), 1);
    if (is_pocl()) {
        ck_assert_ptr_nonnull(strstr(warning, "8 threads"));
        ck_assert_ptr_nonnull(strstr(warning, "if POCL_MAX_PTHREAD_COUNT is set to 1 before"));
    }
    render(context);
    skg_context_release(&context);
    ck_skg(skg_context_create("device=cpu threads=3", &context)); /* as asked, whatever is allowed */
    if (is_pocl()) ck_assert_int_eq(units_of(context), 3);
    skg_context_release(&context);
    const int count = threads_list(states);
    for (int n = 0; n < count; n++) ck_assert_str_eq(states[n].cpus, states[0].cpus);
    ck_assert_int_eq(sched_getaffinity(0, sizeof now, &now), 0);
    ck_assert(CPU_EQUAL(&now, &one));
    if (cpus == 1) skip_test("one CPU only");
}
END_TEST

/* Run with OMP_PROC_BIND=true: OpenMP has bound this thread to one of its places, and the driver uses them all. */
START_TEST(bound_by_openmp) {
    static thread_state states[THREADS_MAX];
    cpu_set_t all, one;
    skg_context *context = NULL;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const int cpus = cpus_of_this(&all, &one);
    int wider = 0;
    if (cores == 1 || cpus == cores) skip_test("OpenMP has bound no thread, or there is one core only");
    ck_skg(skg_context_create("device=cpu", &context));
    render(context);
    const int count = threads_list(states);
    for (int n = 0; n < count; n++) wider += strcmp(states[n].cpus, states[0].cpus) != 0;
    ck_assert_int_gt(wider, 0);
    ck_assert_int_gt(units_of(context), 1);
    skg_context_release(&context);
    cpu_set_t now;
    ck_assert_int_eq(sched_getaffinity(0, sizeof now, &now), 0);
    ck_assert(CPU_EQUAL(&now, &all));
}
END_TEST

/* --- fork */

/* Runs `ask` in a child; its answer is the exit status. */
static int in_child(int (*ask)(void)) {
    int result = -1;
    const pid_t child = fork();
    if (child == 0) {
        alarm(60); /* a child that hangs ends */
        _exit(ask());
    }
    ck_assert_int_eq(waitpid(child, &result, 0), child);
    return WIFEXITED(result) ? WEXITSTATUS(result) : -1;
}

static int all_refuse(void) {
    skg_context *context = NULL;
    skg_device_info info;
    int64_t count = 0;
    skg_device_info_init(&info);
    if (skg_context_create(NULL, &context) != SKG_ERR_FORK || context) return 1;
    if (!strstr(skg_last_error(), "exec or spawn")) return 2;
    if (skg_device_count(&count) != SKG_ERR_FORK) return 3;
    if (skg_device_get(0, &info) != SKG_ERR_FORK) return 4;
    if (run_context && skg_context_device_get(run_context, &info) != SKG_ERR_FORK) return 5;
    skg_context_release(&run_context);
    return 0;
}

START_TEST(a_fork_after_the_start) {
    ck_skg(skg_context_create(NULL, &run_context));
    ck_assert_int_eq(in_child(all_refuse), 0);
    render(run_context); /* the parent is as it was */
    skg_context_release(&run_context);
    ck_assert_int_eq(in_child(all_refuse), 0);
}
END_TEST

static int works(void) {
    skg_context *context = NULL;
    if (skg_context_create(NULL, &context) != SKG_OK) return 1;
    skg_context_release(&context);
    return 0;
}

START_TEST(a_fork_before_the_start) {
    ck_assert_int_eq(in_child(works), 0);
    ck_assert_int_eq(works(), 0);
    ck_assert_int_ne(in_child(works), 0);
}
END_TEST

/* --- signals */

static void handler(int number) {
    (void)number;
}

static void informed(int number, siginfo_t *information, void *context) {
    (void)number;
    (void)information;
    (void)context;
}

/* Check itself uses SIGALRM, SIGTERM and SIGINT, but not in a child. */
START_TEST(signal_handlers_stay) {
    static struct sigaction before[NSIG];
    struct sigaction after;
    skg_context *context = NULL;
    for (int n = 1; n < NSIG; n++) {
        struct sigaction mine = {.sa_flags = n % 2 ? SA_SIGINFO | SA_RESTART : 0};
        if (n % 2)
            mine.sa_sigaction = informed;
        else
            mine.sa_handler = n % 4 ? handler : SIG_IGN;
        sigaction(n, &mine, NULL); /* fails for those that cannot be caught */
        if (sigaction(n, NULL, &before[n]) != 0) before[n].sa_flags = -1;
    }
    ck_skg(skg_context_create(NULL, &context));
    render(context);
    skg_context_release(&context);
    for (int n = 1; n < NSIG; n++) {
        if (before[n].sa_flags == -1) continue;
        ck_assert_int_eq(sigaction(n, NULL, &after), 0);
        ck_assert_msg(after.sa_flags == before[n].sa_flags && after.sa_handler == before[n].sa_handler,
                      "signal %d has another handler", n);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    const char *binding = getenv("OMP_PROC_BIND");
    if (binding && strcmp(binding, "true") == 0) {
        tcase_add_test(tests, bound_by_openmp);
        return;
    }
    tcase_add_loop_test(tests, threads_that_start_at_once, 0, 5);
    tcase_add_test(tests, threads_of_the_driver);
    tcase_add_test(tests, a_rank_on_one_core);
    tcase_add_test(tests, a_fork_after_the_start);
    tcase_add_test(tests, a_fork_before_the_start);
    tcase_add_test(tests, signal_handlers_stay);
}

SKG_SUITE_MAIN("processes", add_tests)
