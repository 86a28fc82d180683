/* Rounds by the command: children that are killed at any moment and started again. */
#include "soak.h"

#include "support/random.h"

#include <skiagraph/scanning.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PROJECTIONS = 240, KILLS = 3, WORDS = 16 };

/* Starts a program in the folder, with its words; what it says goes to .said there. It leads a process group. */
static pid_t start(const soak *s, const char *const *words) {
    const pid_t child = fork();
    if (child < 0) bench_die("a process cannot be made: %s", strerror(errno));
    if (child) return child;
    setpgid(0, 0);
    if (chdir(s->folder) != 0) _exit(126);
    const int said = open(".said", O_WRONLY | O_CREAT | O_TRUNC, 0600), nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, 0), dup2(said, 1), dup2(said, 2);
    execvp(words[0], (char *const *)(uintptr_t)words);
    _exit(127);
}

static void show_said(const soak *s) {
    char path[SOAK_PATH + 16], line[512];
    snprintf(path, sizeof path, "%s/.said", s->folder);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) fputs(line, stderr);
    if (file) fclose(file);
}

/* Waits until a child has ended well. killed: it may also have been ended by signal 9. Returns whether it was. */
static int finish(const soak *s, pid_t child, int killed, const char *what) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) bench_die("%s: a child was lost", what);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
    if (killed && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return 1;
    show_said(s);
    bench_die("%s: a child ended with %s %d", what, WIFSIGNALED(status) ? "signal" : "exit status",
              WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

static void run(const soak *s, const char *const *words, const char *what) {
    finish(s, start(s, words), 0, what);
}

static void in_folder(const soak *s, const char *name, char path[SOAK_PATH + 64]) {
    snprintf(path, SOAK_PATH + 64, "%s/%s", s->folder, name);
}

static void remove_from(const soak *s, const char *name) {
    char path[SOAK_PATH + 64];
    in_folder(s, name, path);
    if (unlink(path) != 0) bench_die("%s is not there", path);
}

/* Starts, kills and starts again; the last time the child may finish. ms: how long it takes undisturbed. */
static void disturb(soak *s, const char *const *words, double ms, const char *what) {
    for (int k = 0; k < KILLS; k++) {
        const pid_t child = start(s, words);
        bench_sleep(draw(&s->state, 0, 1.2) * ms);
        kill(child, SIGKILL);
        s->kills += finish(s, child, 1, what);
        s->restarts++;
    }
    run(s, words, what);
}

/* The values of a scan: all bytes of a file; of an .h5, in which times differ, the attenuations. */
static uint64_t hash_scan(const soak *s, const char *name) {
    char path[SOAK_PATH + 64];
    skg_scan_reader *reader = NULL;
    skg_scan *scan = NULL;
    skg_view view;
    uint64_t hash = 1;
    in_folder(s, name, path);
    if (!strstr(name, ".h5")) return soak_hash_file(path);
    bench_try(skg_scan_reader_open(path, &reader), path);
    bench_try(skg_scan_reader_scan_get(reader, &scan), path);
    skg_view_init(&view);
    bench_try(skg_scan_view_get(scan, 0, &view), path);
    float *image = bench_alloc((size_t)(view.rows * view.columns), sizeof *image);
    for (int64_t k = 0; k < PROJECTIONS; k++) {
        bench_try(skg_scan_reader_attenuation_get(reader, k, image), path);
        hash = hash * 31 + soak_hash(image, (size_t)(view.rows * view.columns) * sizeof *image);
    }
    free(image);
    skg_scan_reader_release(&reader);
    return hash;
}

static void same_scans(const soak *s, const char *one, const char *other, const char *what) {
    if (hash_scan(s, one) != hash_scan(s, other))
        bench_die("%s: %s/%s is not %s, which nothing disturbed", what, s->folder, other, one);
}

void soak_killed_scan(soak *s, int64_t number) {
    /* HDF5 keeps memory from its first use on: case 0, in the warm-up. */
    static const char *const endings[] = {".h5", ".mha", ".tif", ".raw"};
    const char *ending = endings[s->has_hdf5 ? number % 4 : 1 + number % 3];
    char path[SOAK_PATH + 64], whole[16], killed[16];
    in_folder(s, "scene.json", path);
    soak_scene_write(s, number, PROJECTIONS, path);
    snprintf(whole, sizeof whole, "whole%s", ending);
    snprintf(killed, sizeof killed, "killed%s", ending);
    const double begun = bench_now();
    run(s, (const char *const[]){s->command, "scan", "scene.json", "-o", whole, "--quiet", NULL}, "scan");
    const double ms = bench_now() - begun;
    disturb(s, (const char *const[]){s->command, "scan", "scene.json", "-o", killed, "--quiet", NULL}, ms,
            "killed scan");
    same_scans(s, whole, killed, "killed scan");
    if (strcmp(ending, ".h5") == 0)
        run(s,
            (const char *const[]){s->command, "scan", "scene.json", "-o", killed, "--verify", "--quiet",
                                  NULL},
            "verify");
    const char *const made[] = {"scene.json", ".said", whole};
    for (int k = 0; k < 3; k++) remove_from(s, made[k]);
    if (strcmp(ending, ".raw") == 0) remove_from(s, "whole.mhd"), remove_from(s, "killed.mhd");
    soak_folder_check(s, killed, "killed scan");
    soak_folder_clear(s);
}

/* Pixels that an image has written before it was killed stay under its temporary name, since no later run knows of it. */
void soak_killed_image(soak *s, int64_t number) {
    char path[SOAK_PATH + 64];
    in_folder(s, "scene.json", path);
    soak_scene_write(s, number, 1, path);
    const double begun = bench_now();
    run(s, (const char *const[]){s->command, "image", "scene.json", "-o", "whole.tif", "--quiet", NULL},
        "image");
    const double ms = bench_now() - begun;
    disturb(s, (const char *const[]){s->command, "image", "scene.json", "-o", "killed.tif", "--quiet", NULL},
            ms, "killed image");
    same_scans(s, "whole.tif", "killed.tif", "killed image");
    soak_folder_clear(s);
}

static const char *const ranks[] = {"mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"};

int soak_mpi_is_there(const soak *s) {
    int status = 0;
    const pid_t child = start(s, (const char *const[]){"mpirun", "--version", NULL});
    waitpid(child, &status, 0);
    soak_folder_clear(s);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Two ranks make the scan of one; before that, both are killed once. */
void soak_mpi(soak *s, int64_t number) {
    enum { RANKS = sizeof ranks / sizeof *ranks };
    const char *words[WORDS] = {0};
    char path[SOAK_PATH + 64];
    in_folder(s, "scene.json", path);
    soak_scene_write(s, number, PROJECTIONS, path);
    memcpy(words, ranks, sizeof ranks);
    const char *const rest[] = {s->command, "scan", "scene.json", "-o", "whole.mha", "--quiet"};
    memcpy(words + RANKS, rest, sizeof rest);
    run(s, words + RANKS, "scan");
    if (prctl(PR_SET_CHILD_SUBREAPER, 1) != 0) bench_die("orphaned ranks cannot be waited for");
    words[RANKS + 4] = "shared.mha";
    const pid_t child = start(s, words);
    bench_sleep(draw(&s->state, 0, 2000));
    kill(-child, SIGKILL); /* mpirun and its ranks */
    s->kills += finish(s, child, 1, "killed MPI pair");
    while (waitpid(-1, NULL, 0) > 0) continue; /* ranks that have lost their mpirun end by themselves */
    s->restarts++;
    run(s, words, "MPI pair");
    same_scans(s, "whole.mha", "shared.mha", "MPI pair");
    const char *const made[] = {"scene.json", ".said", "whole.mha"};
    for (int k = 0; k < 3; k++) remove_from(s, made[k]);
    soak_folder_check(s, "shared.mha", "MPI pair");
    soak_folder_clear(s);
}
