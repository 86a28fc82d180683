/* Data of the verb fit, and its reports. Functions that return int return an exit status and print the error. */
#ifndef CLI_FIT_WORK_H
#define CLI_FIT_WORK_H

#include "common/args.h"

#include <jansson.h>
#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

typedef struct {
    const cli_arguments *arguments;
    skg_setup *setup;
    skg_scene *scene; /* owned by the set-up */
    skg_fit *fit;
    skg_fit_state state;
    double seconds; /* of the search */
} fit_work;

/* The scene of the first operand, or of another file. */
int fit_load_scene(const cli_arguments *arguments, const char *path, int with_settings, skg_setup **setup);

/* Makes the fit, with targets and flags. */
int fit_prepare(fit_work *work);

/* The file of -o with an extension, or NULL. */
const char *fit_output(const fit_work *work, const char *extension);

/* --- Reports of a fit, in words and numbers. */

json_t *fit_json(const fit_work *work);
void fit_print(const fit_work *work);
int fit_write_csv(const fit_work *work, const char *path);

/* The errors before and after as bars, a pair for each target: PNG in memory, which the caller frees. */
int fit_bars_png(const fit_work *work, unsigned char **png, size_t *size);
int fit_write_bars(const fit_work *work, const char *path);

/* Writes one file with tables, bars and maps, which loads nothing from elsewhere. */
int fit_write_page(const fit_work *work, const char *path);

#endif
