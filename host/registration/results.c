/* Results of a registration: numbers, words, views, poses, pictures. */
#include "registration/types.h"

#include "core/text.h"

#include <inttypes.h>
#include <string.h>

static skg_status need_end(const skg_registration *r, const char *call) {
    if (r->ended) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: nothing is registered yet; call skg_registration_run first", call);
}

static skg_status need_index(const char *call, int64_t index, int64_t count) {
    if (index >= 0 && index < count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: index %" PRId64 " is not below %" PRId64, call, index, count);
}

skg_status skg_registration_result_get(const skg_registration *registration,
                                       skg_registration_result *result) {
    SKG_NEEDS(registration);
    SKG_NEEDS(result);
    SKG_TRY(need_end(registration, __func__));
    return skg_struct_write(&registration->result, sizeof registration->result, "skg_registration_result",
                            result);
}

skg_status skg_registration_verdict_get(const skg_registration *registration, const char **sentence) {
    SKG_NEEDS(registration);
    SKG_NEEDS(sentence);
    SKG_TRY(need_end(registration, __func__));
    *sentence = registration->verdict;
    return SKG_OK;
}

skg_status skg_registration_direction_get(const skg_registration *registration, int64_t index,
                                          skg_registration_direction *direction) {
    SKG_NEEDS(registration);
    SKG_NEEDS(direction);
    SKG_TRY(need_end(registration, __func__));
    SKG_TRY(need_index(__func__, index, registration->result.directions));
    return skg_struct_write(&registration->directions[index], sizeof *registration->directions,
                            "skg_registration_direction", direction);
}

skg_status skg_registration_view_get(const skg_registration *registration, int64_t image, skg_view *view) {
    SKG_NEEDS(registration);
    SKG_NEEDS(view);
    SKG_TRY(need_end(registration, __func__));
    SKG_TRY(need_index(__func__, image, registration->image_count));
    return skg_struct_write(&registration->state.views[image], sizeof(skg_view), "skg_view", view);
}

skg_status skg_registration_motion_get(const skg_registration *registration, double *motion) {
    SKG_NEEDS(registration);
    SKG_NEEDS(motion);
    SKG_TRY(need_end(registration, __func__));
    memcpy(motion, registration->state.motion, sizeof registration->state.motion);
    return SKG_OK;
}

skg_status skg_registration_pose_get(const skg_registration *registration, int64_t part, double *pose) {
    const skg_registration *r = registration;
    skg_part one;
    int64_t count = 0;
    SKG_NEEDS(registration);
    SKG_NEEDS(pose);
    SKG_TRY(need_end(r, __func__));
    SKG_TRY(skg_scene_part_count(r->scene, &count));
    SKG_TRY(need_index(__func__, part, count));
    skg_part_init(&one);
    SKG_TRY(skg_scene_part_get(r->scene, part, &one));
    memcpy(pose, one.pose, sizeof one.pose);
    for (int64_t p = 0; p < r->part_count; p++)
        if (r->parts[p] == part) skg_pose_multiply(r->state.motion, one.pose, pose);
    return SKG_OK;
}

/* The model at the end, from its images. */
static skg_status model_of(skg_registration *r, int64_t image, double *values) {
    const reg_level *level = &r->levels[r->level_count - 1];
    const reg_shrunk *shrunk = &level->images[image];
    float **images = NULL;
    skg_status status = reg_images_create(r, level, &images);
    if (status == SKG_OK) status = reg_render(r, level, &r->state, images);
    if (status == SKG_OK) reg_model(r, level, &r->state, image, images[image], values);
    /* Where no pixel counts, polynomials mean nothing. */
    for (int64_t p = 0; p < shrunk->rows * shrunk->columns && status == SKG_OK; p++)
        if (!(shrunk->mask[p] > 0))
            values[p] = -log(exp(-((double)images[image][p] + shrunk->rest[p])) + REG_FLOOR);
    reg_images_free(r, &images);
    return status;
}

/* Model less radiograph at the end. */
static skg_status after_of(skg_registration *r, int64_t image, double *values) {
    const reg_shrunk *shrunk = &r->levels[r->level_count - 1].images[image];
    SKG_TRY(model_of(r, image, values));
    for (int64_t p = 0; p < shrunk->rows * shrunk->columns; p++)
        values[p] = shrunk->mask[p] > 0 ? values[p] - shrunk->fixed[p] : 0;
    return SKG_OK;
}

/* Sums over all rows and columns before: [rows + 1][columns + 1]. */
static void sum_up(int64_t rows, int64_t columns, const double *from, double *sums) {
    for (int64_t row = 0; row < rows; row++) {
        double line = 0;
        for (int64_t column = 0; column < columns; column++) {
            line += from[row * columns + column];
            sums[(row + 1) * (columns + 1) + column + 1] = sums[row * (columns + 1) + column + 1] + line;
        }
    }
}

/* Sum over the neighbourhood of a pixel. */
static double sum_about(const reg_shrunk *s, const double *sums, int64_t row, int64_t column, int64_t reach) {
    const int64_t top = row > reach ? row - reach : 0, first = column > reach ? column - reach : 0,
                  bottom = row + reach < s->rows ? row + reach + 1 : s->rows,
                  last = column + reach < s->columns ? column + reach + 1 : s->columns, step = s->columns + 1;
    return sums[bottom * step + last] - sums[top * step + last] - sums[bottom * step + first] +
           sums[top * step + first];
}

/* Structure in the residual at the end: means of neighbourhoods that are beyond three standard deviations of its noise. */
static skg_status structure_of(skg_registration *r, int64_t image, double *values) {
    const reg_shrunk *s = &r->levels[r->level_count - 1].images[image];
    const int64_t reach = (s->rows < s->columns ? s->rows : s->columns) / 80;
    double *sums = NULL, *counts = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc((s->rows + 1) * (s->columns + 1), sizeof *sums, "sums of a picture", &sums));
    SKG_TRY_CLEANUP(
        skg_alloc((s->rows + 1) * (s->columns + 1), sizeof *counts, "sums of a picture", &counts));
    SKG_TRY_CLEANUP(after_of(r, image, values));
    sum_up(s->rows, s->columns, values, sums);
    sum_up(s->rows, s->columns, s->mask, counts);
    for (int64_t p = 0; p < s->rows * s->columns; p++) {
        const int64_t row = p / s->columns, column = p % s->columns;
        const double count = sum_about(s, counts, row, column, reach),
                     mean = count > 0 ? sum_about(s, sums, row, column, reach) / count : 0;
        values[p] = s->mask[p] > 0 && fabs(mean) > 3 * r->result.noise / sqrt(count) ? mean : 0;
    }
cleanup:
    skg_free(&sums);
    skg_free(&counts);
    return status;
}

