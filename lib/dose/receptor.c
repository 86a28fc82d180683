/* Exposure of the detector behind the parts: air kerma, exposure index, the smallest signal. */
#include "dose/figures.h"

#include "beam/spectrum.h"
#include "core/maths.h"
#include "plan/decisions.h"

#include <stdlib.h>

/* RQA5 of IEC 61267, under which detectors are calibrated: 70 kV behind 2.5 mm Al in the tube and 21 mm Al more. Its first half-value
 * layer is 6.8 mm Al by the standard, 6.64 as PTB measured it, and near both with our tube. */
static const double RQA5_KV = 70, RQA5_MM_AL = 23.5;

/* IEC 62494-1: the index of a detector that is given 1 uGy under these conditions. */
static const double INDEX_PER_UGY = 100;

/* The sides of the region whose median signal counts, over those of the field: its middle tenth. */
static const double REGION_SIDE = 0.31622776601683794;

/* --- a meter of air kerma as a response */

/* Fills a row of the meter's table: kerma of a photon over what a keV recorded stands for. */
static double per_kev_of(const skg_kerma_table *kerma, const double *kev) {
    double per_kev = 0;
    for (int i = 0; i < SKG_KERMA_ROWS; i++) per_kev = fmax(per_kev, kerma->of[i] / kev[i]);
    return per_kev;
}

/* Records in proportion to air kerma. per_kev: result: uGy mm2 that a keV recorded stands for. */
static skg_status make_meter(double high_kev, skg_response **meter, double *per_kev) {
    skg_kerma_table *kerma = NULL;
    skg_response_table table;
    double *kev = NULL;
    skg_status status = SKG_OK;
    skg_response_table_init(&table);
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *kerma, "dose", &kerma));
    SKG_TRY_CLEANUP(skg_alloc((int64_t)2 * SKG_KERMA_ROWS, sizeof *kev, "dose", &kev));
    skg_kerma_table_fill(high_kev, kerma);
    double *recorded = kev + SKG_KERMA_ROWS;
    for (int i = 0; i < SKG_KERMA_ROWS; i++)
        kev[i] = SKG_DOSE_LOWEST_KEV *
                 exp((double)i / (SKG_KERMA_ROWS - 1) * log(kerma->high_kev / SKG_DOSE_LOWEST_KEV));
    kev[SKG_KERMA_ROWS - 1] = fmax(kev[SKG_KERMA_ROWS - 1], high_kev); /* rounding */
    *per_kev = per_kev_of(kerma, kev);
    for (int i = 0; i < SKG_KERMA_ROWS; i++) recorded[i] = kerma->of[i] / *per_kev;
    table.count = SKG_KERMA_ROWS, table.energies_kev = kev, table.recorded_kev = recorded;
    status = skg_response_create_table(&table, meter);
cleanup:
    skg_free(&kerma);
    skg_free(&kev);
    return status;
}

/* --- images */

typedef struct {
    int32_t window[4];       /* pixels that the field reaches: columns from, to, rows from, to */
    float *mean, *scattered; /* [rows][columns]; scattered: 0 without scatter */
} picture;

/* The plan's beam and parts before another detector, without noise and blur. */
static skg_plan_options options_of(const skg_recipe *recipe, skg_response *response, int32_t oblique) {
    skg_plan_options options = recipe->options;
    skg_effects_leave_out(&options);
    options.world = recipe->options.world;
    options.heel = recipe->options.heel;
    options.bowtie = recipe->options.bowtie;
    options.falloff = recipe->view.projection == SKG_PROJECTION_POINT ? SKG_FALLOFF_ON : SKG_FALLOFF_OFF;
    options.response = response;
    options.oblique = oblique;
    options.quantity = SKG_QUANTITY_FLUENCE;
    options.precision =
        recipe->options.precision == SKG_PRECISION_HALF ? SKG_PRECISION_SINGLE : recipe->options.precision;
    options.strategy = SKG_STRATEGY_AUTO;
    options.tile = options.profile = 0;
    options.bands = 0, options.band_kev = NULL;
    options.view_count = 0, options.views = NULL;
    return options;
}

