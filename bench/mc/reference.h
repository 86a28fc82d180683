/* Reference images: MetaImage headers (.mhd) with raw float32, little endian. */
#ifndef BENCH_MC_REFERENCE_H
#define BENCH_MC_REFERENCE_H

#include <stdint.h>

/* Reads <prefix><name>.mhd, which the caller frees. Ends the program if it does not hold columns x rows
 * floats. A file that does not exist gives NULL if it is not needed, and otherwise ends the program. */
double *reference_read(const char *prefix, const char *name, int64_t columns, int64_t rows, int needed);

/* Writes <prefix><name>.raw, float32 without a header. */
void reference_write(const char *prefix, const char *name, const double *image, int64_t count);

/* Zero-mean normalised cross-correlation. */
double reference_ncc(const double *a, const double *b, int64_t count);

#endif
