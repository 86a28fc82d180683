/* Shared code of tests of the public interface: a device, plans of a few lines, images and their bits. */
#include "support/run.h"

#include "suite.h"

#include <stdlib.h>
#include <string.h>

skg_context *run_context;

/* Whether Check runs each test in a process of its own; tests/CMakeLists.txt has the list of suites in which it does not. */
static int is_forked(void) {
    const char *fork = getenv("CK_FORK");
    return !fork || strcmp(fork, "no") != 0;
}

void run_open(void) {
    if (!run_context) ck_skg(skg_context_create(NULL, &run_context));
}

void run_close(void) {
    if (is_forked()) skg_context_release(&run_context);
}

int run_has_double(void) {
    skg_device_info info;
    skg_device_info_init(&info);
    ck_skg(skg_context_device_get(run_context, &info));
    return info.double_precision;
}

skg_view run_view(int64_t n, double pitch) {
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = n;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = pitch;
    return view;
}

skg_mesh *run_mesh(const solid *s) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create(run_context, "solid",
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = s->vertices,
                                              .positions = s->positions,
                                              .triangles = s->triangles,
                                              .corners = s->corners,
                                              .unit_mm = 1},
                           &mesh));
    return mesh;
}

int64_t run_part(skg_scene *scene, const char *label, skg_mesh *mesh, double mu, const double *pose,
                 int64_t inside) {
    skg_part part;
    int64_t id = -1;
    skg_part_init(&part);
    part.mesh = mesh;
    part.label = label;
    part.inside = inside;
    for (int k = 0; k < 16 && pose; k++) part.pose[k] = pose[k];
    ck_skg(skg_material_create_mu(label, mu, &part.material));
    ck_skg(skg_scene_part_add(scene, &part, &id));
    skg_material_release(&part.material);
    return id;
}

skg_scene *run_scene(const solid *s, const double *pose) {
    skg_scene *scene = NULL;
    skg_mesh *mesh = run_mesh(s);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "solid", mesh, 1, pose, -1);
    skg_mesh_release(&mesh);
    return scene;
}

skg_plan *run_plan(skg_scene *scene, const skg_view *view, run_choice choice) {
    skg_plan_options options;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    options.precision = choice.precision;
    options.strategy = choice.strategy;
    options.tile = choice.tile;
    options.quantity = choice.quantity;
    options.overlaps = 0;
    ck_skg(skg_spectrum_create_mono(100, 1, &spectrum));
    ck_skg(skg_plan_create(run_context, scene, view, spectrum, &options, &plan));
    skg_spectrum_release(&spectrum);
    return plan;
}

/* Floats become doubles in place, from the last on. */
static void widen(double *values, int64_t count) {
    const float *narrow = (const float *)(const void *)values;
    for (int64_t p = count - 1; p >= 0; p--) {
        float value;
        memcpy(&value, narrow + p, sizeof value);
        values[p] = (double)value;
    }
}

static double *image_of(skg_plan *plan, const skg_view *view, int lengths) {
    skg_plan_report report;
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    const int64_t count = view->rows * view->columns;
    double *image = calloc((size_t)count, sizeof *image);
    skg_plan_report_init(&report);
    ck_skg(skg_plan_report_get(plan, &report));
    skg_frame_init(&frame);
    skg_output_init(&output);
    output.type = report.precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output.data = image;
    if (lengths) {
        output.kind = SKG_OUTPUT_LENGTHS;
        output.lengths = SKG_LENGTHS_SURFACE;
        ck_skg(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
    } else {
        ck_skg(skg_plan_image(plan, &output));
    }
    if (output.type == SKG_TYPE_FLOAT32) widen(image, count);
    return image;
}

double *run_lengths(skg_plan *plan, const skg_view *view) {
    return image_of(plan, view, 1);
}

double *run_image(skg_plan *plan, const skg_view *view) {
    return image_of(plan, view, 0);
}

double *run_solid(const solid *s, const double *pose, const skg_view *view, run_choice choice) {
    skg_scene *scene = run_scene(s, pose);
    skg_plan *plan = run_plan(scene, view, choice);
    double *image = run_lengths(plan, view);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    return image;
}

uint64_t run_hash(const void *bytes, int64_t count) {
    uint64_t hash = 14695981039346656037u;
    const unsigned char *at = bytes;
    for (int64_t n = 0; n < count; n++) hash = (hash ^ at[n]) * 1099511628211u;
    return hash;
}
