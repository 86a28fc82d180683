/* Measures the cost of energies, with 5 materials at 1024 x 1024 pixels: the library's attenuation of 90 energies against a plain kernel of
 * the same sum with OpenCL's exp; and images of 150 energies against images of the compressed spectrum. */
#include "common/bench.h"

#include "affinity/affinity.h"

#include <skiagraph/opencl.h>

#include <stdlib.h>
#include <string.h>

static const char usage[] = "[--quick] [--size N] [--repeats N] [--device CONFIG] [--affinity] [--csv FILE]";
enum { MATERIALS = 5, ENERGIES = 90, BINS = 150 };

typedef struct {
    long size, repeats;
    int affinity;
    const char *device, *csv;
} settings;

/* The rival: the same loops with eight pixels in a work-item. */
static const char rival_source[] =
    "__kernel void attenuate(int materials, int energies, __global const float8 *lengths, __constant float *mu,\n"
    "                        __constant float *weight, __global float8 *image) {\n"
    "    const size_t item = get_global_id(0), items = get_global_size(0);\n"
    "    float8 sum = 0;\n"
    "    for (int e = 0; e < energies; e++) {\n"
    "        float8 x = 0;\n"
    "        for (int m = 0; m < materials; m++) x += mu[e * materials + m] * lengths[m * items + item];\n"
    "        sum += weight[e] * exp(-x);\n"
    "    }\n"
    "    image[item] = sum;\n"
    "}\n";

typedef struct {
    cl_context cl;
    cl_command_queue queue;
    cl_program program;
    cl_kernel kernel;
    cl_mem memory[4]; /* lengths, mu, weights, image */
    size_t pixels;
} rival;

static void check(cl_int code, const char *what) {
    if (code != CL_SUCCESS) bench_die("%s: OpenCL code %d", what, (int)code);
}

static cl_mem buffer_of(const rival *r, size_t bytes) {
    cl_int code = CL_SUCCESS;
    cl_mem memory = clCreateBuffer(r->cl, CL_MEM_READ_WRITE, bytes, NULL, &code);
    check(code, "clCreateBuffer");
    const float some = 0.01f;
    check(clEnqueueFillBuffer(r->queue, memory, &some, sizeof some, 0, bytes, 0, NULL, NULL),
          "clEnqueueFillBuffer");
    return memory;
}

/* On the first device of the first platform. */
static void open_rival(rival *r, size_t pixels) {
    static const char *const source = rival_source;
    const cl_int counts[2] = {MATERIALS, ENERGIES};
    cl_platform_id platform;
    cl_device_id device;
    cl_int code = clGetPlatformIDs(1, &platform, NULL);
    check(code, "clGetPlatformIDs");
    check(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL), "clGetDeviceIDs");
    r->pixels = pixels;
    r->cl = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    check(code, "clCreateContext");
    r->queue = clCreateCommandQueue(r->cl, device, 0, &code);
    check(code, "clCreateCommandQueue");
    r->program = clCreateProgramWithSource(r->cl, 1, (const char **)&source, NULL, &code);
    check(code, "clCreateProgramWithSource");
    check(clBuildProgram(r->program, 1, &device, "-cl-std=CL1.2", NULL, NULL), "clBuildProgram");
    r->kernel = clCreateKernel(r->program, "attenuate", &code);
    check(code, "clCreateKernel");
    const size_t bytes[4] = {pixels * MATERIALS * 4, MATERIALS * ENERGIES * 4, ENERGIES * 4, pixels * 4};
    for (cl_uint k = 0; k < 2; k++)
        check(clSetKernelArg(r->kernel, k, sizeof counts[k], &counts[k]), "counts");
    for (cl_uint k = 0; k < 4; k++) {
        r->memory[k] = buffer_of(r, bytes[k]);
        check(clSetKernelArg(r->kernel, 2 + k, sizeof(cl_mem), &r->memory[k]), "memory");
    }
}

static void close_rival(rival *r) {
    for (int k = 0; k < 4; k++) clReleaseMemObject(r->memory[k]);
    clReleaseKernel(r->kernel);
    clReleaseProgram(r->program);
    clReleaseCommandQueue(r->queue);
    clReleaseContext(r->cl);
}

