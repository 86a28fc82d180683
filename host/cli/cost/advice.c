#include "cost/advice.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/command.h"
#include "cost/compare.h"
#include "cost/measure.h"

#include <math.h>
#include <stdlib.h>

/* Marks the frontier of the rays' settings: no other is both faster and better. */
static void find_frontier(cost_study *study) {
    for (int i = 0; i < study->count; i++) {
        cost_point *point = &study->points[i];
        point->on_frontier = point->reference == COST_OF_RAYS && !isnan(point->max_flat);
        for (int k = 0; k < study->count && point->on_frontier; k++) {
            const cost_point *other = &study->points[k];
            int no_worse = other->reference == COST_OF_RAYS && other->min_ms <= point->min_ms &&
                           other->max_flat <= point->max_flat;
            int better = other->min_ms < point->min_ms || other->max_flat < point->max_flat;
            if (no_worse && better) point->on_frontier = 0;
        }
    }
}

/* The fastest of the rays' settings within a bar, otherwise the most accurate. The minimum time decides,
 * which other load disturbs least. */
static int choose_rays(const cost_study *study, double bar) {
    int fastest = -1, best = -1;
    for (int i = 0; i < study->count; i++) {
        const cost_point *point = &study->points[i];
        if (point->reference != COST_OF_RAYS || isnan(point->max_flat)) continue;
        if (best < 0 || point->max_flat < study->points[best].max_flat) best = i;
        if (!(point->max_flat <= bar)) continue;
        if (fastest < 0 || point->min_ms < study->points[fastest].min_ms) fastest = i;
    }
    return fastest >= 0 ? fastest : best;
}

/* The first repair within a bar, otherwise the exact one; -1: no mesh is leaky. */
static int choose_repair(const cost_study *study, double bar) {
    int best = -1;
    for (int i = 0; i < study->count; i++) { /* points stand in the order of their work */
        if (study->points[i].reference != COST_OF_REPAIR) continue;
        best = i;
        if (study->points[i].max_flat <= bar) return i;
    }
    return best;
}

/* The first setting of a dial within a bar, otherwise the most accurate; -1: the scene has no such dial.
 * Settings stand in the order of their work. */
static int choose_sampling(const cost_study *study, int reference, double bar) {
    int best = -1;
    for (int i = 0; i < study->count; i++) {
        if (study->points[i].reference != reference) continue;
        if (study->points[i].rms_flat <= bar) return i;
        if (best < 0 || study->points[i].rms_flat < study->points[best].rms_flat) best = i;
    }
    return best;
}

static cost_setting whole_of(const cost_study *study, const cost_advice *advice) {
    cost_setting setting = study->points[advice->rays].setting;
    if (advice->samples >= 0) setting.samples = study->points[advice->samples].setting.samples;
    if (advice->supersampling >= 0)
        setting.supersampling = study->points[advice->supersampling].setting.supersampling;
    if (advice->triangles >= 0) setting.meshing = study->points[advice->triangles].setting.meshing;
    if (advice->repair >= 0) setting.repair = study->points[advice->repair].setting.repair;
    if (setting.repair == study->session.options.repair) setting.repair = -1;
    return setting;
}

/* The time in ms of an image with the reference's rays and the setting's passes. */
static double reference_ms(const cost_study *study, const cost_setting *setting) {
    double slowest = 0;
    for (int i = 0; i < study->count; i++)
        if (study->points[i].reference == COST_OF_RAYS) slowest = fmax(slowest, study->points[i].median_ms);
    return slowest / cost_passes(&study->own) * cost_passes(setting);
}

static int measure_whole(cost_study *study, cost_advice *advice) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    double *reference = calloc((size_t)study->pixels, sizeof *reference);
    cost_setting best = study->references[COST_OF_RAYS].setting;
    best.samples = advice->whole.setting.samples;
    best.supersampling = advice->whole.setting.supersampling;
    best.meshing = advice->whole.setting.meshing;
    best.repair = advice->whole.setting.repair;
    int exit_status = CLI_DONE;
    if (!image || !reference) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the image");
    } else {
        skg_status status = cost_image(study, &advice->whole.setting, image, &advice->whole);
        if (status >= SKG_OK) status = cost_image(study, &best, reference, NULL);
        exit_status =
            status < SKG_OK ? cli_fail(status) : cost_compare(study, 1, image, reference, &advice->whole);
    }
    free(advice->whole.difference);
    free(advice->whole.small);
    advice->whole.difference = advice->whole.small = NULL;
    free(image);
    free(reference);
    return exit_status;
}

/* Combines the chosen rays, samples, supersampling, triangles and repair. If the combination misses the
 * tolerance, chooses more accurate rays. */
static int advise_whole(cost_study *study, cost_advice *advice) {
    double bar = advice->bar;
    for (int turn = 0; turn < 3; turn++, bar /= 4) {
        advice->rays = choose_rays(study, bar);
        advice->rays_met = study->points[advice->rays].max_flat <= advice->bar;
        advice->whole = (cost_point){.dial = COST_SCENE, .setting = whole_of(study, advice)};
        const cost_setting *setting = &advice->whole.setting;
        advice->whole_state = COST_WHOLE_IS_RAYS;
        if (setting->samples == study->own.samples && setting->supersampling == study->own.supersampling &&
            setting->meshing < 0 && setting->repair < 0)
            return CLI_DONE;
        advice->whole_state = COST_WHOLE_TOO_LONG;
        if (reference_ms(study, setting) > cost_patience_ms(study)) return CLI_DONE;
        advice->whole_state = COST_WHOLE_MEASURED;
        int exit_status = measure_whole(study, advice);
        if (exit_status != CLI_DONE || !advice->rays_met || advice->whole.max_flat <= advice->bar)
            return exit_status;
    }
    advice->rays_met = 0;
    return CLI_DONE;
}

static int is_met(const cost_study *study, int point, double bar) {
    return point < 0 || study->points[point].rms_flat <= bar;
}

int cost_advise(cost_study *study) {
    find_frontier(study);
    if (choose_rays(study, 0) < 0)
        return cli_error(CLI_DEVICE, "no setting could be measured: one image of the scene takes too long");
    cli_progress_begin("measuring the settings that are recommended", COST_TOLERANCES);
    for (int i = 0; i < COST_TOLERANCES; i++) {
        cost_advice *advice = &study->advice[i];
        advice->tolerance = cost_tolerances[i];
        advice->bar = fmax(advice->tolerance, study->noise / 10);
        advice->samples = choose_sampling(study, COST_OF_SAMPLES, advice->bar);
        advice->supersampling = choose_sampling(study, COST_OF_AREAS, advice->bar);
        advice->triangles = choose_sampling(study, COST_OF_TRIANGLES, advice->bar);
        advice->repair = choose_repair(study, advice->bar);
        advice->sampling_met = is_met(study, advice->samples, advice->bar) &&
                               is_met(study, advice->supersampling, advice->bar) &&
                               is_met(study, advice->triangles, advice->bar);
        int exit_status = advise_whole(study, advice);
        if (exit_status != CLI_DONE) return exit_status;
        advice->rays_command = cost_command(study, &study->points[advice->rays].setting);
        advice->whole_command = cost_command(study, &advice->whole.setting);
        if (!advice->rays_command || !advice->whole_command)
            return cli_error(CLI_DEVICE, "out of host memory");
        cli_progress_step(i + 1);
    }
    cli_progress_end();
    return CLI_DONE;
}
