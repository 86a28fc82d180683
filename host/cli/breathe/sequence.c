/* Poses a moving scene for a frame of a sequence. */
#include "breathe/outputs.h"

#include "common/say.h"

#include <math.h>

int sequence_pose(fluoroscopy *f, const sequence *s, int64_t frame) {
    const double time = isnan(s->at) ? (double)frame / s->fps : s->at;
    skg_status status = isnan(s->phase) ? skg_motion_pose_at_time(f->motion, time)
                                        : skg_motion_pose_at_phase(f->motion, s->phase);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}
