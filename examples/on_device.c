/* Images that stay on the device: a program with an OpenCL context of its own has images written into its buffers, and a kernel of
 * its own compares them. One number for each row comes back. The search finds the place of a cube from its image alone.
 *
 *     cc on_device.c $(pkg-config --cflags --libs skiagraph-opencl) -lm -o on_device */
#include <skiagraph/opencl.h>
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 256, ROWS = 192, PLACES = 9 };
static const double truth = 3; /* mm along x */

/* Each work-item adds up the squared differences of one row. */
static const char text[] =
    "__kernel void compare(__global const float *image, __global const float *wanted, int columns, __global float *sums) {\n"
    "    const int row = (int)get_global_id(0);\n"
    "    float sum = 0.0f;\n"
    "    for (int c = 0; c < columns; c++) {\n"
    "        const float off = image[row * columns + c] - wanted[row * columns + c];\n"
    "        sum = fma(off, off, sum);\n"
    "    }\n"
    "    sums[row] = sum;\n"
    "}\n";

typedef struct {
    cl_context cl;
    cl_command_queue queue;
    cl_program program;
    cl_kernel compare;
    cl_mem image, wanted, sums;
    skg_plan *plan;
} device;

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

static int opencl_failed(cl_int code, const char *call) {
    if (code != CL_SUCCESS) fprintf(stderr, "error %d from %s\n", (int)code, call);
    return code != CL_SUCCESS;
}

/* Any device, as a program that computes something else would have chosen it. */
static int open_device(device *d, cl_device_id *id) {
    cl_platform_id platform = NULL;
    cl_int code = clGetPlatformIDs(1, &platform, NULL);
    if (opencl_failed(code, "clGetPlatformIDs")) return 1;
    if (opencl_failed(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, id, NULL), "clGetDeviceIDs")) return 1;
    d->cl = clCreateContext(NULL, 1, id, NULL, NULL, &code);
    if (opencl_failed(code, "clCreateContext")) return 1;
    d->queue = clCreateCommandQueue(d->cl, *id, 0, &code);
    if (opencl_failed(code, "clCreateCommandQueue")) return 1;
    const char *source = text;
    d->program = clCreateProgramWithSource(d->cl, 1, &source, NULL, &code);
    if (opencl_failed(code, "clCreateProgramWithSource") ||
        opencl_failed(clBuildProgram(d->program, 1, id, "", NULL, NULL), "clBuildProgram"))
        return 1;
    d->compare = clCreateKernel(d->program, "compare", &code);
    const size_t bytes = (size_t)COLUMNS * ROWS * sizeof(float);
    if (!code) d->image = clCreateBuffer(d->cl, CL_MEM_READ_WRITE, bytes, NULL, &code);
    if (!code) d->wanted = clCreateBuffer(d->cl, CL_MEM_READ_WRITE, bytes, NULL, &code);
    if (!code) d->sums = clCreateBuffer(d->cl, CL_MEM_WRITE_ONLY, ROWS * sizeof(float), NULL, &code);
    return opencl_failed(code, "the kernel or a buffer");
}

/* The image with the cube at x goes into the buffer. done: an event for what follows. */
static int render(const device *d, double x, cl_mem into, cl_event *done) {
    static const int64_t part = 0;
    const double pose[16] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    skg_frame frame;
    skg_output output;
    skg_job *job = NULL;
    skg_frame_init(&frame);
    frame.pose_count = 1;
    frame.pose_parts = &part;
    frame.poses = pose;
    skg_output_init(&output);
    output.buffer = into;
    return failed(skg_plan_submit_cl(d->plan, 1, &frame, 1, &output, 0, NULL, done, &job)) ||
           failed(skg_job_wait(&job));
}

/* The sum of squared differences between the image with the cube at x and the wanted one. */
static int measure(const device *d, double x, double *error) {
    const cl_int columns = COLUMNS;
    const size_t rows = ROWS;
    float sums[ROWS];
    cl_event done = NULL;
    if (render(d, x, d->image, &done)) return 1;
    clSetKernelArg(d->compare, 0, sizeof(cl_mem), &d->image);
    clSetKernelArg(d->compare, 1, sizeof(cl_mem), &d->wanted);
    clSetKernelArg(d->compare, 2, sizeof columns, &columns);
    clSetKernelArg(d->compare, 3, sizeof(cl_mem), &d->sums);
    cl_int code = clEnqueueNDRangeKernel(d->queue, d->compare, 1, NULL, &rows, NULL, 1, &done, NULL);
    clReleaseEvent(done);
    if (opencl_failed(code, "clEnqueueNDRangeKernel")) return 1;
    code = clEnqueueReadBuffer(d->queue, d->sums, CL_TRUE, 0, sizeof sums, sums, 0, NULL, NULL);
    *error = 0;
    for (int row = 0; row < ROWS; row++) *error += (double)sums[row];
    return opencl_failed(code, "clEnqueueReadBuffer");
}

/* A cube of 20 mm, 40 cm from the source and 10 cm from the detector. */
static int make_plan(skg_context *context, skg_plan **plan) {
    skg_scene *scene = NULL;
    skg_spectrum *beam = NULL;
    skg_plan_options options;
    skg_part part;
    skg_view view;
    skg_part_init(&part);
    skg_view_init(&view);
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    view.source[1] = -400, view.centre[1] = 100;
    view.column_step[0] = 0.25, view.row_step[2] = -0.25;
    view.columns = COLUMNS, view.rows = ROWS;
    part.label = "cube";
    int64_t id = 0;
    const int bad =
        failed(skg_scene_create(context, &scene)) || failed(skg_mesh_create_cube(20, &part.mesh)) ||
        failed(skg_material_create_mu("plastic", 0.5, &part.material)) ||
        failed(skg_scene_part_add(scene, &part, &id)) || failed(skg_spectrum_create_mono(60, 1000, &beam)) ||
        failed(skg_plan_create(context, scene, &view, beam, &options, plan));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    return bad;
}

static int search(const device *d) {
    double best = HUGE_VAL, found = 0;
    cl_event done = NULL;
    if (render(d, truth, d->wanted, &done)) return 1;
    clReleaseEvent(done);
    for (int n = 0; n < PLACES; n++) {
        const double x = n - PLACES / 2;
        double error = 0;
        if (measure(d, x, &error)) return 1;
        printf("cube at %+.0f mm: %.6g\n", x, error);
        if (error < best) best = error, found = x;
    }
    printf("found at %+.0f mm\n", found);
    return !(best == 0 && found == truth); /* the same pose has the same bits */
}

int main(void) {
    device d = {0};
    skg_context *context = NULL;
    cl_device_id id = NULL;
    const int bad = open_device(&d, &id) || failed(skg_context_create_cl(d.cl, id, d.queue, &context)) ||
                    make_plan(context, &d.plan) || search(&d);
    skg_plan_release(&d.plan);
    skg_context_release(&context);
    if (d.image) clReleaseMemObject(d.image);
    if (d.wanted) clReleaseMemObject(d.wanted);
    if (d.sums) clReleaseMemObject(d.sums);
    if (d.compare) clReleaseKernel(d.compare);
    if (d.program) clReleaseProgram(d.program);
    if (d.queue) clReleaseCommandQueue(d.queue);
    if (d.cl) clReleaseContext(d.cl);
    return bad;
}
