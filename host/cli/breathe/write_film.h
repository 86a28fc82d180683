/* The sequence as a film. */
#ifndef SKG_CLI_WRITE_FILM_H
#define SKG_CLI_WRITE_FILM_H

#include "breathe/sequence.h"

/* Computes the frames and writes them to the one file s->place. Returns an exit status and prints the error. */
int write_film(fluoroscopy *f, const sequence *s);

#endif
