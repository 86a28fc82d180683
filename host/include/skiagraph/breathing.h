/** @file
 * Breathing: includes breath.h, thorax.h and body.h.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BREATHING_H
#define SKIAGRAPH_BREATHING_H

#include <skiagraph/body.h>
#include <skiagraph/breath.h>
#include <skiagraph/thorax.h>

#endif
