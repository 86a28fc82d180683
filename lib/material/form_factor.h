/* Form factors of molecules in a material. Private. */
#ifndef SKG_FORM_FACTOR_H
#define SKG_FORM_FACTOR_H

#include "material/material.h"

/* Gives a material that has none a copy of a table. x: [count] 1/Angstrom; squares: [count], times `scale` of 1 g */
skg_status skg_form_factor_copy(int64_t count, const double *x, const double *squares, double scale,
                                skg_material *to);

/* The sum of F^2 over 1 g of a material at a momentum transfer, by its table: linear between rows, the first of which also holds before it.
 * Returns 0 where atoms are free: without a table, and from its last row on. */
int skg_form_factor_at(const skg_material *material, double x, double *coherent);

#endif
