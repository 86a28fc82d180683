/* Which dial to turn, and what that costs. */
#include "cost/findings.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const double ADVISED =
    0.97; /* the share of the given time after which no recommendation is measured */

static double ms_of(const cost_study *study, const cost_point *point) {
    return study->measured.shots[point->shot].price_ms;
}

/* Marks the frontier of the rays' settings: no other is both faster and better. */
static void find_frontier(cost_study *study) {
    for (int i = 0; i < study->measured.count; i++) {
        cost_point *point = &study->measured.points[i];
        point->on_frontier = point->reference == COST_OF_RAYS && !isnan(point->max_flat);
        for (int k = 0; k < study->measured.count && point->on_frontier; k++) {
            const cost_point *other = &study->measured.points[k];
            const double its = ms_of(study, other), ms = ms_of(study, point);
            int no_worse =
                other->reference == COST_OF_RAYS && its <= ms && other->max_flat <= point->max_flat;
            int better = its < ms || other->max_flat < point->max_flat;
            if (no_worse && better) point->on_frontier = 0;
        }
    }
}

/* The fastest of the rays' settings within a bar, otherwise the most accurate. The price decides. */
static int choose_rays(const cost_study *study, double bar) {
    int fastest = -1, best = -1;
    for (int i = 0; i < study->measured.count; i++) {
        const cost_point *point = &study->measured.points[i];
        if (point->reference != COST_OF_RAYS || isnan(point->max_flat)) continue;
        if (best < 0 || point->max_flat < study->measured.points[best].max_flat) best = i;
        if (!(point->max_flat <= bar)) continue;
        if (fastest < 0 || ms_of(study, point) < ms_of(study, &study->measured.points[fastest])) fastest = i;
    }
    return fastest >= 0 ? fastest : best;
}

/* The first repair within a bar, otherwise the best one; -1: there is nothing to repair or to unite. */
static int choose_repair(const cost_study *study, double bar) {
    int best = -1;
    for (int i = 0; i < study->measured.count; i++) { /* points stand in the order of their work */
        if (study->measured.points[i].reference != COST_OF_REPAIR ||
            cost_is_other_body(study, &study->measured.points[i].setting))
            continue;
        best = i;
        if (study->measured.points[i].max_flat <= bar) return i;
    }
    return best;
}

/* The first setting of a dial within a bar, otherwise the most accurate; -1: the scene has no such dial.
 * Settings stand in the order of their work. */
static int choose_sampling(const cost_study *study, int reference, double bar) {
    int best = -1;
    for (int i = 0; i < study->measured.count; i++) {
        if (study->measured.points[i].reference != reference) continue;
        if (study->measured.points[i].rms_flat <= bar) return i;
        if (best < 0 || study->measured.points[i].rms_flat < study->measured.points[best].rms_flat) best = i;
    }
    return best;
}

static cost_setting whole_of(const cost_study *study, const cost_advice *advice) {
    cost_setting setting = study->measured.points[advice->rays].setting;
    if (advice->samples >= 0) setting.samples = study->measured.points[advice->samples].setting.samples;
    if (advice->supersampling >= 0)
        setting.supersampling = study->measured.points[advice->supersampling].setting.supersampling;
    if (advice->triangles >= 0) setting.meshing = study->measured.points[advice->triangles].setting.meshing;
    if (advice->repair >= 0) setting.repair = study->measured.points[advice->repair].setting.repair;
    if (setting.repair == cost_repair(study, &study->subject.own)) setting.repair = -1;
    return setting;
}

/* The time in ms of an image with the reference's rays and the setting's passes. */
static double reference_ms(const cost_study *study, const cost_setting *setting) {
    double slowest = 0;
    for (int i = 0; i < study->measured.count; i++)
        if (study->measured.points[i].reference == COST_OF_RAYS)
            slowest = fmax(slowest, ms_of(study, &study->measured.points[i]));
    return slowest / cost_passes(&study->subject.own) * cost_passes(setting);
}

static int measure_whole(cost_study *study, cost_advice *advice) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    double *reference = calloc((size_t)study->pixels, sizeof *reference);
    cost_setting best = study->measured.references[COST_OF_RAYS].setting;
    best.samples = advice->whole.setting.samples;
    best.supersampling = advice->whole.setting.supersampling;
    best.meshing = advice->whole.setting.meshing;
    best.repair = advice->whole.setting.repair;
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
        advice->rays = choose_rays(study, bar);
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
        cost_append(text, size, "%sthe error of %s was not measured", separator, cost_source_names[source]);
    else if (coarse->error > bar)
        cost_append(text, size, "%sthe error of %s is about %.1e", separator, cost_source_names[source],
                    coarse->error);
}

/* Why the tolerance is not reached. */
static void give_reason(const cost_study *study, cost_advice *advice) {
    static const int sources[] = {COST_SOURCE_SAMPLES, COST_SOURCE_SUPERSAMPLING, COST_SOURCE_TRIANGLES};
    const int sampled[] = {advice->samples, advice->supersampling, advice->triangles};
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
    blame_coarse(study, COST_SOURCE_REPAIR, advice->repair, advice->bar, text, size);
    if (*text && study->left_out)
        cost_append(text, size, "; %" PRId64 " settings did not fit in the given time", study->left_out);
}

int cost_advise(cost_study *study) {
    find_frontier(study);
    if (choose_rays(study, 0) < 0)
        return cli_error(CLI_DEVICE, "no setting could be measured: one image of the scene takes too long");
    for (int i = 0; i < COST_TOLERANCES; i++) {
        cost_advice *advice = &study->judged.advice[i];
        cli_progress_forecast("measuring the settings that are recommended", i, COST_TOLERANCES,
                              fmax(cost_left_ms(study, ADVISED), 0));
        advice->tolerance = cost_tolerances[i];
        advice->bar = fmax(advice->tolerance, study->subject.noise / 10);
        advice->samples = choose_sampling(study, COST_OF_SAMPLES, advice->bar);
        advice->supersampling = choose_sampling(study, COST_OF_AREAS, advice->bar);
        advice->triangles = choose_sampling(study, COST_OF_TRIANGLES, advice->bar);
        advice->repair = choose_repair(study, advice->bar);
        advice->sampling_met = is_met(study, advice->samples, advice->bar) &&
                               is_met(study, advice->supersampling, advice->bar) &&
                               is_met(study, advice->triangles, advice->bar);
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
