/* Uses the whole library, from a thorax to files and an image: numbers that no state of the caller may change. */
#ifndef SKG_TESTS_EVERYTHING_H
#define SKG_TESTS_EVERYTHING_H

#include <stdint.h>

enum { EVERYTHING_SIDE = 40, EVERYTHING_PIXELS = EVERYTHING_SIDE * EVERYTHING_SIDE };

typedef struct {
    double per_cm, half_value_mm;
    float image[2][EVERYTHING_PIXELS]; /* of two energy bands */
    uint64_t files;                    /* hash of thorax.json, image.mha and a mesh */
    char material[64], channel[64];
} everything;

/* Needs run_context. */
void do_everything(everything *done);

/* Sets a German locale, made for this, for the whole process; returns 0 if this system has no means. */
int everything_comma(void);

#endif
