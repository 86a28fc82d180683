/* Effects of detectors that count photons: thresholds, clouds of charge, fluorescence, anti-coincidence, dead time. */
#include "beam/counter_kernels.h"
#include "core/log.h"
#include "core/maths.h"
#include "plan/decisions.h"
#include "plan/rules.h"

#include <math.h>

/* The detector that counts; NULL: the detector does not. */
static const skg_counting *counting_of(const skg_plan_options *options) {
    return options->counter ? &options->counter->counting : NULL;
}

/* Refuses options that a detector that counts excludes; each row says what to do instead. */
static skg_status check_counting(const skg_plan_options *o) {
    if (!o->counter) return SKG_OK;
    const struct {
        int given;
        const char *what;
    } others[] = {
        {o->response != NULL, "an energy response or a scintillator: the sensor has its own"},
        {o->bands > 0, "bands of energy: thresholds are its windows"},
        {o->blur != NULL || o->depth_blur != NULL, "a blur (LSF, PSF, MTF): it follows from the charge that "
                                                   "pixels share"},
        {o->dqe != NULL, "a DQE: it follows from what is counted"},
        {o->oblique != 0, "an oblique scintillator: photons cross the sensor straight"},
        {o->swank < 1, "a Swank factor: every pulse counts 1"},
        {o->scatter != NULL, "scatter, whose energies at the detector are not sorted into windows"},
    };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (others[k].given)
            return skg_fail(SKG_ERR_UNSUPPORTED, "a detector that counts (Counting) is not combined with %s",
                            others[k].what);
    if (o->quantity != SKG_QUANTITY_ENERGY && o->quantity != SKG_QUANTITY_FLUENCE) return SKG_OK;
    return skg_fail(SKG_ERR_UNSUPPORTED,
                    "a detector that counts (Counting) does not know the energy of what it counts; take the "
                    "quantity photons, transmission or attenuation");
}

skg_status skg_counting_check_pixels(const skg_recipe *recipe, const skg_view *view, skg_status status) {
    const skg_counting *c = counting_of(&recipe->options);
    const double alike =
        1e-4; /* exporters write six digits; of the cosine between sides 1e-4 is nothing, too */
    const double columns = skg_length(view->column_step), rows = skg_length(view->row_step);
    if (!c) return SKG_OK;
    if (fabs(columns / c->pixel_mm[0] - 1) > alike || fabs(rows / c->pixel_mm[1] - 1) > alike)
        return skg_fail(
            status,
            "the detector that counts has pixels of %g x %g mm, those of the view are %g x %g mm; "
            "give both the same",
            c->pixel_mm[0], c->pixel_mm[1], columns, rows);
    if (fabs(skg_dot(view->column_step, view->row_step)) > alike * columns * rows)
        return skg_fail(SKG_ERR_SCENE,
                        "the pixels of a detector that counts are rectangles, and those of the view lean");
    return SKG_OK;
}

skg_status skg_counting_check(const skg_recipe *recipe) {
    const skg_counting *c = counting_of(&recipe->options);
    if (!c) return SKG_OK;
    SKG_TRY(skg_counting_check_pixels(recipe, &recipe->view, SKG_ERR_SCENE));
    for (int64_t v = 0; v < recipe->options.view_count; v++)
        SKG_TRY(skg_counting_check_pixels(recipe, &recipe->options.views[v], SKG_ERR_SCENE));
    if (c->pile_up && recipe->absolute && recipe->view.projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "pile-up needs the number of photons in a pixel, which mAs does not give for a "
                        "parallel beam; give photons per pixel (PhotonCount)");
    return SKG_OK;
}

static int counts(const skg_recipe *recipe) {
    return recipe->options.counter != NULL;
}

static skg_status refuse_counting(const char *call, const skg_recipe *recipe, int by_view) {
    (void)by_view;
    return counts(recipe) ? skg_effect_no_gradient(call, "a detector that counts (Counting)",
                                                   "give a scene with an energy response")
                          : SKG_OK;
}

static void find_counting(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_model *model = &f->recipe->model;
    const skg_counting *c = counting_of(&f->recipe->options);
    double photons = 0, counted = 0;
    if (!c) {
        skg_effect_set(state, 0, "not asked for: the detector integrates energy");
        return;
    }
    for (int32_t n = 0; n < model->nodes; n++) photons += model->node_photons[n];
    for (int32_t k = 0; k < model->channels; k++) counted += model->flat_field[k];
    skg_effect_set(state, 1, "%d %s from %g keV on; a photon of the open beam makes %.3g counts",
                   (int)c->count, c->count == 1 ? "threshold" : "thresholds", c->threshold_kev[0],
                   counted / photons);
    for (int32_t k = 0; k < model->channels; k++)
        if (!(model->flat_field[k] > 0))
            skg_log(
                f->context, SKG_LOG_WARNING,
                "the window from %g keV on counts nothing of the beam: its image is black; is its threshold above the energies of the "
                "beam, or does the sensor stop nothing?",
                c->threshold_kev[k]);
}

/* Both images of each window, with squares whose size is not known before the machine is made: lines fly far, clouds do not. */
static double cost_counting(const skg_effect_facts *f) {
    const double n = f->recipe->model.channels,
                 pixels = counting_of(&f->recipe->options)->fluorescence ? SKG_COUNTING_PIXELS : 9;
    return pixels * n * (1 + n * f->recipe->options.noise);
}

