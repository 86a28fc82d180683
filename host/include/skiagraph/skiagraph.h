/** @file
 * Skiagraph: X-ray images of triangle meshes on any OpenCL device. This header includes all that makes them. What moves a scene,
 * scans it, finds a body in radiographs or serves its page is included by name: breathing.h, scanning.h, registration.h, live.h; and so
 * is opencl.h.
 *
 * Objects are handles. skg_X_create_... makes one, skg_X_retain adds an owner and skg_X_release removes one;
 * handles without a retain function have one owner. Results come last and by pointer. Lengths are in mm,
 * energies in keV, densities in g/cm3, linear attenuation coefficients in 1/cm, times in s, angles in radians
 * unless the name says degrees. error.h explains status codes, export.h the structs, context.h threads and
 * fork, frame.h jobs.
 *
 * Calls compute in the default floating-point environment and read and write decimal points, whatever rounding
 * mode and locale the calling thread has. Both are restored when a call returns.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_H
#define SKIAGRAPH_H

#include <skiagraph/beam.h>
#include <skiagraph/blur.h>
#include <skiagraph/bodies.h>
#include <skiagraph/collimation.h>
#include <skiagraph/context.h>
#include <skiagraph/counting.h>
#include <skiagraph/dose.h>
#include <skiagraph/error.h>
#include <skiagraph/image.h>
#include <skiagraph/material.h>
#include <skiagraph/memory.h>
#include <skiagraph/mesh.h>
#include <skiagraph/part_table.h>
#include <skiagraph/plan.h>
#include <skiagraph/progress.h>
#include <skiagraph/scatter.h>
#include <skiagraph/scene.h>
#include <skiagraph/scene_picture.h>
#include <skiagraph/setup.h>
#include <skiagraph/source.h>
#include <skiagraph/types.h>
#include <skiagraph/version.h>
#include <skiagraph/volume.h>

#endif
