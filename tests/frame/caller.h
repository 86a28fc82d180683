/* A caller with OpenCL objects of its own, and a cube of 20 mm with a ball inside. */
#ifndef SKG_TEST_CALLER_H
#define SKG_TEST_CALLER_H

#include <skiagraph/opencl.h>
#include <skiagraph/skiagraph.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE };

typedef struct {
    cl_context cl;
    cl_device_id device;
    cl_command_queue queue;
    cl_mem buffer;
    skg_context *context;
    skg_scene *scene;
    skg_plan *plan;
    skg_view view;
} caller;

/* bytes: of the buffer; options: of the plan, may be NULL. */
void open_caller(caller *c, size_t bytes, const skg_plan_options *options);
void close_caller(caller *c);

/* Adds a part, and releases the mesh. inside: a part, or -1. */
void add_part(caller *c, const char *label, skg_mesh *mesh, double mu, int64_t inside);

/* An output to this memory. */
skg_output output_of(void *data);

#endif
