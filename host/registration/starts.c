/* Further starts of a registration: drawn about the first one and from neighbours alike, ranked on small images. */
#include "registration/types.h"

#include <stdlib.h>
#include <string.h>

enum { KEPT = 3, BATCH = 64, NEIGHBOURS = 2 };

typedef struct {
    double loss;
    int64_t index;
} ranked;

static int by_loss(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->loss != y->loss) return x->loss < y->loss ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/* A direction of length 1: the third is drawn evenly, since a sphere's zones of one height have one area. */
static void draw_direction(uint64_t *state, double *direction) {
    const double z = 2 * skg_draw(state) - 1, angle = 2 * SKG_PI * skg_draw(state), across = sqrt(1 - z * z);
    direction[0] = across * cos(angle), direction[1] = across * sin(angle), direction[2] = z;
}

/* The motion after a step from the first start. */
static void start_at(const skg_registration *r, const double *step, reg_state *scratch, double *motion) {
    memcpy(scratch->motion, r->state.motion, sizeof scratch->motion);
    reg_state_move(r, step, scratch);
    memcpy(motion, scratch->motion, 16 * sizeof *motion);
}

/* Middle and radius of one part, by those of a body of this part alone. */
static skg_status measure_part(const skg_registration *r, int64_t part, skg_registration *alone) {
    *alone = *r;
    alone->parts = &part;
    alone->part_count = 1;
    return reg_body_measure(alone);
}

/* Shifts to the nearest parts of about the same size: a vertebra may be taken for the one above. */
static skg_status find_neighbours(const skg_registration *r, double shifts[NEIGHBOURS][3], int *count) {
    int64_t parts = 0;
    double distances[NEIGHBOURS];
    *count = 0;
    if (r->part_count != 1) return SKG_OK;
    SKG_TRY(skg_scene_part_count(r->scene, &parts));
    for (int64_t p = 0; p < parts; p++) {
        skg_registration other;
        double shift[3];
        if (p == r->parts[0]) continue;
        SKG_TRY(measure_part(r, p, &other));
        skg_add_scaled(other.middle, -1, r->middle, shift);
        const double distance = skg_length(shift), size = other.radius / r->radius;
        if (size < 0.7 || size > 1.4 || distance > 4 * r->radius) continue;
        int at = *count < NEIGHBOURS ? (*count)++ : NEIGHBOURS;
        for (; at > 0 && distance < distances[at - 1]; at--)
            if (at < NEIGHBOURS) {
                distances[at] = distances[at - 1];
                memcpy(shifts[at], shifts[at - 1], sizeof shift);
            }
        if (at == NEIGHBOURS) continue;
        distances[at] = distance;
        memcpy(shifts[at], shift, sizeof shift);
    }
    return SKG_OK;
}

/* motions: the first start, neighbours, and those that are drawn. */
static skg_status list_starts(const skg_registration *r, int64_t *count, double **motions) {
    double neighbours[NEIGHBOURS][3];
    int found = 0;
    reg_state scratch = {0};
    uint64_t random = (uint64_t)r->options.seed;
    SKG_TRY(find_neighbours(r, neighbours, &found));
    *count = 1 + found + r->options.restarts;
    SKG_TRY(skg_alloc(16 * *count, sizeof **motions, "starts of a registration", motions));
    for (int64_t k = 0; k < *count; k++) {
        double step[6] = {0};
        if (k > 0 && k <= found) memcpy(step, neighbours[k - 1], sizeof neighbours[0]);
        if (k > found) {
            double direction[3];
            draw_direction(&random, direction);
            skg_scale_vector(r->options.spread_mm * cbrt(skg_draw(&random)), direction, step);
            draw_direction(&random, direction);
            skg_scale_vector(r->options.spread_rad * cbrt(skg_draw(&random)) * r->radius, direction,
                             step + 3);
        }
        start_at(r, step, &scratch, *motions + 16 * k);
    }
    return SKG_OK;
}

/* The losses of up to BATCH poses at the coarsest level, polynomials found for each. */
static skg_status rank_batch(skg_registration *r, int64_t count, const double *motions, reg_state *scratch,
                             double *losses) {
    const reg_level *level = &r->levels[0];
    float **images = NULL, **one = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(r->image_count, sizeof *images, "images of starts", &images));
    SKG_TRY_CLEANUP(skg_alloc(r->image_count, sizeof *one, "images of starts", &one));
    for (int64_t i = 0; i < r->image_count; i++) {
        const skg_view view = reg_view_shrunk(&r->state.views[i], level->factor);
        SKG_TRY_CLEANUP(
            skg_alloc(count * view.rows * view.columns, sizeof **images, "images of starts", &images[i]));
        SKG_TRY_CLEANUP(reg_render_poses(r, &level->images[i], &view, count, motions, images[i]));
    }
    for (int64_t k = 0; k < count; k++) {
        for (int64_t i = 0; i < r->image_count; i++)
            one[i] = images[i] + k * level->images[i].rows * level->images[i].columns;
        reg_state_copy(r, &r->state, scratch);
        SKG_TRY_CLEANUP(reg_nuisances_find(r, level, scratch, one));
        losses[k] = reg_loss(r, level, scratch, one);
    }
cleanup:
    for (int64_t i = 0; images && i < r->image_count; i++) skg_free(&images[i]);
    skg_free(&images);
    skg_free(&one);
    return status;
}

static skg_status rank(skg_registration *r, int64_t count, const double *motions, ranked *order) {
    reg_state scratch = {0};
    double losses[BATCH];
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(reg_state_create(r, &scratch));
    for (int64_t k = 0; k < count; k += BATCH) {
        const int64_t some = count - k < BATCH ? count - k : BATCH;
        SKG_TRY_CLEANUP(reg_progress(r));
        SKG_TRY_CLEANUP(rank_batch(r, some, motions + 16 * k, &scratch, losses));
        for (int64_t s = 0; s < some; s++) order[k + s] = (ranked){losses[s], k + s};
    }
    qsort(order, (size_t)count, sizeof *order, by_loss);
cleanup:
    reg_state_free(&scratch);
    return status;
}

/* Follows the best starts through all levels but the last. */
static skg_status follow(skg_registration *r, int64_t count, const double *motions, const ranked *order) {
    const int64_t levels = r->level_count > 1 ? r->level_count - 1 : 1;
    double best = HUGE_VAL;
    reg_state state = {0}, found = {0};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(reg_state_create(r, &state));
    SKG_TRY_CLEANUP(reg_state_create(r, &found));
    for (int64_t k = 0; k < count && k < KEPT; k++) {
        double loss = HUGE_VAL;
        reg_state_copy(r, &r->state, &state);
        memcpy(state.motion, motions + 16 * order[k].index, sizeof state.motion);
        for (int64_t l = 0; l < levels && status == SKG_OK; l++)
            status = reg_gain_search(r, &r->levels[l], &state, &loss);
        if (loss < best) {
            best = loss;
            reg_state_copy(r, &state, &found);
        }
        if (status != SKG_OK) break; /* what was found so far stands */
    }
    if (best < HUGE_VAL) reg_state_copy(r, &found, &r->state);
cleanup:
    reg_state_free(&state);
    reg_state_free(&found);
    return status;
}

skg_status reg_starts_try(skg_registration *r) {
    int64_t count = 0;
    double *motions = NULL;
    ranked *order = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(list_starts(r, &count, &motions));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *order, "starts of a registration", &order));
    SKG_TRY_CLEANUP(rank(r, count, motions, order));
    SKG_TRY_CLEANUP(follow(r, count, motions, order));
cleanup:
    skg_free(&motions);
    skg_free(&order);
    return status;
}
