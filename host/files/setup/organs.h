/* What a scene file says of the organs of a body. Private. */
#ifndef SKG_SETUP_ORGANS_H
#define SKG_SETUP_ORGANS_H

#include "setup/types.h"

/* Overwrites an organ, but for mesh and inside, with what the key Organs says of a part, if it does. */
void skg_setup_describe_organ(const skg_breathing_section *section, int64_t part, skg_organ *organ);

#endif
