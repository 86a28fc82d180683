/* Skiagraph: X-ray images of triangle meshes on any OpenCL device. This header takes in all others but
 * opencl.h. */
#ifndef SKIAGRAPH_H
#define SKIAGRAPH_H

#include <skiagraph/beam.h>
#include <skiagraph/breathing.h>
#include <skiagraph/context.h>
#include <skiagraph/error.h>
#include <skiagraph/image.h>
#include <skiagraph/material.h>
#include <skiagraph/mesh.h>
#include <skiagraph/motion.h>
#include <skiagraph/plan.h>
#include <skiagraph/scene.h>
#include <skiagraph/setup.h>
#include <skiagraph/version.h>

#endif
