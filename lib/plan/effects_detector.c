/* Effects of the detector: response, blur, layers. Those of its noise are in effects_noise.c. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "core/log.h"
#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "spectral/model.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>

/* Sizes of pixels that are the same but for the six digits that exporters write. */
static const double ALIKE = 1e-4;

static void find_response(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_plan_options *options = &f->recipe->options;
    const int counts = skg_quantity_counts(options);
    if (options->response)
        skg_effect_set(state, 1,
                       counts ? "photons are counted by the share of them that the detector records"
                              : "photons count by what the detector records of their energy");
    else
        skg_effect_set(state, 0,
                       counts ? "the detector is ideal: it counts all photons"
                              : "the detector is ideal: all photons, all their energy");
}

static int has_blur(const skg_recipe *recipe) {
    return recipe->is_blurred;
}

static void find_blur(const skg_effect_facts *f, skg_effect_state *state) {
    if (has_blur(f->recipe) && !f->recipe->options.depth_blur)
        skg_effect_set(state, 1, "%s of the detector is given", skg_blur_kind(f->layers->blurs[0]));
    else
        skg_effect_set(state, 0, "no line or point spread function is given");
}

static double cost_blur(const skg_effect_facts *f) {
    return f->recipe->model.channels * (double)skg_blur_samples(f->layers->blurs[0]);
}

/* Refuses a response that is not that of a layer. what: needs the layer; mend: what to do without one. */
static skg_status check_layer(const skg_plan_options *options, const char *what, const char *mend) {
    if (skg_response_is_layer(options->response)) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s, but the detector %s; give the response of a scintillator, or %s",
                    what, options->response ? "has a table of energies" : "is ideal", mend);
}

static skg_status check_oblique(const skg_plan_options *options) {
    SKG_TRY(skg_check_flag("oblique", options->oblique));
    if (!options->oblique) return SKG_OK;
    return check_layer(options, "rays cross the layer of a scintillator obliquely", "leave oblique out");
}

static int has_oblique(const skg_recipe *recipe) {
    return recipe->options.oblique;
}

static void find_oblique(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_shades *shades = &f->recipe->model.shades;
    const skg_shade_extent *extent = &shades->oblique_extent;
    if (!has_oblique(f->recipe))
        skg_effect_set(state, 0,
                       f->recipe->options.response ? "not asked for: photons cross the layer straight"
                                                   : "the detector is ideal");
    else if (shades->oblique == 0)
        skg_effect_set(state, 0,
                       extent->half > 0 ? "every ray crosses the layer straight"
                                        : "one energy over its flat field does not show it");
    else
        skg_effect_set(state, 1,
                       "paths through the layer are up to %.4g times its thickness; %" PRId32
                       " %s, to %.1g of the logarithm",
                       1 / (extent->middle - extent->half), shades->oblique,
                       skg_plural(shades->oblique, "shade", "shades"), shades->oblique_error);
}

static double cost_oblique(const skg_effect_facts *f) {
    const skg_model *model = &f->recipe->model;
    return f->counts.passes *
           (SKG_COST_RAY + model->shades.oblique * (SKG_SHADE_TERMS + (double)model->nodes));
}

static void find_escape(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_response *response = f->recipe->options.response;
    if (skg_response_escapes(response))
        skg_effect_set(
            state, 1,
            "K fluorescence leaves the scintillator: recorded energies and Swank factors are those "
            "of its pulse heights");
    else if (!response)
        skg_effect_set(state, 0, "the detector is ideal");
    else
        skg_effect_set(state, 0,
                       skg_response_is_layer(response) ? "not asked for: fluorescence stays in the layer"
                                                       : "the response is a table");
}

static void find_deposition(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_response *response = f->recipe->options.response;
    if (skg_response_transports(response))
        skg_effect_set(
            state, 1,
            "photons that the scintillator scatters leave it or are absorbed elsewhere in it: recorded "
            "energies and Swank factors are those of what is left");
    else if (!response)
        skg_effect_set(state, 0, "the detector is ideal");
    else
        skg_effect_set(state, 0,
                       skg_response_is_layer(response)
                           ? "not asked for: every photon that interacts leaves all its energy"
                           : "the response is a table");
}

/* The blurs of the layers from the number `first` on, and the sums of all layers. */
static double cost_of_layers(const skg_effect_facts *f, int32_t first) {
    const skg_model *model = &f->recipe->model;
    const double nodes = model->nodes, channels = model->channels;
    double samples = 0;
    for (int32_t l = first; l < f->layers->count; l++)
        samples += (double)skg_blur_samples(f->layers->blurs[l]);
    return channels * samples + f->counts.passes * nodes * (model->layers - 1);
}

