/* What passes need before they are drawn, and passes that wait to be drawn together: samples of the source of one frame, or frames of a
 * job. */
#include "frame/frames.h"

#include <string.h>

skg_status skg_frame_update_meshes(skg_job *job) {
    const skg_recipe *recipe = job->recipe;
    if (job->then.meshes) return SKG_OK;
    SKG_TRY(skg_plan_meshes_check(&recipe->meshes, recipe->scene));
    return skg_geometry_update(&job->machine->geometry, recipe->meshes.meshes, &job->staging);
}

/* Numbers before the extents of the passes: the pass that is claimed next. */
enum { CLAIM = 1 };

static skg_status begin(const skg_pass *pass, skg_waiting *g) {
    const int32_t room = skg_raster_passes(pass->main.raster);
    g->tables = (skg_pass_tables){0};
    SKG_TRY(skg_staging_take(g->staging, CLAIM + 4 * room * pass->planes, sizeof *g->placed, "extents",
                             &g->placed));
    SKG_TRY(skg_realloc(room, sizeof *g->passes, "passes", &g->passes));
    g->room = room;
    return SKG_OK;
}

skg_status skg_waiting_add(skg_job *job, const skg_pass *pass, skg_waiting *g) {
    if (g->count == 0) SKG_TRY(begin(pass, g));
    SKG_TRY(skg_frame_update_meshes(job));
    SKG_TRY(skg_geometry_weigh_pass(&job->machine->geometry, &pass->camera, pass->parts, pass->scale.scale,
                                    g->room, &g->tables, g->staging));
    skg_pass_extents(pass, g->placed + CLAIM + 4 * g->count * pass->planes);
    g->passes[g->count++] = *pass;
    return SKG_OK;
}

skg_status skg_waiting_draw(skg_job *job, const skg_waiting *g, cl_event *read) {
    skg_machine *machine = job->machine;
    if (g->count == 0) return SKG_OK;
    SKG_TRY(skg_geometry_send_passes(machine->context, &machine->geometry, &g->tables));
    return skg_raster_run_passes(g->passes->main.raster, &machine->geometry, g->count, g->placed, read,
                                 &job->staging.log);
}

void skg_waiting_empty(skg_waiting *g) {
    while (g->count > 0) skg_pass_release(&g->passes[--g->count]);
}

void skg_waiting_release(skg_waiting *g) {
    skg_waiting_empty(g);
    skg_free(&g->passes);
}
