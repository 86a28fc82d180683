/* Units as scene files spell them, without regard to case. Private. */
#ifndef SKG_UNITS_H
#define SKG_UNITS_H

#include "core/core.h"

/* The millimetres in one unit of length ("um", "mm", "cm", "dm", "m", "dam", "hm", "km" and their full names).
 * SKG_ERR_FORMAT for another word; the sentence offers the nearest name. */
skg_status skg_unit_of_length(const char *name, double *mm);

/* The keV in one unit of energy ("eV", "keV", "MeV" and their full names). */
skg_status skg_unit_of_energy(const char *name, double *kev);

#endif
