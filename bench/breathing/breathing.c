/* Breathing: the exact solution of Chain Mail against the published queue; steps of a whole body; poses and
 * images. */
#include "body/types.h"
#include "breathing/queue.h"
#include "common/bench.h"
#include "common/thorax.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] = "[--quick] [--triangles N] [--csv FILE]";

enum { LARGE = 935000 }; /* triangles, which give 200,000 deformable vertices */

static const double push[3] = {3, -5, -20}; /* mm */

/* One way to solve, and its last solution. */
typedef struct {
    const char *name;
    skg_chain *chain;
    int32_t driver;
    int64_t most; /* 0: exact */
    queue scratch;
    double *u;
} solver;

static void solve(void *what) {
    solver *s = what;
    memset(s->u, 0, (size_t)(3 * s->chain->nodes) * sizeof *s->u);
    if (s->most == 0)
        bench_try(skg_chain_move(s->chain, push, s->u, NULL), "chain");
    else
        queue_move(s->chain, s->driver, push, s->most, &s->scratch, s->u);
}

static skg_chain *chain_of(skg_mesh *mesh, const char *label, skg_tissue tissue, int32_t *driver) {
    int64_t vertices, triangles, links;
    bench_try(skg_mesh_count(mesh, &vertices, &triangles), label);
    double *rest = bench_alloc((size_t)vertices * 3, sizeof *rest);
    int32_t *corners = bench_alloc((size_t)triangles * 3, sizeof *corners), *ends;
    bench_try(skg_mesh_positions_get(mesh, rest, 0), label);
    bench_try(skg_mesh_triangles_get(mesh, corners, 0), label);
    bench_try(skg_chain_links(triangles, corners, NULL, &links, &ends), label);
    *driver = 0;
    for (int64_t i = 0; i < vertices; i++)
        if (rest[3 * i + 2] > rest[3 * *driver + 2]) *driver = (int32_t)i;
    skg_chain *chain;
    bench_try(skg_chain_create(label, vertices, rest, links, ends, &tissue, 1, NULL, &chain), label);
    bench_try(skg_chain_drive(chain, 1, driver), label);
    free(ends);
    free(corners);
    free(rest);
    return chain;
}

/* The exact solver comes first, because the others are compared with it. */
static void compare(const char *label, const char *tissue, skg_chain *chain, int32_t driver, int turns,
                    FILE *csv) {
    enum { SOLVERS = 3 };
    solver s[SOLVERS] = {
        {.name = "exact"}, {.name = "queue, once", .most = 1}, {.name = "queue, again", .most = 200}};
    bench_frame frames[SOLVERS];
    void *what[SOLVERS];
    static bench_times times[SOLVERS];
    memset(times, 0, sizeof times);
    for (int i = 0; i < SOLVERS; i++) {
        s[i].chain = chain, s[i].driver = driver;
        queue_make(chain, &s[i].scratch);
        s[i].u = bench_alloc((size_t)chain->nodes * 3, sizeof(double));
        frames[i] = solve, what[i] = s + i;
    }
    bench_interleave(SOLVERS, frames, what, turns, 3, times);
    for (int i = 0; i < SOLVERS; i++) {
        int64_t broken;
        double worst, apart = 0;
        skg_chain_check(chain, s[i].u, 1e-9, &broken, &worst);
        for (int64_t n = 0; n < 3 * chain->nodes; n++) apart = fmax(apart, fabs(s[i].u[n] - s[0].u[n]));
        double share = 100 * (double)broken / (double)(chain->first[chain->nodes] / 2);
        printf("| %-10s | %-13s | %-12s | %6d %5.1f %% | %9.2g | %9.2g | %9.3f | %9.3f |\n", label, tissue,
               s[i].name, (int)broken, share, worst, apart, bench_min(times + i), bench_median(times + i));
        if (csv)
            fprintf(csv, "%s,%s,%s,%d,%g,%g,%g,%g\n", label, tissue, s[i].name, (int)broken, worst, apart,
                    bench_min(times + i), bench_median(times + i));
        if (i == 0 && broken > 0) bench_die("the exact solution breaks %d links", (int)broken);
    }
    for (int i = 0; i < SOLVERS; i++) {
        queue_free(&s[i].scratch);
        free(s[i].u);
    }
}

typedef struct {
    skg_body *body;
    int64_t step;
} breather;

static void breathe(void *what) {
    breather *b = what;
    skg_breath breath;
    skg_breath_init(&breath);
    skg_breath_state state;
    skg_breath_state_init(&state);
    bench_try(skg_breath_state_at_phase(&breath, (double)(b->step++ % 120) / 120, &state), "breath");
    bench_try(skg_body_pose(b->body, &state), "body");
}

/* A breath of 120 steps with 1, 2, 4, ... threads. */
static void steps(long triangles, int turns, FILE *csv) {
    int64_t deformable = 0;
    bench_thorax thorax;
    thorax_make(triangles, THORAX_CLOSED, &thorax);
    breather b = {thorax_body(&thorax), 0};
    for (int64_t i = 0; i < b.body->organs; i++)
        if (b.body->organ[i].soft.chain) deformable += b.body->organ[i].vertices;
    printf("\nThe generated thorax, %ld triangles, %ld deformable vertices, a breath of 120 steps.\n",
           triangles, (long)deformable);
    int most = omp_get_max_threads();
    for (int threads = 1; threads <= most;
         threads = threads < most && 2 * threads > most ? most : 2 * threads) {
        omp_set_num_threads(threads);
        bench_times times = {0};
        for (int turn = 0; turn < turns; turn++) bench_turn(breathe, &b, 120, &times);
        printf("%d threads: a step of the body %.3f ms (median; least %.3f): %.0f steps/s\n", threads,
               bench_median(&times), bench_min(&times), 1000 / bench_median(&times));
        if (csv)
            fprintf(csv, "body,%ld vertices,%d threads,,,,%g,%g\n", (long)deformable, threads,
                    bench_min(&times), bench_median(&times));
        if (threads == most) break;
    }
    skg_body_release(&b.body);
    thorax_free(&thorax);
}

