/* The named breaths of the generated thorax, as anatomy couples ribs and diaphragm and as the paper does: by how much
 * what drives an organ contradicts itself, folded facets, the liver's volume, broken links, and the time of a pose. */
#include "common/bench.h"

#include <skiagraph/breathing.h>

#include <math.h>
#include <omp.h>
#include <stdlib.h>

static const char usage[] = "[--quick] [--triangles N,N,...] [--csv FILE]";

enum { PHASES = 10, PATTERNS = 6, COUPLINGS = 2, SIZES_MAX = 8 };

static const char *const patterns[PATTERNS] = {"quiet",   "diaphragmatic", "thoracic",
                                               "shallow", "deep",          "hyperventilation"};
static const char *const couplings[COUPLINGS] = {"anatomical", "paper"}; /* as SKG_COUPLING_ */

typedef struct {
    skg_thorax *thorax;
    skg_body *body;
    skg_breath breath;
    int64_t step;
} breather;

static void make(long triangles, int simple, int32_t coupling, breather *b) {
    skg_thorax_options kind;
    skg_body_options options;
    int64_t parts;
    skg_thorax_options_init(&kind);
    skg_body_options_init(&options);
    kind.triangles = triangles, kind.simple = simple, options.coupling = coupling;
    *b = (breather){0};
    bench_try(skg_thorax_create(&kind, &b->thorax), "thorax");
    bench_try(skg_thorax_part_count(b->thorax, &parts), "thorax");
    bench_try(skg_body_create(NULL, &options, &b->body), "body");
    for (int64_t i = 0; i < parts; i++) {
        skg_thorax_part part;
        skg_organ organ;
        skg_thorax_part_init(&part);
        skg_organ_init(&organ);
        bench_try(skg_thorax_part_get(b->thorax, i, &part), "thorax");
        organ.mesh = part.mesh, organ.label = part.label, organ.inside = part.inside;
        bench_try(skg_body_add(b->body, &organ, NULL), part.label);
    }
    bench_try(skg_body_link(b->body), "body");
}

static void pose(void *what) {
    breather *b = what;
    skg_breath_state state;
    skg_breath_state_init(&state);
    bench_try(skg_breath_state_at_phase(&b->breath, (double)(b->step++ % PHASES) / PHASES, &state), "breath");
    bench_try(skg_body_pose(b->body, &state), "body");
}

/* The worst over the phases of a breath. */
static void judge(breather *b, const char *thorax, long triangles, const char *coupling, const char *pattern,
                  double ms, FILE *csv) {
    double conflict = 0, liver = 0, tidal = 0;
    int64_t folded = 0, broken = 0;
    b->step = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        skg_body_measure m;
        skg_body_measure_init(&m);
        pose(b);
        bench_try(skg_body_measure_get(b->body, &m), "measure");
        conflict = fmax(conflict, m.conflict_mm), liver = fmax(liver, fabs(m.liver_volume_ratio - 1));
        tidal = fmax(tidal, m.tidal_ml);
        folded = m.flipped_triangles > folded ? m.flipped_triangles : folded;
        broken = m.broken_links > broken ? m.broken_links : broken;
    }
    printf("| %-6s | %7ld | %-16s | %-10s | %7.2f | %5ld | %7.3f | %5ld | %6.0f | %8.3f |\n", thorax,
           triangles, pattern, coupling, conflict, (long)folded, 100 * liver, (long)broken, tidal, ms);
    if (csv)
        fprintf(csv, "%s,%ld,%s,%s,%g,%ld,%g,%ld,%g,%g\n", thorax, triangles, pattern, coupling, conflict,
                (long)folded, 100 * liver, (long)broken, tidal, ms);
}

static void run(long triangles, int simple, int turns, FILE *csv) {
    breather b[COUPLINGS];
    const bench_frame frames[COUPLINGS] = {pose, pose};
    void *const what[COUPLINGS] = {b, b + 1};
    for (int c = 0; c < COUPLINGS; c++) make(triangles, simple, c, b + c);
    for (int p = 0; p < PATTERNS; p++) {
        static bench_times times[COUPLINGS];
        for (int c = 0; c < COUPLINGS; c++) {
            times[c] = (bench_times){0};
            skg_breath_init(&b[c].breath);
            bench_try(skg_breath_pattern_get(patterns[p], &b[c].breath), "breath");
        }
        bench_interleave(COUPLINGS, frames, what, turns, 2 * PHASES, times);
        for (int c = 0; c < COUPLINGS; c++)
            judge(b + c, simple ? "simple" : "full", triangles, couplings[c], patterns[p],
                  bench_median(times + c), csv);
    }
    for (int c = 0; c < COUPLINGS; c++) {
        skg_body_release(&b[c].body);
        skg_thorax_release(&b[c].thorax);
    }
}

int main(int count, char **words) {
    bench_arguments arguments = {count, words, 1};
    long sizes[SIZES_MAX] = {10000, 42000, 336000, 935000};
    int quick = 0, number = 4;
    const char *value = NULL, *path = NULL;
    while (arguments.next < count) {
        if (bench_flag(&arguments, "--quick"))
            quick = 1, number = 2;
        else if (bench_option(&arguments, "--triangles", &value))
            number = (int)bench_numbers(value, 10000, 20000000, SIZES_MAX, sizes);
        else if (!bench_option(&arguments, "--csv", &path))
            bench_usage(&arguments, usage);
    }
    omp_set_num_threads(1); /* a pose is then measured in ms of one core */
    FILE *csv = path ? bench_open(path) : NULL;
    if (csv)
        fprintf(csv,
                "thorax,triangles,breath,coupling,conflict_mm,folded,liver_percent,broken,tidal_ml,ms\n");
    printf("The worst of %d phases; ms: median of a pose on one core, the couplings alternating.\n\n",
           PHASES);
    printf(
        "| thorax | triangles | breath | coupling | conflict, mm | folded facets | liver, %% | broken links | tidal, ml "
        "| ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (int s = 0; s < number; s++)
        for (int simple = 1; simple >= 0; simple--) run(sizes[s], simple, quick ? 1 : 3, csv);
    if (csv && fclose(csv) != 0) bench_die("%s: not written", path);
    return 0;
}
