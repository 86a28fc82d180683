/* Whether a fit finds hidden breaths of the paper's coupling again: of the simple thorax of 10,000 triangles, with all 14
 * parameters drawn from the middle 70 % of each range; its liver and diaphragm at end-inspiration are the targets. */
#include "common/bench.h"

#include <skiagraph/breathing.h>

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

static const char usage[] = "[--quick] [--bodies N] [--first N] [--seeds N] [--evaluations N] [--csv FILE]";

enum { SETTINGS = 7, TARGETS = 2, WORD = 200 };
static const char *const organs[TARGETS] = {"diaphragm", "liver"};
static const char *const paper[] = {"Breathing.Coupling=Paper"};

typedef struct {
    long bodies, first, seeds, evaluations;
} sizes;

/* Splitmix64: the same bodies everywhere. */
static double draw(uint64_t *state, double low, double high) {
    uint64_t z = *state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    z ^= z >> 31;
    const double middle = 0.15 + 0.7 * (double)(z >> 11) * 0x1p-53;
    return low + middle * (high - low);
}

static void bounds_of(const skg_mesh *mesh, double low[3], double high[3]) {
    int64_t vertices, triangles;
    bench_try(skg_mesh_count(mesh, &vertices, &triangles), "mesh");
    double *p = bench_alloc((size_t)(3 * vertices), sizeof *p);
    bench_try(skg_mesh_positions_get(mesh, p, 0), "mesh");
    for (int64_t i = 0; i < 3 * vertices; i++) {
        const int64_t k = i % 3;
        low[k] = i < 3 ? p[i] : fmin(low[k], p[i]);
        high[k] = i < 3 ? p[i] : fmax(high[k], p[i]);
    }
    free(p);
}

/* Settings of a scene: as docs/fit.md has the ranges. */
static void draw_body(const skg_mesh *diaphragm, uint64_t seed, char words[SETTINGS][WORD]) {
    double low[3], high[3], t[3], d[3], l[3], n[3], at = 0;
    uint64_t state = seed;
    bounds_of(diaphragm, low, high);
    t[0] = draw(&state, -12, 12), t[1] = draw(&state, -12, 12), t[2] = draw(&state, -40, 5);
    const double azimuth = draw(&state, 0, BENCH_PI), elevation = draw(&state, BENCH_PI / 18, BENCH_PI / 2);
    const double offset = draw(&state, 0, 0.6 * (high[2] - low[2]));
    d[0] = draw(&state, 0.5, 1), d[1] = draw(&state, 1, 1.5), d[2] = draw(&state, 0, 0.5);
    l[0] = draw(&state, 0.5, 1), l[1] = draw(&state, 1, 1.5), l[2] = draw(&state, 0, 0.5);
    n[0] = cos(elevation) * cos(azimuth), n[1] = cos(elevation) * sin(azimuth), n[2] = sin(elevation);
    for (int k = 0; k < 3; k++) at += n[k] * (k < 2 ? 0.5 * (low[k] + high[k]) : high[k]);
    snprintf(words[0], WORD, "%s", paper[0]);
    snprintf(words[1], WORD, "Breathing.Tendon=[%.17g, %.17g, %.17g, \"mm\"]", t[0], t[1], t[2]);
    snprintf(words[2], WORD, "Breathing.TendonPlane=[%.17g, %.17g, %.17g, %.17g]", n[0], n[1], n[2],
             offset - at);
    snprintf(words[3], WORD, "Breathing.Organs.diaphragm={\"Tissue\": [%.17g, %.17g, %.17g]}", d[0], d[1],
             d[2]);
    snprintf(words[4], WORD, "Breathing.Organs.liver={\"Tissue\": [%.17g, %.17g, %.17g]}", l[0], l[1], l[2]);
    snprintf(words[5], WORD, "Breathing.DiaphragmRibs=[%.17g, \"mm\"]", draw(&state, 1, 30));
    snprintf(words[6], WORD, "Breathing.DiaphragmLiver=[%.17g, \"mm\"]", draw(&state, 1, 20));
}

static skg_setup *load(const char *scene, int64_t count, const char *const *words) {
    skg_setup *setup;
    bench_try(skg_setup_load(NULL, scene, count, words, &setup), scene);
    return setup;
}

static skg_mesh *mesh_of(const skg_setup *setup, const char *label, int64_t *id) {
    skg_scene *scene;
    skg_part part;
    skg_part_init(&part);
    bench_try(skg_setup_scene_get(setup, &scene), "scene");
    bench_try(skg_scene_part_find(scene, label, id), label);
    bench_try(skg_scene_part_get(scene, *id, &part), label);
    return part.mesh;
}

/* Surfaces of the hidden body at end-inspiration become targets. */
static void add_targets(skg_fit *fit, const char *scene, char words[SETTINGS][WORD]) {
    const char *list[SETTINGS];
    skg_motion *motion;
    for (int s = 0; s < SETTINGS; s++) list[s] = words[s];
    skg_setup *hidden = load(scene, SETTINGS, list);
    bench_try(skg_motion_create(NULL, hidden, &motion), "motion");
    bench_try(skg_motion_pose_at_phase(motion, 0), "motion");
    for (int o = 0; o < TARGETS; o++) {
        int64_t id, vertices, triangles;
        skg_mesh *mesh = mesh_of(hidden, organs[o], &id), *copy;
        bench_try(skg_mesh_count(mesh, &vertices, &triangles), organs[o]);
        double *positions = bench_alloc((size_t)(3 * vertices), sizeof *positions);
        int32_t *corners = bench_alloc((size_t)(3 * triangles), sizeof *corners);
        bench_try(skg_mesh_positions_get(mesh, positions, 0), organs[o]);
        bench_try(skg_mesh_triangles_get(mesh, corners, 0), organs[o]);
        bench_try(skg_mesh_create(NULL, organs[o],
                                  &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                     .vertices = vertices,
                                                     .positions = positions,
                                                     .triangles = triangles,
                                                     .corners = corners,
                                                     .unit_mm = 1},
                                  &copy),
                  organs[o]);
        bench_try(skg_fit_target_add(fit, id, 0, copy), organs[o]);
        skg_mesh_release(&copy);
        free(positions);
        free(corners);
    }
    skg_motion_release(&motion);
    skg_setup_release(&hidden);
}