/* A pose and its image, made in one of three ways. */
typedef struct {
    breather *breather;
    skg_plan *plan;
    skg_output *output;
    skg_job *job;
} fluoroscope;

static void pose_alone(void *what) {
    fluoroscope *f = what;
    breathe(f->breather);
}

static void one_after_the_other(void *what) {
    fluoroscope *f = what;
    breathe(f->breather);
    bench_try(skg_plan_submit(f->plan, 1, NULL, 1, f->output, &f->job), "image");
    bench_try(skg_job_wait(&f->job), "image");
}

/* Computes the pose of frame n + 1 while the device makes the image of frame n. This saves time even if the
 * device is the same CPU. Measured on two AVX2 cores, the minimum of 7 to 15 breaths: 5.8 ms a frame instead
 * of 6.8 with 42,000 triangles (the pose alone takes 0.6), and 12.6 ms instead of 15.2 with 200,000 (the pose
 * alone takes 3.7). */
static void overlapped(void *what) {
    fluoroscope *f = what;
    bench_try(skg_plan_submit(f->plan, 1, NULL, 1, f->output, &f->job), "image");
    breathe(f->breather);
    bench_try(skg_job_wait(&f->job), "image");
}

static skg_plan *fluoroscopy_of(skg_context *context, const bench_thorax *thorax) {
    skg_scene *scene = thorax_scene(context, thorax);
    skg_spectrum *spectrum = thorax_beam();
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_view view;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    thorax_view(512, &view);
    bench_try(skg_plan_create(context, scene, &view, spectrum, &options, &plan), "plan");
    skg_scene_release(&scene);
    skg_spectrum_release(&spectrum);
    return plan;
}

static void frames(const bench_thorax *thorax, int turns, FILE *csv) {
    enum { WAYS = 3 };
    static const char *const names[WAYS] = {"pose alone", "pose, then image", "overlapped"};
    static const bench_frame ways[WAYS] = {pose_alone, one_after_the_other, overlapped};
    static bench_times times[WAYS];
    skg_context *context = bench_context(NULL);
    breather b = {thorax_body(thorax), 0};
    skg_output output;
    skg_output_init(&output);
    output.data = bench_alloc(512 * 512, sizeof(float));
    fluoroscope f = {&b, fluoroscopy_of(context, thorax), &output, NULL};
    void *const what[WAYS] = {&f, &f, &f};
    bench_interleave(WAYS, ways, what, turns, 120, times);
    printf("\nA pose and its 512 x 512 image, 5 materials, 10 energies, no file written:\n");
    for (int w = 0; w < WAYS; w++) {
        printf("%-16s %.3f ms (median; least %.3f): %.0f a second\n", names[w], bench_median(times + w),
               bench_min(times + w), 1000 / bench_median(times + w));
        if (csv)
            fprintf(csv, "frame,,%s,,,,%g,%g\n", names[w], bench_min(times + w), bench_median(times + w));
    }
    free(output.data);
    skg_plan_release(&f.plan);
    skg_body_release(&b.body);
    skg_context_release(&context);
}

int main(int count, char **words) {
    bench_arguments arguments = {count, words, 1};
    int quick = 0;
    long triangles = 42000;
    const char *value = NULL, *path = NULL;
    while (arguments.next < count) {
        if (bench_flag(&arguments, "--quick"))
            quick = 1;
        else if (bench_option(&arguments, "--triangles", &value))
            bench_numbers(value, 10000, 20000000, 1, &triangles);
        else if (!bench_option(&arguments, "--csv", &path))
            bench_usage(&arguments, usage);
    }
    FILE *csv = path ? bench_open(path) : NULL;
    if (csv) fprintf(csv, "organ,tissue,solver,broken_links,worst_mm,from_exact_mm,least_ms,median_ms\n");
    bench_thorax thorax;
    thorax_make(triangles, THORAX_CLOSED, &thorax);
    printf(
        "Top vertex driven by (3, -5, -20) mm; links broken by more than 1e-9 mm.\n\n"
        "| organ      | tissue        | solver       | links broken   | worst, mm | off, mm   | least, ms | median    |\n"
        "|---|---|---|---|---|---|---|---|\n");
    for (int64_t i = 0; i < thorax.parts; i++) {
        skg_thorax_part part;
        skg_thorax_part_init(&part);
        bench_try(skg_thorax_part_get(thorax.thorax, i, &part), "thorax");
        if (strcmp(part.label, "liver") != 0 && strcmp(part.label, "diaphragm") != 0) continue;
        for (int t = 0; t < 2; t++) {
            const skg_tissue tissue[2] = {{0.7, 1.1, 0.1}, {0.9, 1.02, 0}};
            int32_t driver;
            skg_chain *chain = chain_of(part.mesh, part.label, tissue[t], &driver);
            compare(part.label, t == 0 ? "0.7/1.1/0.1" : "0.9/1.02/0", chain, driver, quick ? 2 : 8, csv);
            skg_chain_free(&chain);
        }
    }
    steps(triangles, quick ? 2 : 6, csv);
    if (!quick) steps(LARGE, 2, csv);
    frames(&thorax, quick ? 2 : 6, csv);
    thorax_free(&thorax);
    if (csv && fclose(csv) != 0) bench_die("%s: not written", path);
    return 0;
}
