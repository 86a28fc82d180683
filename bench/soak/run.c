/* A long mixed run of everything that a host does with the library and the command: the bits stay the same, and memory, file
 * handles, threads and folders do not grow. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "soak.h"

#include "support/random.h"

#include <skiagraph/scanning.h>

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const char usage[] =
    "[--quick (no children)] [--seconds N] [--seed S] [--into FOLDER] [--device CONFIG]\n"
    "    [--fault piece | heap | handle | file | bits]";

/* By how much memory may grow: 3,000 rounds change the heap by 80 KiB (pools of the C library) and the resident size by 5 MiB up
 * and down (bench/README.md). For a kernel that is compiled only after the warm-up PoCL keeps up to 3 MiB for good. */
enum { HEAP_ALLOWED_KIB = 1024, RESIDENT_ALLOWED_KIB = 16 * 1024, KERNEL_ALLOWED_KIB = 4 * 1024, ROWS = 10 };
enum { FAULT_BYTES = 4 << 20 };

static const struct {
    const char *name;
    soak_round round;
    int weight; /* how often it is drawn */
    int is_child;
} kinds[] = {{"images in one job", soak_frames, 8, 0},
             {"images in several jobs", soak_jobs, 6, 0},
             {"scans", soak_scan, 6, 0},
             {"files, continued", soak_file, 6, 0},
             {"two threads, two contexts", soak_two_contexts, 4, 0},
             {"two threads, one context", soak_one_context, 4, 0},
             {"new contexts", soak_new_contexts, 1, 0},
             {"scans of the command, killed", soak_killed_scan, 2, 1},
             {"images of the command, killed", soak_killed_image, 1, 1},
             {"MPI pairs", soak_mpi, 1, 1}};
enum { KINDS = sizeof kinds / sizeof *kinds, MPI = KINDS - 1 };

static const char *const faults[FAULT_COUNT] = {"none", "piece", "heap", "handle", "file", "bits"};

typedef struct {
    long seconds;
    int quick;
    int64_t rounds[KINDS], total;
} progress;

static int find_fault(const char *name) {
    for (int k = 0; k < FAULT_COUNT; k++)
        if (strcmp(name, faults[k]) == 0) return k;
    bench_die("there is no fault %s", name);
}

/* The command is the program skiagraph beside this one. */
static const char *find_command(const char *self) {
    static char path[SOAK_PATH + 16];
    const char *slash = strrchr(self, '/');
    snprintf(path, sizeof path, "%.*sskiagraph", slash ? (int)(slash - self) + 1 : 0, self);
    char *whole = slash ? realpath(path, NULL) : NULL;
    if (slash && !whole) bench_die("%s is not there; build the target skiagraph_command", path);
    if (whole) snprintf(path, sizeof path, "%s", whole);
    free(whole);
    return path;
}

static void read_settings(int count, char **words, soak *s, progress *p) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL, *into = "/tmp";
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    s->seed = (uint64_t)now.tv_sec % 1000000;
    *p = (progress){.seconds = 60};
    while (arguments.next < arguments.count) {
        long number = 0;
        if (bench_flag(&arguments, "--quick"))
            p->quick = 1;
        else if (bench_option(&arguments, "--seconds", &value))
            bench_numbers(value, 0, 1000000, 1, &p->seconds);
        else if (bench_option(&arguments, "--seed", &value))
            bench_numbers(value, 0, 1000000000, 1, &number), s->seed = (uint64_t)number;
        else if (bench_option(&arguments, "--fault", &value))
            s->fault = find_fault(value);
        else if (!bench_option(&arguments, "--into", &into) &&
                 !bench_option(&arguments, "--device", &s->device))
            bench_usage(&arguments, usage);
    }
    s->state = s->seed;
    s->command = find_command(words[0]);
    if (snprintf(s->folder, sizeof s->folder, "%s/skg-soak-XXXXXX", into) >= (int)sizeof s->folder ||
        !mkdtemp(s->folder))
        bench_die("no folder can be made in %s", into);
}

/* Makes the fault of --fault. The compiler must not see that the memory is lost. */
static void misbehave(const soak *s) {
    static void *volatile lost;
    char path[SOAK_PATH + 16];
    skg_mesh *mesh = NULL;
    if (s->fault == FAULT_PIECE) bench_try(skg_mesh_create_cube(1, &mesh), "mesh");
    if (s->fault == FAULT_HEAP) lost = memset(malloc(FAULT_BYTES), 1, FAULT_BYTES);
    if (s->fault == FAULT_HANDLE && !fopen("/dev/null", "r")) bench_die("no file can be opened");
    snprintf(path, sizeof path, "%s/lost.part-1", s->folder);
    if (s->fault == FAULT_FILE) fclose(bench_open(path));
    (void)lost;
}

static void take_round(soak *s, progress *p, int kind, int64_t number) {
    if ((kinds[kind].is_child && p->quick) || (kind == MPI && !s->has_mpi)) return;
    kinds[kind].round(s, number);
    p->rounds[kind]++, p->total++;
    misbehave(s);
}

static int draw_kind(soak *s) {
    int64_t all = 0;
    for (int k = 0; k < KINDS; k++) all += kinds[k].weight;
    int64_t at = draw_below(&s->state, all);
    for (int k = 0; k < KINDS; k++)
        if ((at -= kinds[k].weight) < 0) return k;
    return 0;
}

