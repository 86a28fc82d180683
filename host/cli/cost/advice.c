/* Which dial to turn, and what that costs. */
#include "cost/findings.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/dial.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const double ADVISED =
    0.97; /* the share of the given time after which no recommendation is measured */

/* Points of a reference by their error. Rays have prices; other points stand in the order of their work. The largest error decides where
 * single pixels are wrong. */
static cost_offer look_at(const cost_study *study, int index, const void *user) {
    const int reference = *(const int *)user;
    const cost_point *point = &study->measured.points[index];
    const int counts = point->reference == reference &&
                       !(reference == COST_OF_REPAIR && cost_is_other_body(study, &point->setting));
    const double error =
        reference == COST_OF_RAYS || reference == COST_OF_REPAIR ? point->max_flat : point->rms_flat;
    return (cost_offer){counts ? error : (double)NAN,
                        reference == COST_OF_RAYS ? cost_price_of(study, point) : index};
}

/* Marks the frontier of the rays' settings. */
static void find_frontier(cost_study *study) {
    const int rays = COST_OF_RAYS;
    for (int i = 0; i < study->measured.count; i++)
        study->measured.points[i].on_frontier =
            cost_is_on_frontier(study, study->measured.count, look_at, &rays, i);
}

/* The cheapest point of a reference within a bar, otherwise the most accurate; -1: there is none. */
static int choose(const cost_study *study, int reference, double bar) {
    int best;
    const int cheapest = cost_cheapest(study, study->measured.count, look_at, &reference, bar, &best);
    return cheapest >= 0 ? cheapest : best;
}

static cost_setting whole_of(const cost_study *study, const cost_advice *advice) {
    cost_setting setting = study->measured.points[advice->rays].setting;
    for (int dial = COST_SAMPLES; dial <= COST_TRIANGLES; dial++)
        if (advice->chosen[dial] >= 0)
            cost_take(dial, &study->measured.points[advice->chosen[dial]].setting, &setting);
    if (setting.repair == cost_repair(study, &study->subject.own)) setting.repair = -1;
    return setting;
}

/* The time in ms of an image with the reference's rays and the setting's passes. */
static double reference_ms(const cost_study *study, const cost_setting *setting) {
    double slowest = 0;
    for (int i = 0; i < study->measured.count; i++)
        if (study->measured.points[i].reference == COST_OF_RAYS)
            slowest = fmax(slowest, cost_price_of(study, &study->measured.points[i]));
    return slowest / cost_passes(&study->subject.own) * cost_passes(setting);
}

static int measure_whole(cost_study *study, cost_advice *advice) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    double *reference = calloc((size_t)study->pixels, sizeof *reference);
    cost_setting best = study->measured.references[COST_OF_RAYS].setting;
    for (int dial = COST_SAMPLES; dial <= COST_TRIANGLES; dial++)
        cost_take(dial, &advice->whole.setting, &best);
    int exit_status = CLI_DONE;
    if (!image || !reference) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the image");
    } else {
        skg_status status = cost_shoot(study, &advice->whole.setting, image, &advice->whole.shot);
        if (!SKG_FAILED(status)) status = cost_image(study, &best, reference, NULL);
        exit_status =
            SKG_FAILED(status) ? cli_fail(status) : cost_compare(study, 1, image, reference, &advice->whole);
        if (exit_status == CLI_DONE)
            exit_status = cost_compare_shot(study, image, &study->measured.shots[advice->whole.shot]);
    }
    free(advice->whole.difference);
    advice->whole.difference = NULL;
    free(image);
    free(reference);
    return exit_status;
}

/* Times a combination whose reference would take too long, if it does not take too long itself. */
static int time_whole(cost_study *study, const cost_setting *setting) {
    int number, exit_status = CLI_DONE;
    if (cost_find_shot(study, setting) >= 0 || cost_estimate_ms(study, setting) > cost_patience_ms(study) ||
        cost_effort_ms(study, setting) > cost_left_ms(study, ADVISED))
        return CLI_DONE;
    double *image = calloc((size_t)study->pixels, sizeof *image);
    if (!image) return cli_error(CLI_DEVICE, "out of host memory for the image");
    const skg_status status = cost_shoot(study, setting, image, &number);
    exit_status = SKG_FAILED(status) ? cli_fail(status)
                                     : cost_compare_shot(study, image, &study->measured.shots[number]);
    free(image);
    return exit_status;
}

/* Combines the chosen rays, samples, supersampling, triangles and repair. If the combination misses the
 * tolerance, chooses more accurate rays. */
static int advise_whole(cost_study *study, cost_advice *advice) {
    double bar = advice->bar;
    for (int turn = 0; turn < 3; turn++, bar /= 4) {
        advice->rays = choose(study, COST_OF_RAYS, bar);
        advice->rays_met = study->measured.points[advice->rays].max_flat <= advice->bar;
        advice->whole = (cost_point){.dial = COST_SCENE, .setting = whole_of(study, advice)};
        const cost_setting *setting = &advice->whole.setting;
        advice->whole_state = COST_WHOLE_IS_RAYS;
        if (setting->samples == study->subject.own.samples &&
            setting->supersampling == study->subject.own.supersampling && setting->meshing < 0 &&
            setting->repair < 0)
            return CLI_DONE;
        advice->whole_state = COST_WHOLE_TOO_LONG;
        const double ms = reference_ms(study, setting);
        const int too_long = ms > cost_patience_ms(study) ||
                             ms + 2 * cost_effort_ms(study, setting) > cost_left_ms(study, ADVISED);
        if (too_long) return time_whole(study, setting);
        advice->whole_state = COST_WHOLE_MEASURED;
        int exit_status = measure_whole(study, advice);
        if (exit_status != CLI_DONE || !advice->rays_met || advice->whole.max_flat <= advice->bar)
            return exit_status;
    }
    advice->rays_met = 0;
    return CLI_DONE;
}

