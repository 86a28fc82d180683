/* The outputs of a submission: what is computed, and where it goes. Private. */
#ifndef SKG_OUTPUTS_H
#define SKG_OUTPUTS_H

#include "frame/work.h"
#include "plan/recipe.h"
#include "stage/machine.h"
#include "stage/staging.h"

typedef struct {
    skg_output to; /* checked; strides filled in */
    int64_t channels;
    int64_t first; /* element of to.buffer where the first frame begins */
} skg_frame_output;

/* Checks output `index` of a list and fills in the rest. call: the name of the public function. frames: their number. */
skg_status skg_frame_output_read(const char *call, const skg_recipe *recipe, const skg_machine *machine,
                                 int64_t frames, const skg_output *outputs, int64_t index,
                                 skg_frame_output *output);

/* Whether a kind of output shows the scatter alone. */
static inline int skg_output_is_scatter(int32_t kind) {
    return kind == SKG_OUTPUT_SCATTER || kind == SKG_OUTPUT_SCATTER_SIGMA ||
           kind == SKG_OUTPUT_SCATTER_COMPONENT;
}

/* Where the device puts the output of a frame: the caller's buffer, or device memory from which it is read back. */
skg_status skg_frame_output_place(const skg_frame_output *output, const skg_view *view, skg_machine *machine,
                                  int64_t frame, skg_image_place *place);

/* Enqueues the read of an output into the caller's host memory. Does nothing if it stays on the device. */
skg_status skg_frame_output_read_back(const skg_frame_output *output, const skg_view *view,
                                      const skg_machine *machine, int64_t frame, skg_stage_log *log);

#endif
