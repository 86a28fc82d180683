/* How many pixels the library finds unbalanced. Open meshes are counted pixel by pixel; closed ones are not,
 * so a closed body is opened by a triangle that no ray meets. */
#ifndef SKG_TESTS_BALANCE_H
#define SKG_TESTS_BALANCE_H

#include "support/run.h"

/* A triangle of `pixels` across about (column, row), half-way to the detector: what it is added to is open. */
solid stray(const skg_view *view, double column, double row, double pixels);

/* The unbalanced pixels of the body with a stray triangle at (at, at). pose may be NULL. */
int64_t count_bad(const solid *body, const double *pose, const skg_view *view, double at, double pixels,
                  run_choice choice);

#endif
