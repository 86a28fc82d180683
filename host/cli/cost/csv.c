/* The numbers of measured points: one table of them, for CSV and for JSON. */
#include "cost/output.h"

#include "cost/clock.h"
#include "cost/dial.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

enum { COST_IS_CLOCK = COST_IS_REAL + 1 }; /* a column with the name of the clock */

#define OF_SHOT(member, kind) 1, kind, offsetof(cost_shot, member)
#define OF_POINT(member) 0, COST_IS_REAL, offsetof(cost_point, member)

/* Columns of CSV, and keys of a point in JSON; NULL: JSON has it elsewhere. */
static const struct {
    const char *column, *key;
    int is_of_shot, kind;
    size_t at;
} fields[] = {{"nodes", "nodes", OF_SHOT(nodes, COST_IS_INT64)},
              {"planes", "planes", OF_SHOT(planes, COST_IS_INT64)},
              {"runs", "runs", OF_SHOT(runs, COST_IS_INT64)},
              {"plan_ms", "plan_ms", OF_SHOT(plan_ms, COST_IS_REAL)},
              {"price_ms", NULL, OF_SHOT(price_ms, COST_IS_REAL)},
              {"uncertainty_ms", NULL, OF_SHOT(uncertainty_ms, COST_IS_REAL)},
              {"clock", NULL, OF_SHOT(price_ms, COST_IS_CLOCK)},
              {"wall_now_ms", NULL, OF_SHOT(wall_now_ms, COST_IS_REAL)},
              {"total_rms", NULL, OF_SHOT(total_rms, COST_IS_REAL)},
              {"max_open", "max_open", OF_POINT(max_flat)},
              {"rms_open", "rms_open", OF_POINT(rms_flat)},
              {"max_ref", "max_ref", OF_POINT(max_ref)},
              {"rms_ref", "rms_ref", OF_POINT(rms_ref)},
              {"max_mm", "max_mm", OF_POINT(max_mm)},
              {"rms_mm", "rms_mm", OF_POINT(rms_mm)}};
enum { FIELDS = sizeof fields / sizeof *fields };

static double number_of(const cost_study *study, const cost_point *point, int field) {
    const void *whole = fields[field].is_of_shot ? (const void *)&study->measured.shots[point->shot] : point;
    return cost_read(fields[field].kind, (const char *)whole + fields[field].at);
}

void cost_add_numbers(const cost_study *study, const cost_point *point, json_t *object) {
    for (int f = 0; f < FIELDS; f++)
        if (fields[f].key)
            json_object_set_new(object, fields[f].key,
                                cost_number_json(fields[f].kind, number_of(study, point, f)));
}

static void put_point(const cost_study *study, const cost_point *point, FILE *stream) {
    fprintf(stream, "%s,", cost_dial_name(point->dial));
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        cost_put_value(stream, study, &point->setting, dial);
    for (int f = 0; f < FIELDS; f++)
        if (fields[f].kind == COST_IS_CLOCK)
            fprintf(stream, "%s,", cost_clock_name(study));
        else
            cost_put_number(stream, fields[f].kind, number_of(study, point, f));
    fprintf(stream, "%d\n", point->on_frontier);
}

char *cost_csv(const cost_study *study) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fputs("dial,", stream);
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        fprintf(stream, "%s,", cost_dials[dial].column ? cost_dials[dial].column : cost_dials[dial].key);
    for (int f = 0; f < FIELDS; f++) fprintf(stream, "%s,", fields[f].column);
    fputs("frontier\n", stream);
    for (int i = 0; i < study->measured.count; i++) put_point(study, &study->measured.points[i], stream);
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
