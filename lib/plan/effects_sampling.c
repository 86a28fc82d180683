/* Effects of sampling: energies, source, pixels, compression. */
#include "core/log.h"
#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <inttypes.h>
#include <stdio.h>

/* From this many energies on it is worth a warning that all are used: most beams need 8 to 24. */
enum { MANY_ENERGIES = 25 };

static skg_status copy_bands(skg_recipe *recipe) {
    skg_plan_options *options = &recipe->options;
    if (options->bands < 0 || options->bands > SKG_CHANNELS_MAX || (options->bands > 0 && !options->band_kev))
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " bands of energy; 0 to %d, with their edges",
                        options->bands, SKG_CHANNELS_MAX);
    if (options->bands == 0) return SKG_OK;
    return skg_copies_array(&recipe->copies, options->bands + 1, "bands", &options->band_kev);
}

static skg_status check_bands(const skg_plan_options *options) {
    return skg_check_choice("weight of bands", options->band_weight, SKG_BAND_WEIGHT_ENERGY,
                            "SKG_BAND_WEIGHT_PHOTONS or SKG_BAND_WEIGHT_ENERGY");
}

static void find_energies(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_model *model = &f->recipe->model;
    if (model->bins > 1)
        skg_effect_set(state, 1, "%" PRId32 " %s, %" PRId32 " %s for %" PRId32 " %s", model->nodes,
                       skg_plural(model->nodes, "energy", "energies"), model->planes,
                       skg_plural(model->planes, "plane", "planes"), model->materials,
                       skg_plural(model->materials, "material", "materials that differ"));
    else
        skg_effect_set(state, 0, "the beam has one energy: one exponential per pixel, one plane");
}

static double cost_energies(const skg_effect_facts *f) {
    return f->counts.pass - f->counts.plain;
}

/* The self-test follows from how the passes are drawn, not from the effect. */
static void find_source(const skg_effect_facts *f, skg_effect_state *state) {
    static const char *const shapes[] = {"point", "line",   "rectangle",    "cube",
                                         "disc",  "sphere", "Gaussian spot"};
    const skg_samples *samples = &f->recipe->samples;
    const char *shape = shapes[samples->spot.shape];
    if (samples->spot.shape == SKG_SPOT_POINT)
        skg_effect_set(state, 0,
                       f->recipe->view.projection == SKG_PROJECTION_POINT ? "the source is a point: one pass"
                                                                          : "the beam is parallel: one pass");
    else if (f->sample_error > 0)
        skg_effect_set(
            state, 1,
            "%s: %" PRId64
            " samples; the last doubling changed 99.9 %% of the pixels by less than %.2g of the flat "
            "field",
            shape, samples->spot_count, f->sample_error);
    else
        skg_effect_set(state, 1, "%s: %" PRId64 " samples, as asked for", shape, samples->spot_count);
}

static double rays_of_pixel(const skg_recipe *recipe) {
    return (double)(recipe->samples.shifts * recipe->samples.shifts);
}

static double cost_source(const skg_effect_facts *f) {
    return (f->counts.passes / rays_of_pixel(f->recipe) - 1) * f->counts.pass;
}

static void find_supersampling(const skg_effect_facts *f, skg_effect_state *state) {
    const int64_t shifts = f->recipe->samples.shifts;
    if (shifts > 1)
        skg_effect_set(state, 1, "%" PRId64 " x %" PRId64 " rays a pixel, %s", shifts, shifts,
                       f->recipe->fine_reason);
    else
        skg_effect_set(state, 0, "one ray a pixel, at its centre");
}

static double cost_supersampling(const skg_effect_facts *f) {
    const skg_cost_counts *c = &f->counts;
    const double pass = f->recipe->samples.fine > 1 ? c->pass - c->set_up : c->pass;
    return (c->passes - c->passes / rays_of_pixel(f->recipe)) * pass;
}

static skg_status check_tolerance(const skg_plan_options *options) {
    if (options->tolerance >= 0 && options->tolerance < 1) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "a tolerance of %g; a relative error from 0 to below 1",
                    options->tolerance);
}

