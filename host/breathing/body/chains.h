/* The chain of a deformable organ, with its drivers. Private. */
#ifndef SKG_CHAINS_H
#define SKG_CHAINS_H

#include "body/types.h"

/* Makes an organ's chain, and finds its drivers by the caller's links or the label's rule. */
skg_status skg_body_make_chain(skg_body *body, skg_body_organ *organ);

/* Frees them, also those that a failed call left. */
void skg_body_drop_chain(skg_body_organ *organ);

#endif
