/* Units as scene files spell them, without regard to case. Private. */
#ifndef SKG_UNITS_H
#define SKG_UNITS_H

#include "core/core.h"

/* mm in one unit of length ("um", "mm", "cm", "dm", "m", "dam", "hm", "km" and their names). SKG_ERR_FORMAT
 * with the nearest name. */
skg_status skg_unit_of_length(const char *name, double *mm);

/* keV in one unit of energy ("eV", "keV", "MeV" and their names). */
skg_status skg_unit_of_energy(const char *name, double *kev);

#endif
