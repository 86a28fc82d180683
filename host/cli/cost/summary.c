/* Writes the findings of a study in a few sentences. */
#include "cost/findings.h"

#include "cost/dial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double HALF = 0.55; /* of today's error counts as half */
static const double LESS = 0.9;  /* of today's time or error counts as less */
static const double SAME = 1.05; /* of today's error counts as the same */
static const double BUSY = 1.5;  /* times the price: a wait that is told beside it */

/* Two significant digits, without an exponent. */
static void put_number(double value, char *text, size_t size) {
    const double magnitude = fabs(value);
    int decimals = 0;
    if (magnitude > 0) decimals = 1 - (int)floor(log10(magnitude));
    snprintf(text, size, "%.*f", decimals < 0 ? 0 : decimals > 7 ? 7 : decimals, value);
}

const char *cost_percent(double share, char *text, size_t size) {
    char number[32];
    put_number(100 * share, number, sizeof number);
    if (isnan(share))
        snprintf(text, size, "not finite");
    else if (share > 0 && share < 1e-8)
        snprintf(text, size, "below 0.000001 %%");
    else
        snprintf(text, size, "%s %%", share > 0 ? number : "0");
    return text;
}

const char *cost_ms(double ms, double uncertainty_ms, char *text, size_t size) {
    char number[32], spread[32];
    put_number(ms, number, sizeof number);
    put_number(uncertainty_ms, spread, sizeof spread);
    if (uncertainty_ms > 0.05 * ms)
        snprintf(text, size, "%s +- %s ms", number, spread);
    else
        snprintf(text, size, "%s ms", number);
    return text;
}

const char *cost_more(double ms, double uncertainty_ms, char *text, size_t size) {
    char number[32], spread[32];
    put_number(ms, number, sizeof number);
    put_number(uncertainty_ms, spread, sizeof spread);
    if (fabs(ms) <= uncertainty_ms)
        snprintf(text, size, "the same time within +- %s ms", spread);
    else if (uncertainty_ms > 0.05 * fabs(ms))
        snprintf(text, size, "%s%s +- %s ms", ms > 0 ? "+" : "", number, spread);
    else
        snprintf(text, size, "%s%s ms", ms > 0 ? "+" : "", number);
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
    char change[256], ms[64], percent[48];
    const double more = shot->price_ms - here->price_ms, ratio = shot->total_rms / here->total_rms;
    name_change(study, &shot->setting, change, sizeof change);
    cost_append(study->judged.summary, sizeof study->judged.summary, " %s: %s, %s, ", what, change,
                cost_more(more, hypot(shot->uncertainty_ms, here->uncertainty_ms), ms, sizeof ms));
    if (ratio <= HALF && ratio > 0.4)
        cost_append(study->judged.summary, sizeof study->judged.summary, "error halved.");
    else if (ratio > LESS && ratio <= SAME)
        cost_append(study->judged.summary, sizeof study->judged.summary, "with the same error.");
    else
        cost_append(study->judged.summary, sizeof study->judged.summary, "error %s.",
                    cost_percent(shot->total_rms, percent, sizeof percent));
}

/* The sources that could be measured and were not: "triangles, repair". Returns their number. */
static int list_missing(const cost_study *study, char *text, size_t size) {
    int count = 0;
    *text = '\0';
    for (int i = 0; i < COST_SOURCES; i++)
        if (study->judged.sources[i].state == COST_NOT_MEASURED)
            cost_append(text, size, "%s%s", count++ ? ", " : "", cost_source_names[i]);
    return count;
}

/* Adds the error by scatter, which all settings share. */
static void name_scatter(cost_study *study) {
    const cost_source *scatter = &study->judged.sources[COST_SOURCE_SCATTER];
    char percent[48];
    if (!(scatter->error > 0)) return;
    cost_append(study->judged.summary, sizeof study->judged.summary,
                " Scatter, which no setting here has, is about %s.",
                cost_percent(scatter->error, percent, sizeof percent));
}

static int count_measured(const cost_study *study) {
    int count = 0;
    for (int i = 0; i < COST_SOURCE_SURFACE; i++) count += study->judged.sources[i].state >= COST_COARSE;
    return count;
}