static void find_cloud(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_counting *c = counting_of(&f->recipe->options);
    if (c && (c->bias_v > 0 || c->cloud_mm > 0))
        skg_effect_set(
            state, 1,
            "charge reaches the pixels in clouds with standard deviations of %.2g to %.2g of a pixel",
            skg_cloud_width(c, c->thickness_mm) / c->pixel_mm[0], skg_cloud_width(c, 0) / c->pixel_mm[0]);
    else
        skg_effect_set(state, 0,
                       c ? "not asked for: charge arrives where it was set free"
                         : "the detector does not count");
}

static void find_pixel_lines(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_counting *c = counting_of(&f->recipe->options);
    if (c && c->fluorescence)
        skg_effect_set(state, 1,
                       "K lines of the sensor stay in the pixel, reach others, or leave the sensor");
    else
        skg_effect_set(state, 0,
                       c ? "not asked for: fluorescence stays where it was set free"
                         : "the detector does not count");
}

static void find_anti_coincidence(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_counting *c = counting_of(&f->recipe->options);
    if (c && c->anti_coincidence)
        skg_effect_set(state, 1, "2 x 2 pixels are summed for each photon; noise of a sum is %g keV",
                       2 * c->electronic_kev);
    else
        skg_effect_set(state, 0,
                       c ? "not asked for: every pixel counts by itself" : "the detector does not count");
}

skg_status skg_counting_check_flat(const skg_recipe *recipe) {
    static const double least = 1e-30; /* floats end at 1e-38, and a ratio divides by it */
    const skg_counting *c = counting_of(&recipe->options);
    double recorded[SKG_THRESHOLDS_MAX] = {0};
    if (!c || !c->pile_up) return SKG_OK;
    const double pulses = skg_open_pulses(&recipe->options, &recipe->model, 1);
    SKG_TRY(skg_open_recorded(&recipe->options, &recipe->model, 1, recorded));
    for (int64_t w = 0; w < c->count && pulses > 0; w++)
        if (!(recorded[w] > least))
            return skg_fail(
                SKG_ERR_BEAM,
                "the open beam makes %.3g pulses in a dead time, of which the detector counts %.3g in the window from %g keV on, so "
                "there is no ratio to its flat field; give fewer photons, a longer ExposureTime or a shorter "
                "DeadTime",
                pulses, recorded[w], c->threshold_kev[w]);
    return SKG_OK;
}

/* The share of the counts of the open beam that pile-up moves to another window. */
static double share_moved(const skg_effect_facts *f, double kept) {
    const skg_model *model = &f->recipe->model;
    double recorded[SKG_THRESHOLDS_MAX] = {0}, all = 0, moved = 0;
    if (skg_open_recorded(&f->recipe->options, model, 1, recorded) != SKG_OK) return 0;
    for (int32_t k = 0; k < model->channels; k++) {
        all += recorded[k];
        moved += fmax(recorded[k] - kept * model->flat_field[k], 0);
    }
    return all > 0 ? moved / all : 0;
}

static void find_pile_up(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_counting *c = counting_of(&f->recipe->options);
    double left = 0;
    if (!c || !c->pile_up) {
        skg_effect_set(state, 0, c ? "not asked for: every pulse counts" : "the detector does not count");
        return;
    }
    const double pulses = skg_open_pulses(&f->recipe->options, &f->recipe->model, 1);
    if (skg_pile_up_get(c->pile_up, pulses, &left, NULL) != SKG_OK) return;
    skg_effect_set(
        state, 1,
        "%.3g pulses in a dead time of the open beam, of which %.3g count; %.2g of the counts are sums "
        "of pulses that move to another window",
        pulses, left, pulses > 0 ? share_moved(f, left / pulses) : 0);
    if (pulses > 1 && c->pile_up == SKG_PILE_UP_PARALYSABLE)
        skg_log(
            f->context, SKG_LOG_WARNING,
            "pile-up: the open beam makes %.3g pulses in a dead time; from 1 on a paralysable detector "
            "counts less where more arrives, so that the open beam looks darker than what is behind parts",
            pulses);
}

static void leave_out_counting(skg_plan_options *options) {
    options->counter = NULL;
}

const skg_effect_row skg_effect_counting = {
    .name = "photon counting",
    .key = "Counting",
    .self_test = SKG_SELF_TEST_PULSES,
    .check = check_counting,
    .refuses_half = counts,
    .refuses_gradient = refuse_counting,
    .leave_out = leave_out_counting,
    .find = find_counting,
    .cost = cost_counting,
};

const skg_effect_row skg_effect_cloud = {
    .name = "charge sharing",
    .key = "Bias",
    .refuses_gradient = refuse_counting,
    .find = find_cloud,
};

const skg_effect_row skg_effect_pixel_lines = {
    .name = "fluorescence between pixels",
    .key = "Fluorescence",
    .refuses_gradient = refuse_counting,
    .find = find_pixel_lines,
};

const skg_effect_row skg_effect_anti_coincidence = {
    .name = "anti-coincidence",
    .key = "AntiCoincidence",
    .refuses_gradient = refuse_counting,
    .find = find_anti_coincidence,
};

const skg_effect_row skg_effect_pile_up = {
    .name = "pile-up",
    .key = "PileUp",
    .refuses_gradient = refuse_counting,
    .find = find_pile_up,
};