skg_status skg_blur_take_pixels(const skg_detector_blur *blurs, int64_t index, double pixel_mm[2]) {
    skg_detector_blur one = {.size = sizeof one};
    SKG_TRY(skg_struct_read_at(blurs, index, "skg_detector_blur", &one, sizeof one));
    for (int d = 0; d < 2; d++) {
        const double mm = one.pixel_mm[d];
        if (!(mm >= 0 && mm <= DBL_MAX))
            return skg_fail(SKG_ERR_ARGUMENT, "the blur is of pixels of %g mm; give a length, or 0 for any",
                            mm);
        if (mm > 0 && pixel_mm[d] > 0 && fabs(mm / pixel_mm[d] - 1) > ALIKE)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "the blurs of depths are of pixels of %g and of %g mm; give them for the same",
                            pixel_mm[d], mm);
        if (mm > 0) pixel_mm[d] = mm;
    }
    return SKG_OK;
}

static skg_status check_pixels(const double own[2], const char *what, const char *mend, const skg_view *view,
                               skg_status status) {
    const double mm[2] = {skg_length(view->column_step), skg_length(view->row_step)};
    for (int d = 0; d < 2; d++)
        if (own[d] > 0 && fabs(mm[d] / own[d] - 1) > ALIKE)
            return skg_fail(status, "%s is of pixels of %g x %g mm, those of the view are %g x %g mm; %s",
                            what, own[0], own[1], mm[0], mm[1], mend);
    return SKG_OK;
}

skg_status skg_blur_check_pixels(const skg_recipe *recipe, const skg_view *view, skg_status status) {
    const double own[2] = {skg_length(recipe->view.column_step), skg_length(recipe->view.row_step)};
    SKG_TRY(check_pixels(
        recipe->blur_pixel_mm, "the blur of the detector (MTF)",
        "give it for these (a file with them, skg_line_spread_get, or blur={\"mtf\": rows} in Python)", view,
        status));
    return recipe->options.dqe
               ? check_pixels(own, "the noise power (DQE) of the plan", "make a plan for it", view, status)
               : SKG_OK;
}

skg_status skg_blur_check(const skg_recipe *recipe) {
    SKG_TRY(skg_blur_check_pixels(recipe, &recipe->view, SKG_ERR_SCENE));
    for (int64_t v = 0; v < recipe->options.view_count; v++)
        SKG_TRY(skg_blur_check_pixels(recipe, &recipe->options.views[v], SKG_ERR_SCENE));
    return SKG_OK;
}

static skg_status copy_depths(skg_recipe *recipe) {
    skg_depth_blur *ours = NULL;
    double before = 0;
    if (!recipe->options.depth_blur) return SKG_OK;
    if (recipe->options.blur)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "each depth of the scintillator has a blur of its own; leave out the one for all");
    SKG_TRY(skg_copies_struct(&recipe->copies, recipe->options.depth_blur, "skg_depth_blur", sizeof *ours,
                              skg_depth_blur_init_sized, &ours));
    if (ours->count < 1 || ours->count > SKG_DEPTHS_MAX || !ours->to || !ours->blur)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%" PRId64 " depths of a scintillator; 1 to %d, with ends and blurs", ours->count,
                        (int)SKG_DEPTHS_MAX);
    SKG_TRY(skg_copies_array(&recipe->copies, ours->count, "depths", &ours->to));
    for (int64_t d = 0; d < ours->count; before = ours->to[d++])
        if (!(ours->to[d] > before && ours->to[d] <= 1) || (d == ours->count - 1 && ours->to[d] < 1))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "depth %" PRId64
                            " of the scintillator ends at %g of its thickness; ends rise, and the "
                            "last is 1",
                            d + 1, ours->to[d]);
    for (int64_t d = 0; d < ours->count; d++)
        SKG_TRY(skg_blur_take_pixels(ours->blur, d, recipe->blur_pixel_mm));
    ours->blur = NULL; /* read when the plan is made */
    recipe->options.depth_blur = ours;
    return SKG_OK;
}

static skg_status check_depths(const skg_plan_options *options) {
    const int64_t channels = options->bands > 0 ? options->bands : 1;
    if (!options->depth_blur) return SKG_OK;
    SKG_TRY(
        check_layer(options, "a blur by depths needs to know where photons interact", "one blur for all"));
    if (options->depth_blur->count * channels > SKG_CHANNELS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " depths of %" PRId64 " bands; at most %d together",
                        options->depth_blur->count, channels, (int)SKG_CHANNELS_MAX);
    return SKG_OK;
}

static void find_depths(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_depth_blur *depths = f->recipe->options.depth_blur;
    if (depths)
        skg_effect_set(state, 1,
                       "%d depths of the scintillator, each with a blur of its own; the deepest has %s",
                       (int)depths->count, skg_blur_kind(f->layers->blurs[f->layers->count - 1]));
    else
        skg_effect_set(state, 0, "not asked for: the blur is the same for all energies");
}

static double cost_depths(const skg_effect_facts *f) {
    return cost_of_layers(f, 0);
}

void skg_dqe_init_sized(void *dqe, int32_t size) {
    const skg_dqe defaults = {0};
    skg_struct_init(dqe, size, &defaults, sizeof defaults);
}

