/* Compares two builds of the library: each is loaded by processes of its own, which take turns. The processes are this
 * program with another LD_LIBRARY_PATH. */
#include "contender.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char usage[] =
    "OLD NEW SCENE... [--frames N] [--turns N] [--rounds N] [--views N] [--size N]\n"
    "    [--set KEY=VALUE]... [--device CONFIG] [--csv FILE]\n"
    "OLD, NEW: folders of libskiagraph.so. SCENE: FILE.json, a mesh or a folder of them, sphere:N,\n"
    "soup:N, shuffled:N";

enum { OLD = 0, NEW = 1, BUILDS = 2, WORDS = 96, RATIOS = 512 };
static const char *const names[VERSUS_COUNT] = {
    "context", "scene", "plan", "first image", "warm frame", "moving frame", "a view of a batch"};

typedef struct {
    pid_t pid;
    int to, from;
} process;

/* The words of the command. */
typedef struct {
    versus_settings set;
    const char *csv;
    int contend;                 /* 1: this process is a contender */
    int operand_count;           /* folders and scenes */
    const char *operands[WORDS]; /* a contender has one, its scene */
    int option_count;
    char *options[WORDS]; /* for contenders */
} command;

/* Results of all rounds for one scene. */
typedef struct {
    bench_times times[VERSUS_COUNT][BUILDS];
    int ratio_count[VERSUS_COUNT];
    double ratios[VERSUS_COUNT][RATIOS];
    int differ[VERSUS_COUNT];
    versus_start start;
} results;

static void get(int from, void *what, size_t bytes, const char *folder) {
    char *to = what;
    while (bytes > 0) {
        const ssize_t got = read(from, to, bytes);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) bench_die("the process with the library in %s ended early", folder);
        to += got, bytes -= (size_t)got;
    }
}

/* Ends the program unless the process has loaded the library of this folder. */
static void check_library(const process *it, const char *folder) {
    char path[PATH_MAX], line[PATH_MAX + 128];
    struct stat wanted, loaded;
    int found = 0;
    snprintf(path, sizeof path, "%s/libskiagraph.so", folder);
    if (stat(path, &wanted) != 0) bench_die("%s: %s", path, strerror(errno));
    snprintf(path, sizeof path, "/proc/%ld/maps", (long)it->pid);
    FILE *maps = fopen(path, "r");
    if (!maps) bench_die("%s: %s", path, strerror(errno));
    while (fgets(line, sizeof line, maps)) {
        const char *at = strchr(line, '/');
        line[strcspn(line, "\n")] = '\0';
        found |=
            at && stat(at, &loaded) == 0 && loaded.st_ino == wanted.st_ino && loaded.st_dev == wanted.st_dev;
    }
    fclose(maps);
    if (!found) bench_die("the library of %s was not loaded", folder);
}

/* Starts a contender and waits for its first image. */
static void start_process(char *const *words, const char *folder, process *out, versus_start *start) {
    int to[2], from[2];
    if (pipe(to) != 0 || pipe(from) != 0) bench_die("a pipe cannot be made");
    fflush(NULL);
    out->pid = fork();
    if (out->pid < 0) bench_die("a process cannot be made");
    if (out->pid == 0) {
        dup2(to[0], STDIN_FILENO);
        dup2(from[1], STDOUT_FILENO);
        close(to[0]), close(to[1]), close(from[0]), close(from[1]);
        setenv("LD_LIBRARY_PATH", folder, 1);
        execv("/proc/self/exe", words);
        _exit(127);
    }
    close(to[0]), close(from[1]);
    out->to = to[1], out->from = from[0];
    fcntl(out->to, F_SETFD, FD_CLOEXEC); /* or the other process would keep this one's input open */
    fcntl(out->from, F_SETFD, FD_CLOEXEC);
    get(out->from, start, sizeof *start, folder);
    check_library(out, folder);
}

static void end_process(process *it) {
    int status = 0;
    close(it->to);
    close(it->from);
    waitpid(it->pid, &status, 0);
    if (status != 0) bench_die("a contender ended with status %d", status);
}

static double min_of(const double *ms, long count) {
    double least = ms[0];
    for (long i = 1; i < count; i++) least = ms[i] < least ? ms[i] : least;
    return least;
}

static void add_ratio(results *all, int kind, const double *least) {
    if (all->ratio_count[kind] < RATIOS)
        all->ratios[kind][all->ratio_count[kind]++] = least[NEW] / least[OLD];
}

/* One turn of both; the one that begins changes from turn to turn. */
static void take_turns(const versus_settings *set, const process *both, const char *const *folders, int kind,
                       long number, results *all) {
    static versus_turn turns[BUILDS];
    const long frames = kind == VERSUS_VIEWS ? 1 : set->frames;
    double least[BUILDS];
    for (int i = 0; i < BUILDS; i++) {
        const int who = (i + (int)number) % BUILDS;
        if (write(both[who].to, &kind, sizeof kind) != (ssize_t)sizeof kind)
            bench_die("a contender has gone");
        get(both[who].from, &turns[who], sizeof turns[who], folders[who]);
        for (long f = 0; f < frames; f++) bench_add(&all->times[kind][who], turns[who].ms[f]);
        least[who] = min_of(turns[who].ms, frames);
    }
    add_ratio(all, kind, least);
    all->differ[kind] |= turns[OLD].hash != turns[NEW].hash;
}

