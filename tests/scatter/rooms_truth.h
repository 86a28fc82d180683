/* Scatter in the rooms by photons of our own, and then in the twenty random rooms of seeds 100 to 119. */
#ifndef SKG_TESTS_SCATTER_ROOMS_TRUTH_H
#define SKG_TESTS_SCATTER_ROOMS_TRUTH_H

#include "rooms.h"

extern const room_truth rooms_truths[];

#endif