static skg_status draw(const skg_plan *plan, const skg_plan_options *options, skg_progress *progress,
                       picture *p) {
    const skg_recipe *recipe = plan->recipe;
    skg_spectrum *beam = NULL;
    skg_plan *made = NULL;
    skg_job *job = NULL;
    skg_output outputs[2];
    skg_frame frame;
    skg_status status = SKG_OK;
    skg_frame_init(&frame);
    frame.progress = progress;
    for (int k = 0; k < 2; k++) skg_output_init(&outputs[k]);
    outputs[0].data = p->mean;
    outputs[1].data = p->scattered, outputs[1].kind = SKG_OUTPUT_SCATTER;
    SKG_TRY_CLEANUP(skg_progress_step(progress, 0, 1));
    SKG_TRY_CLEANUP(
        skg_spectrum_create_counts(recipe->spectrum, skg_recipe_exposure(recipe, &recipe->view), &beam));
    SKG_TRY_CLEANUP(skg_plan_create(plan->context, recipe->scene, &recipe->view, beam, options, &made));
    SKG_TRY_CLEANUP(skg_plan_submit(made, 1, &frame, options->scatter ? 2 : 1, outputs, &job));
    status = skg_job_wait(&job);
cleanup:
    skg_plan_release(&made);
    skg_spectrum_release(&beam);
    /* Path lengths outside the verified range matter little here. */
    return status == SKG_RANGE ? SKG_OK : status;
}

/* The air kerma over the pixels of the field, on average. Photons of the primary come aslant, so that more of them pass a mm2 across their
 * way than a mm2 of the detector; what is scattered is counted as if it came straight. */
static double mean_kerma(const skg_dose_beam *beam, const picture *p, double per_kev) {
    const skg_view *view = &beam->recipe->view;
    double normal[3], sum = 0;
    int64_t count = 0;
    skg_cross(view->column_step, view->row_step, normal);
    skg_scale_vector(1 / skg_length(normal), normal, normal);
    for (int64_t r = p->window[2]; r < p->window[3]; r++)
        for (int64_t c = p->window[0]; c < p->window[1]; c++, count++) {
            const double all = (double)p->mean[r * view->columns + c],
                         scattered = (double)p->scattered[r * view->columns + c];
            double way[3];
            skg_scale_vector(1, beam->direction, way);
            if (!beam->parallel) {
                skg_add_scaled(view->centre, (double)c - 0.5 * (double)(view->columns - 1), view->column_step,
                               way);
                skg_add_scaled(way, (double)r - 0.5 * (double)(view->rows - 1), view->row_step, way);
                skg_add_scaled(way, -1, view->source, way);
            }
            sum += (all - scattered) * skg_length(way) / fabs(skg_dot(way, normal)) + scattered;
        }
    return count > 0 ? sum / (double)count * per_kev : 0;
}