/* New processes, so that the start is measured again and memory lies elsewhere. counted 0: only fills the caches. */
static void take_round(const versus_settings *set, char *const *words, const char *const *folders, long round,
                       int counted, results *all) {
    process both[BUILDS];
    versus_start starts[BUILDS];
    for (int i = 0; i < BUILDS; i++) {
        const int who = (i + (int)round) % BUILDS;
        start_process(words, folders[who], &both[who], &starts[who]);
    }
    for (int kind = 0; kind < VERSUS_ONCE && counted; kind++) {
        const double ms[BUILDS] = {starts[OLD].ms[kind], starts[NEW].ms[kind]};
        for (int who = 0; who < BUILDS; who++) bench_add(&all->times[kind][who], ms[who]);
        add_ratio(all, kind, ms);
    }
    for (int kind = VERSUS_ONCE; kind < VERSUS_COUNT && counted; kind++)
        for (long turn = 0; turn < set->turns; turn++) take_turns(set, both, folders, kind, turn, all);
    all->start = starts[NEW];
    for (int who = 0; who < BUILDS; who++) end_process(&both[who]);
}

static double median_of(double *values, int count) {
    bench_times times = {.count = count};
    memcpy(times.ms, values, (size_t)count * sizeof *values);
    return bench_median(&times);
}

static int print_results(const char *scene, results *all, FILE *csv) {
    int differ = 0;
    printf("%s: %lld parts, %lld triangles, %lld vertices, %lld x %lld pixels\n\n", scene,
           (long long)all->start.parts, (long long)all->start.triangles, (long long)all->start.vertices,
           (long long)all->start.columns, (long long)all->start.rows);
    printf(
        "| | old, ms | new, ms | new / old | median of ratios | images |\n|---|---:|---:|---:|---:|---|\n");
    for (int kind = 0; kind < VERSUS_COUNT; kind++) {
        const bench_times *times = all->times[kind];
        const double old = bench_min(&times[OLD]), now = bench_min(&times[NEW]);
        const double median = median_of(all->ratios[kind], all->ratio_count[kind]);
        const char *images = kind < VERSUS_ONCE ? "" : all->differ[kind] ? "differ" : "same bits";
        differ |= all->differ[kind];
        printf("| %s | %.4g | %.4g | %.3f | %.3f | %s |\n", names[kind], old, now, now / old, median, images);
        if (csv)
            fprintf(csv, "%s,%s,%.5g,%.5g,%.4f,%.4f,%s\n", scene, names[kind], old, now, now / old, median,
                    images);
    }
    printf("\n");
    fflush(stdout);
    return differ;
}

static void read_option(bench_arguments *arguments, command *out) {
    versus_settings *set = &out->set;
    const char *value = NULL;
    if (bench_flag(arguments, "--contend"))
        out->contend = 1;
    else if (bench_option(arguments, "--frames", &value))
        bench_numbers(value, 1, VERSUS_FRAMES, 1, &set->frames);
    else if (bench_option(arguments, "--turns", &value))
        bench_numbers(value, 1, 100, 1, &set->turns);
    else if (bench_option(arguments, "--rounds", &value))
        bench_numbers(value, 1, 100, 1, &set->rounds);
    else if (bench_option(arguments, "--views", &value))
        bench_numbers(value, 1, 4096, 1, &set->views);
    else if (bench_option(arguments, "--size", &value))
        bench_numbers(value, 16, 8192, 1, &set->size);
    else if (bench_option(arguments, "--set", &value) && set->count < VERSUS_SETTINGS)
        set->settings[set->count++] = value;
    else if (!value && !bench_option(arguments, "--device", &set->device) &&
             !bench_option(arguments, "--csv", &out->csv))
        bench_usage(arguments, usage);
}

static void read_command(int count, char **words, command *out) {
    bench_arguments arguments = {count, words, 1};
    *out = (command){.set = {.size = 512, .frames = 10, .turns = 3, .rounds = 3, .views = 16}};
    if (count > WORDS) bench_die("more than %d words", WORDS);
    while (arguments.next < count) {
        if (strncmp(words[arguments.next], "--", 2) != 0) {
            out->operands[out->operand_count++] = words[arguments.next++];
            continue;
        }
        int first = arguments.next;
        read_option(&arguments, out);
        while (first < arguments.next) out->options[out->option_count++] = words[first++];
    }
    if (out->contend ? out->operand_count != 1 : out->operand_count < BUILDS + 1)
        bench_die("usage: %s %s", words[0], usage);
}

static int compare(const command *given, const char *program, const char *const *folders, const char *scene,
                   FILE *csv) {
    char name[PATH_MAX], place[PATH_MAX], flag[] = "--contend", *words[WORDS + 4] = {name, flag, place};
    results *all = bench_alloc(1, sizeof *all);
    snprintf(name, sizeof name, "%s", program);
    snprintf(place, sizeof place, "%s", scene);
    for (int i = 0; i < given->option_count; i++) words[3 + i] = given->options[i];
    take_round(&given->set, words, folders, 0, 0, all);
    for (long round = 0; round < given->set.rounds; round++)
        take_round(&given->set, words, folders, round, 1, all);
    const int differ = print_results(scene, all, csv);
    free(all);
    return differ;
}

int main(int count, char **words) {
    command given;
    int differ = 0;
    read_command(count, words, &given);
    given.set.scene = given.operands[0];
    if (given.contend) return versus_contend(&given.set);
    signal(SIGPIPE, SIG_IGN);
    FILE *csv = given.csv ? bench_open(given.csv) : NULL;
    if (csv) fprintf(csv, "scene,what,old_ms,new_ms,ratio,median_of_ratios,images\n");
    printf(
        "Least times in ms; `new / old` is their ratio. %ld rounds of new processes, in each %ld turns of %ld frames.\n\n",
        given.set.rounds, given.set.turns, given.set.frames);
    for (int i = BUILDS; i < given.operand_count; i++)
        differ |= compare(&given, words[0], given.operands, given.operands[i], csv);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", given.csv);
    return differ;
}
