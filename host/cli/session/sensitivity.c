/* How much the image changes when each part moves. */
#include "session/sensitivity.h"

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

/* One measurement. twists: [3][parts][6]; images: [3][values] */
typedef struct {
    skg_plan *plan;
    const skg_frame *frame;
    double flat_field, *twists, *images;
    int64_t values;
    double begun_ms;
    cli_sensitivity *found;
} measuring;

/* The derivatives of the image by one part's place along x, y and z. */
static skg_status differentiate(const measuring *m, int64_t part) {
    skg_direction directions[3];
    skg_output images;
    int64_t cut[3] = {0};
    for (int k = 0; k < 3; k++) {
        double *twists = m->twists + 6 * k * m->found->count;
        skg_direction_init(&directions[k]);
        directions[k].poses = twists;
        twists[6 * part + k] = 1;
    }
    skg_output_init(&images);
    images.type = SKG_TYPE_FLOAT64;
    images.data = m->images;
    const skg_status status = skg_plan_derivatives(m->plan, m->frame, 3, directions, &images, cut);
    for (int k = 0; k < 3; k++) {
        m->twists[6 * (k * m->found->count + part) + k] = 0;
        m->found->saturated += cut[k];
    }
    return status;
}

/* The root mean squares over the image, as fractions of the open beam. */
static void take(const measuring *m, cli_part_sensitivity *part) {
    double gram[3][3] = {{0}}, value = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double *one = m->images + a * m->values, *other = m->images + b * m->values;
            for (int64_t i = 0; i < m->values; i++) gram[a][b] += one[i] * other[i];
            gram[a][b] /= (double)m->values * m->flat_field * m->flat_field;
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
    const cli_part_sensitivity *x = a, *y = b;
    if (x->is_known != y->is_known) return y->is_known - x->is_known;
    if (x->largest != y->largest) return x->largest < y->largest ? 1 : -1;
    return (x->part > y->part) - (x->part < y->part);
}

static skg_status measure_parts(const measuring *m) {
    cli_sensitivity *found = m->found;
    skg_status status = SKG_OK;
    for (int64_t p = 0; p < found->count && status == SKG_OK && !cli_stop_asked(); p++) {
        cli_progress_forecast("differentiating by parts", p, found->count,
                              (cli_now_ms() - m->begun_ms) / (double)(p ? p : 1) *
                                  (double)(found->count - p));
        status = differentiate(m, p);
        if (status == SKG_OK) take(m, &found->parts[p]);
    }
    return status;
}

void cli_sensitivity_refuse(cli_sensitivity *found) {
    snprintf(found->refusal, sizeof found->refusal, "%.511s", skg_last_error());
}

static int allocate(const cli_session *session, measuring *m) {
    cli_sensitivity *found = m->found;
    int64_t channels = 1;
    skg_status status = skg_scene_part_count(session->scene, &found->count);
    if (status == SKG_OK) status = skg_plan_channel_count(m->plan, &channels);
    if (status != SKG_OK) return cli_fail(status);
    m->values = channels * session->view.columns * session->view.rows;
    m->twists = calloc(18 * (size_t)found->count + 1, sizeof *m->twists);
    m->images = calloc(3 * (size_t)m->values, sizeof *m->images);
    found->parts = calloc((size_t)found->count + 1, sizeof *found->parts);
    if (m->twists && m->images && found->parts) return CLI_DONE;
    found->count = 0;
    return cli_error(CLI_DEVICE, "out of host memory");
}

int cli_sensitivity_measure(const cli_session *session, skg_plan *plan, const skg_frame *frame,
                            double flat_field, cli_sensitivity *found) {
    measuring m = {
        .plan = plan, .frame = frame, .flat_field = flat_field, .begun_ms = cli_now_ms(), .found = found};
    const int exit_status = allocate(session, &m);
    if (exit_status == CLI_DONE) {
        for (int64_t p = 0; p < found->count; p++) found->parts[p].part = p;
        if (measure_parts(&m) != SKG_OK) cli_sensitivity_refuse(found);
        qsort(found->parts, (size_t)found->count, sizeof *found->parts, falling);
    }
    found->seconds = 1e-3 * (cli_now_ms() - m.begun_ms);
    free(m.twists);
    free(m.images);
    return exit_status;
}

json_t *cli_sensitivity_json(const cli_session *session, const cli_sensitivity *found) {
    json_t *object = json_object(), *parts = json_array();
    for (int64_t i = 0; i < found->count && found->parts[i].is_known; i++) {
        const cli_part_sensitivity *its = &found->parts[i];
        json_t *part = json_object();
        const char *label = "";
        skg_scene_part_label_get(session->scene, its->part, &label);
        json_object_set_new(part, "part", cli_json_text(label));
        json_object_set_new(part, "x", cli_json_number(its->along[0]));
        json_object_set_new(part, "y", cli_json_number(its->along[1]));
        json_object_set_new(part, "z", cli_json_number(its->along[2]));
        json_object_set_new(part, "largest", cli_json_number(its->largest));
        json_object_set_new(part, "direction", cli_json_numbers(its->direction, 3));
        json_array_append_new(parts, part);
    }
    json_object_set_new(object, "unit", cli_json_text("1/mm"));
    json_object_set_new(object, "parts", parts);
    json_object_set_new(object, "of", json_integer(found->count));
    json_object_set_new(object, "saturated", json_integer(found->saturated));
    json_object_set_new(object, "seconds", cli_json_number(found->seconds));
    json_object_set_new(object, "reason", *found->refusal ? cli_json_text(found->refusal) : json_null());
    return object;
}
