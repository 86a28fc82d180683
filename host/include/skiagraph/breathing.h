/** @file
 * Breathing: includes breath.h, thorax.h and body.h. */
#ifndef SKIAGRAPH_BREATHING_H
#define SKIAGRAPH_BREATHING_H

#include <skiagraph/body.h>
#include <skiagraph/breath.h>
#include <skiagraph/thorax.h>

#endif
