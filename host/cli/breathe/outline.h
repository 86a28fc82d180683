#ifndef SKG_CLI_OUTLINE_H
#define SKG_CLI_OUTLINE_H

#include "breathe/fluoroscopy.h"

/* Finds the outlines of "ribs,diaphragm@0": the parts whose labels begin with a word of the list, at the
 * phase after '@' (0 without one). "ribs" also stands for "rib 1", "rib 2" and so on. Returns an exit status
 * and prints the error. */
int outline_find(fluoroscopy *f, const char *wanted);

#endif
