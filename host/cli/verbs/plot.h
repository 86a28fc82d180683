/* Curves against an energy axis as .png or .svg, and tables as .csv: what `material` and `beam` write. */
#ifndef SKG_CLI_PLOT_H
#define SKG_CLI_PLOT_H

#include "common/args.h"

#include <stddef.h>

typedef struct {
    const char *name;    /* in the legend */
    const double *x, *y; /* [count]; NaN, and y <= 0 on a logarithmic axis, interrupt the curve */
    int64_t count;
} cli_curve;

typedef struct {
    const char *title, *x_label, *y_label;
    int is_log;    /* both axes; otherwise both are linear, and y begins at 0 */
    int is_filled; /* the area below the first curve */
    const cli_curve *curves;
    int count;
} cli_plot;

/* Whether every -o (cli_flag_plot) has an extension that can be written; *plots: how many of them are pictures. */
int cli_check_plots(const cli_arguments *arguments, int *plots);

/* Writes every -o: pictures of the plot, and the text `csv`. A file appears whole or not at all. */
int cli_write_plots(const cli_arguments *arguments, const cli_plot *plot, const char *csv);

/* "wrote FILE" for every -o, unless --quiet or --json. */
void cli_tell_plots(const cli_arguments *arguments);

#endif
