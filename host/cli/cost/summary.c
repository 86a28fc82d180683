/* Writes the findings of a study in a few sentences. */
#include "cost/findings.h"

#include "cost/dial.h"

#include <math.h>
#include <stdio.h>

static const double HALF = 0.55; /* of today's error counts as half */
static const double LESS = 0.9;  /* of today's time or error counts as less */
static const double SAME = 1.05; /* of today's error counts as the same */
static const double BUSY = 1.5;  /* times the price: a wait that is told beside it */

/* Appends a sentence to the summary. */
#define SAY(study, ...) cost_append((study)->judged.summary, sizeof(study)->judged.summary, __VA_ARGS__)

/* Two significant digits, without an exponent. */
static cost_text number_of(double value) {
    const double magnitude = fabs(value);
    cost_text text;
    int decimals = 0;
    if (magnitude > 0) decimals = 1 - (int)floor(log10(magnitude));
    snprintf(text.of, sizeof text.of, "%.*f", decimals < 0 ? 0 : decimals > 7 ? 7 : decimals, value);
    return text;
}

cost_text cost_percent(double share) {
    cost_text text = {"not finite"};
    if (share > 0 && share < 1e-8)
        snprintf(text.of, sizeof text.of, "below 0.000001 %%");
    else if (!isnan(share))
        snprintf(text.of, sizeof text.of, "%.60s %%", share > 0 ? number_of(100 * share).of : "0");
    return text;
}

cost_text cost_ms(double ms, double uncertainty_ms) {
    cost_text text = number_of(ms);
    if (uncertainty_ms > 0.05 * fabs(ms))
        cost_append(text.of, sizeof text.of, " +- %s", number_of(uncertainty_ms).of);
    cost_append(text.of, sizeof text.of, " ms");
    return text;
}

cost_text cost_more(double ms, double uncertainty_ms) {
    cost_text text;
    if (fabs(ms) <= uncertainty_ms)
        snprintf(text.of, sizeof text.of, "the same time within +- %.32s ms", number_of(uncertainty_ms).of);
    else
        snprintf(text.of, sizeof text.of, "%s%.60s", ms > 0 ? "+" : "", cost_ms(ms, uncertainty_ms).of);
    return text;
}

/* Shots that err less than today's. Changes of one dial come before others, unless those are faster by a tenth. */
static cost_offer look_at_buy(const cost_study *study, int index, const void *user) {
    const cost_shot *here = user, *shot = &study->measured.shots[index];
    const double weight = cost_changed_dial(study, &shot->setting) == COST_SEVERAL ? 1.1 : 1;
    return (cost_offer){shot->total_rms < LESS * here->total_rms ? shot->total_rms : (double)NAN,
                        weight * shot->price_ms};
}

/* Shots that are faster by a tenth. */
static cost_offer look_at_saving(const cost_study *study, int index, const void *user) {
    const cost_shot *here = user, *shot = &study->measured.shots[index];
    const int is_faster = shot->price_ms + shot->uncertainty_ms < LESS * here->price_ms;
    return (cost_offer){is_faster ? shot->total_rms : (double)NAN, shot->price_ms};
}

/* Chooses the settings to change to: the fastest that halves the error of the whole, otherwise the most accurate; and the fastest that errs
 * no more than today's image. */
static void choose_changes(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const int count = study->measured.shot_count;
    int best;
    const int half = cost_cheapest(study, count, look_at_buy, here, HALF * here->total_rms, &best);
    study->judged.buy = half >= 0 ? half : best;
    study->judged.saving = cost_cheapest(study, count, look_at_saving, here, SAME * here->total_rms, NULL);
}

/* The values of the dials in which a shot differs from the scene: "84000 triangles, double precision". */
static void name_change(const cost_study *study, const cost_setting *setting, char *text, size_t size) {
    *text = '\0';
    for (int dial = COST_PRECISION; dial <= COST_TRIANGLES; dial++) {
        char value[96];
        cost_setting its = study->subject.own;
        cost_take(dial, setting, &its);
        if (cost_changed_dial(study, &its) == COST_SCENE) continue;
        cost_describe_dial(study, setting, dial, value, sizeof value);
        cost_append(text, size, "%s%s", *text ? " with " : "", value);
    }
}

static void add_change(cost_study *study, const char *what, int number) {
    const cost_shot *here = &study->measured.shots[study->measured.here],
                    *shot = &study->measured.shots[number];
    char change[256];
    const double more = shot->price_ms - here->price_ms, ratio = shot->total_rms / here->total_rms;
    name_change(study, &shot->setting, change, sizeof change);
    SAY(study, " %s: %s, %s, ", what, change,
        cost_more(more, hypot(shot->uncertainty_ms, here->uncertainty_ms)).of);
    if (ratio <= HALF && ratio > 0.4)
        SAY(study, "error halved.");
    else if (ratio > LESS && ratio <= SAME)
        SAY(study, "with the same error.");
    else
        SAY(study, "error %s.", cost_percent(shot->total_rms).of);
}