static void report_compression(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_model *model = &f->recipe->model;
    char logarithm[96] = "";
    if (f->recipe->options.quantity == SKG_QUANTITY_ATTENUATION)
        snprintf(logarithm, sizeof logarithm, "; of -ln(I/I0) %.2g, at transmissions down to %.2g",
                 model->log_error, model->least);
    skg_effect_set(state, 1,
                   "%" PRId32 " of %" PRId32 " energies and %" PRId32 " %s for %" PRId32
                   " %s; error of transmissions%s at most %.2g%s, verified on %" PRId64 " points",
                   model->nodes, model->bins, model->planes, skg_plural(model->planes, "plane", "planes"),
                   model->materials, skg_plural(model->materials, "material", "materials"),
                   model->variances ? " and variances" : "", model->bound, logarithm, model->verified);
}

static void find_compression(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_plan_options *options = &f->recipe->options;
    const skg_model *model = &f->recipe->model;
    const int half = options->precision == SKG_PRECISION_HALF;
    if (model->verified > 0)
        report_compression(f, state);
    else if (model->bins == 1)
        skg_effect_set(state, 0, "the beam has one energy");
    else if (half)
        skg_effect_set(state, 0, "half precision keeps every energy and a plane per material, as the paper");
    else if (options->tolerance > 0)
        skg_effect_set(state, 0, "no fewer energies meet a tolerance of %g: every one is used",
                       options->tolerance);
    else
        skg_effect_set(state, 0, "tolerance 0: every energy is used");
    if (model->verified == 0 && options->tolerance > 0 && !half && model->materials > 0 &&
        model->bins >= MANY_ENERGIES)
        skg_log(f->context, SKG_LOG_WARNING,
                "compression does not pay: no fewer energies meet a tolerance of %g, so all %" PRId32
                " are used; filter the beam as its tube does, or allow a larger tolerance",
                options->tolerance, model->bins);
}

static double cost_compression(const skg_effect_facts *f) {
    const skg_model *model = &f->recipe->model;
    return skg_cost_of_attenuation(model, model->nodes, model->planes) -
           skg_cost_of_attenuation(model, model->bins, model->materials);
}

static void leave_out_energies(skg_plan_options *options) {
    options->bands = 0, options->band_kev = NULL;
}

const skg_effect_row skg_effect_energies = {
    .name = "several energies",
    .key = "Beam",
    .self_test = SKG_SELF_TEST_ENERGIES,
    .copy = copy_bands,
    .check = check_bands,
    .adjoint = "weights.cl",
    .leave_out = leave_out_energies,
    .find = find_energies,
    .cost = cost_energies,
};

static void leave_out_source(skg_plan_options *options) {
    options->spot = NULL;
}

const skg_effect_row skg_effect_source = {
    .name = "extended source",
    .key = "Shape",
    .adjoint = "add_ends",
    .leave_out = leave_out_source,
    .find = find_source,
    .cost = cost_source,
};

static void find_off_focal(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_spot *spot = &f->recipe->samples.spot;
    if (spot->off_focal > 0)
        skg_effect_set(state, 1, "%.3g %% of the photons come from a disc of %.4g mm around the focal spot",
                       100 * spot->off_focal, spot->off_focal_mm);
    else
        skg_effect_set(state, 0, "all photons come from the focal spot");
}

/* Off-focal radiation has no samples of its own: those of the source are enough. */
const skg_effect_row skg_effect_off_focal = {
    .name = "off-focal radiation",
    .key = "OffFocal",
    .adjoint = "add_ends",
    .find = find_off_focal,
};

static void leave_out_supersampling(skg_plan_options *options) {
    options->supersampling = 1;
}

const skg_effect_row skg_effect_supersampling = {
    .name = "supersampling",
    .key = "Oversampling",
    .self_test = SKG_SELF_TEST_RAYS,
    .adjoint = "weights.cl",
    .leave_out = leave_out_supersampling,
    .find = find_supersampling,
    .cost = cost_supersampling,
};

const skg_effect_row skg_effect_compression = {
    .name = "spectral compression",
    .key = "Tolerance",
    .check = check_tolerance,
    .adjoint = "weights.cl",
    .find = find_compression,
    .cost = cost_compression,
};
