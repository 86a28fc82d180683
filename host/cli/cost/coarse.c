/* The coarse pass of a study: the size of each source of error, from few images and without times. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/dials.h"
#include "cost/findings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Images that were computed last. A setting that several sources need is computed once. */
typedef struct {
    cost_setting setting;
    double *image;
    int is_filled;
} slot;

enum { OWN, FROM, TO, SLOTS };

/* The settings whose images differ by a source of error; the first one errs more. 0: there is no better setting. */
static int choose_pair(const cost_study *study, int source, cost_setting *from, cost_setting *to) {
    const cost_setting *own = &study->subject.own;
    *from = *own;
    /* Bins and precision are compared where the tolerance adds nothing. */
    if (source == COST_SOURCE_BINS || source == COST_SOURCE_PRECISION) from->tolerance = 0;
    /* Few source samples, to save time. */
    if (source == COST_SOURCE_SUPERSAMPLING && from->samples > 16) from->samples = 16;
    *to = *from;
    return cost_improve(study, cost_sources[source].dial, to);
}

/* Every energy takes longer than the energies of a tolerance, at most in proportion to their numbers. */
static double image_ms(const cost_study *study, const cost_setting *setting) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const double energies = setting->tolerance < study->subject.own.tolerance && here->nodes > 0
                                ? (double)here->bins / (double)here->nodes
                                : 1;
    const double making =
        setting->meshing < 0 ? 0 : cost_making_ms(study, &study->meshings[setting->meshing]);
    return making + study->measured.plan_ms + fmax(energies, 1) * cost_estimate_ms(study, setting);
}

static int find_slot(const cost_study *study, const slot slots[SLOTS], const cost_setting *setting) {
    for (int i = 0; i < SLOTS; i++)
        if (slots[i].is_filled && cost_is_same(study, &slots[i].setting, setting)) return i;
    return -1;
}

/* The number of the slot with the setting's image, which is computed if there is none. kept: a slot that stays. Negative: it could
 * not be computed, and *status says why. */
static int fetch(cost_study *study, slot slots[SLOTS], const cost_setting *setting, int kept,
                 skg_status *status) {
    const int found = find_slot(study, slots, setting), free_slot = kept == FROM ? TO : FROM;
    if (found >= 0) return found;
    slot *its = &slots[free_slot];
    its->setting = *setting;
    *status = cost_image(study, setting, its->image, NULL);
    its->is_filled = !SKG_FAILED(*status);
    return its->is_filled ? free_slot : -1;
}

static int compare_pair(cost_study *study, int source, slot slots[SLOTS], const cost_setting *from,
                        const cost_setting *to) {
    cost_coarse *coarse = &study->measured.coarse[source];
    skg_status status = SKG_OK;
    const int first = fetch(study, slots, from, -1, &status);
    const int second = first < 0 ? -1 : fetch(study, slots, to, first, &status);
    if (second < 0) {
        if (status == SKG_ERR_DEVICE || status == SKG_ERR_INTERNAL || status == SKG_ERR_NO_DEVICE)
            return cli_fail(status);
        snprintf(coarse->reason, sizeof coarse->reason, "not measured: %.150s", skg_last_error());
        return CLI_DONE;
    }
    coarse->state = COST_COARSE;
    cost_describe_dial(study, to, cost_sources[source].dial, coarse->compared, sizeof coarse->compared);
    return cost_compare_coarsely(study, slots[first].image, slots[second].image, coarse);
}

/* Whether the images of a pair that are not there yet can be computed in the time that is left. */
static int has_time(const cost_study *study, const slot slots[SLOTS], const cost_setting *from,
                    const cost_setting *to) {
    double ms = find_slot(study, slots, to) < 0 ? image_ms(study, to) : 0;
    if (find_slot(study, slots, from) < 0) ms += image_ms(study, from);
    return ms <= cost_coarse_left_ms(study);
}

static int measure_source(cost_study *study, int source, slot slots[SLOTS]) {
    cost_coarse *coarse = &study->measured.coarse[source];
    cost_setting from, to;
    const char *never = source == COST_SOURCE_TRIANGLES ? study->triangles_reason : "";
    if (!choose_pair(study, source, &from, &to)) {
        snprintf(coarse->reason, sizeof coarse->reason, "%s", *never ? never : cost_why_not(study, source));
        return CLI_DONE;
    }
    if (has_time(study, slots, &from, &to)) return compare_pair(study, source, slots, &from, &to);
    snprintf(coarse->reason, sizeof coarse->reason, "%s", cost_time_reason());
    return CLI_DONE;
}

int cost_measure_coarsely(cost_study *study, double *own) {
    /* Meshes may have to be made, which takes longest. */
    static const int order[] = {COST_SOURCE_TOLERANCE, COST_SOURCE_PRECISION, COST_SOURCE_BINS,
                                COST_SOURCE_REPAIR,    COST_SOURCE_SAMPLES,   COST_SOURCE_SUPERSAMPLING,
                                COST_SOURCE_TRIANGLES};
    slot slots[SLOTS] = {[OWN] = {study->subject.own, own, 1}};
    int exit_status = CLI_DONE;
    for (int i = FROM; i <= TO; i++) {
        slots[i].image = calloc((size_t)study->pixels, sizeof *own);
        if (!slots[i].image) exit_status = cli_error(CLI_DEVICE, "out of host memory for the image");
    }
    for (int i = 0; i < COST_SOURCE_SURFACE && exit_status == CLI_DONE; i++) {
        study->measured.coarse[order[i]].state = COST_NOT_MEASURED;
        if (order[i] == COST_SOURCE_TRIANGLES) exit_status = cost_find_meshings(study);
        if (exit_status == CLI_DONE && !cost_why_absent(study, order[i]))
            exit_status = measure_source(study, order[i], slots);
    }
    free(slots[FROM].image);
    free(slots[TO].image);
    return exit_status;
}
