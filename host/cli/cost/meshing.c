/* Coarser and finer meshes of a scene's parts, for the dial of triangles. */
#include "cost/dials.h"

#include "common/say.h"

#include <inttypes.h>
#include <stdio.h>

static const double LEAST_THORAX_MS = 3e3; /* no machine in use generates a thorax in less; measured: 4 s */
static const double SHARE = 0.4;           /* of the time that is left, for making meshes */

static void give_reason(cost_study *study, const char *reason) {
    snprintf(study->triangles_reason, sizeof study->triangles_reason, "%s", reason);
}

int cost_find_meshings(cost_study *study) {
    skg_status status = SKG_OK;
    if (cost_may_be_thorax(study)) {
        if (cost_coarse_left_ms(study) < LEAST_THORAX_MS) {
            study->subject.is_thorax = -1;
            study->subject.has_round = 1;
            give_reason(study, cost_time_reason());
            return CLI_DONE;
        }
        study->subject.is_thorax = cost_is_thorax(study);
    }
    if (study->subject.is_thorax)
        cost_list_thorax(study);
    else
        status = cost_find_round(study);
    study->subject.has_round = study->meshing_count > 0;
    if (status == SKG_ERR_MEMORY) return cli_fail(status);
    if (status == SKG_OK) return CLI_DONE;
    snprintf(study->triangles_reason, sizeof study->triangles_reason, "not measured: %.150s",
             skg_last_error());
    cost_note(study, "triangles are not swept: %s", skg_last_error());
    while (study->meshing_count) cost_meshing_free(&study->meshings[--study->meshing_count]);
    return CLI_DONE;
}

int cost_coarse_meshing(const cost_study *study) {
    int found = -1;
    for (int i = 0; i < study->meshing_count; i++) {
        const cost_meshing *meshing = &study->meshings[i];
        const double ratio = (double)meshing->triangles / (double)study->subject.triangles;
        if (ratio > 0.75 && ratio < 1.5) continue; /* too near to the scene */
        if (found >= 0 && ratio > 1 && !meshing->scene) break;
        found = i;
        if (ratio > 1) break;
    }
    return found;
}

/* A meshing with half as many triangles again as the scene shows what finer ones change. A thorax of the scene's own number N has
 * some per cent more than N. */
static int is_finer(const cost_study *study, const cost_meshing *meshing) {
    return 2 * meshing->triangles > 3 * study->subject.triangles;
}

/* Whether this meshing, and the one before, which is compared with it, can be made in time. */
static int can_be_made(const cost_study *study, int number) {
    double ms = cost_making_ms(study, &study->meshings[number]);
    if (number > 0) ms += cost_making_ms(study, &study->meshings[number - 1]);
    return ms <= 0 || ms <= SHARE * cost_left_ms(study, 1);
}

void cost_limit_meshings(cost_study *study) {
    char reason[192] = "";
    if (study->meshing_count == 0) return;
    if (!is_finer(study, &study->meshings[study->meshing_count - 1]))
        snprintf(reason, sizeof reason, "the scene has %" PRId64 " triangles, and none finer is made",
                 study->subject.triangles);
    while (!*reason && !can_be_made(study, study->meshing_count - 1)) {
        const cost_meshing *finest = &study->meshings[study->meshing_count - 1];
        const double ms = cost_making_ms(study, finest);
        cost_meshing_free(&study->meshings[--study->meshing_count]);
        if (study->meshing_count == 0 || !is_finer(study, &study->meshings[study->meshing_count - 1]))
            snprintf(reason, sizeof reason,
                     "the time did not suffice to make finer meshes, which takes about %.2g s", 1e-3 * ms);
    }
    if (!*reason) {
        const double finest = (double)study->meshings[study->meshing_count - 1].triangles;
        if (study->subject.is_thorax && finest < 3.5 * (double)study->subject.triangles)
            cost_note(
                study,
                "the finest thorax has only %.2g times the scene's triangles, so that the error of the triangles is "
                "larger than what was measured; a longer --within allows finer ones",
                finest / (double)study->subject.triangles);
        return;
    }
    give_reason(study, reason);
    cost_note(study, "triangles are not swept: %s", reason);
    while (study->meshing_count) cost_meshing_free(&study->meshings[--study->meshing_count]);
}

skg_status cost_scene_of(cost_study *study, const cost_setting *setting, skg_scene **scene) {
    *scene = study->session.scene;
    if (setting->meshing < 0) return SKG_OK;
    cost_meshing *meshing = &study->meshings[setting->meshing];
    if (!meshing->scene) {
        const skg_status status = cost_make_thorax(study, meshing);
        if (status != SKG_OK) return status;
    }
    *scene = meshing->scene;
    return SKG_OK;
}
