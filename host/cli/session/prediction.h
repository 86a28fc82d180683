/* Predicts the scatter in a plan's images from few histories, and whether images need it. */
#ifndef SKG_CLI_PREDICTION_H
#define SKG_CLI_PREDICTION_H

#include <jansson.h>

#include <skiagraph/report.h>

typedef struct {
    skg_scatter_prediction found;
    int is_known; /* 0: scatter is not simulated for the scene */
    char reason[320];
} cli_prediction;

/* Predicts. What fails is the reason. */
void cli_predict(skg_plan *plan, double tolerance, cli_prediction *prediction);

/* Prints the transmissions of the scene's grid, by the definitions of IEC 60627; nothing without a grid. */
void cli_prediction_print_grid(const cli_prediction *prediction);

/* {ratio_predicted, called_for, reason}, and of a grid {primary, scatter, total, selectivity} */
json_t *cli_prediction_json(const cli_prediction *prediction);

#endif
