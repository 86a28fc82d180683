/* Predicts the scatter in a plan's images from few histories, and whether images need it. */
#include "session/prediction.h"

#include "common/encode.h"
#include "common/progress.h"

#include <math.h>
#include <stdio.h>

static void find_reason(double tolerance, cli_prediction *p) {
    char ratio[64], beside[96];
    const skg_scatter_prediction *found = &p->found;
    if (!(found->max > 0)) {
        snprintf(p->reason, sizeof p->reason, "predicted: nothing scatters to the detector");
        return;
    }
    if (isfinite(found->ratio))
        snprintf(ratio, sizeof ratio, "%.2g %% of the primary in the parts' shadow", 100 * found->ratio);
    else
        snprintf(ratio, sizeof ratio, "all that arrives in the parts' shadow");
    if (tolerance > 0)
        snprintf(beside, sizeof beside, "%s than the tolerance of %g", found->called_for ? "more" : "less",
                 tolerance);
    else
        snprintf(beside, sizeof beside, "no tolerance says that so much may be left out");
    snprintf(p->reason, sizeof p->reason, "predicted: scatter is %s, and up to %.2g %% of the open beam: %s",
             ratio, 100 * found->max, beside);
}

void cli_predict(skg_plan *plan, double tolerance, cli_prediction *p) {
    *p = (cli_prediction){0};
    skg_scatter_prediction_init(&p->found);
    cli_progress_begin("predicting the scatter", 0);
    p->is_known = skg_plan_scatter_predict(plan, &p->found) == SKG_OK;
    cli_progress_end();
    if (p->is_known)
        find_reason(tolerance, p);
    else
        snprintf(p->reason, sizeof p->reason, "not predicted: %.300s", skg_last_error());
}

static int has_grid(const cli_prediction *p) {
    return p->is_known && p->found.grid_primary < 1;
}

void cli_prediction_print_grid(const cli_prediction *p) {
    if (has_grid(p))
        printf(
            "the grid passes %.2g %% of the primary, %.2g %% of the scatter, %.2g %% of all: selectivity %.2g (IEC 60627's "
            "terms, for this scene)\n",
            100 * p->found.grid_primary, 100 * p->found.grid_scatter, 100 * p->found.grid_total,
            p->found.grid_primary / p->found.grid_scatter);
}

json_t *cli_prediction_json(const cli_prediction *p) {
    json_t *object = json_object();
    json_object_set_new(object, "ratio_predicted",
                        p->is_known ? cli_json_number(p->found.ratio) : json_null());
    json_object_set_new(object, "called_for", p->is_known ? json_boolean(p->found.called_for) : json_null());
    json_object_set_new(object, "reason", cli_json_text(p->reason));
    if (has_grid(p)) {
        json_t *grid = json_object();
        json_object_set_new(grid, "primary", cli_json_number(p->found.grid_primary));
        json_object_set_new(grid, "scatter", cli_json_number(p->found.grid_scatter));
        json_object_set_new(grid, "total", cli_json_number(p->found.grid_total));
        json_object_set_new(grid, "selectivity",
                            cli_json_number(p->found.grid_primary / p->found.grid_scatter));
        json_object_set_new(object, "grid", grid);
    }
    return object;
}
