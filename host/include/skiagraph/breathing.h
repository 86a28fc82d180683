/** @file
 * Breathing: a body that breathes, the thorax that is made by numbers, the motion of a scene, distances between meshes, and the fit
 * of a body to a patient. Includes the headers of these.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BREATHING_H
#define SKIAGRAPH_BREATHING_H

#include <skiagraph/body.h>
#include <skiagraph/breath.h>
#include <skiagraph/distance.h>
#include <skiagraph/fit.h>
#include <skiagraph/motion.h>
#include <skiagraph/thorax.h>

#endif
