/* Interface of a format of film. Functions that return int return an exit status and print the error. */
#ifndef CLI_FILM_WRITER_H
#define CLI_FILM_WRITER_H

#include "common/file.h"

#include <stdint.h>

/* The frames of a film. */
typedef struct {
    int64_t columns, rows;
    int channels;        /* bytes of a pixel; 1: grey; 4: red, green, blue and one that is ignored */
    double fps;          /* frames per second */
    const char *comment; /* what the film shows; the file names it beside the program */
} film_format;

/* A film that is being written. */
typedef struct {
    film_format format;
    cli_file file;
    int64_t frames; /* that were added */
    void *state;    /* the writer's own */
} film_reel;

typedef struct {
    const char *const *extensions; /* ends with NULL */
    int (*check)(const char *path, double fps);
    int (*open)(film_reel *reel);
    int (*add)(film_reel *reel, const unsigned char *pixels);
    int (*finish)(film_reel *reel);   /* before the file is committed */
    void (*release)(film_reel *reel); /* after each of these, also if it failed; state may be NULL */
} film_writer;

extern const film_writer film_gif, film_encoded;

#endif
