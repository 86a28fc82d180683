/* How far a result can be believed: noise, structure of what is left, and directions that the radiographs do not determine. */
#include "registration/types.h"

#include "core/eigen.h"

#include <stdlib.h>
#include <string.h>

enum { LAGS = 32, CELLS = 8 };

static void add_lags(const reg_shrunk *s, const double *left, reg_rest *rest) {
    for (int64_t p = 0; p < s->rows * s->columns; p++) {
        const int64_t row = p / s->columns, column = p % s->columns;
        if (!(s->mask[p] > 0)) continue;
        for (int64_t k = 1; k <= LAGS; k++) {
            if (column + k < s->columns && s->mask[p + k] > 0)
                rest->lag[k] += left[p] * left[p + k], rest->lags[k]++;
            if (row + k < s->rows && s->mask[p + k * s->columns] > 0)
                rest->lag[k] += left[p] * left[p + k * s->columns], rest->lags[k]++;
        }
        if (column + 1 >= s->columns || row + 1 >= s->rows) continue;
        const int64_t q = p + s->columns;
        if (!(s->mask[p + 1] > 0 && s->mask[q] > 0 && s->mask[q + 1] > 0)) continue;
        const double twist = left[p] - left[p + 1] - left[q] + left[q + 1];
        rest->noise += twist * twist / 4, rest->blocks++;
    }
}

/* The cell of the image with the largest mean square. */
static void find_worst(const reg_shrunk *s, int64_t image, const double *left, reg_rest *rest) {
    for (int64_t cell = 0; cell < CELLS * CELLS; cell++) {
        const int64_t top = cell / CELLS * s->rows / CELLS, bottom = (cell / CELLS + 1) * s->rows / CELLS,
                      first = cell % CELLS * s->columns / CELLS,
                      last = (cell % CELLS + 1) * s->columns / CELLS;
        double sum = 0, count = 0;
        for (int64_t row = top; row < bottom; row++)
            for (int64_t column = first; column < last; column++) {
                const int64_t p = row * s->columns + column;
                if (s->mask[p] > 0) sum += left[p] * left[p], count++;
            }
        if (count * 4 < (double)((bottom - top) * (last - first)) || !(sum > rest->worst * count)) continue;
        rest->worst = sum / count;
        rest->worst_image = image;
        rest->worst_row = (top + bottom) / 2, rest->worst_column = (first + last) / 2;
    }
}

static void add_rest(const reg_shrunk *s, int64_t image, const double *left, reg_rest *rest) {
    for (int64_t p = 0; p < s->rows * s->columns; p++) {
        if (!(s->mask[p] > 0)) continue;
        rest->squares += left[p] * left[p], rest->pixels++;
        rest->fixed += s->fixed[p], rest->fixed_squares += s->fixed[p] * s->fixed[p];
    }
    add_lags(s, left, rest);
    find_worst(s, image, left, rest);
}

static void set_rest(const reg_rest *rest, skg_registration_result *result) {
    const double pixels = (double)rest->pixels, variance = rest->squares / pixels,
                 fixed = rest->fixed_squares / pixels - pow(rest->fixed / pixels, 2);
    double correlated = 1;
    result->residual = sqrt(variance);
    result->noise = rest->blocks > 0 ? fmin(sqrt(rest->noise / (double)rest->blocks), result->residual)
                                     : result->residual;
    for (int k = 1; k <= LAGS && rest->lags[k] > 0 && variance > 0; k++) {
        const double share = rest->lag[k] / (double)rest->lags[k] / variance;
        if (share < 0.1) break; /* noise of the estimate from here on */
        correlated += 2 * share;
    }
    result->correlation_pixels = correlated;
    result->explained = fixed > 0 ? 1 - variance / fixed : 0;
}

typedef struct {
    float **images;
    double *model, *derivatives, *values, *vectors, *meat;
    reg_equations equations;
    reg_scene around;
    reg_rest rest;
    double contrast[3];
} judging;

/* The standard deviation along a direction, mm. values, vectors: of the normal matrix, which is a mean over pixels. meat: NULL: from noise
 * alone. */
