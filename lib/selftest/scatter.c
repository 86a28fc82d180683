/* The self-test of scatter. */
#include "core/core.h"
#include "material/scattering.h"
#include "scatter/interactions.h"
#include "selftest/selftest.h"

#include <skiagraph/report.h>

#include <math.h>
#include <stdio.h>

enum { N = 8, PIXELS = N * N, PIECES = 4 };

/* A small cube of water, in which hardly any photon scatters twice, behind jaws of about its size. keV and mm. */
static const double kev = 60, edge = 0.5, source = 500, detector = 60, pixel = 20, opening = 0.6;

/* 20 cm of water before a detector of 30 x 30 cm at 20 cm: scatter over primary by EGSnrc (docs/validation.md). */
static const double slab_ratio = 1.1452;

typedef struct {
    skg_scene *scene;
    skg_material *water;
    skg_spectrum *beam;
    skg_plan *plan;
    float image[2][PIXELS]; /* all photons; scattered ones */
} scatter_run;

static skg_status make_scene(skg_context *context, const double *edges, scatter_run *run) {
    skg_part part;
    skg_part_init(&part);
    part.label = "water";
    SKG_TRY(skg_material_create_formula("H2O", 1, &run->water));
    SKG_TRY(skg_spectrum_create_mono(kev, 1, &run->beam));
    SKG_TRY(skg_scene_create(context, &run->scene));
    SKG_TRY(skg_mesh_create_cuboid(edges[0], edges[1], edges[2], &part.mesh));
    part.material = run->water;
    const skg_status status = skg_scene_part_add(run->scene, &part, NULL);
    skg_mesh_release(&part.mesh);
    return status;
}

static skg_status render(skg_context *context, const double *edges, const skg_view *view,
                         const skg_collimation *jaws, int64_t histories, scatter_run *run) {
    skg_plan_options options;
    skg_scatter scatter;
    skg_output outputs[2];
    skg_job *job = NULL;
    skg_plan_options_init(&options);
    skg_scatter_init(&scatter);
    scatter.histories = histories;
    options.scatter = &scatter;
    options.collimation = jaws;
    options.falloff = SKG_FALLOFF_ON;
    /* The program of a first image, which is there in any case; a GPU has none of this strategy. */
    options.strategy = context->device->info.gpu ? SKG_STRATEGY_ATOMICS : SKG_STRATEGY_COPIES;
    SKG_TRY(make_scene(context, edges, run));
    SKG_TRY(skg_plan_create(context, run->scene, view, run->beam, &options, &run->plan));
    for (int k = 0; k < 2; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].data = run->image[k];
    }
    outputs[1].kind = SKG_OUTPUT_SCATTER;
    SKG_TRY(skg_plan_submit(run->plan, 1, NULL, 2, outputs, &job));
    return skg_job_wait(&job);
}

static void drop(scatter_run *run) {
    skg_plan_release(&run->plan);
    skg_scene_release(&run->scene);
    skg_spectrum_release(&run->beam);
    skg_material_release(&run->water);
}

static skg_view view_of(double from, double to, double step) {
    skg_view view;
    skg_view_init(&view);
    view.source[0] = -from;
    view.centre[0] = to;
    view.column_step[1] = view.row_step[2] = step;
    view.columns = view.rows = N;
    return view;
}

/* keV that a mm of water sends through 1 sr at an angle, of one photon per mm2. */
static double sent(const skg_scatter_physics *p, double cosine) {
    const int64_t last = p->energies - 1;
    const double x = kev / SKG_HC_KEV_ANGSTROM * sqrt(0.5 * (1 - cosine));
    const double range = log1p(p->momentum_high / p->momentum_scale);
    const int64_t row = llrint(log1p(x / p->momentum_scale) / range * (double)(p->momenta - 1));
    const double mixture = p->coefficients[0][0];
    const double compton = (double)p->compton[last][0] / (double)p->compton_shape[last][0];
    const double rayleigh = (double)p->rayleigh[last][0] / (double)p->rayleigh_shape[last][0];
    const double left = kev / (1 + kev / SKG_ELECTRON_KEV * (1 - cosine));
    return mixture * (compton * skg_klein_nishina(kev, cosine) * (double)p->incoherent[row][0] * left +
                      rayleigh * skg_thomson(cosine) * (double)p->coherent[row][0] * kev);
}

