/* A joint basis for columns of numbers. Private.
 *
 * Tissues differ little, and a material that is another one with a different density does not differ at all. Every
 * column is written as a mixture of SKG_SCATTER_RANK columns, so that relative errors are small: each row is fitted to all
 * materials by least squares of (mixture - value) / value, and so are the coefficients of each material, alternately.
 * The coefficients of the SKG_SCATTER_RANK materials that differ most are 1 and 0s, which loses nothing, because
 * a basis is only defined up to a linear map. */
#ifndef SKG_SCATTER_REDUCE_H
#define SKG_SCATTER_REDUCE_H

#include "scatter/physics.h"

/* weight         [rows] of a relative error in the search for coefficients
 * columns        [count][rows] values > 0, or 0 in a row where all are
 * coefficients   [count]
 * basis          [rows]
 *
 * With at most SKG_SCATTER_RANK columns that are no multiples of each other the result is exact. */
skg_status skg_reduce(int64_t count, int64_t rows, const double *weight, const double *columns,
                      double (*coefficients)[SKG_SCATTER_RANK], double (*basis)[SKG_SCATTER_RANK]);

#endif