static double spread_along(const skg_registration *r, const double *along, const double *values,
                           const double *vectors, const double *meat, double pixels) {
    const int64_t count = reg_count(r);
    double solved[REG_LONGEST] = {0}, variance = 0;
    for (int64_t d = 0; d < count; d++) {
        const double *vector = vectors + d * count, share = skg_dot_long(count, along, vector);
        if (share == 0) continue;
        if (!(values[d] > 1e-14 * values[count - 1])) {
            if (fabs(share) > 1e-6) return HUGE_VAL;
            continue;
        }
        for (int64_t k = 0; k < count; k++) solved[k] += share / values[d] / pixels * vector[k];
        variance += share * share / values[d] / pixels * r->result.noise * r->result.noise;
    }
    if (!meat) return sqrt(variance);
    variance = 0;
    for (int64_t k = 0; k < count; k++) variance += solved[k] * skg_dot_long(count, meat + k * count, solved);
    return sqrt(fmax(variance, 0));
}

static void set_direction(skg_registration *r, int64_t d, const judging *j) {
    const double *vector = j->vectors + d * reg_count(r), pixels = (double)j->rest.pixels;
    skg_registration_direction *direction = &r->directions[d];
    skg_registration_direction_init(direction);
    direction->sigma_mm = spread_along(r, vector, j->values, j->vectors, NULL, pixels);
    direction->sigma_structure_mm =
        fmax(direction->sigma_mm, spread_along(r, vector, j->values, j->vectors, j->meat, pixels));
    direction->determined = direction->sigma_structure_mm <= r->options.need_mm;
    reg_name_direction(r, vector, r->names[d], sizeof *r->names);
    direction->name = r->names[d];
}

static void set_uncertainty(skg_registration *r, const judging *j) {
    skg_registration_result *result = &r->result;
    const double pixels = (double)j->rest.pixels;
    for (int64_t d = 0; d < reg_count(r); d++) set_direction(r, d, j);
    if (r->options.free == SKG_REGISTRATION_FREE_POSE) memcpy(r->least, j->vectors, sizeof r->least);
    for (int k = 0; k < REG_POSE && r->options.free == SKG_REGISTRATION_FREE_POSE; k++) {
        const double unit = k < 3 ? 1 : 1 / r->radius;
        double along[REG_POSE] = {0};
        along[k] = 1;
        const double noise = spread_along(r, along, j->values, j->vectors, NULL, pixels),
                     structure = fmax(noise, spread_along(r, along, j->values, j->vectors, j->meat, pixels));
        result->sigma[k] = noise * unit, result->sigma_structure[k] = structure * unit;
        result->determined[k] = structure <= r->options.need_mm;
    }
}

/* The parts' contrast in a radiograph: their attenuation less that of what they displace. */
static skg_status add_contrast(skg_registration *r, const reg_scene *around, const reg_level *level,
                               int64_t image, const float *body, double sums[3]) {
    const reg_shrunk *s = &level->images[image];
    double *contrast = NULL;
    SKG_TRY(skg_alloc(s->rows * s->columns, sizeof *contrast, "contrast", &contrast));
    const skg_status status =
        reg_render_once(r, around, NULL, &r->state.views[image], r->rays, NULL, contrast);
    for (int64_t p = 0; p < s->rows * s->columns; p++) contrast[p] = (double)body[p] - contrast[p];
    if (status == SKG_OK) reg_contrast(level, &r->state, image, body, contrast, sums);
    skg_free(&contrast);
    return status;
}

static skg_status begin(skg_registration *r, const reg_level *level, judging *j) {
    const int64_t count = reg_count(r);
    int64_t most = 0;
    for (int64_t i = 0; i < r->image_count; i++) {
        const int64_t size = level->images[i].rows * level->images[i].columns;
        most = size > most ? size : most;
    }
    SKG_TRY(reg_images_create(r, level, &j->images));
    SKG_TRY(skg_alloc(most, sizeof *j->model, "model", &j->model));
    SKG_TRY(skg_alloc(most * reg_local_count(r), sizeof *j->derivatives, "derivatives", &j->derivatives));
    SKG_TRY(skg_alloc(count, sizeof *j->values, "directions", &j->values));
    SKG_TRY(skg_alloc(count * count, sizeof *j->vectors, "directions", &j->vectors));
    SKG_TRY(skg_alloc(count * count, sizeof *j->meat, "directions", &j->meat));
    skg_free(&r->directions);
    skg_free(&r->names);
    SKG_TRY(skg_alloc(count, sizeof *r->directions, "directions", &r->directions));
    SKG_TRY(skg_alloc(count, sizeof *r->names, "directions", &r->names));
    SKG_TRY(reg_equations_create(r, &j->equations));
    return reg_scene_make(r, REG_AROUND, &j->around);
}

