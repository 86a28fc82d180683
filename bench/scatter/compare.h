/* Images of scatter against those of a Monte Carlo program. */
#ifndef BENCH_SCATTER_COMPARE_H
#define BENCH_SCATTER_COMPARE_H

#include "scatter/subject.h"

/* Prints the table of 20 cm of water by order and kind, with the reference's attenuation or ours, and writes its rows. prefix:
 * of the files, up to "w0_". histories: of each run. Returns how many bars are missed. */
int compare_water(skg_context *context, const char *prefix, int64_t histories, FILE *csv);

/* Compares images of the cube likewise. prefix: up to "a_" */
int compare_cube(skg_context *context, const char *prefix, const char *scene, double tolerance, FILE *csv);

#endif
