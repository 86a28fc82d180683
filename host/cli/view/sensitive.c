/* Colours parts by how much the image changes when they move. */
#include "view/picture.h"

#include "common/progress.h"
#include "common/say.h"

#include <string.h>

/* The plan of the scene's image in keV, without scatter and noise, in the precision that is nearest to the scene's own and has
 * derivatives. */
static skg_status make_plan(const view_work *w, skg_plan **plan) {
    skg_plan_options options = w->session.options;
    options.quantity = SKG_QUANTITY_ENERGY;
    options.scatter = NULL;
    options.noise = 0;
    options.electronic_kev = options.quantum_step_kev = 0;
    options.overlaps = 0; /* the plan of the image has reported them */
    if (options.precision == SKG_PRECISION_HALF) options.precision = SKG_PRECISION_SINGLE;
    return skg_plan_create(w->session.context, w->session.scene, &w->session.view, w->session.spectrum,
                           &options, plan);
}

int view_find_sensitivity(view_work *w) {
    cli_sensitivity *found = &w->sensitivity;
    skg_plan *plan = NULL;
    skg_channel channel;
    skg_frame frame;
    int exit_status = CLI_DONE;
    if (!w->sensitive) return CLI_DONE;
    skg_frame_init(&frame);
    skg_channel_init(&channel);
    skg_status status = w->motion ? skg_motion_fill(w->motion, &frame) : SKG_OK;
    if (!SKG_FAILED(status)) status = make_plan(w, &plan);
    if (!SKG_FAILED(status)) status = skg_plan_channel_get(plan, 0, &channel);
    if (SKG_FAILED(status))
        cli_sensitivity_refuse(found);
    else if (!(channel.flat_field > 0))
        snprintf(found->refusal, sizeof found->refusal, "the scene has no beam");
    else
        exit_status = cli_sensitivity_measure(&w->session, plan, &frame, channel.flat_field, found);
    cli_progress_end();
    if (*found->refusal) cli_note("no sensitivity: %s", found->refusal);
    skg_plan_release(&plan);
    return exit_status;
}
