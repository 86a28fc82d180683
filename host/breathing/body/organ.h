/* One organ, from what the caller says of it. Private. */
#ifndef SKG_ORGAN_H
#define SKG_ORGAN_H

#include "body/types.h"

/* Copies and checks; on a failure the caller frees what is there. */
skg_status skg_body_fill_organ(const skg_organ *given, skg_body_organ *organ);

#endif
