/* A scene of many frames, and the jobs that make them. */
#ifndef JOBS_H
#define JOBS_H

#include "suite.h"
#include "support/run.h"

/* Of 24 x 24 pixels with 16 x 16 rays each a core is given some 170 frames at once (lib/frame/submit_frames.c). */
enum { SIDE = 24, PIXELS = SIDE * SIDE, FINE = 16, FRAMES_PER_CORE = 300, UNTOUCHED = -77 };

extern skg_view jobs_view;
extern skg_scene *jobs_scene;
extern skg_mesh *jobs_ball;
extern skg_plan *jobs_plan;
extern int64_t jobs_frames;
extern float *jobs_pixels, jobs_reference[PIXELS];

skg_output jobs_output(float *to);
/* samples: of the source; 0: a point. noise: 1: -ln of images with noise. */
skg_plan *jobs_plan_of(int32_t samples, int32_t noise);
skg_plan *jobs_fine_plan(void);
void jobs_open(void);
void jobs_close(void);
skg_job *jobs_submit(void);
/* The first `count` frames hold the reference, and the others nothing. */
void jobs_check(int64_t count);
int jobs_hold_frames(void);
/* One frame of so many samples of the source that it is given to the device in some 20 steps of 50 ms (lib/frame/submit_frames.c), four
 * at a time; the noise of a sample does not matter here. */
skg_plan *jobs_long_plan(int32_t noise);
/* Waits until the device has written there, without any call of the library. */
void jobs_look_only(const float *pixel);

#endif