static int by_value(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The median over the middle of the field. values: workspace of as many as the image has. */
static double median_signal(const skg_view *view, const picture *p, float *values) {
    int64_t ends[4], count = 0;
    for (int k = 0; k < 4; k += 2) {
        const double middle = 0.5 * (p->window[k] + p->window[k + 1]),
                     half = 0.5 * REGION_SIDE * (p->window[k + 1] - p->window[k]);
        ends[k] = (int64_t)floor(middle - half), ends[k + 1] = (int64_t)ceil(middle + half);
    }
    for (int64_t r = ends[2]; r < ends[3]; r++)
        for (int64_t c = ends[0]; c < ends[1]; c++) values[count++] = p->mean[r * view->columns + c];
    if (count == 0) return 0;
    qsort(values, (size_t)count, sizeof *values, by_value);
    return 0.5 * ((double)values[(count - 1) / 2] + (double)values[count / 2]);
}

/* --- the exposure index */

static skg_status make_rqa5(skg_spectrum **spectrum) {
    enum { ALUMINIUM = 13 };
    skg_material *metal = NULL;
    skg_filter filter;
    skg_tube tube;
    skg_filter_init(&filter);
    skg_tube_init(&tube);
    SKG_TRY(skg_material_create_element(ALUMINIUM, &metal));
    filter.material = metal, filter.thickness_mm = RQA5_MM_AL;
    tube.kvp = RQA5_KV, tube.filter_count = 1, tube.filters = &filter;
    const skg_status status = skg_spectrum_create_tube(&tube, spectrum);
    skg_material_release(&metal);
    return status;
}

/* keV/mm2 that a detector records of 1 uGy under conditions of calibration. */
static skg_status signal_per_ugy(const skg_response *response, double *signal) {
    skg_spectrum *beam = NULL;
    double kev = 0, kerma = 0;
    skg_status status = SKG_OK;
    SKG_TRY(make_rqa5(&beam));
    for (int64_t i = 0; i < beam->count && status == SKG_OK; i++) {
        double recorded = beam->energy_kev[i];
        const int known = !response || beam->energy_kev[i] >= skg_response_lowest(response);
        if (response && known) status = skg_response_get(response, beam->energy_kev[i], 1, &recorded, NULL);
        kev += known ? beam->photons[i] * recorded : 0;
        kerma += beam->photons[i] * skg_air_kerma(beam->energy_kev[i]);
    }
    skg_spectrum_release(&beam);
    *signal = kerma > 0 ? kev / kerma : 0;
    return status;
}

static skg_status find_index(const skg_plan *plan, skg_progress *progress, picture *p, float *values,
                             double *index) {
    const skg_plan_options options =
        options_of(plan->recipe, plan->recipe->options.response, plan->recipe->options.oblique);
    double per_ugy = 0;
    *index = (double)NAN;
    if (plan->recipe->options.counter) return SKG_OK; /* it is defined for detectors of energy */
    SKG_TRY(draw(plan, &options, progress, p));
    if (signal_per_ugy(options.response, &per_ugy) != SKG_OK)
        return SKG_OK; /* it does not know these energies */
    *index =
        per_ugy > 0 ? INDEX_PER_UGY * median_signal(&plan->recipe->view, p, values) / per_ugy : (double)NAN;
    return SKG_OK;
}

/* --- signal and noise where the parts let least through */

static skg_status find_darkest(skg_plan *plan, const picture *p, float *variance, skg_dose_receptor *found) {
    const skg_recipe *recipe = plan->recipe;
    const skg_view *view = &recipe->view;
    const int is_logarithm = recipe->options.quantity == SKG_QUANTITY_ATTENUATION;
    skg_output outputs[2];
    skg_job *job = NULL;
    if (!(recipe->options.noise || recipe->options.electronic_kev > 0) || recipe->model.channels != 1)
        return SKG_OK;
    for (int k = 0; k < 2; k++) skg_output_init(&outputs[k]);
    outputs[0].kind = SKG_OUTPUT_MEAN, outputs[0].data = p->mean;
    outputs[1].kind = SKG_OUTPUT_VARIANCE, outputs[1].data = variance;
    SKG_TRY(skg_plan_submit(plan, 1, NULL, 2, outputs, &job));
    const skg_status status = skg_job_wait(&job);
    if (status != SKG_OK && status != SKG_RANGE) return status;
    for (int64_t r = p->window[2]; r < p->window[3]; r++)
        for (int64_t c = p->window[0]; c < p->window[1]; c++) {
            const double value = (double)p->mean[r * view->columns + c];
            if (found->has_darkest && !(is_logarithm ? value > found->signal : value < found->signal))
                continue;
            found->has_darkest = 1;
            found->row = r, found->column = c, found->signal = value;
        }
    if (!found->has_darkest) return SKG_OK;
    found->noise = sqrt((double)variance[found->row * view->columns + found->column]);
    found->relative = is_logarithm ? found->noise : found->noise / found->signal;
    return SKG_OK;
}

/* --- all of it */

static skg_status find_window(const skg_dose_beam *beam, int32_t window[4]) {
    skg_camera camera;
    SKG_TRY(skg_camera_make(&beam->recipe->view, NULL, 0, 0, &camera));
    SKG_TRY(skg_field_window(&beam->field, &camera, window));
    if (!(window[0] < window[1] && window[2] < window[3]))
        return skg_fail(SKG_ERR_SCENE,
                        "dose: the field of the beam reaches no pixel; open the jaws (Collimation)");
    return SKG_OK;
}

skg_status skg_dose_receptor_find(skg_plan *plan, const skg_dose_beam *beam, skg_progress *progress,
                                  skg_dose_receptor *found) {
    const int64_t pixels = plan->recipe->view.columns * plan->recipe->view.rows;
    float *memory = NULL;
    skg_response *meter = NULL;
    picture p = {{0}, NULL, NULL};
    double per_kev = 0;
    skg_status status = SKG_OK;
    *found = (skg_dose_receptor){0};
    SKG_TRY_CLEANUP(find_window(beam, p.window));
    SKG_TRY_CLEANUP(skg_alloc(3 * pixels, sizeof *memory, "dose", &memory));
    p.mean = memory, p.scattered = memory + pixels;
    SKG_TRY_CLEANUP(make_meter(beam->high_kev, &meter, &per_kev));
    const skg_plan_options options = options_of(plan->recipe, meter, 0);
    SKG_TRY_CLEANUP(draw(plan, &options, progress, &p));
    found->kerma = mean_kerma(beam, &p, per_kev);
    SKG_TRY_CLEANUP(find_index(plan, progress, &p, memory + 2 * pixels, &found->exposure_index));
    status = find_darkest(plan, &p, memory + 2 * pixels, found);
cleanup:
    skg_response_release(&meter);
    skg_free(&memory);
    return status;
}