static skg_status copy_dqe(skg_recipe *recipe) {
    skg_dqe *ours = NULL;
    if (!recipe->options.dqe) return SKG_OK;
    SKG_TRY(skg_copies_struct(&recipe->copies, recipe->options.dqe, "skg_dqe", sizeof *ours,
                              skg_dqe_init_sized, &ours));
    if (ours->count < 2 || !ours->per_mm || !ours->dqe)
        return skg_fail(SKG_ERR_ARGUMENT, "a table of the DQE has at least two frequencies");
    for (int64_t i = 0; i < ours->count; i++)
        if (!(ours->dqe[i] > 0 && ours->dqe[i] <= 1))
            return skg_fail(SKG_ERR_ARGUMENT, "DQE, row %" PRId64 ": %g; give more than 0, up to 1", i + 1,
                            ours->dqe[i]);
    SKG_TRY(skg_copies_array(&recipe->copies, ours->count, "DQE", &ours->per_mm));
    SKG_TRY(skg_copies_array(&recipe->copies, ours->count, "DQE", &ours->dqe));
    recipe->options.dqe = ours;
    return SKG_OK;
}

static skg_status check_dqe(const skg_plan_options *options) {
    if (options->dqe && options->depth_blur)
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "the power of the noise follows from a DQE and from a blur by depths; give one of them");
    if (options->dqe && options->bands > 0)
        return skg_fail(SKG_ERR_ARGUMENT, "a DQE by spatial frequency is that of an image without bands");
    return SKG_OK;
}

static void find_dqe(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_dqe *dqe = f->recipe->options.dqe;
    if (dqe && f->recipe->options.noise)
        skg_effect_set(state, 1, "noise power by a DQE of %g at 0 to %g at %g per mm; noise is blurred by %s",
                       dqe->dqe[0], dqe->dqe[dqe->count - 1], dqe->per_mm[dqe->count - 1],
                       skg_blur_kind(f->layers->blurs[f->layers->count - 1]));
    else
        skg_effect_set(state, 0,
                       dqe ? "there is no noise" : "not asked for: noise is blurred as the signal is");
}

static double cost_dqe(const skg_effect_facts *f) {
    return cost_of_layers(f, f->layers->count - 1);
}

static void leave_out_response(skg_plan_options *options) {
    options->response = NULL;
}

const skg_effect_row skg_effect_response = {
    .name = "energy response",
    .key = "EnergyResponse",
    .adjoint = "weights.cl",
    .leave_out = leave_out_response,
    .predicted = 1,
    .find = find_response,
};

static void leave_out_blur(skg_plan_options *options) {
    options->blur = NULL;
}

const skg_effect_row skg_effect_blur = {
    .name = "blur",
    .key = "MTF",
    .self_test = SKG_SELF_TEST_BLUR,
    .refuses_half = has_blur,
    .adjoint = "undo_blurs",
    .leave_out = leave_out_blur,
    .find = find_blur,
    .cost = cost_blur,
};

static skg_status refuse_oblique(const char *call, const skg_recipe *recipe, int by_view) {
    return by_view && recipe->options.oblique ? skg_effect_no_view_gradient(call, "an oblique scintillator")
                                              : SKG_OK;
}

static void leave_out_oblique(skg_plan_options *options) {
    options->oblique = 0;
}

const skg_effect_row skg_effect_oblique = {
    .name = "oblique scintillator",
    .key = "Oblique",
    .self_test = SKG_SELF_TEST_SHADES,
    .check = check_oblique,
    .refuses_half = has_oblique,
    .refuses_gradient = refuse_oblique,
    .adjoint = "weights.cl",
    .leave_out = leave_out_oblique,
    .find = find_oblique,
    .cost = cost_oblique,
};

const skg_effect_row skg_effect_escape = {
    .name = "K escape",
    .key = "Escape",
    .adjoint = "weights.cl",
    .find = find_escape,
};

const skg_effect_row skg_effect_deposition = {
    .name = "scintillator scatter",
    .key = "Deposition",
    .adjoint = "weights.cl",
    .find = find_deposition,
};

static void leave_out_depths(skg_plan_options *options) {
    options->depth_blur = NULL;
}

const skg_effect_row skg_effect_depths = {
    .name = "blur by depths",
    .key = "Depths",
    .self_test = SKG_SELF_TEST_DEPTHS,
    .copy = copy_depths,
    .check = check_depths,
    .refuses_half = has_blur,
    .adjoint = "undo_blurs",
    .leave_out = leave_out_depths,
    .find = find_depths,
    .cost = cost_depths,
};

static void leave_out_dqe(skg_plan_options *options) {
    options->dqe = NULL;
}

const skg_effect_row skg_effect_dqe = {
    .name = "noise power",
    .key = "DQE",
    .self_test = SKG_SELF_TEST_APART,
    .copy = copy_dqe,
    .check = check_dqe,
    .leave_out = leave_out_dqe,
    .find = find_dqe,
    .cost = cost_dqe,
};
