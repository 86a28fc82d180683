/* The points of a study as CSV. */
#include "cost/output.h"

#include "cost/clock.h"
#include "cost/dial.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A number and a comma; empty: not measured. */
static void put_number(FILE *stream, double value) {
    if (!isnan(value)) fprintf(stream, "%.6g", value);
    fputc(',', stream);
}

char *cost_csv(const cost_study *study) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fputs(
        "dial,precision,tolerance,max_bins,samples,supersampling,repair,triangles,relaxation,hysteresis,"
        "nodes,planes,runs,plan_ms,price_ms,uncertainty_ms,clock,wall_now_ms,total_rms,max_open,rms_open,max_ref,rms_ref,max_mm,rms_mm,"
        "frontier\n",
        stream);
    for (int i = 0; i < study->measured.count; i++) {
        const cost_point *p = &study->measured.points[i];
        const cost_shot *shot = &study->measured.shots[p->shot];
        fprintf(stream, "%s,", cost_dial_name(p->dial));
        for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
            cost_put_value(stream, study, &p->setting, dial);
        fprintf(stream, "%" PRId64 ",%" PRId64 ",%" PRId64 ",%.6g,%.6g,", shot->nodes, shot->planes,
                shot->runs, shot->plan_ms, shot->price_ms);
        put_number(stream, shot->uncertainty_ms);
        fprintf(stream, "%s,%.6g,", cost_clock_name(study), shot->wall_now_ms);
        put_number(stream, shot->total_rms);
        fprintf(stream, "%.6g,%.6g,%.6g,%.6g,", p->max_flat, p->rms_flat, p->max_ref, p->rms_ref);
        put_number(stream, p->max_mm);
        put_number(stream, p->rms_mm);
        fprintf(stream, "%d\n", p->on_frontier);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