/* The scatter of the cube in a pixel, keV: all of it from the cube's middle. */
static double wanted_at(const skg_scatter_physics *p, int64_t number) {
    const double per_sr = (source + detector) * (source + detector) / (pixel * pixel);
    const double through = exp(-edge * (double)p->total[p->energies - 1][0] * p->coefficients[0][0]);
    const double photons = per_sr / (source * source) * edge * edge * edge * through;
    double sum = 0;
    for (int k = 0; k < PIECES * PIECES; k++) {
        const double y = pixel * ((double)(number % N) - N / 2 + 0.5 + (k % PIECES + 0.5) / PIECES);
        const double z = pixel * ((double)(number / N) - N / 2 + 0.5 + (k / PIECES + 0.5) / PIECES);
        const double r = sqrt(detector * detector + y * y + z * z), cosine = detector / r;
        sum += sent(p, cosine) * cosine / (r * r) * pixel * pixel / (PIECES * PIECES);
    }
    return photons * sum;
}

/* Blocks of four pixels are right within 6 %: at the corners 7,000 contributions of 131,072 histories leave 1.2 % of noise. */
static void compare_blocks(const skg_scatter_physics *p, const float *image, skg_verdict *verdict) {
    verdict->good = 1;
    for (int block = 0; block < PIXELS / 4 && verdict->good; block++) {
        const int first = block / (N / 2) * 2 * N + block % (N / 2) * 2;
        double wanted = 0, shown = 0;
        for (int k = 0; k < 4; k++) {
            const int pixel_of = first + k / 2 * N + k % 2;
            wanted += wanted_at(p, pixel_of);
            shown += (double)image[pixel_of];
        }
        if (fabs(shown / wanted - 1) <= 0.06) continue;
        verdict->good = 0;
        snprintf(verdict->reason, sizeof verdict->reason,
                 "four pixels from (%d, %d) on of the scatter of a small cube have %.4g keV instead of %.4g",
                 first / N, first % N, shown, wanted);
    }
}

static skg_status compare_cube(skg_context *context, skg_verdict *verdict) {
    const double edges[3] = {edge, edge, edge};
    const double aside =
        0.5 * pixel * source / (source + detector); /* of the detector's middle, at the jaws */
    skg_view view = view_of(source, detector, pixel);
    scatter_run run = {0};
    skg_scatter_physics physics = {0};
    skg_collimation jaws;
    skg_status status = SKG_OK;
    skg_collimation_init(&jaws);
    jaws.kind = SKG_COLLIMATION_RECTANGLE;
    jaws.distance_mm = source;
    jaws.low[0] = jaws.low[1] = -opening / 2 - aside;
    jaws.high[0] = jaws.high[1] = opening / 2 - aside;
    view.centre[1] = view.centre[2] = 0.5 * pixel; /* a pixel sees the source through the jaws */
    SKG_TRY_CLEANUP(render(context, edges, &view, &jaws, 131072, &run));
    SKG_TRY_CLEANUP(skg_scatter_physics_make(1, &run.water, NULL, kev / 4, kev, &physics));
    compare_blocks(&physics, run.image[1], verdict);
cleanup:
    skg_scatter_physics_free(&physics);
    drop(&run);
    return status;
}

/* 16,384 histories leave 1 % of the sum; the coarse pixels make the primary 1 % too large. */
static skg_status compare_slab(skg_context *context, skg_verdict *verdict) {
    const double edges[3] = {200, 300, 300};
    const skg_view view = view_of(900, 300, 37.5);
    scatter_run run = {0};
    double all = 0, scattered = 0;
    const skg_status status = render(context, edges, &view, NULL, 16384, &run);
    for (int p = 0; p < PIXELS; p++) all += (double)run.image[0][p], scattered += (double)run.image[1][p];
    const double ratio = scattered / (all - scattered);
    verdict->good = fabs(ratio / slab_ratio - 1) <= 0.04;
    if (!verdict->good)
        snprintf(verdict->reason, sizeof verdict->reason,
                 "behind 20 cm of water scatter is %.4g of the primary instead of %.4g, in %d pixels", ratio,
                 slab_ratio, PIXELS);
    drop(&run);
    return status;
}

skg_status skg_self_test_scatter(skg_context *context, skg_verdict *verdict) {
    SKG_TRY(compare_cube(context, verdict));
    return verdict->good ? compare_slab(context, verdict) : SKG_OK;
}
