/* Blocks that are cut into pieces: pixels of the pieces' picture that are not those of the whole. Not timed. */
#include "common/bench.h"
#include "support/cuts.h"

#include <float.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] = "[--scenes N] [--first N] [--size N] [--pieces N] [--device CONFIG]";

typedef struct {
    long scenes, first, size, pieces;
    const char *device;
} settings;

typedef struct {
    int64_t scenes, cuts, parts, met;
    int64_t wrong[2], differ; /* in single, in double precision; scenes that strategies disagree about */
    double worst[2];
} tally;

static const char *const structures[CUTS_STRUCTURES] = {"piece by piece", "through all", "two materials",
                                                        "nested"};
static const char *const places[CUTS_PLACES] = {"through centres", "anywhere"};

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.scenes = 160, .size = 65, .pieces = CUTS_PIECES};
    while (arguments.next < arguments.count) {
        if (bench_option(&arguments, "--scenes", &value))
            bench_numbers(value, 1, 1000000000, 1, &out->scenes);
        else if (bench_option(&arguments, "--first", &value))
            bench_numbers(value, 0, 1000000000, 1, &out->first);
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 16, 4096, 1, &out->size);
        else if (bench_option(&arguments, "--pieces", &value))
            bench_numbers(value, 2, CUTS_PIECES, 1, &out->pieces);
        else if (!bench_option(&arguments, "--device", &out->device))
            bench_usage(&arguments, usage);
    }
}

/* The exponents of every ray. */
static void image_of(skg_context *context, skg_scene *scene, const cut_scene *s, skg_spectrum *beam,
                     int32_t precision, int32_t strategy, double *image) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_plan_options_init(&options);
    skg_output_init(&output);
    options.precision = precision;
    options.strategy = strategy;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.overlaps = 0;
    output.type = SKG_TYPE_FLOAT64;
    output.data = image;
    bench_try(skg_plan_create(context, scene, &s->view, beam, &options, &plan), "plan");
    bench_try(skg_plan_image(plan, &output), "image");
    skg_plan_release(&plan);
}

static void take(skg_context *context, skg_spectrum *beam, const settings *set, uint64_t number,
                 double *image, double *other, tally *total) {
    static const int32_t ways[] = {SKG_STRATEGY_COPIES, SKG_STRATEGY_TILES, SKG_STRATEGY_ATOMICS};
    /* 4 units in the last place of the largest coordinate, and 3e-5 of the longest path; in double
     * precision twice the shift of edges, and what positions of doubles leave of 1e-11. */
    const double bar[2] = {3e-5, 1e-9};
    const size_t bytes = (size_t)(set->size * set->size) * sizeof *image;
    cut_scene *s = cut_make(number, set->size, (int)set->pieces);
    tally *its = &total[CUTS_PLACES * s->structure + s->place];
    const double shift[2] = {4 * (double)FLT_EPSILON * (double)set->size * s->magnified,
                             0x1p-34 * s->magnified};
    skg_scene *scene = NULL;
    bench_try(cut_scene_create(context, s, &scene), "scene");
    its->scenes++, its->cuts += s->cuts, its->parts += s->parts;
    for (int precision = 0; precision < 2; precision++) {
        const int32_t chosen = precision ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
        for (int way = 0; way < 3; way++) {
            image_of(context, scene, s, beam, chosen, ways[way], way ? other : image);
            if (way && memcmp(image, other, bytes) != 0) {
                its->differ++;
                printf("scene %" PRIu64 ": strategies differ\n", number);
            }
        }
        const cut_verdict v = cut_judge(s, image, shift[precision], bar[precision]);
        if (precision == 0) its->met += v.met;
        its->wrong[precision] += v.wrong;
        its->worst[precision] = its->worst[precision] > v.worst ? its->worst[precision] : v.worst;
        if (v.wrong > 0)
            printf("scene %" PRIu64 " (%s, %s, %" PRId64 " parts), %s: %" PRId64
                   " pixels wrong, the first in row %" PRId64 ", column %" PRId64 "\n",
                   number, structures[s->structure], places[s->place], s->parts,
                   precision ? "double" : "single", v.wrong, v.first / set->size, v.first % set->size);
    }
    skg_scene_release(&scene);
    cut_free(s);
}

/* Returns whether a pixel is wrong that must not be. */
static int print(const tally *total) {
    int bad = 0;
    printf("\n| cuts | scenes | cuts | parts | met | wrong, single / double | worst, single / double |\n"
           "|---|---:|---:|---:|---:|---:|---:|\n");
    for (int k = 0; k < CUTS_STRUCTURES * CUTS_PLACES; k++) {
        const tally *its = &total[k];
        const int place = k % CUTS_PLACES;
        printf("| %s, %s | %" PRId64 " | %" PRId64 " | %" PRId64 " | %" PRId64 " | %" PRId64 " / %" PRId64
               " | %.2g / %.2g |\n",
               structures[k / CUTS_PLACES], places[place], its->scenes, its->cuts, its->parts, its->met,
               its->wrong[0], its->wrong[1], its->worst[0], its->worst[1]);
        const double most = place == CUTS_ANYWHERE ? 1e-6 * (double)its->met : 0;
        bad |= (double)its->wrong[0] > most || its->wrong[1] > 0 || its->differ > 0;
    }
    return bad;
}

int main(int count, char **words) {
    settings set;
    tally total[CUTS_STRUCTURES * CUTS_PLACES] = {0};
    skg_spectrum *beam = NULL;
    read_settings(count, words, &set);
    skg_context *context = bench_context(set.device);
    bench_try(skg_context_log_set(context, NULL, NULL), "log");
    bench_try(skg_spectrum_create_mono(100, 1, &beam), "beam");
    const size_t pixels = (size_t)(set.size * set.size);
    double *image = bench_alloc(pixels, sizeof *image), *other = bench_alloc(pixels, sizeof *other);
    for (long n = set.first; n < set.first + set.scenes; n++)
        take(context, beam, &set, (uint64_t)n, image, other, total);
    printf("Scenes %ld to %ld, %ld x %ld pixels\n", set.first, set.first + set.scenes - 1, set.size,
           set.size);
    const int bad = print(total);
    free(image);
    free(other);
    skg_spectrum_release(&beam);
    skg_context_release(&context);
    return bad;
}
