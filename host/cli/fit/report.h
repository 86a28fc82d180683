/* What a fit found, in words and numbers. */
#ifndef SKG_CLI_FIT_REPORT_H
#define SKG_CLI_FIT_REPORT_H

#include "fit/work.h"

json_t *fit_json(const fit_work *work);
void fit_print(const fit_work *work);
int fit_write_csv(const fit_work *work, const char *path);

/* The errors before and after as bars, a pair for each target: PNG in memory, which the caller frees. */
int fit_bars_png(const fit_work *work, unsigned char **png, size_t *size);
int fit_write_bars(const fit_work *work, const char *path);

#endif
