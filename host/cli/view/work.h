/* What the flags of `view` ask for, and what is made of it. Functions that return int return an exit status and print the
 * error. */
#ifndef SKG_CLI_VIEW_WORK_H
#define SKG_CLI_VIEW_WORK_H

#include "view/place.h"

typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    skg_motion *motion; /* NULL: the scene stands still */
    skg_plan *plan;     /* of the detector's image; made with the first one */
    skg_look look;
    double phase, at;    /* NaN: not given */
    double seconds, fps; /* of films and of a page that breathes; seconds NaN: not given */
    float *values;       /* of the detector's image */
    double low, high;    /* shown as black and as white, from the first image on */
    uint8_t *image, *rgba;
    double *path;
    view_places places;
} view_work;

/* Computes the detector's image of the present pose and shows it in the look. */
int view_make_image(view_work *w);

/* Moves the scene to a time in s. */
int view_pose_at(view_work *w, double time);

/* Draws the present pose, with labels, into w->rgba. */
int view_draw(view_work *w);

#endif
