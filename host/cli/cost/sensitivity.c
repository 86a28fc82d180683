/* How much the image changes when parts move, beside what accuracy costs. */
#include "cost/measuring.h"
#include "cost/output.h"

#include "common/say.h"

int cost_measure_sensitivity(cost_study *study) {
    skg_plan *plan = NULL;
    cost_setting own = study->subject.own;
    int exit_status = CLI_DONE;
    if (!study->sensitive) return CLI_DONE;
    if (own.precision == SKG_PRECISION_HALF)
        own.precision = SKG_PRECISION_SINGLE; /* half has no derivatives */
    if (cost_plan(study, &own, NULL, &plan) >= SKG_OK)
        exit_status = cli_sensitivity_measure(&study->session, plan, NULL, study->subject.flat_field,
                                              &study->measured.sensitivity);
    else
        cli_sensitivity_refuse(&study->measured.sensitivity);
    skg_plan_release(&plan);
    return exit_status;
}

json_t *cost_sensitivity_json(const cost_study *study) {
    return study->sensitive ? cli_sensitivity_json(&study->session, &study->measured.sensitivity)
                            : json_null();
}
