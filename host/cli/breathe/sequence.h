/* The sequence of frames that the flags choose, and its times. */
#ifndef SKG_CLI_SEQUENCE_H
#define SKG_CLI_SEQUENCE_H

#include "breathe/fluoroscopy.h"

typedef struct {
    double seconds, fps;
    double phase, at; /* of one picture; NaN: not given */
    int64_t frames;
    const char *place, *meshes;
    double plan_ms, sequence_ms;
    double pose_ms; /* of all frames of the sequence */
} sequence;

/* Moves the scene to a frame of the sequence. Returns an exit status and prints the error. */
int sequence_pose(fluoroscopy *f, const sequence *s, int64_t frame);

#endif
