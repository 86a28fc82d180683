/* Projections in a stack or a folder, and the places of source and detector. Functions that return int return an exit status and print the error. */
#ifndef CLI_SCAN_STACK_H
#define CLI_SCAN_STACK_H

#include <skiagraph/skiagraph.h>

typedef struct stack_reader stack_reader;

/* Opens a .mha, .mhd, .tif or a folder of TIFFs with its flat and dark fields.
 *
 * path       a .xtekct: the folder that it names
 * geometry   .csv as --geometry wrote it, or a .xtekct
 * reader     result; the caller closes it, also after a failure */
int stack_open(const char *path, const char *geometry, stack_reader **reader);
void stack_close(stack_reader **reader);

/* The views, which belong to the reader, and the axis about which they turn. */
void stack_scan(stack_reader *reader, skg_scan **scan, double axis[3], double centre[3]);

/* Reads a projection as -ln(I / I0). */
int stack_attenuation(stack_reader *reader, int64_t index, float *image);

#endif