static void run_rival(void *contender) {
    rival *r = contender;
    const size_t items = r->pixels / 8, local = 64;
    check(clEnqueueNDRangeKernel(r->queue, r->kernel, 1, NULL, &items, &local, 0, NULL, NULL), "rival");
    check(clFinish(r->queue), "clFinish");
}

/* Five nested boxes of different materials that fill the detector. */
static skg_scene *nested_boxes(skg_context *context) {
    static const char *const matter[MATERIALS] = {"water", "Bone, Cortical (ICRU-44)",
                                                  "Adipose Tissue (ICRU-44)", "Al", "Tissue, Soft (ICRU-44)"};
    skg_scene *scene = NULL;
    bench_try(skg_scene_create(context, &scene), "scene");
    for (int i = 0; i < MATERIALS; i++) {
        skg_mesh *box = NULL;
        skg_material *material = NULL;
        skg_part part;
        bench_try(skg_mesh_create_cuboid(600 - 20 * i, 600 - 20 * i, 100 - 15 * i, &box), "box");
        bench_try(skg_material_create_named(matter[i], &material), "material");
        skg_part_init(&part);
        part.mesh = box, part.material = material, part.label = matter[i], part.inside = i - 1;
        bench_try(skg_scene_part_add(scene, &part, NULL), "part");
        skg_mesh_release(&box);
        skg_material_release(&material);
    }
    return scene;
}

static skg_spectrum *even_spectrum(int64_t bins) {
    static double kev[BINS], photons[BINS];
    skg_spectrum *spectrum = NULL;
    for (int64_t i = 0; i < bins; i++) {
        kev[i] = 20 + 100.0 * (double)i / (double)bins;
        photons[i] = 1 + (double)(i % 7);
    }
    bench_try(skg_spectrum_create_bins(bins, kev, photons, &spectrum), "spectrum");
    return spectrum;
}

typedef struct {
    skg_plan *plan;
    skg_output output;
    double attenuate_ms; /* of the last frame, if stages are timed */
} frames;

static frames plan_of(skg_context *context, skg_scene *scene, const settings *s, int64_t bins,
                      double tolerance, int profile) {
    frames f = {0};
    skg_view view;
    skg_plan_options options;
    skg_spectrum *spectrum = even_spectrum(bins);
    skg_view_init(&view);
    view.columns = view.rows = s->size;
    view.source[2] = -1000, view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 300.0 / (double)s->size;
    skg_plan_options_init(&options);
    options.tolerance = tolerance, options.profile = profile, options.overlaps = 0;
    bench_try(skg_plan_create(context, scene, &view, spectrum, &options, &f.plan), "plan");
    skg_output_init(&f.output);
    f.output.data = bench_alloc((size_t)(s->size * s->size), sizeof(float));
    skg_spectrum_release(&spectrum);
    return f;
}

static void run_frame(void *contender) {
    frames *f = contender;
    bench_try(skg_plan_image(f->plan, &f->output), "image");
}

static void close_frames(frames *f) {
    skg_plan_release(&f->plan);
    free(f->output.data);
}

static double stage_ms(const skg_plan *plan, const char *name) {
    int64_t count = 0;
    skg_stage stage;
    bench_try(skg_plan_stage_count(plan, &count), "stages");
    for (int64_t i = 0; i < count; i++) {
        skg_stage_init(&stage);
        bench_try(skg_plan_stage_get(plan, i, &stage), "stage");
        if (strcmp(stage.name, name) == 0) return stage.ns * 1e-6;
    }
    return 0;
}

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.size = 1024, .repeats = 30};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->repeats = 10;
        else if (bench_flag(&arguments, "--affinity"))
            out->affinity = 1;
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 32, 8192, 1, &out->size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 5, BENCH_SAMPLES, 1, &out->repeats);
        else if (!bench_option(&arguments, "--device", &out->device) &&
                 !bench_option(&arguments, "--csv", &out->csv))
            bench_usage(&arguments, usage);
    }
}

