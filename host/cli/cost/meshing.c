#include "cost/meshing.h"

#include "common/say.h"
#include "cost/round.h"
#include "cost/thorax.h"

#include <inttypes.h>

int cost_find_meshings(cost_study *study) {
    study->is_thorax = cost_is_thorax(study);
    skg_status status = SKG_OK;
    if (study->is_thorax)
        cost_find_thorax(study);
    else
        status = cost_find_round(study);
    study->has_round = study->meshing_count > 0;
    if (status == SKG_ERR_MEMORY) return cli_fail(status);
    if (status != SKG_OK) cost_note(study, "triangles are not swept: %s", skg_last_error());
    const int64_t most = study->meshing_count ? study->meshings[study->meshing_count - 1].triangles : 0;
    if (status == SKG_OK && study->meshing_count && most < 2 * study->triangles)
        cost_note(study, "triangles are not swept: the scene has %" PRId64 ", and none finer is made",
                  study->triangles);
    else if (status == SKG_OK)
        return CLI_DONE;
    while (study->meshing_count) cost_meshing_free(&study->meshings[--study->meshing_count]);
    return CLI_DONE;
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
