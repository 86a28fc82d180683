/* A 3D view: where its things are, the picture with names and measures, and its PNG file. Functions that
 * return int return an exit status and print the error. */
#ifndef CLI_VIEW_PICTURE_H
#define CLI_VIEW_PICTURE_H

#include "session/sensitivity.h"
#include "session/session.h"

#include <skiagraph/breathing.h>

#include <stddef.h>

/* Where the things of a 3D view are: for its caption, its labels and --json. */

/* A part in the picture. */
typedef struct {
    const char *label;
    double centre[3]; /* of its vertices, mm */
    double low[3], high[3];
    double at[2];                   /* column and row of its centre */
    double low_column, high_column; /* of the corners of its box in the picture */
    double area;                    /* pixels of the rectangle around these corners */
    double dot[2];                  /* of a named part: column and row where it can be seen */
} view_part;

typedef struct {
    view_part *parts;
    int64_t count;
    view_part **named; /* those of `parts` that the picture names; NULL: not chosen yet */
    int64_t named_count;
    double low[3], high[3];                /* box of all parts, mm */
    double source_detector, source_object; /* mm; NaN with a source at infinity */
    double magnification;
} view_places;

/* The caller frees places->parts and places->named, also after a failure. */
int view_find_places(const cli_session *session, const skg_look *look, view_places *places);

/* Chooses the parts that are named, the largest of each kind that can be seen, and where their dots are. */
int view_choose_named(const cli_session *session, const skg_look *look, view_places *places);

/* Where the beam starts on its axis; of a source at infinity a point in front of the parts. */
void view_source(const skg_view *view, const view_places *places, double source[3]);

/* --- Flags of `view`, and the pictures made of them. */

typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    skg_motion *motion; /* NULL: the scene stands still */
    skg_plan *plan;     /* of the detector's image; made with the first one */
    skg_look look;
    double phase, at;    /* NaN: not given */
    double zoom;         /* NaN: not given */
    double middle[3];    /* mm: what is zoomed at */
    double seconds, fps; /* of films and of a page that breathes; seconds NaN: not given */
    float *values;       /* of the detector's image */
    double low, high;    /* shown as black and as white, from the first image on */
    uint8_t *image, *rgba;
    double *path;
    view_places places;
    int sensitive; /* 1: sensitivity is wanted */
    cli_sensitivity sensitivity;
} view_work;

/* Computes the detector's image of the present pose and shows it in the look. */
int view_make_image(view_work *w);

/* Measures how much the image of the present pose changes when each part moves, if w->sensitive is 1. What has no derivative is a
 * note. */
int view_find_sensitivity(view_work *w);

/* Moves the scene to a time in s. */
int view_pose_at(view_work *w, double time);

/* Draws the present pose, with labels, into w->rgba. */
int view_draw(view_work *w);

/* Names and measures on a 3D view, and its PNG file. */

/* Draws the labels and the caption over the picture, rgba [rows][columns][4]. */
int view_label(const cli_session *session, const skg_look *look, const view_places *places, uint8_t *rgba);

/* Makes a PNG file of the picture, which the caller frees. */
int view_encode(const skg_look *look, const uint8_t *rgba, unsigned char **bytes, size_t *count);

/* Inserts a text chunk "Software: skiagraph VERSION" behind the header, by which cli_check_overwrite knows the file.
 * */
int view_sign(unsigned char **bytes, size_t *count);

#endif