/* The library's exponentials against OpenCL's, in turns of one frame. */
static void compare_exponentials(skg_context *context, skg_scene *scene, const settings *s, FILE *csv) {
    const size_t pixels = (size_t)(s->size * s->size);
    const double exponentials = (double)pixels * ENERGIES;
    frames own = plan_of(context, scene, s, ENERGIES, 0, 1);
    rival other = {0};
    bench_times ours = {0}, theirs = {0};
    open_rival(&other, pixels);
    run_rival(&other);
    run_frame(&own);
    for (long i = 0; i < s->repeats; i++) {
        run_frame(&own);
        bench_add(&ours, stage_ms(own.plan, "attenuate"));
        const double start = bench_now();
        run_rival(&other);
        bench_add(&theirs, bench_now() - start);
    }
    printf("| attenuation of %d energies, %d materials | min ms | median ms | Gexp/s |\n|---|---|---|---|\n",
           ENERGIES, MATERIALS);
    printf("| library | %.2f | %.2f | %.2f |\n", bench_min(&ours), bench_median(&ours),
           exponentials / bench_min(&ours) * 1e-6);
    printf("| OpenCL's exp of eight pixels | %.2f | %.2f | %.2f |\n", bench_min(&theirs),
           bench_median(&theirs), exponentials / bench_min(&theirs) * 1e-6);
    printf("\nlibrary over OpenCL's exp: %.2f (target: 1.5)\n\n", bench_min(&theirs) / bench_min(&ours));
    if (csv)
        fprintf(csv, "attenuate,library,%g,%g\nattenuate,opencl_exp,%g,%g\n", bench_min(&ours),
                bench_median(&ours), bench_min(&theirs), bench_median(&theirs));
    close_rival(&other);
    close_frames(&own);
}

/* Whole frames with every energy and with the nodes of several tolerances. */
static void compare_tolerances(skg_context *context, skg_scene *scene, const settings *s, FILE *csv) {
    static const double tolerances[] = {0, 1e-6, 1e-4, 1e-2};
    enum { CASES = sizeof tolerances / sizeof *tolerances };
    frames plans[CASES];
    bench_frame functions[CASES];
    void *what[CASES];
    bench_times times[CASES] = {{0}};
    for (int i = 0; i < CASES; i++) {
        plans[i] = plan_of(context, scene, s, BINS, tolerances[i], 0);
        functions[i] = run_frame;
        what[i] = &plans[i];
    }
    bench_interleave(CASES, functions, what, (int)s->repeats / 5, 5, times);
    printf("| tolerance, %d energies | nodes | planes | stated error | min ms | median ms | faster |\n"
           "|---|---|---|---|---|---|---|\n",
           BINS);
    for (int i = 0; i < CASES; i++) {
        skg_plan_report report;
        skg_plan_report_init(&report);
        bench_try(skg_plan_report_get(plans[i].plan, &report), "report");
        printf("| %g | %d | %d | %.2g | %.2f | %.2f | %.2f |\n", tolerances[i], (int)report.nodes,
               (int)report.planes, report.bound, bench_min(&times[i]), bench_median(&times[i]),
               bench_min(&times[0]) / bench_min(&times[i]));
        if (csv)
            fprintf(csv, "tolerance_%g,library,%g,%g\n", tolerances[i], bench_min(&times[i]),
                    bench_median(&times[i]));
        close_frames(&plans[i]);
    }
}

int main(int count, char **words) {
    settings s;
    read_settings(count, words, &s);
    if (s.affinity) host_pin_threads();
    FILE *csv = s.csv ? bench_open(s.csv) : NULL;
    if (csv) fprintf(csv, "case,contender,min_ms,median_ms\n");
    skg_context *context = bench_context(s.device);
    skg_scene *scene = nested_boxes(context);
    compare_exponentials(context, scene, &s, csv);
    compare_tolerances(context, scene, &s, csv);
    skg_scene_release(&scene);
    skg_context_release(&context);
    if (csv && fclose(csv) != 0) bench_die("%s could not be written", s.csv);
    return 0;
}
