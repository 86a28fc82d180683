/* The page of a fit. */
#ifndef SKG_CLI_FIT_PAGE_H
#define SKG_CLI_FIT_PAGE_H

#include "fit/work.h"

/* Writes one file with tables, bars and maps, which loads nothing from elsewhere. */
int fit_write_page(const fit_work *work, const char *path);

#endif
