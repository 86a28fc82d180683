/* The study as text on the terminal. */
#include "cost/output.h"

#include "cost/findings.h"
#include "cost/measuring.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 100 };

/* A paragraph, broken at blanks. */
static void print_wrapped(const char *text) {
    size_t used = 0;
    while (*text) {
        const size_t word = strcspn(text, " ");
        if (used && used + 1 + word > WIDTH) {
            putchar('\n');
            used = 0;
        }
        used += (size_t)printf("%s%.*s", used ? " " : "", (int)word, text);
        text += word + (text[word] == ' ');
    }
    putchar('\n');
}

static void print_source(const cost_study *study, int number) {
    const cost_source *source = &study->judged.sources[number];
    if (source->error == 0) return; /* named in one line by print_none */
    printf("  %-21s %14s  ", cost_sources[number].name,
           isnan(source->error) ? "?" : cost_percent(source->error).of);
    if (source->halving >= 0)
        printf("%s, %s\n", source->buys, cost_more(source->halving_ms, source->halving_uncertainty_ms).of);
    else
        printf("%s\n", source->reason);
}

/* The sources that make no error at all, in one line. */
static void print_none(const cost_study *study) {
    char text[256] = "";
    for (int i = 0; i < COST_SOURCES; i++)
        if (study->judged.sources[i].error == 0)
            cost_append(text, sizeof text, "%s%s", *text ? ", " : "", cost_sources[i].name);
    if (*text) printf("  %-21s %14s  %s\n", "none", "0 %", text);
}

static void print_sources(const cost_study *study) {
    printf("\n  %-21s %14s  %s\n", "source of error", "of open beam", "what halves it");
    for (int i = 0; i < COST_SOURCES; i++) print_source(study, i);
    print_none(study);
}

static void print_advice(const cost_study *study, const cost_advice *advice) {
    const int number = cost_find_shot(study, &advice->whole.setting);
    const cost_shot *shot = &study->measured.shots[number < 0 ? 0 : number];
    char text[160];
    cost_describe(study, &advice->whole.setting, text, sizeof text);
    printf("  %-7g %-18s %s%s%s\n", advice->tolerance,
           number < 0 ? "not timed" : cost_ms(shot->price_ms, shot->uncertainty_ms).of,
           *advice->reason ? "(not reached) " : "", text,
           advice->bar > advice->tolerance ? " (a tenth of the noise is enough)" : "");
}

/* The machine, and how far the numbers can be trusted. */
static void print_trust(const cost_study *study) {
    printf("\n  %lld settings in %.0f s on %s", (long long)study->measured.shot_count,
           1e-3 * (study->ended_ms - study->begun_ms), study->session.device.name);
    if (!isnan(study->judged.unrest))
        printf("; prices by %s, the same image's varied by %.0f %%",
               study->has_processor_clock ? "processor time" : "the wall", 100 * study->judged.unrest);
    if (study->judged.reference_error > 0)
        printf("; best image known to %s", cost_percent(study->judged.reference_error).of);
    putchar('\n');
    if (study->stopped)
        printf("  stopped: what was measured until then is kept\n");
    else if (study->left_out)
        printf("  %" PRId64 " settings did not fit in %.3g s; --within gives more time\n", study->left_out,
               1e-3 * study->within_ms);
}

/* To three decimals, and 0 without a sign. */
static double steady(double value) {
    return round(1e3 * value) / 1e3 + 0.0;
}

/* How much the image changes when a part moves. */
static void print_sensitivity(const cost_study *study) {
    const cli_sensitivity *s = &study->measured.sensitivity;
    if (!study->sensitive) return;
    printf("\n  %-21s %13s %13s %13s %13s  %s\n", "rms change for a mm", "along x", "along y", "along z",
           "at most", "along");
    for (int64_t i = 0; i < s->count && s->parts[i].is_known; i++) {
        const cli_part_sensitivity *its = &s->parts[i];
        const char *label = "";
        skg_scene_part_label_get(study->session.scene, its->part, &label);
        printf("  %-21s %13s %13s %13s %13s  (%.3f, %.3f, %.3f)\n", label, cost_percent(its->along[0]).of,
               cost_percent(its->along[1]).of, cost_percent(its->along[2]).of, cost_percent(its->largest).of,
               steady(its->direction[0]), steady(its->direction[1]), steady(its->direction[2]));
    }
    if (*s->refusal) print_wrapped(s->refusal);
    if (s->saturated)
        printf("  %" PRId64 " slopes of faces were cut off, and the changes are larger than printed\n",
               s->saturated);
}

void cost_print(const cost_study *study) {
    print_wrapped(study->judged.summary);
    print_sources(study);
    print_sensitivity(study);
    printf("\n  %-7s %-18s fastest setting\n", "error", study->frames > 1 ? "ms a frame" : "ms an image");
    for (int i = 0; i < COST_TOLERANCES; i++) print_advice(study, &study->judged.advice[i]);
    if (study->judged.buy >= 0)
        printf("\n  best buy: %s\n", study->measured.shots[study->judged.buy].command);
    if (study->judged.saving >= 0)
        printf("  to save time: %s\n", study->measured.shots[study->judged.saving].command);
    print_trust(study);
}