static void name_largest(cost_study *study) {
    char percent[48], missing[160];
    const int misses = list_missing(study, missing, sizeof missing), measured = count_measured(study);
    const cost_source *largest =
        study->judged.largest < 0 ? NULL : &study->judged.sources[study->judged.largest];
    if (largest)
        cost_append(study->judged.summary, sizeof study->judged.summary, " Largest error%s: %s (%s%s).",
                    misses ? " of those measured" : "", cost_source_names[study->judged.largest],
                    largest->state == COST_COARSE ? "about " : "",
                    cost_percent(largest->error, percent, sizeof percent));
    else if (measured)
        cost_append(study->judged.summary, sizeof study->judged.summary,
                    " No source of error that was measured is above 0.");
    else
        cost_append(study->judged.summary, sizeof study->judged.summary, " No source of error was measured.");
    if (misses)
        cost_append(study->judged.summary, sizeof study->judged.summary, " Not measured: %s.", missing);
}

/* Adds price and error of today's image. */
static void state_here(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const char *each = study->frames > 1 ? "a frame in batches" : "an image";
    char ms[64], percent[48], sure[48];
    cost_append(study->judged.summary, sizeof study->judged.summary, "This scene: ");
    cost_append(study->judged.summary, sizeof study->judged.summary, "%s %s",
                cost_ms(here->price_ms, here->uncertainty_ms, ms, sizeof ms), each);
    if (here->wall_now_ms > BUSY * here->price_ms)
        cost_append(study->judged.summary, sizeof study->judged.summary,
                    " by processor time (%s on the wall, on this machine as it is now)",
                    cost_ms(here->wall_now_ms, 0, ms, sizeof ms));
    if (!isnan(here->total_rms)) cost_append(study->judged.summary, sizeof study->judged.summary, ", ");
    if (!isnan(
            here->total_rms)) /* a best image that is known less well than its distance gives a lower bound */
        cost_append(study->judged.summary, sizeof study->judged.summary, "%s%s off",
                    study->judged.reference_error <= here->total_rms ? "" : "at least ",
                    cost_percent(here->total_rms, percent, sizeof percent));
    if (study->judged.reference_error > 0.1 * here->total_rms &&
        study->judged.reference_error <= here->total_rms)
        cost_append(study->judged.summary, sizeof study->judged.summary, " (+- %s)",
                    cost_percent(study->judged.reference_error, sure, sizeof sure));
    cost_append(study->judged.summary, sizeof study->judged.summary, ".");
}

/* Adds the price of uniting components, which the scene asks for, and the error of images without it. */
static void price_union(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const int32_t apart = cost_repair(study, &study->subject.own) - COST_UNITE;
    char ms[64], percent[48];
    for (int i = 0; study->subject.has_shells && i < study->measured.count; i++) {
        const cost_point *point = &study->measured.points[i];
        if (point->reference != COST_OF_REPAIR || point->setting.repair != apart || point->shot < 0) continue;
        const cost_shot *without = &study->measured.shots[point->shot];
        cost_append(study->judged.summary, sizeof study->judged.summary,
                    " The union of components takes %s of it; without it the image differs by up to %s.",
                    cost_ms(here->price_ms - without->price_ms,
                            hypot(here->uncertainty_ms, without->uncertainty_ms), ms, sizeof ms),
                    cost_percent(point->max_flat, percent, sizeof percent));
        return;
    }
}

/* Adds the price of linear values between cells, and how much they change the image. */
static void price_between(cost_study *study) {
    const cost_between *between = &study->measured.between;
    char cells[64], linear[64], percent[48];
    if (!between->is_known) return;
    cost_append(
        study->judged.summary, sizeof study->judged.summary,
        " Linear values between the cells of volumes take %s instead of %s, and change the image by up to %s.",
        cost_ms(between->ms[1], between->uncertainty_ms[1], linear, sizeof linear),
        cost_ms(between->ms[0], between->uncertainty_ms[0], cells, sizeof cells),
        cost_percent(between->max, percent, sizeof percent));
}

void cost_summarise(cost_study *study) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    char percent[48];
    choose_changes(study);
    if (study->judged.buy >= 0 && study->measured.shots[study->judged.buy].price_ms < here->price_ms)
        study->judged.saving = -1; /* it saves time as well */
    state_here(study);
    price_union(study);
    price_between(study);
    name_largest(study);
    name_scatter(study);
    if (study->subject.noise > 10 * here->total_rms) {
        cost_append(study->judged.summary, sizeof study->judged.summary,
                    " The scene's noise is %s, so nothing needs to be bought.",
                    cost_percent(study->subject.noise, percent, sizeof percent));
        study->judged.buy = -1;
    }
    if (study->judged.buy >= 0)
        add_change(study, "Best buy", study->judged.buy);
    else if (!(study->subject.noise > 10 * here->total_rms) && study->measured.shot_count > 1)
        cost_append(study->judged.summary, sizeof study->judged.summary,
                    " No setting that was measured errs less.");
    if (study->judged.saving >= 0) add_change(study, "To save time", study->judged.saving);
}
