/* Measures of a pose that motion needs too. Private. */
#ifndef SKG_MEASURE_H
#define SKG_MEASURE_H

#include <skiagraph/breathing.h>

/* V0/V of the lungs; 1 where there is none. */
double skg_body_lung_ratio(const skg_body *body);

/* Depth of the needle's tip below the skin, as its mesh has it, mm; NaN: no needle. */
double skg_body_needle_depth(const skg_body *body);

#endif
