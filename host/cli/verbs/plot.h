/* The files that `material` and `beam` write: curves against energy as .png or .svg, tables as .csv.
 * Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_PLOT_H
#define SKG_CLI_PLOT_H

#include "common/args.h"

#include <stddef.h>

typedef struct {
    const char *name;    /* in the legend */
    const double *x, *y; /* [count]; the curve is interrupted by NaN, and by y <= 0 on a logarithmic axis */
    int64_t count;
} cli_curve;

typedef struct {
    const char *title, *x_label, *y_label;
    int is_log;    /* 1: both axes are logarithmic; 0: both are linear, and y begins at 0 */
    int is_filled; /* 1: the area below the first curve is filled */
    const cli_curve *curves;
    int count;
} cli_plot;

/* Checks the extension of every -o. *plots: the number of pictures among them. */
int cli_check_plots(const cli_arguments *arguments, int *plots);

/* Writes every -o: pictures of the plot, and the text `csv`. A file appears whole or not at all. */
int cli_write_plots(const cli_arguments *arguments, const cli_plot *plot, const char *csv);

/* Prints "wrote FILE" for every -o, unless --quiet or --json. */
void cli_report_plots(const cli_arguments *arguments);

#endif
