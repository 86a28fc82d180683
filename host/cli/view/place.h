/* Where the things of a 3D view are: for its caption, its labels and --json. Functions that return int return an exit
 * status and print the error. */
#ifndef SKG_CLI_PLACE_H
#define SKG_CLI_PLACE_H

#include "session/session.h"

/* A part in the picture. */
typedef struct {
    const char *label;
    double centre[3]; /* of its vertices, mm */
    double low[3], high[3];
    double at[2];                   /* column and row of its centre */
    double low_column, high_column; /* of the corners of its box in the picture */
    double area;                    /* pixels of the rectangle around these corners */
} view_part;

typedef struct {
    view_part *parts;
    int64_t count;
    double low[3], high[3];                /* box of all parts, mm */
    double source_detector, source_object; /* mm; NaN with a source at infinity */
    double magnification;
} view_places;

/* The caller frees places->parts, also after a failure. */
int view_find_places(const cli_session *session, const skg_look *look, view_places *places);

/* Where the beam starts on its axis; of a source at infinity a point in front of the parts. */
void view_source(const skg_view *view, const view_places *places, double source[3]);

#endif
