/* The error of a point against the reference. */
#include "cost/measuring.h"

#include "common/progress.h"
#include "common/say.h"

#include <math.h>
#include <stdlib.h>

/* The small picture of differences: of each block of pixels the one that is largest in magnitude. NULL: out of memory. */
static float *shrink_difference(const cost_study *study, int64_t images, const double *image,
                                const double *reference) {
    const int64_t columns = study->session.view.columns, block = study->thumb_block;
    float *difference = calloc((size_t)(study->thumb_columns * study->thumb_rows), sizeof *difference);
    for (int64_t i = 0; difference && i < images * study->pixels; i++) {
        const int64_t pixel = i % study->pixels;
        const int64_t at = pixel / columns / block * study->thumb_columns + pixel % columns / block;
        const float value = (float)((image[i] - reference[i]) / study->subject.flat_field);
        if (fabsf(value) > fabsf(difference[at])) difference[at] = value;
    }
    return difference;
}

/* The small picture of an image: the mean of each block of pixels. NULL: out of memory. */
static float *shrink_image(const cost_study *study, const double *image) {
    const int64_t columns = study->session.view.columns, block = study->thumb_block;
    const size_t places = (size_t)(study->thumb_columns * study->thumb_rows);
    int32_t *count = calloc(places, sizeof *count);
    float *small = calloc(places, sizeof *small);
    for (int64_t i = 0; count && small && i < study->pixels; i++) {
        const int64_t at = i / columns / block * study->thumb_columns + i % columns / block;
        small[at] += (float)(image[i] / study->subject.flat_field);
        count[at]++;
    }
    if (!count) free(small), small = NULL;
    for (size_t at = 0; small && at < places; at++) small[at] /= (float)count[at];
    free(count);
    return small;
}

/* The largest error and the sum of their squares, as fractions of the flat field. An error that is not finite stays. */
static double worst_of_flat(const cost_study *study, int64_t count, const double *image,
                            const double *reference, double *squares) {
    double worst = 0;
    *squares = 0;
    for (int64_t i = 0; i < count; i++) {
        const double error = fabs(image[i] - reference[i]) / study->subject.flat_field;
        if (!(error <= worst)) worst = error;
        *squares += error * error;
    }
    return worst;
}

int cost_compare(const cost_study *study, int64_t images, const double *image, const double *reference,
                 cost_point *point) {
    double squares_flat, squares_ref = 0;
    int64_t seen = 0;
    point->max_ref = 0;
    point->max_mm = point->rms_mm = (double)NAN;
    point->max_flat = worst_of_flat(study, images * study->pixels, image, reference, &squares_flat);
    for (int64_t i = 0; i < images * study->pixels; i++) {
        if (!(reference[i] > 0)) continue;
        const double of_ref = fabs(image[i] - reference[i]) / reference[i];
        if (!(of_ref <= point->max_ref)) point->max_ref = of_ref;
        squares_ref += of_ref * of_ref;
        seen++;
    }
    point->rms_flat = sqrt(squares_flat / (double)(images * study->pixels));
    point->rms_ref = seen ? sqrt(squares_ref / (double)seen) : 0;
    free(point->difference);
    point->difference = shrink_difference(study, images, image, reference);
    return point->difference ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
}

int cost_compare_coarsely(const cost_study *study, const double *image, const double *better,
                          cost_coarse *coarse) {
    cost_point point = {.difference = coarse->difference};
    const int exit_status = cost_compare(study, 1, image, better, &point);
    coarse->error = point.rms_flat;
    coarse->max = point.max_flat;
    coarse->difference = point.difference;
    return exit_status;
}

int cost_compare_shot(const cost_study *study, const double *image, cost_shot *shot) {
    const double *reference = study->measured.references[COST_OF_ALL].image;
    double squares;
    if (shot->small || !reference || cost_is_other_body(study, &shot->setting))
        return CLI_DONE; /* once is enough */
    shot->total_max = worst_of_flat(study, study->pixels, image, reference, &squares);
    shot->total_rms = sqrt(squares / (double)study->pixels);
    shot->difference = shrink_difference(study, 1, image, reference);
    shot->small = shrink_image(study, image);
    return shot->difference && shot->small ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
}

static skg_status lengths_of(skg_plan *plan, int64_t part, int32_t type, int64_t pixels, double *data) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = type;
    output.data = data;
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = part;
    output.lengths = SKG_LENGTHS_SURFACE;
    skg_status status = skg_plan_submit(plan, 1, NULL, 1, &output, &job);
    if (!SKG_FAILED(status)) status = skg_job_wait(&job);
    if (!SKG_FAILED(status)) cost_widen(type, pixels, data);
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
    for (; !SKG_FAILED(status) && e->seen < e->parts; e->seen++) {
        if (e->seen == 1) begun = cli_now_ms(); /* the first part compiles the kernels */
        if (e->seen > 1 && cli_now_ms() - begun > cost_patience_ms(study)) break;
        for (int k = 0; k < 2 && !SKG_FAILED(status); k++)
            status = lengths_of(e->plan[k], e->seen, e->type[k], study->pixels, e->data[k]);
        if (!SKG_FAILED(status)) add_part(study, e);
    }
    return status;
}

/* One ray per pixel, from one point of the source. */
static cost_setting plain_rays(const cost_study *study, const cost_setting *setting, int32_t precision) {
    cost_setting its = *setting;
    its.bins = study->subject.finest;
    its.tolerance = 0;
    its.samples = study->subject.own.samples > 0 ? 1 : 0;
    its.supersampling = 1;
    its.precision = precision;
    return its;
}

void cost_compare_lengths(cost_study *study, const cost_setting *reference, cost_point *point) {
    const cost_setting best =
        plain_rays(study, reference, study->measured.references[COST_OF_RAYS].setting.precision);
    const cost_setting its = plain_rays(study, &point->setting, point->setting.precision);
    length_errors e = {.type = {cost_type(best.precision), cost_type(its.precision)}};
    e.data[0] = calloc((size_t)(2 * study->pixels), sizeof *e.data[0]);
    e.data[1] = e.data[0] + study->pixels;
    skg_status status = e.data[0] ? skg_scene_part_count(study->session.scene, &e.parts) : SKG_ERR_MEMORY;
    if (!SKG_FAILED(status)) status = cost_plan(study, &best, NULL, &e.plan[0]);
    if (!SKG_FAILED(status)) status = cost_plan(study, &its, NULL, &e.plan[1]);
    if (!SKG_FAILED(status)) status = add_parts(study, &e);
    if (!SKG_FAILED(status) && e.seen < e.parts) {
        char text[160];
        cost_describe(study, &point->setting, text, sizeof text);
        cost_note(study, "path lengths of %s: the first %lld of %lld parts; the others would take too long",
                  text, (long long)e.seen, (long long)e.parts);
    }
    point->max_mm = !SKG_FAILED(status) ? e.worst : (double)NAN;
    point->rms_mm = !SKG_FAILED(status) ? (e.met ? sqrt(e.squares / (double)e.met) : 0) : (double)NAN;
    skg_plan_release(&e.plan[0]);
    skg_plan_release(&e.plan[1]);
    free(e.data[0]);
}
