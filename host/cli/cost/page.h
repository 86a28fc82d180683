/* The study as a page: page.html with the study's JSON and its pictures instead of a mark. */
#ifndef SKG_CLI_COST_PAGE_H
#define SKG_CLI_COST_PAGE_H

#include "cost/study.h"

/* Writes a page that needs no other file: plots, pictures, advice. */
int cost_write_page(const cost_study *study, const char *path);

#endif
