/* A stack of projections (.mha) and the table of its poses. Functions that return int return an exit status and print the error. */
#ifndef CLI_SCAN_STACK_H
#define CLI_SCAN_STACK_H

#include <skiagraph/skiagraph.h>

typedef struct stack_reader stack_reader;

/* Opens a .mha that `scan` wrote, with the .csv that --geometry wrote, and its flat and dark fields beside it. The caller closes it,
 * also after a failure. */
int stack_open(const char *path, const char *geometry, stack_reader **reader);
void stack_close(stack_reader **reader);

/* The views, which belong to the reader, and the axis about which they turn. */
void stack_scan(stack_reader *reader, skg_scan **scan, double axis[3], double centre[3]);

/* Reads a projection as -ln(I / I0). */
int stack_attenuation(stack_reader *reader, int64_t index, float *image);

#endif