static void end(const skg_registration *r, judging *j) {
    reg_images_free(r, &j->images);
    skg_free(&j->model);
    skg_free(&j->derivatives);
    skg_free(&j->values);
    skg_free(&j->vectors);
    skg_free(&j->meat);
    reg_equations_free(&j->equations);
    reg_scene_free(&j->around);
}

static skg_status judge_image(skg_registration *r, const reg_level *level, int64_t i, judging *j) {
    const reg_shrunk *s = &level->images[i];
    SKG_TRY(reg_differentiate(r, level, &r->state, i, j->derivatives));
    reg_equations_add(r, level, &r->state, i, j->images[i], j->derivatives, 0, &j->equations);
    reg_scores(r, level, &r->state, i, j->images[i], j->derivatives, &j->equations, j->meat);
    reg_model(r, level, &r->state, i, j->images[i], j->model);
    for (int64_t p = 0; p < s->rows * s->columns; p++) j->model[p] -= s->fixed[p];
    add_rest(s, i, j->model, &j->rest);
    return add_contrast(r, &j->around, level, i, j->images[i], j->contrast);
}

static void describe_motion(skg_registration *r) {
    double moved[3], shift[3];
    skg_registration_result *result = &r->result;
    reg_twist_of(r->state.motion, result->twist);
    skg_pose_point(r->state.motion, r->middle, moved);
    skg_add_scaled(moved, -1, r->middle, shift);
    memcpy(result->middle, r->middle, sizeof result->middle);
    result->radius_mm = r->radius;
    result->shift_mm = skg_length(shift);
    result->turn_rad = skg_length(result->twist + 3);
    result->directions = reg_count(r);
}

/* Eigenvalues of the normal matrix, the least certain direction first: those of its negative in falling order. */
static void find_directions(int64_t count, judging *j) {
    for (int64_t k = 0; k < count * count; k++) j->equations.matrix[k] = -j->equations.matrix[k];
    skg_eigen((int)count, j->equations.matrix, j->values, j->vectors);
    for (int64_t k = 0; k < count; k++) j->values[k] = -j->values[k];
}

static skg_status judge(skg_registration *r, const reg_level *level, judging *j) {
    SKG_TRY(begin(r, level, j));
    SKG_TRY(reg_render(r, level, &r->state, j->images));
    r->result.loss = reg_loss(r, level, &r->state, j->images);
    r->minimized = r->loss;
    r->loss = SKG_REGISTRATION_LOSS_LSQ; /* whatever was minimized: in units of attenuation */
    SKG_TRY(reg_nuisances_find(r, level, &r->state, j->images));
    for (int64_t i = 0; i < r->image_count; i++) SKG_TRY(judge_image(r, level, i, j));
    set_rest(&j->rest, &r->result);
    r->result.worst_image = j->rest.worst_image;
    r->result.worst_row = j->rest.worst_row, r->result.worst_column = j->rest.worst_column;
    find_directions(reg_count(r), j);
    set_uncertainty(r, j);
    /* Noise hides what agrees; its own share of the radiographs' squares is left out. */
    const double *c = j->contrast,
                 radiograph =
                     c[0] - 2 * c[1] + fmax(c[2] - pow(r->result.noise, 2) * (double)j->rest.pixels, 0);
    r->result.agreement = c[0] > 0 && radiograph > 0 ? fmin((c[0] - c[1]) / sqrt(c[0] * radiograph), 1) : 0;
    describe_motion(r);
    reg_say_verdict(r, &j->rest);
    return SKG_OK;
}

skg_status reg_judge(skg_registration *r) {
    judging j = {0};
    const skg_status status = judge(r, &r->levels[r->level_count - 1], &j);
    end(r, &j);
    return status;
}