/* One fit; returns whether every target is within 0.1 mm and 2 % of its motion. */
static int fit_one(const char *scene, const skg_setup *setup, long body, long seed, long evaluations,
                   FILE *csv) {
    char words[SETTINGS][WORD];
    skg_fit_options options;
    skg_fit_state state;
    skg_fit *fit;
    int64_t id;
    int is_met = 1;
    draw_body(mesh_of(setup, organs[0], &id), 1000 + (uint64_t)body, words);
    skg_fit_options_init(&options);
    skg_fit_state_init(&state);
    options.evaluations = evaluations, options.enough_mm = 0.02, options.seed = seed;
    bench_try(skg_fit_create(NULL, setup, &options, &fit), "fit");
    add_targets(fit, scene, words);
    const double begin = bench_now();
    do bench_try(skg_fit_step(fit, &state), "fit");
    while (!state.done);
    const double seconds = 1e-3 * (bench_now() - begin);
    bench_try(skg_fit_finish(fit), "fit");
    printf("| %4ld | %4ld | %11ld | %8ld | %7.1f |", body, seed, (long)state.evaluations,
           (long)state.restarts, seconds);
    if (csv)
        fprintf(csv, "%ld,%ld,%ld,%ld,%g", body, seed, (long)state.evaluations, (long)state.restarts,
                seconds);
    for (int o = 0; o < TARGETS; o++) {
        skg_fit_target t;
        skg_fit_target_init(&t);
        bench_try(skg_fit_target_get(fit, o, &t), organs[o]);
        is_met &= t.after_mean_mm <= fmin(0.1, 0.02 * t.motion_mm);
        printf(" %8.3f | %7.4f |", t.motion_mm, t.after_mean_mm);
        if (csv) fprintf(csv, ",%g,%g", t.motion_mm, t.after_mean_mm);
    }
    printf(" %s |\n", is_met ? "yes" : "no ");
    fflush(stdout);
    if (csv) fprintf(csv, ",%d\n", is_met);
    skg_fit_release(&fit);
    return is_met;
}

static void write_thorax(char *folder, char *scene, size_t size) {
    skg_thorax_options options;
    skg_thorax *thorax;
    skg_thorax_options_init(&options);
    options.triangles = 10000, options.simple = 1;
    if (!mkdtemp(folder)) bench_die("%s cannot be made", folder);
    bench_try(skg_thorax_create(&options, &thorax), "thorax");
    bench_try(skg_thorax_save(thorax, folder), folder);
    skg_thorax_release(&thorax);
    snprintf(scene, size, "%s/thorax.json", folder);
}

int main(int count, char **words) {
    bench_arguments arguments = {.count = count, .words = words, .next = 1};
    sizes n = {.bodies = 20, .first = 1, .seeds = 5, .evaluations = 8000};
    const char *csv_path = NULL, *text;
    char folder[] = "/tmp/skg-fits-XXXXXX", scene[64], command[80];
    while (arguments.next < count)
        if (bench_flag(&arguments, "--quick"))
            n.bodies = 1, n.seeds = 1, n.evaluations = 100;
        else if (bench_option(&arguments, "--bodies", &text))
            bench_numbers(text, 1, 1000, 1, &n.bodies);
        else if (bench_option(&arguments, "--first", &text))
            bench_numbers(text, 1, 1000, 1, &n.first);
        else if (bench_option(&arguments, "--seeds", &text))
            bench_numbers(text, 1, 1000, 1, &n.seeds);
        else if (bench_option(&arguments, "--evaluations", &text))
            bench_numbers(text, 1, 1000000, 1, &n.evaluations);
        else if (!bench_option(&arguments, "--csv", &csv_path))
            bench_usage(&arguments, usage);
    write_thorax(folder, scene, sizeof scene);
    FILE *csv = csv_path ? bench_open(csv_path) : NULL;
    if (csv)
        fputs(
            "body,seed,evaluations,restarts,seconds,diaphragm_motion,diaphragm_mean,liver_motion,liver_mean,met\n",
            csv);
    skg_setup *setup = load(scene, 1, paper);
    long met = 0;
    puts(
        "| body | seed | evaluations | restarts | seconds | diaphragm: motion, mean after, mm | liver: motion, mean after, mm | met |\n"
        "|---|---|---|---|---|---|---|---|");
    for (long body = n.first; body < n.first + n.bodies; body++)
        for (long seed = 1; seed <= n.seeds; seed++)
            met += fit_one(scene, setup, body, seed, n.evaluations, csv);
    printf("\n%ld of %ld fits are within 0.1 mm and 2 %% of the motion of both organs.\n", met,
           n.bodies * n.seeds);
    skg_setup_release(&setup);
    if (csv) fclose(csv);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) != 0;
}
