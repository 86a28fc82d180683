/* The frames of a film. */
#ifndef SKG_CLI_FILM_FORMAT_H
#define SKG_CLI_FILM_FORMAT_H

#include <stdint.h>

typedef struct {
    int64_t columns, rows;
    int channels;        /* bytes of a pixel; 1: grey; 4: red, green, blue and one that is ignored */
    double fps;          /* frames per second */
    const char *comment; /* what the film shows; the file names it beside the program */
} film_format;

#endif
