/* Images of a scene that moves. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_FLUOROSCOPY_H
#define SKG_CLI_FLUOROSCOPY_H

#include "session/session.h"

#include <skiagraph/breathing.h>

typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    skg_motion *motion;
    skg_plan *plan;
    int64_t pixels;
    float *image[2];  /* [rows][columns] of -ln(I/I0): one is computed while the other is used */
    double low, high; /* shown as black and as white: one range for all frames */
    int range_warned; /* 1: lengths outside the verified range were warned of */
    char *outline;    /* [rows][columns] 1 where an outline is drawn; NULL: none */
    skg_lag *lag;     /* of the detector, for the frames of a sequence; NULL: none */
} fluoroscopy;

/* The image of the motion in its present pose, into image[which]: started, then waited for. */
int fluoroscopy_start_image(fluoroscopy *f, int which, skg_job **job);
int fluoroscopy_wait_image(fluoroscopy *f, skg_job **job);

/* The lag of the scene's detector at rest, if it has GreyValues.Lag. */
int fluoroscopy_open_lag(fluoroscopy *f);

/* Lets image[which], the next frame of a sequence, show what the detector holds of those before. */
void fluoroscopy_hold(fluoroscopy *f, int which);

/* Writes image[which] with the outline drawn into it. */
int fluoroscopy_write(fluoroscopy *f, int which, const char *path);

/* The grey levels of image[which] with the outline drawn into it, as fluoroscopy_write shows it, but from 0 to 255. */
void fluoroscopy_greys(fluoroscopy *f, int which, unsigned char *greys);

/* Fills in a picture of -ln(I/I0) from low to high. */
void fluoroscopy_picture(const fluoroscopy *f, int64_t columns, int64_t rows, const float *values,
                         skg_picture *picture);

#endif
