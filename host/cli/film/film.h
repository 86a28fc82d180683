/* Films: a sequence of frames in one file, .gif by giflib, .mp4 and .webm by the program ffmpeg. The file appears whole
 * or not at all. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_FILM_H
#define SKG_CLI_FILM_H

#include "film/writer.h"

typedef struct film film;

/* Whether the extension of a path is a film's. */
int film_is(const char *path);

/* Refuses, before anything is computed, a film that could not be written: without giflib or ffmpeg, or at a rate that the
 * format does not have. */
int film_check(const char *path, double fps);

/* Opens a film. film_finish or film_discard ends it.
 *
 * format   is copied, the comment included */
int film_open(const char *path, const film_format *format, film **opened);

/* Adds a frame, [rows][columns][channels]. */
int film_add(film *open, const unsigned char *pixels);

/* Completes the file. Whatever it returns, the film is ended. */
int film_finish(film **open);

/* Ends a film without a file. Does nothing if there is none. */
void film_discard(film **open);

#endif
