/* Combines the best of each dial, and looks for cheaper points. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "cost/dial.h"
#include "cost/dials.h"

#include <math.h>
#include <stdlib.h>

enum { VALUES_MAX = 48, GUESSES_MAX = 40000, TRIED_MAX = 8 };

/* The measured values of one dial, or of the rays' three. */
typedef struct {
    int count, points[VALUES_MAX];
    double own_ms; /* of the value that the scene has; 0: it was not measured */
} values;

typedef struct {
    cost_setting setting;
    double ms, error; /* predicted */
} guess;

static void list(const cost_study *study, int reference, values *its) {
    *its = (values){0};
    for (int i = 0; i < study->measured.count; i++) {
        const cost_point *point = &study->measured.points[i];
        if (point->reference != reference || point->state != COST_MEASURED || isnan(point->rms_flat) ||
            cost_is_other_body(study, &point->setting))
            continue;
        const int dial = cost_changed_dial(study, &point->setting);
        /* Supersampling is measured with fewer source samples than the scene has. */
        const int is_own = reference == COST_OF_AREAS
                               ? point->setting.supersampling == study->subject.own.supersampling
                               : dial == COST_SCENE;
        if (is_own) its->own_ms = cost_price_of(study, point);
        if (its->count < VALUES_MAX) its->points[its->count++] = i;
    }
    if (!(its->own_ms > 0)) its->count = 0;
}

/* Changes a guess by one value: errors of different dials add as squares, and times multiply. */
static guess change(const cost_study *study, const guess *before, const values *its, int value) {
    guess after = *before;
    const cost_point *point = &study->measured.points[its->points[value]];
    const cost_setting *to = &point->setting;
    after.ms *= cost_price_of(study, point) / its->own_ms;
    after.error = hypot(before->error, point->rms_flat);
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        if (cost_dials[dial].reference == point->reference) cost_take(dial, to, &after.setting);
    return after;
}

/* All combinations; the caller frees them. */
static guess *guess_all(const cost_study *study, int64_t *count) {
    static const int references[] = {COST_OF_RAYS, COST_OF_TRIANGLES, COST_OF_AREAS, COST_OF_SAMPLES,
                                     COST_OF_REPAIR};
    guess *all = calloc(GUESSES_MAX, sizeof *all);
    *count = 1;
    if (!all) return NULL;
    all[0] =
        (guess){.setting = study->subject.own, .ms = study->measured.shots[study->measured.here].price_ms};
    for (int r = 0; r < 5; r++) {
        values its;
        const int64_t before = *count;
        list(study, references[r], &its);
        if (its.count == 0 || before * its.count > GUESSES_MAX) continue;
        for (int v = its.count - 1; v >= 0;
             v--) /* the first value last: it overwrites what the others start from */
            for (int64_t i = 0; i < before; i++) all[v * before + i] = change(study, &all[i], &its, v);
        *count = before * its.count;
    }
    return all;
}

static int faster(const void *a, const void *b) {
    const guess *x = a, *y = b;
    if (x->ms != y->ms) return x->ms < y->ms ? -1 : 1;
    return (x->error > y->error) - (x->error < y->error);
}

/* Keeps the guesses than which none is both faster and more accurate, by rising time. */
static int64_t keep_best(guess *all, int64_t count) {
    int64_t kept = 0;
    qsort(all, (size_t)count, sizeof *all, faster);
    for (int64_t i = 0; i < count; i++)
        if (kept == 0 || all[i].error < all[kept - 1].error) all[kept++] = all[i];
    return kept;
}

/* Measures a guess, if it is new and the time suffices. */
static int try_guess(cost_study *study, const guess *its, double share, double *image, int *tried) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const double runs = (double)(1 + cost_first_runs(study) * study->frames);
    const double wall_ms =
        its->ms * here->wall_now_ms / here->price_ms; /* the time that is given is the wall's */
    if (cost_find_shot(study, &its->setting) >= 0 || wall_ms > cost_patience_ms(study)) return 0;
    const int count = study->measured.count;
    if (study->measured.plan_ms + runs * wall_ms > cost_left_ms(study, share)) {
        study->left_out++;
        return 0;
    }
    cost_add_point(study, COST_SEVERAL, 0, its->setting);
    if (study->measured.count == count) return 0;
    (*tried)++;
    return cost_measure(study, &study->measured.points[count], image);
}

int cost_combine(cost_study *study, double share, double *image) {
    int64_t count;
    int tried = 0, exit_status = 0;
    guess *all = guess_all(study, &count);
    if (!all) return exit_status; /* the study goes without combinations */
    const int64_t best = keep_best(all, count);
    const int64_t most = study->quick ? TRIED_MAX / 2 : TRIED_MAX;
    cli_progress_forecast("measuring combinations of settings", 0, 0, fmax(cost_left_ms(study, share), 0));
    /* evenly along the frontier */
    for (int64_t i = 0; i < most && exit_status == 0; i++)
        exit_status =
            try_guess(study, &all[best == 1 ? 0 : i * (best - 1) / (most - 1)], share, image, &tried);
    free(all);
    return exit_status;
}

static cost_offer look_at_shot(const cost_study *study, int index, const void *user) {
    (void)user;
    return (cost_offer){study->measured.shots[index].total_rms, study->measured.shots[index].price_ms};
}

void cost_find_frontier(cost_study *study) {
    for (int i = 0; i < study->measured.shot_count; i++)
        study->measured.shots[i].on_frontier =
            cost_is_on_frontier(study, study->measured.shot_count, look_at_shot, NULL, i);
}