static int is_met(const cost_study *study, int point, double bar) {
    return point < 0 || study->measured.points[point].rms_flat <= bar;
}

/* Appends the point's value if its error is above the bar: it is the best that was measured of its dial. */
static void blame(const cost_study *study, int point, double error, double bar, char *text, size_t size) {
    char value[96];
    if (point < 0 || error <= bar) return;
    const cost_point *its = &study->measured.points[point];
    cost_describe_dial(study, &its->setting, its->dial, value, sizeof value);
    cost_append(text, size, "%s%s, the most accurate measured, still err%s %.1e", *text ? "; " : "", value,
                its->dial == COST_PRECISION || its->dial == COST_TOLERANCE || its->dial == COST_REPAIR ? "s"
                                                                                                       : "",
                error);
}

/* Appends a source of which no point was measured, if its coarse error is above the bar or not known. */
static void blame_coarse(const cost_study *study, int source, int point, double bar, char *text,
                         size_t size) {
    const cost_coarse *coarse = &study->measured.coarse[source];
    const int has_dial = source == COST_SOURCE_TRIANGLES ? study->subject.has_round
                         : source == COST_SOURCE_SAMPLES ? study->subject.has_spot
                                                         : 1;
    if (point >= 0 || !has_dial || cost_why_absent(study, source)) return;
    const char *separator = *text ? "; " : "";
    if (coarse->state != COST_COARSE)
        cost_append(text, size, "%sthe error of %s was not measured", separator, cost_sources[source].name);
    else if (coarse->error > bar)
        cost_append(text, size, "%sthe error of %s is about %.1e", separator, cost_sources[source].name,
                    coarse->error);
}

/* Why the tolerance is not reached. */
static void give_reason(const cost_study *study, cost_advice *advice) {
    static const int sources[] = {COST_SOURCE_SAMPLES, COST_SOURCE_SUPERSAMPLING, COST_SOURCE_TRIANGLES};
    const int *const chosen = advice->chosen;
    const int sampled[] = {chosen[COST_SAMPLES], chosen[COST_SUPERSAMPLING], chosen[COST_TRIANGLES]};
    char *text = advice->reason;
    const size_t size = sizeof advice->reason;
    const cost_point *rays = &study->measured.points[advice->rays];
    if (!advice->rays_met && rays->max_flat > advice->bar)
        cost_append(text, size, "no precision, tolerance or number of bins errs less than %.1e",
                    rays->max_flat);
    else if (!advice->rays_met)
        cost_append(text, size, "all dials together err %.1e", advice->whole.max_flat);
    for (int k = 0; k < 3; k++)
        blame(study, sampled[k], sampled[k] < 0 ? 0 : study->measured.points[sampled[k]].rms_flat,
              advice->bar, text, size);
    for (int k = 0; k < 3; k++) blame_coarse(study, sources[k], sampled[k], advice->bar, text, size);
    blame_coarse(study, COST_SOURCE_REPAIR, chosen[COST_REPAIR], advice->bar, text, size);
    if (*text && study->left_out)
        cost_append(text, size, "; %" PRId64 " settings did not fit in the given time", study->left_out);
}

int cost_advise(cost_study *study) {
    find_frontier(study);
    if (choose(study, COST_OF_RAYS, 0) < 0)
        return cli_error(CLI_DEVICE, "no setting could be measured: one image of the scene takes too long");
    for (int i = 0; i < COST_TOLERANCES; i++) {
        cost_advice *advice = &study->judged.advice[i];
        cli_progress_forecast("measuring the settings that are recommended", i, COST_TOLERANCES,
                              fmax(cost_left_ms(study, ADVISED), 0));
        advice->tolerance = cost_tolerances[i];
        advice->bar = fmax(advice->tolerance, study->subject.noise / 10);
        advice->sampling_met = 1;
        for (int dial = COST_SAMPLES; dial <= COST_TRIANGLES; dial++) {
            advice->chosen[dial] = choose(study, cost_dials[dial].reference, advice->bar);
            if (dial != COST_REPAIR) advice->sampling_met &= is_met(study, advice->chosen[dial], advice->bar);
        }
        int exit_status = advise_whole(study, advice);
        if (exit_status != CLI_DONE) return exit_status;
        advice->rays_command = cost_command(study, &study->measured.points[advice->rays].setting);
        advice->whole_command = cost_command(study, &advice->whole.setting);
        if (!advice->rays_command || !advice->whole_command)
            return cli_error(CLI_DEVICE, "out of host memory");
        give_reason(study, advice);
    }
    return CLI_DONE;
}
