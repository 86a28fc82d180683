#include "cost/compare.h"

#include "common/progress.h"
#include "common/say.h"
#include "cost/measure.h"

#include <math.h>
#include <stdlib.h>

static int shrink(const cost_study *study, int64_t images, const double *image, const double *reference,
                  cost_point *point) {
    const int64_t columns = study->session.view.columns, block = study->thumb_block;
    const size_t places = (size_t)(study->thumb_columns * study->thumb_rows);
    int32_t *count = calloc(places, sizeof *count);
    point->difference = calloc(places, sizeof *point->difference);
    point->small = calloc(places, sizeof *point->small);
    int enough = count && point->difference && point->small;
    for (int64_t i = 0; enough && i < images * study->pixels; i++) {
        const int64_t pixel = i % study->pixels;
        const int64_t at = pixel / columns / block * study->thumb_columns + pixel % columns / block;
        const float value = (float)((image[i] - reference[i]) / study->flat_field);
        if (fabsf(value) > fabsf(point->difference[at])) point->difference[at] = value;
        if (i >= study->pixels) continue; /* the small picture shows the first image */
        point->small[at] += (float)(image[i] / study->flat_field);
        count[at]++;
    }
    for (size_t at = 0; enough && at < places; at++) point->small[at] /= (float)count[at];
    free(count);
    return enough ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
}

int cost_compare(const cost_study *study, int64_t images, const double *image, const double *reference,
                 cost_point *point) {
    double squares_flat = 0, squares_ref = 0;
    int64_t seen = 0;
    point->max_flat = point->max_ref = 0;
    point->max_mm = point->rms_mm = (double)NAN;
    for (int64_t i = 0; i < images * study->pixels; i++) {
        double error = fabs(image[i] - reference[i]), of_flat = error / study->flat_field;
        if (!(of_flat <= point->max_flat))
            point->max_flat = of_flat; /* also if it is NaN, which then stays */
        squares_flat += of_flat * of_flat;
        if (!(reference[i] > 0)) continue;
        double of_ref = error / reference[i];
        if (!(of_ref <= point->max_ref)) point->max_ref = of_ref;
        squares_ref += of_ref * of_ref;
        seen++;
    }
    point->rms_flat = sqrt(squares_flat / (double)(images * study->pixels));
    point->rms_ref = seen ? sqrt(squares_ref / (double)seen) : 0;
    return shrink(study, images, image, reference, point);
}

static skg_status lengths_of(skg_plan *plan, int64_t part, int32_t type, int64_t pixels, double *data) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = type;
    output.data = data;
    skg_status status = skg_plan_lengths(plan, part, SKG_LENGTHS_SURFACE, 1, NULL, &output, &job);
    if (status >= SKG_OK) status = skg_job_wait(&job);
    if (status >= SKG_OK) cost_widen(type, pixels, data);
    return status;
}

typedef struct {
    skg_plan *plan[2]; /* of the reference and of the point */
    int32_t type[2];
    double *data[2], worst, squares;
    int64_t met, parts, seen;
} length_errors;

static void add_part(const cost_study *study, length_errors *e) {
    for (int64_t i = 0; i < study->pixels; i++) {
        const double error = fabs(e->data[1][i] - e->data[0][i]);
        if (!(error <= e->worst)) e->worst = error;
        e->squares += error * error;
        e->met += e->data[0][i] != 0 || e->data[1][i] != 0;
    }
}

/* Adds part after part until the time is used up. */
static skg_status add_parts(const cost_study *study, length_errors *e) {
    double begun = 0;
    skg_status status = SKG_OK;
    for (; status >= SKG_OK && e->seen < e->parts; e->seen++) {
        if (e->seen == 1) begun = cli_now_ms(); /* the first part compiles the kernels */
        if (e->seen > 1 && cli_now_ms() - begun > cost_patience_ms(study)) break;
        for (int k = 0; k < 2 && status >= SKG_OK; k++)
            status = lengths_of(e->plan[k], e->seen, e->type[k], study->pixels, e->data[k]);
        if (status >= SKG_OK) add_part(study, e);
    }
    return status;
}

/* One ray per pixel, from one point of the source. */
static cost_setting plain_rays(const cost_study *study, const cost_setting *setting, int32_t precision) {
    cost_setting its = *setting;
    its.bins = study->finest;
    its.tolerance = 0;
    its.samples = study->own.samples > 0 ? 1 : 0;
    its.supersampling = 1;
    its.precision = precision;
    return its;
}

void cost_compare_lengths(cost_study *study, const cost_setting *reference, cost_point *point) {
    const cost_setting best = plain_rays(study, reference, study->references[COST_OF_RAYS].setting.precision);
    const cost_setting its = plain_rays(study, &point->setting, point->setting.precision);
    length_errors e = {.type = {cost_type(best.precision), cost_type(its.precision)}};
    e.data[0] = calloc((size_t)(2 * study->pixels), sizeof *e.data[0]);
    e.data[1] = e.data[0] + study->pixels;
    skg_status status = e.data[0] ? skg_scene_part_count(study->session.scene, &e.parts) : SKG_ERR_MEMORY;
    if (status >= SKG_OK) status = cost_plan(study, &best, NULL, &e.plan[0]);
    if (status >= SKG_OK) status = cost_plan(study, &its, NULL, &e.plan[1]);
    if (status >= SKG_OK) status = add_parts(study, &e);
    if (status >= SKG_OK && e.seen < e.parts) {
        char text[160];
        cost_describe(study, &point->setting, text, sizeof text);
        cost_note(study, "path lengths of %s: the first %lld of %lld parts; the others would take too long",
                  text, (long long)e.seen, (long long)e.parts);
    }
    point->max_mm = status >= SKG_OK ? e.worst : (double)NAN;
    point->rms_mm = status >= SKG_OK ? (e.met ? sqrt(e.squares / (double)e.met) : 0) : (double)NAN;
    skg_plan_release(&e.plan[0]);
    skg_plan_release(&e.plan[1]);
    free(e.data[0]);
}