/* The sources that could be measured and were not: "triangles, repair". Returns their number. */
static int list_missing(const cost_study *study, char *text, size_t size) {
    int count = 0;
    *text = '\0';
    for (int i = 0; i < COST_SOURCES; i++)
        if (study->judged.sources[i].state == COST_NOT_MEASURED)
            cost_append(text, size, "%s%s", count++ ? ", " : "", cost_sources[i].name);
    return count;
}

/* Adds the error by scatter, which all settings share. */
static void name_scatter(cost_study *study) {
    const cost_source *scatter = &study->judged.sources[COST_SOURCE_SCATTER];
    if (!(scatter->error > 0)) return;
    SAY(study, " Scatter, which no setting here has, is about %s.", cost_percent(scatter->error).of);
}

static int count_measured(const cost_study *study) {
    int count = 0;
    for (int i = 0; i < COST_SOURCE_SURFACE; i++) count += study->judged.sources[i].state >= COST_COARSE;
    return count;
}

static void name_largest(cost_study *study) {
    char missing[160];
    const int misses = list_missing(study, missing, sizeof missing), measured = count_measured(study);
    const cost_source *largest =
        study->judged.largest < 0 ? NULL : &study->judged.sources[study->judged.largest];
    if (largest)
        SAY(study, " Largest error%s: %s (%s%s).", misses ? " of those measured" : "",
            cost_sources[study->judged.largest].name, largest->state == COST_COARSE ? "about " : "",
            cost_percent(largest->error).of);
    else if (measured)
        SAY(study, " No source of error that was measured is above 0.");
    else
        SAY(study, " No source of error was measured.");
    if (misses) SAY(study, " Not measured: %s.", missing);
}

/* Adds price and error of today's image. */
static void state_here(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const char *each = study->frames > 1 ? "a frame in batches" : "an image";
    SAY(study, "This scene: ");
    SAY(study, "%s %s", cost_ms(here->price_ms, here->uncertainty_ms).of, each);
    if (here->wall_now_ms > BUSY * here->price_ms)
        SAY(study, " by processor time (%s on the wall, on this machine as it is now)",
            cost_ms(here->wall_now_ms, 0).of);
    if (!isnan(here->total_rms)) SAY(study, ", ");
    if (!isnan(
            here->total_rms)) /* a best image that is known less well than its distance gives a lower bound */
        SAY(study, "%s%s off", study->judged.reference_error <= here->total_rms ? "" : "at least ",
            cost_percent(here->total_rms).of);
    if (study->judged.reference_error > 0.1 * here->total_rms &&
        study->judged.reference_error <= here->total_rms)
        SAY(study, " (+- %s)", cost_percent(study->judged.reference_error).of);
    SAY(study, ".");
}

/* Adds the price of uniting components, which the scene asks for, and the error of images without it. */
static void price_union(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const int32_t apart = cost_repair(study, &study->subject.own) - COST_UNITE;
    for (int i = 0; study->subject.has_shells && i < study->measured.count; i++) {
        const cost_point *point = &study->measured.points[i];
        if (point->reference != COST_OF_REPAIR || point->setting.repair != apart || point->shot < 0) continue;
        const cost_shot *without = &study->measured.shots[point->shot];
        SAY(study, " The union of components takes %s of it; without it the image differs by up to %s.",
            cost_ms(here->price_ms - without->price_ms, hypot(here->uncertainty_ms, without->uncertainty_ms))
                .of,
            cost_percent(point->max_flat).of);
        return;
    }
}

/* Adds the price of linear values between cells, and how much they change the image. */
static void price_between(cost_study *study) {
    const cost_between *between = &study->measured.between;
    if (!between->is_known) return;
    SAY(study,
        " Linear values between the cells of volumes take %s instead of %s, and change the image by up to %s.",
        cost_ms(between->ms[1], between->uncertainty_ms[1]).of,
        cost_ms(between->ms[0], between->uncertainty_ms[0]).of, cost_percent(between->max).of);
}

void cost_summarise(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    choose_changes(study);
    if (study->judged.buy >= 0 && study->measured.shots[study->judged.buy].price_ms < here->price_ms)
        study->judged.saving = -1; /* it saves time as well */
    state_here(study);
    price_union(study);
    price_between(study);
    name_largest(study);
    name_scatter(study);
    if (study->subject.noise > 10 * here->total_rms) {
        SAY(study, " The scene's noise is %s, so nothing needs to be bought.",
            cost_percent(study->subject.noise).of);
        study->judged.buy = -1;
    }
    if (study->judged.buy >= 0)
        add_change(study, "Best buy", study->judged.buy);
    else if (!(study->subject.noise > 10 * here->total_rms) && study->measured.shot_count > 1)
        SAY(study, " No setting that was measured errs less.");
    if (study->judged.saving >= 0) add_change(study, "To save time", study->judged.saving);
}