static skg_status shadow_of(skg_registration *r, int64_t image, double *values) {
    reg_scene shadow = {0};
    skg_status status = reg_scene_make(r, REG_SHADOW, &shadow);
    if (status == SKG_OK)
        status = reg_render_once(r, &shadow, NULL, &r->state.views[image], 1, r->state.motion, values);
    reg_scene_free(&shadow);
    return status;
}

skg_status skg_registration_picture_get(skg_registration *registration, int64_t image, int32_t which,
                                        double *values) {
    SKG_PLAIN;
    skg_registration *r = registration;
    SKG_NEEDS(registration);
    SKG_NEEDS(values);
    SKG_TRY(need_end(r, __func__));
    SKG_TRY(need_index(__func__, image, r->image_count));
    const reg_image *one = &r->images[image];
    const reg_shrunk *shrunk = &r->levels[r->level_count - 1].images[image];
    const int64_t count = one->view.rows * one->view.columns;
    switch (which) {
    case SKG_REGISTRATION_PICTURE_FIXED:
        memcpy(values, shrunk->fixed, (size_t)count * sizeof *values);
        break;
    case SKG_REGISTRATION_PICTURE_BEFORE:
        memcpy(values, one->before, (size_t)count * sizeof *values);
        break;
    case SKG_REGISTRATION_PICTURE_SHADOW_BEFORE:
        memcpy(values, one->shadow, (size_t)count * sizeof *values);
        break;
    case SKG_REGISTRATION_PICTURE_MODEL:
        return model_of(r, image, values);
    case SKG_REGISTRATION_PICTURE_SHADOW_AFTER:
        return shadow_of(r, image, values);
    case SKG_REGISTRATION_PICTURE_AFTER:
        return after_of(r, image, values);
    case SKG_REGISTRATION_PICTURE_STRUCTURE:
        return structure_of(r, image, values);
    default:
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId32 " is no SKG_REGISTRATION_PICTURE_ value", __func__,
                        which);
    }
    return SKG_OK;
}

skg_status skg_registration_step_count(const skg_registration *registration, int64_t *count) {
    SKG_NEEDS(registration);
    SKG_NEEDS(count);
    *count = registration->path_count;
    return SKG_OK;
}

skg_status skg_registration_step_get(const skg_registration *registration, int64_t index, int64_t *level,
                                     double *loss) {
    SKG_NEEDS(registration);
    SKG_TRY(need_index(__func__, index, registration->path_count));
    if (level) *level = registration->path[index].level;
    if (loss) *loss = registration->path[index].loss;
    return SKG_OK;
}
