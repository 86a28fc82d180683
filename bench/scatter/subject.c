/* Scenes that scatter, their frames, and what is counted before it is smoothed. */
#include "scatter/subject.h"

#include "../tests/scatter/sums.h"
#include "common/thorax.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static skg_material *at_density(const char *name, double density) {
    skg_material *from = NULL, *material = NULL;
    bench_try(skg_material_create_named(name, &from), name);
    bench_try(skg_material_create_at_density(from, density, &material), name);
    skg_material_release(&from);
    return material;
}

subject subject_water(skg_context *context, const char *name, double plane, double density) {
    subject s = {.name = name, .context = context, .rays = 4};
    skg_part part;
    skg_part_init(&part);
    skg_view_init(&s.view);
    s.view.source[0] = -900, s.view.centre[0] = plane;
    s.view.column_step[1] = s.view.row_step[2] = 9.375;
    s.view.columns = s.view.rows = 32;
    bench_try(skg_scene_create(context, &s.scene), name);
    bench_try(skg_mesh_create_cuboid(200, 300, 300, &part.mesh), name);
    part.material = at_density("Water, Liquid", density);
    part.label = "water";
    bench_try(skg_scene_part_add(s.scene, &part, NULL), name);
    bench_try(skg_spectrum_create_mono(60, 1, &s.beam), name);
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    return s;
}

/* Gives a part a tissue by its Hounsfield number; per_cm: its attenuation at 80 keV, or 0 for its own. */
static void set_tissue(const subject *s, const char *label, double hu, double per_cm) {
    skg_material *material = NULL, *scaled = NULL;
    int64_t part = 0;
    double density = 0, own = 0;
    bench_try(skg_scene_part_find(s->scene, label, &part), label);
    bench_try(skg_material_create_hounsfield(hu, &material), label);
    bench_try(skg_material_density_get(material, &density), label);
    bench_try(skg_material_attenuation_get(material, 80, &own), label);
    bench_try(skg_material_create_at_density(material, density * (per_cm > 0 ? per_cm / own : 1), &scaled),
              label);
    bench_try(skg_scene_part_material_set(s->scene, part, scaled), label);
    skg_material_release(&material);
    skg_material_release(&scaled);
}

subject subject_cube(skg_context *context, const char *file, int exact) {
    subject s = {.name = "cube", .context = context, .rays = 2};
    skg_setup *setup = NULL;
    bench_try(skg_setup_load(context, file, 0, NULL, &setup), file);
    skg_view_init(&s.view);
    bench_try(skg_setup_scene_get(setup, &s.scene), file);
    bench_try(skg_setup_spectrum_get(setup, &s.beam), file);
    bench_try(skg_setup_view_get(setup, &s.view), file);
    bench_try(skg_scene_retain(s.scene), file);
    bench_try(skg_spectrum_retain(s.beam), file);
    skg_setup_release(&setup);
    set_tissue(&s, "soft tissue", 51, exact ? 0.19332243 : 0);
    set_tissue(&s, "bone", 1329, exact ? 0.39630633 : 0);
    return s;
}

subject subject_thorax(skg_context *context, long size) {
    subject s = {.name = "thorax", .context = context, .rays = 1};
    bench_thorax thorax;
    skg_tube tube;
    skg_filter filter;
    skg_material *aluminium = NULL;
    thorax_make(42000, THORAX_CLOSED, &thorax);
    s.scene = thorax_scene(context, &thorax);
    thorax_free(&thorax);
    thorax_view(size, &s.view);
    skg_tube_init(&tube);
    skg_filter_init(&filter);
    bench_try(skg_material_create_named("Al", &aluminium), "filter");
    filter.material = aluminium;
    filter.thickness_mm = 3;
    tube.kvp = 80, tube.filter_count = 1, tube.filters = &filter;
    bench_try(skg_spectrum_create_tube(&tube, &s.beam), "tube");
    skg_material_release(&aluminium);
    return s;
}

void subject_close(subject *s) {
    skg_scene_release(&s->scene);
    skg_spectrum_release(&s->beam);
    skg_material_release(&s->world);
}

static double cpu_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static skg_plan *plan_of(const subject *s, double tolerance, int64_t histories, int64_t seed) {
    skg_plan_options options;
    skg_scatter scatter;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    skg_scatter_init(&scatter);
    scatter.tolerance = tolerance, scatter.histories = histories, scatter.seed = seed;
    scatter.fluorescence = s->fluorescence;
    options.scatter = &scatter;
    options.falloff = SKG_FALLOFF_ON;
    options.supersampling = s->rays;
    options.overlaps = 0;
    options.world = s->world;
    bench_try(skg_plan_create(s->context, s->scene, &s->view, s->beam, &options, &plan), s->name);
    return plan;
}

/* One output of a frame; of the scatter alone there is no primary to be timed. */
static double *output_of(const subject *s, skg_plan *plan, int32_t kind) {
    const size_t count = (size_t)(s->view.rows * s->view.columns);
    float *narrow = bench_alloc(count, sizeof *narrow);
    double *image = bench_alloc(count, sizeof *image);
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.data = narrow, output.kind = kind;
    bench_try(skg_plan_submit(plan, 1, NULL, 1, &output, &job), s->name);
    bench_try(skg_job_wait(&job), s->name);
    for (size_t i = 0; i < count; i++) image[i] = (double)narrow[i];
    free(narrow);
    return image;
}

taken subject_take(const subject *s, double tolerance, int64_t histories, int64_t seed) {
    taken t = {.count = s->view.rows * s->view.columns};
    skg_plan *warm = plan_of(s, 0, 1024, seed), *plan = plan_of(s, tolerance, histories, seed);
    free(output_of(s, warm, SKG_OUTPUT_SCATTER));
    skg_plan_release(&warm);
    const double begun = cpu_now();
    t.scatter = output_of(s, plan, SKG_OUTPUT_SCATTER);
    t.cpu_s = cpu_now() - begun;
    t.sigma = output_of(s, plan, SKG_OUTPUT_SCATTER_SIGMA);
    t.image = output_of(s, plan, SKG_OUTPUT_IMAGE);
    skg_scatter_report_init(&t.report);
    bench_try(skg_plan_scatter_report_get(plan, &t.report), s->name);
    const int64_t columns = s->view.columns < 32 ? s->view.columns : 32,
                  rows = s->view.rows < 32 ? s->view.rows : 32;
    t.places = columns * rows; /* of square detectors */
    t.sums = bench_alloc((size_t)(SUMS_BATCHES * SUMS_PLANES * t.places), sizeof *t.sums);
    bench_try(sums_read(s->context, plan, t.sums), s->name);
    skg_plan_release(&plan);
    return t;
}

void taken_free(taken *t) {
    free(t->image);
    free(t->scatter);
    free(t->sigma);
    free(t->sums);
    *t = (taken){0};
}
