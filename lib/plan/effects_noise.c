/* Effects of the noise of photons and of the detector's electronics. */
#include "beam/spectrum.h"
#include "core/log.h"
#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/model.h"

#include <inttypes.h>
#include <math.h>

static skg_status check_noise(const skg_plan_options *options) {
    SKG_TRY(skg_check_flag("noise", options->noise));
    if (options->swank > 0 && options->swank <= 1) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "the Swank factor is %g; above 0, at most 1", options->swank);
}

static int has_noise(const skg_recipe *recipe) {
    return recipe->options.noise;
}

static void find_noise(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_plan_options *options = &f->recipe->options;
    const int assumes = skg_response_assumes_efficiency(options->response);
    const char *all = assumes ? "; every photon is taken as recorded" : "";
    if (!options->noise) {
        skg_effect_set(state, 0,
                       f->recipe->absolute
                           ? "not asked for, although mAs counts the photons: the key Noise adds it"
                           : "not asked for");
        return;
    }
    if (skg_quantity_counts(options))
        skg_effect_set(state, 1, "asked for; photons are counted, so the variance is the mean%s", all);
    else
        skg_effect_set(
            state, 1,
            "asked for; Swank factor %g%s; photon by photon if fewer than %g are detected in a pixel%s",
            options->swank, options->response ? " times that of the response" : "", SKG_FEW_PHOTONS, all);
    if (assumes)
        skg_log(
            f->context, SKG_LOG_WARNING,
            "noise with an energy response that gives no efficiency: every photon that arrives is taken as "
            "recorded, so the noise is the least possible; give the efficiency as a third column, or Meaning "
            "\"absorbed\" if photons leave either all of their energy or nothing");
}

static double cost_noise(const skg_effect_facts *f) {
    const double nodes = f->recipe->model.nodes, channels = f->recipe->model.channels;
    return f->counts.passes * channels * (nodes + SKG_COST_DEVIATE);
}

static skg_status check_kev(const skg_plan_options *options, const char *what, double kev) {
    if (!(kev >= 0 && isfinite(kev))) return skg_fail(SKG_ERR_ARGUMENT, "%s is %g keV; 0 or more", what, kev);
    if (kev > 0 && options->counter)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s of %g keV is that of a detector of energy; of one that counts (Counting), give the "
            "noise of its pulses (ElectronicNoise)",
            what, kev);
    if (kev > 0 && skg_quantity_counts(options))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "electronic noise and quantisation are in keV, but photons are counted; leave them out, or "
            "take %s",
            options->quantity == SKG_QUANTITY_PHOTONS ? "another quantity"
                                                      : "SKG_BAND_WEIGHT_ENERGY (BandWeight)");
    return SKG_OK;
}

static skg_status check_electronic(const skg_plan_options *options) {
    return check_kev(options, "electronic noise", options->electronic_kev);
}

static int has_electronic(const skg_recipe *recipe) {
    return recipe->options.electronic_kev > 0;
}

static void find_electronic(const skg_effect_facts *f, skg_effect_state *state) {
    if (has_electronic(f->recipe))
        skg_effect_set(state, 1, "standard deviation of %g keV per pixel", f->recipe->options.electronic_kev);
    else
        skg_effect_set(state, 0, "not asked for");
}

static double cost_electronic(const skg_effect_facts *f) {
    return f->recipe->model.channels * SKG_COST_DEVIATE;
}

static skg_status check_quantisation(const skg_plan_options *options) {
    return check_kev(options, "the quantisation's step", options->quantum_step_kev);
}

static int has_steps(const skg_recipe *recipe) {
    return recipe->options.quantum_step_kev > 0;
}

static void find_quantisation(const skg_effect_facts *f, skg_effect_state *state) {
    if (has_steps(f->recipe))
        skg_effect_set(state, 1, "steps of %g keV per pixel", f->recipe->options.quantum_step_kev);
    else
        skg_effect_set(state, 0, "no step is given");
}

static double cost_quantisation(const skg_effect_facts *f) {
    return f->recipe->model.channels;
}

static void leave_out_noise(skg_plan_options *options) {
    options->noise = 0;
}

const skg_effect_row skg_effect_noise = {
    .name = "quantum noise",
    .key = "Noise",
    .self_test = SKG_SELF_TEST_NOISE,
    .check = check_noise,
    .refuses_half = has_noise,
    .adjoint = "undo_detection",
    .leave_out = leave_out_noise,
    .find = find_noise,
    .cost = cost_noise,
};

static void leave_out_electronic(skg_plan_options *options) {
    options->electronic_kev = 0;
}

const skg_effect_row skg_effect_electronic = {
    .name = "electronic noise",
    .key = "Electronic",
    .self_test = SKG_SELF_TEST_DETECTOR,
    .check = check_electronic,
    .refuses_half = has_electronic,
    .adjoint = "undo_detection",
    .leave_out = leave_out_electronic,
    .find = find_electronic,
    .cost = cost_electronic,
};

static void leave_out_quantisation(skg_plan_options *options) {
    options->quantum_step_kev = 0;
}

const skg_effect_row skg_effect_quantisation = {
    .name = "quantisation",
    .key = "Step",
    .self_test = SKG_SELF_TEST_DETECTOR,
    .check = check_quantisation,
    .refuses_half = has_steps,
    .adjoint = "undo_detection",
    .leave_out = leave_out_quantisation,
    .find = find_quantisation,
    .cost = cost_quantisation,
};
