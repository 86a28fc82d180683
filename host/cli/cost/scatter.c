/* Measures the scatter of the study's scene, and its price. */
#include "cost/findings.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include "common/encode.h"
#include "common/say.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Standard errors that have a price, over the mean of the scatter. */
static const double tolerances[COST_SCATTER_PRICES] = {0.05, 0.02, 0.01};

/* Share of the given time that all prices together may take, and seconds: from a coarser one a finer one is estimated well. */
static const double SHARE = 0.15, AT_MOST_S = 5;

void cost_predict_scatter(cost_study *study, skg_plan *plan) {
    cost_scattering *s = &study->measured.scattering;
    cli_predict(plan, study->session.options.tolerance, &s->prediction);
    for (int i = 0; i < COST_SCATTER_PRICES; i++)
        s->prices[i] = (cost_scatter_price){tolerances[i], (double)NAN, 0};
}

/* Renders the scatter of the scene's own image. */
static skg_status render(const cost_study *study, const skg_scatter *scatter, float *data,
                         skg_scatter_report *report) {
    const cli_session *session = &study->session;
    skg_plan_options options = session->options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_output_init(&output);
    skg_scatter_report_init(report);
    output.kind = SKG_OUTPUT_SCATTER;
    output.data = data;
    options.scatter = scatter;
    skg_status status =
        skg_plan_create(session->context, session->scene, &session->view, session->spectrum, &options, &plan);
    if (!SKG_FAILED(status)) status = skg_plan_image(plan, &output);
    if (!SKG_FAILED(status)) status = skg_plan_scatter_report_get(plan, report);
    skg_plan_release(&plan);
    return status;
}

/* Finds the error of an image without this scatter. */
static int take_error(cost_study *study, const float *data) {
    double *images = calloc((size_t)(2 * study->pixels), sizeof *images);
    if (!images) return cli_error(CLI_DEVICE, "out of host memory");
    double *scatter = images + study->pixels;
    for (int64_t i = 0; i < study->pixels; i++) scatter[i] = (double)data[i];
    const int exit_status =
        cost_compare_coarsely(study, images, scatter, &study->measured.coarse[COST_SOURCE_SCATTER]);
    free(images);
    return exit_status;
}

/* From the last price that was measured: the error falls with the root of the time. */
static double estimate_s(const cost_scattering *s, int number) {
    const double ratio = number ? s->prices[number - 1].tolerance / s->prices[number].tolerance : 0;
    return number ? ratio * ratio * s->prices[number - 1].seconds : 0;
}

static int measure_price(cost_study *study, int number, float *data, double *spent_s) {
    cost_scattering *s = &study->measured.scattering;
    cost_scatter_price *price = &s->prices[number];
    skg_scatter scatter;
    skg_scatter_report report;
    skg_scatter_init(&scatter);
    if (study->subject.own_scatter) scatter = *study->subject.own_scatter;
    scatter.tolerance = price->tolerance;
    scatter.histories = 0;
    const skg_status status = render(study, &scatter, data, &report);
    if (SKG_FAILED(status)) {
        snprintf(s->refusal, sizeof s->refusal, "%.319s", skg_last_error());
        return CLI_DONE;
    }
    price->seconds = report.seconds;
    price->is_measured = 1;
    *spent_s += report.seconds;
    return take_error(study, data);
}

int cost_measure_scatter(cost_study *study) {
    cost_scattering *s = &study->measured.scattering;
    cost_coarse *coarse = &study->measured.coarse[COST_SOURCE_SCATTER];
    double spent_s = 0;
    int exit_status = CLI_DONE;
    coarse->state = s->prediction.is_known ? COST_COARSE : COST_NOT_KNOWN;
    if (!s->prediction.is_known) return CLI_DONE;
    coarse->error = s->prediction.found.rms;
    coarse->max = s->prediction.found.max;
    if (!(coarse->max > 0)) return CLI_DONE;
    float *data = calloc((size_t)study->pixels, sizeof *data);
    if (!data) return cli_error(CLI_DEVICE, "out of host memory for the scatter");
    for (int i = 0; i < COST_SCATTER_PRICES && exit_status == CLI_DONE && !*s->refusal; i++) {
        const double given_s = fmin(1e-3 * SHARE * study->within_ms, AT_MOST_S);
        const double left_s = fmin(given_s - spent_s, 1e-3 * cost_left_ms(study, 1));
        if (left_s > 0 && estimate_s(s, i) <= left_s)
            exit_status = measure_price(study, i, data, &spent_s);
        else
            s->prices[i].seconds = estimate_s(s, i);
    }
    free(data);
    return exit_status;
}

/* Appends "Scatter to 5 % 0.12 s, 2 % 0.9 s, 1 % about 4 s". */
static void list_prices(const cost_scattering *s, char *text, size_t size) {
    if (*s->refusal) cost_append(text, size, "%s", s->refusal);
    for (int i = 0; i < COST_SCATTER_PRICES && !*s->refusal; i++) {
        const cost_scatter_price *price = &s->prices[i];
        cost_append(text, size, "%s%g %% ", i ? ", " : "Scatter to ", 100 * price->tolerance);
        if (price->seconds > 0)
            cost_append(text, size, "%s%.2g s", price->is_measured ? "" : "about ", price->seconds);
        else
            cost_append(text, size, "not timed");
    }
}

void cost_take_scatter(const cost_study *study, cost_source *source) {
    const cost_scattering *s = &study->measured.scattering;
    const cost_coarse *coarse = &study->measured.coarse[COST_SOURCE_SCATTER];
    source->state = coarse->state;
    snprintf(source->reason, sizeof source->reason, "%.319s", s->prediction.reason);
    if (!s->prediction.is_known) return;
    source->error = coarse->error;
    source->max = coarse->max;
    if (!(source->error > 0)) {
        source->state = COST_ABSENT;
        return;
    }
    *source->reason = '\0';
    if (study->subject.own_scatter)
        cost_append(source->reason, sizeof source->reason, "without the scene's Scatter; ");
    list_prices(s, source->reason, sizeof source->reason);
}

json_t *cost_scatter_json(const cost_study *study) {
    const cost_scattering *s = &study->measured.scattering;
    json_t *object = cli_prediction_json(&s->prediction), *prices = json_array();
    for (int i = 0; i < COST_SCATTER_PRICES; i++) {
        json_t *price = json_object();
        json_object_set_new(price, "tolerance", cli_json_number(s->prices[i].tolerance));
        json_object_set_new(price, "seconds",
                            s->prices[i].seconds > 0 ? cli_json_number(s->prices[i].seconds) : json_null());
        json_object_set_new(price, "measured", json_boolean(s->prices[i].is_measured));
        json_array_append_new(prices, price);
    }
    json_object_set_new(object, "prices", prices);
    return object;
}
