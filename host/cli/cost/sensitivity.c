#include "cost/findings.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SQUARINGS = 40 }; /* G^(2^40): a direction whose value is smaller by 1e-11 has vanished */

/* The direction in which v . G v is largest: G to a high power. gram: not negative; 0: any direction */
static void find_largest(const double gram[3][3], double direction[3]) {
    double power[3][3], squared[3][3];
    int column = 0;
    memcpy(power, gram, sizeof power);
    for (int s = 0; s < SQUARINGS; s++) {
        const double trace = power[0][0] + power[1][1] + power[2][2];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                squared[r][c] = 0;
                for (int k = 0; k < 3 && trace > 0; k++)
                    squared[r][c] += power[r][k] / trace * (power[k][c] / trace);
            }
        memcpy(power, squared, sizeof power);
    }
    for (int c = 1; c < 3; c++)
        if (power[c][c] > power[column][column]) column = c;
    const double size = sqrt(power[0][column] * power[0][column] + power[1][column] * power[1][column] +
                             power[2][column] * power[2][column]);
    for (int k = 0; k < 3; k++) direction[k] = size > 0 ? power[k][column] / size : k == 0;
}

/* The derivatives of the image by one part's place along x, y and z. images: [3][pixels] */
static skg_status differentiate(const cost_study *study, skg_plan *plan, int64_t part, double *twists,
                                double *images, int64_t *saturated) {
    skg_direction direction;
    skg_status status = SKG_OK;
    skg_direction_init(&direction);
    direction.poses = twists;
    for (int k = 0; k < 3 && status == SKG_OK; k++) {
        int64_t cut = 0;
        twists[6 * part + k] = 1;
        status = skg_plan_derivative(plan, NULL, &direction, images + k * study->pixels, &cut);
        twists[6 * part + k] = 0;
        *saturated += cut;
    }
    return status;
}

/* The root mean squares over the image, as fractions of the open beam. */
static void take(const cost_study *study, const double *images, cost_part_sensitivity *part) {
    double gram[3][3] = {{0}}, value = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double *one = images + a * study->pixels, *other = images + b * study->pixels;
            for (int64_t i = 0; i < study->pixels; i++) gram[a][b] += one[i] * other[i];
            gram[a][b] /= (double)study->pixels * study->flat_field * study->flat_field;
        }
    find_largest(gram, part->direction);
    for (int a = 0; a < 3; a++) {
        part->along[a] = sqrt(gram[a][a]);
        for (int b = 0; b < 3; b++) value += part->direction[a] * gram[a][b] * part->direction[b];
    }
    part->largest = sqrt(fmax(value, 0));
    part->is_known = 1;
}

static int falling(const void *a, const void *b) {
    const cost_part_sensitivity *x = a, *y = b;
    if (x->is_known != y->is_known) return y->is_known - x->is_known;
    if (x->largest != y->largest) return x->largest < y->largest ? 1 : -1;
    return (x->part > y->part) - (x->part < y->part);
}

static skg_status measure_parts(const cost_study *study, skg_plan *plan, double *twists, double *images,
                                cost_sensitivity *s) {
    skg_status status = SKG_OK;
    for (int64_t p = 0; p < s->count && status == SKG_OK && !cli_stop_asked(); p++) {
        cli_progress_forecast("differentiating by parts", p, s->count,
                              (cli_now_ms() - s->begun_ms) / (double)(p ? p : 1) * (double)(s->count - p));
        status = differentiate(study, plan, p, twists, images, &s->saturated);
        if (status == SKG_OK) take(study, images, &s->parts[p]);
    }
    return status;
}

/* The scene's own image, in the precision that is nearest to its own and has derivatives. */
static skg_status make_plan(cost_study *study, skg_plan **plan) {
    cost_setting own = study->own;
    if (own.precision == SKG_PRECISION_HALF) own.precision = SKG_PRECISION_SINGLE;
    return cost_plan(study, &own, NULL, plan);
}

int cost_measure_sensitivity(cost_study *study) {
    cost_sensitivity *s = &study->sensitivity;
    skg_plan *plan = NULL;
    int exit_status = CLI_DONE;
    if (!s->wanted) return CLI_DONE;
    skg_status status = skg_scene_part_count(study->session.scene, &s->count);
    if (status != SKG_OK) return cli_fail(status);
    double *twists = calloc(6 * (size_t)s->count + 1, sizeof *twists);
    double *images = calloc(3 * (size_t)study->pixels, sizeof *images);
    s->parts = calloc((size_t)s->count + 1, sizeof *s->parts);
    s->begun_ms = cli_now_ms();
    if (!twists || !images || !s->parts) {
        s->count = 0;
        exit_status = cli_error(CLI_DEVICE, "out of host memory");
        goto cleanup;
    }
    for (int64_t p = 0; p < s->count; p++) s->parts[p].part = p;
    status = make_plan(study, &plan);
    if (status >= SKG_OK) status = measure_parts(study, plan, twists, images, s);
    if (status != SKG_OK) snprintf(s->refusal, sizeof s->refusal, "%.511s", skg_last_error());
    s->seconds = 1e-3 * (cli_now_ms() - s->begun_ms);
    qsort(s->parts, (size_t)s->count, sizeof *s->parts, falling);
cleanup:
    skg_plan_release(&plan);
    free(twists);
    free(images);
    return exit_status;
}

json_t *cost_sensitivity_json(const cost_study *study) {
    const cost_sensitivity *s = &study->sensitivity;
    if (!s->wanted) return json_null();
    json_t *object = json_object(), *parts = json_array();
    for (int64_t i = 0; i < s->count && s->parts[i].is_known; i++) {
        const cost_part_sensitivity *its = &s->parts[i];
        json_t *part = json_object(), *direction = json_array();
        const char *label = "";
        skg_scene_part_label_get(study->session.scene, its->part, &label);
        for (int k = 0; k < 3; k++) json_array_append_new(direction, cli_json_number(its->direction[k]));
        json_object_set_new(part, "part", cli_json_text(label));
        json_object_set_new(part, "x", cli_json_number(its->along[0]));
        json_object_set_new(part, "y", cli_json_number(its->along[1]));
        json_object_set_new(part, "z", cli_json_number(its->along[2]));
        json_object_set_new(part, "largest", cli_json_number(its->largest));
        json_object_set_new(part, "direction", direction);
        json_array_append_new(parts, part);
    }
    json_object_set_new(object, "unit", cli_json_text("1/mm"));
    json_object_set_new(object, "parts", parts);
    json_object_set_new(object, "of", json_integer(s->count));
    json_object_set_new(object, "saturated", json_integer(s->saturated));
    json_object_set_new(object, "seconds", cli_json_number(s->seconds));
    json_object_set_new(object, "reason", *s->refusal ? cli_json_text(s->refusal) : json_null());
    return object;
}
