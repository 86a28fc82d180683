/* The inside of a plan: known in this room alone. Private. */
#ifndef SKG_PLAN_PRIVATE_H
#define SKG_PLAN_PRIVATE_H

#include "frame/caller.h"
#include "plan/outcome.h"
#include "stage/machine.h"

struct skg_plan {
    skg_refs refs;
    skg_context *context; /* retained */
    skg_recipe *recipe;   /* replaced, never changed */
    skg_machine machine;
    skg_outcome outcome;
};

/* Makes a plan as skg_plan_create does, but tests nothing. */
skg_status skg_plan_make(skg_context *context, skg_scene *scene, const skg_view *view, skg_spectrum *spectrum,
                         const skg_plan_options *options, skg_plan **plan);

/* As skg_plan_outputs_submit and skg_plan_submit_cl, but tests nothing. call: the name of the public function. events: NULL:
 * none. */
skg_status skg_plan_enqueue(const char *call, skg_plan *plan, int64_t count, const skg_frame *frames,
                            int64_t output_count, const skg_output *outputs, const skg_caller_events *events,
                            skg_job **job);

/* As skg_plan_positions_set_cl, but tests nothing. */
skg_status skg_plan_positions_enqueue(skg_plan *plan, int64_t part, cl_mem buffer, int64_t offset,
                                      const float *lowest, const float *highest,
                                      const skg_caller_events *events);

/* Checks that the scene still has the parts that the plan was made for, in the same places: else SKG_STALE. Takes over
 * materials that have changed. */
skg_status skg_plan_renew(skg_plan *plan);

#endif
