/* What a page asks for: one JSON object a message. */
#ifndef CLI_LIVE_WISH_H
#define CLI_LIVE_WISH_H

#include "live/look.h"

#include <skiagraph/options.h>
#include <stddef.h>

/* How the scene shall be. */
typedef struct {
    int64_t number;
    json_t *settings; /* {"KEY": VALUE}, as --set, on top of the scene file */
    json_t *poses; /* {"PART": [16]}: what moves this part in the world, on top of its pose, row by row, mm */
    double phase;  /* of the breath; NaN: as in the file */
    int64_t projection;                    /* of the scan; -1: the scene's own view */
    int32_t quantity;                      /* enum skg_quantity */
    double band_kev[SKG_CHANNELS_MAX + 1]; /* edges of photon-counting bands, keV */
    int64_t bands;                         /* 0: one channel of all energies */
    int64_t channel;                       /* the band that is shown */
    int dragging, plays;                   /* plays: the phase goes on by itself */
} live_wish;

/* How a slice is reconstructed. */
typedef struct {
    int is_stop;      /* 1: what is under way ends */
    int has_spectrum; /* 0: the mean energy alone */
    int has_noise, has_scatter, has_motion;
    double at_mm; /* from the centre of rotation, along the axis across the slice */
} live_switches;

enum {
    LIVE_WISH,
    LIVE_ACK,
    LIVE_PROBE,
    LIVE_TAKE,
    LIVE_MEASURE,
    LIVE_LOOK,
    LIVE_REGISTER,
    LIVE_RECONSTRUCT,
    LIVE_KINDS
};

/* A message. */
typedef struct {
    int kind;
    live_wish wish;         /* LIVE_WISH */
    live_look look;         /* LIVE_LOOK */
    int64_t ack;            /* LIVE_ACK: number of a frame */
    double probe[2];        /* LIVE_PROBE: column and row */
    char take[8];           /* LIVE_TAKE: "png", "tif" or "mha" */
    int64_t part;           /* LIVE_REGISTER; -1: what is under way ends */
    live_switches switches; /* LIVE_RECONSTRUCT */
} live_message;

/* Reads a message. Returns 1; or 0 with a sentence that says what is wrong. The caller frees the wish of a LIVE_WISH
 * and the look of a LIVE_LOOK. */
int live_message_read(const char *text, size_t length, live_message *message, char sentence[LIVE_SENTENCE]);

/* A scene as its file has it. */
void live_wish_init(live_wish *wish);
void live_wish_free(live_wish *wish);

/* The same wish once more, which the caller frees. */
live_wish live_wish_copy(const live_wish *wish);

/* The wish as a page sends it. */
json_t *live_wish_json(const live_wish *wish);

#endif