/* Every kind for every variant, those by children twice. */
static void warm_up(soak *s, progress *p) {
    for (int kind = 0; kind < KINDS; kind++)
        for (int64_t v = 0; v < (kinds[kind].is_child ? 2 : SOAK_VARIANTS); v++) take_round(s, p, kind, v);
    s->cases = SOAK_VARIANTS;
}

/* With new contexts, since PoCL keeps some memory of plans until the last context is released. */
static soak_health measure(soak *s, const progress *p, double begun) {
    soak_new_contexts(s, 0);
    const soak_health h = soak_health_now();
    printf("| %.0f | %lld | %ld | %ld | %d | %d | %d |\n", (bench_now() - begun) / 1e3, (long long)p->total,
           h.resident_kib, h.heap_kib, h.kernels, h.handles, h.threads);
    fflush(stdout);
    return h;
}

static void judge_memory(const soak_health *before, const soak_health *now) {
    const int kernels = now->kernels - before->kernels;
    const long resident = now->resident_kib - before->resident_kib, heap = now->heap_kib - before->heap_kib;
    const long resident_allowed = RESIDENT_ALLOWED_KIB + (long)kernels * KERNEL_ALLOWED_KIB;
    const long heap_allowed = HEAP_ALLOWED_KIB + (long)kernels * KERNEL_ALLOWED_KIB;
    if (resident > resident_allowed || heap > heap_allowed)
        bench_die(
            "memory has grown since the warm-up: by %ld KiB resident (allowed: %ld), by %ld KiB of heap (allowed: %ld, of which "
            "%d for each of %d kernels that were compiled)",
            resident, resident_allowed, heap, heap_allowed, KERNEL_ALLOWED_KIB, kernels);
}

static void judge(soak_health before, soak_health now) {
    if (now.handles > before.handles)
        bench_die("%d file handles more than after the warm-up", now.handles - before.handles);
    if (now.threads > before.threads)
        bench_die("%d threads more than after the warm-up", now.threads - before.threads);
}

/* Until the time is over, with a row of the table for each tenth of it. */
static void take_rounds(soak *s, progress *p, double begun) {
    soak_health h[ROWS + 1] = {measure(s, p, begun)};
    const double start = bench_now(), part = (1e3 * (double)p->seconds - (start - begun)) / ROWS;
    for (int row = 1; row <= ROWS; row++) {
        while (bench_now() - start < row * part) {
            const int kind = draw_kind(s);
            const int is_new = draw_below(&s->state, 2) && s->cases < SOAK_CASES;
            take_round(s, p, kind, is_new ? s->cases++ : draw_below(&s->state, s->cases));
        }
        h[row] = measure(s, p, begun);
        judge(h[0], h[row]);
    }
    judge_memory(&h[0], &h[ROWS]);
}

static void report(const soak *s, const progress *p) {
    printf("\n| rounds | of |\n|---:|---|\n");
    for (int k = 0; k < KINDS; k++) printf("| %lld | %s |\n", (long long)p->rounds[k], kinds[k].name);
    printf(
        "\n%lld scenes, %lld projections in this process. Children started and killed: %lld, of which %lld had not ended by "
        "themselves.\n",
        (long long)s->cases, (long long)s->frames, (long long)s->restarts, (long long)s->kills);
    printf(
        "Equal bits; memory, handles, threads and the folder are flat (allowed: %d KiB of heap, %d KiB resident, %d KiB for each "
        "kernel compiled meanwhile, no handle, no thread).\n",
        HEAP_ALLOWED_KIB, RESIDENT_ALLOWED_KIB, KERNEL_ALLOWED_KIB);
}

/* Nothing is left: no piece of memory of the library's, no child, no file. */
static void end(soak *s) {
    int64_t pieces = 0;
    for (int k = 0; k < 2; k++) skg_context_release(&s->contexts[k]);
    bench_try(skg_allocation_count(&pieces), "memory");
    if (pieces) bench_die("%lld pieces of the library's memory were never released", (long long)pieces);
    if (waitpid(-1, NULL, WNOHANG) >= 0) bench_die("a child was never waited for");
    soak_folder_check(s, NULL, "the run");
    rmdir(s->folder);
}

int main(int count, char **words) {
    static soak s;
    progress p;
    read_settings(count, words, &s, &p);
    printf("Seed %llu: repeat with --seed %llu.\n", (unsigned long long)s.seed, (unsigned long long)s.seed);
    fflush(stdout);
    const double begun = bench_now();
    s.has_hdf5 = skg_scan_file_path_check("scan.h5") == SKG_OK;
    s.has_mpi = !p.quick && soak_mpi_is_there(&s);
    if (!p.quick && !s.has_mpi) printf("skipped: MPI pairs, because there is no mpirun\n");
    printf(
        "\n| s | rounds | resident KiB | heap KiB | kernels | handles | threads |\n|---:|---:|---:|---:|---:|---:|---:|\n");
    fflush(stdout);
    for (int k = 0; k < 2; k++) bench_try(skg_context_create(s.device, &s.contexts[k]), "context");
    warm_up(&s, &p);
    take_rounds(&s, &p, begun);
    end(&s);
    report(&s, &p);
    return 0;
}
