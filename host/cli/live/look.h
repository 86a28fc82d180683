/* How a page looks at the scene: the eye, and what differs from `skiagraph view`. */
#ifndef CLI_LIVE_LOOK_H
#define CLI_LIVE_LOOK_H

#include <jansson.h>
#include <stdint.h>

enum { LIVE_SENTENCE = 1024 };

typedef struct {
    int64_t number;        /* by which the page knows the picture */
    int64_t columns, rows; /* of the picture */
    double target[3];      /* in the middle of the picture, mm */
    double distance;       /* from the eye to it, mm */
    double from[3], up[3]; /* directions of skg_look */
    double grey[2];        /* values that the detector shows as black and as white: -ln(I/I0) */
    double cut[4];         /* of skg_look */
    double background[3];  /* red, green, blue: 0 to 255 */
    int is_parallel, has_cut;
    json_t *colours; /* {"PART": [red, green, blue, opacity]} of parts that differ, 0 to 255; NULL: none */
} live_look;

/* Reads the object of a message. Returns 1; or 0 with a sentence that says what is wrong. The caller frees a look that was read. */
int live_look_read(const json_t *object, live_look *look, char sentence[LIVE_SENTENCE]);
void live_look_free(live_look *look);

#endif
