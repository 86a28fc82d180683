/* The study as text: a command line, JSON, a table, a page. */
#ifndef CLI_COST_OUTPUT_H
#define CLI_COST_OUTPUT_H

#include "cost/study.h"

#include <jansson.h>

/* The command line of `image` that a setting stands for, quoted for a shell. The caller frees it; NULL if memory is
 * exhausted. */
char *cost_command(const cost_study *study, const cost_setting *setting);

json_t *cost_json(const cost_study *study);

/* The object under the key "scatter". */
json_t *cost_scatter_json(const cost_study *study);

/* The object under the key "interpolation"; null: there is no volume. */
json_t *cost_between_json(const cost_study *study);

/* The object under the key "sensitivity"; null: it was not asked for. */
json_t *cost_sensitivity_json(const cost_study *study);

/* Adds the numbers of a point to its object. */
void cost_add_numbers(const cost_study *study, const cost_point *point, json_t *object);

/* The table of all points as .csv. The caller frees the text; NULL if memory is exhausted. */
char *cost_csv(const cost_study *study);

void cost_print(const cost_study *study);

/* Writes page.html with the study's JSON and its pictures instead of a mark. It needs no other file. */
int cost_write_page(const cost_study *study, const char *path);

#endif
