/* Messages of pages as they were read, and JSON that is written. Private. */
#ifndef SKG_LIVE_INSIDE_H
#define SKG_LIVE_INSIDE_H

#include "core/core.h"

#include <skiagraph/live.h>

#include <jansson.h>

/* How a page looks at the scene: the eye, and what differs from a picture of the library's own. */
typedef struct {
    int64_t columns, rows;
    double target[3], distance, from[3], up[3]; /* of skg_look */
    double grey[2];                             /* values of the detector's image as black and as white */
    double cut[4];                              /* of skg_look, if has_cut */
    double background[3];
    json_t *colours; /* {"PART": [red, green, blue, opacity]}; NULL: those of the library */
    int has_cut, is_parallel;
} skg_live_eye;

struct skg_live_message {
    skg_refs refs;
    skg_live_asked asked; /* its arrays are those that follow */
    json_t *settings;     /* {"KEY": VALUE} of a wish */
    json_t *moves;        /* {"PART": [16]} of a wish */
    char *text;           /* of a wish, as a page sends it */
    char **words;
    int64_t *parts;
    double *poses, band_kev[SKG_CHANNELS_MAX + 1];
    skg_live_eye eye; /* of a look */
};

/* Reads an object into a message that is zeroed. */
skg_status skg_live_read(json_t *object, skg_live_message *message);

/* The key `look`, with the number of the look. */
skg_status skg_live_look_read(const json_t *object, skg_live_message *message);

/* Whether a key is the number of a part, which may be one that the scene does not have. */
int skg_live_part_read(const char *key, int64_t *part);

/* null if the number is not finite. */
json_t *skg_live_number(double number);
json_t *skg_live_numbers(const double *numbers, int64_t count);

/* Bytes that are not UTF-8 become question marks; null of NULL. */
json_t *skg_live_text(const char *text);

/* A JSON text as a value; null of NULL, or if it is none. */
json_t *skg_live_parsed(const char *text);

/* The state of a wish as an object. */
json_t *skg_live_state(const skg_live_message *wish);

/* A text for pages, which is made of an object and releases it. */
skg_status skg_live_text_letter(json_t *object, skg_live_letter **letter);

/* A letter of `count` bytes that the caller fills. */
skg_status skg_live_bytes_letter(int64_t count, skg_live_letter **letter, unsigned char **bytes);

/* Adds source, beam and detector as the page draws them. box: [2][3], of a source at infinity */
skg_status skg_live_view_json(const skg_view *view, const skg_collimation *collimation, const double *box,
                              json_t *object);

#endif
