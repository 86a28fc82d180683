/* The scene of the tests of noise: a slab in a parallel beam, its photons by formulas, and what is checked of images. */
#include "analytic/noise_scene.h"

#include <math.h>

skg_context *context;
skg_scene *scene;
skg_material *tissue, *iodide;
skg_response *scintillator;
skg_view view;
const double two_kev[2] = {40, 80};

void open_scene(void) {
    skg_mesh *slab = NULL;
    skg_part part;
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_scene_create(context, &scene));
    ck_skg(skg_material_create_named("Tissue, Soft (ICRU-44)", &tissue));
    ck_skg(skg_material_create_named("CsI", &iodide));
    ck_skg(skg_response_create_scintillator(iodide, 0.6, 0.8, &scintillator));
    ck_skg(skg_mesh_create_cuboid(1000, 1000, THICKNESS, &slab));
    skg_part_init(&part);
    part.mesh = slab, part.material = tissue, part.label = "slab";
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&slab);
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.columns = view.rows = SIDE;
    view.source[2] = 1; /* direction */
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 0.2;
}

void close_scene(void) {
    skg_response_release(&scintillator);
    skg_material_release(&tissue);
    skg_material_release(&iodide);
    skg_scene_release(&scene);
    skg_context_release(&context);
}

skg_spectrum *energies(int64_t count, const double *kev, const double *photons) {
    skg_spectrum *spectrum = NULL;
    ck_skg(skg_spectrum_create_bins(count, kev, photons, &spectrum));
    return spectrum;
}

skg_plan_options noisy(void) {
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.noise = 1;
    return options;
}

/* `count` frames of an own index and this seed: [count][PIXELS]. */
void take(const skg_spectrum *spectrum, const skg_plan_options *options, int64_t seed, int64_t count,
          double *images) {
    skg_plan *plan = NULL;
    skg_frame frames[8];
    skg_output output;
    skg_job *job = NULL;
    ck_assert(count <= 8);
    for (int64_t i = 0; i < count; i++) {
        skg_frame_init(&frames[i]);
        frames[i].noise_seed = seed, frames[i].index = i;
    }
    ck_skg(skg_plan_create(context, scene, &view, (skg_spectrum *)spectrum, options, &plan));
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = images;
    ck_skg(skg_plan_submit(plan, count, frames, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    skg_plan_release(&plan);
}

moments moments_of(int64_t count, const double *values) {
    moments m = {0, 0};
    for (int64_t i = 0; i < count; i++) m.mean += values[i];
    m.mean /= (double)count;
    for (int64_t i = 0; i < count; i++) m.variance += (values[i] - m.mean) * (values[i] - m.mean);
    m.variance /= (double)(count - 1);
    return m;
}

truth sum_energies(int64_t count, const double *kev, const double *photons, const skg_plan_options *options) {
    truth t = {0};
    for (int64_t i = 0; i < count; i++) {
        double per_cm = 0, recorded = kev[i], efficiency = 1;
        ck_skg(skg_material_attenuation_get(tissue, kev[i], &per_cm));
        if (options->response) ck_skg(skg_response_get(options->response, kev[i], 1, &recorded, &efficiency));
        double swank = 1;
        ck_skg(skg_response_swank_get(options->response, kev[i], 1, &swank));
        swank *= options->swank;
        const double detected = photons[i] * exp(-0.1 * per_cm * THICKNESS) * efficiency * swank;
        const double each = recorded / efficiency / swank;
        t.detected += detected;
        t.mean += detected * each;
        t.variance += detected * each * each;
        t.fourth += detected * pow(each, 4);
    }
    return t;
}

/* Mean and variance within four standard errors. */
void check_moments(int64_t count, const double *values, const truth *t) {
    const moments m = moments_of(count, values);
    const double n = (double)count;
    const double error = sqrt((2 * t->variance * t->variance + t->fourth) / n);
    /* Floats of single precision add 16 roundings, 16 * FLT_EPSILON / 2 = 1e-6. */
    ck_assert_double_eq_tol(m.mean, t->mean, 4 * sqrt(t->variance / n) + 1e-6 * t->mean);
    ck_assert_double_eq_tol(m.variance, t->variance, 4 * error + 1e-6 * t->variance);
}

void check_two_energies(const double *photons, const skg_plan_options *options) {
    static double images[4 * PIXELS];
    skg_spectrum *spectrum = energies(2, two_kev, photons);
    const truth t = sum_energies(2, two_kev, photons, options);
    take(spectrum, options, 7, 4, images);
    check_moments(4 * PIXELS, images, &t);
    skg_spectrum_release(&spectrum);
}
