/* The pyramid of a registration: radiographs, masks and views of coarser pixels. */
#include "registration/types.h"

#include <string.h>

/* Sides of a radiograph at the coarsest level: at most this where a level more would not go below the least. */
enum { COARSE_SIDE = 64, LEAST_SIDE = 24, MOST_SAMPLES = 8 };

/* One pass of a chamfer transform: distances from a pixel to its neighbours before it, in the order of `sign`. */
static void spread(int64_t rows, int64_t columns, int64_t sign, double *far) {
    static const int64_t dy[4] = {0, -1, -1, -1}, dx[4] = {-1, -1, 0, 1};
    for (int64_t at = 0; at < rows * columns; at++) {
        const int64_t pixel = sign > 0 ? at : rows * columns - 1 - at, l = pixel / columns,
                      c = pixel % columns;
        for (int k = 0; k < 4; k++) {
            const int64_t y = l + sign * dy[k], x = c + sign * dx[k];
            if (y < 0 || y >= rows || x < 0 || x >= columns) continue;
            far[pixel] = fmin(far[pixel], far[y * columns + x] + (dy[k] && dx[k] ? sqrt(2) : 1));
        }
    }
}

skg_status reg_mask_near(int64_t rows, int64_t columns, const double *shadow, double distance, double *mask) {
    double *far = NULL;
    SKG_TRY(skg_alloc(rows * columns, sizeof *far, "mask of a radiograph", &far));
    for (int64_t p = 0; p < rows * columns; p++) far[p] = shadow[p] > 0 ? 0 : HUGE_VAL;
    spread(rows, columns, 1, far);
    spread(rows, columns, -1, far);
    for (int64_t p = 0; p < rows * columns; p++)
        if (far[p] > distance) mask[p] = 0;
    skg_free(&far);
    return SKG_OK;
}

static int64_t coarsest(const skg_registration *r) {
    int64_t most = 1, least = INT64_MAX, factor = 1;
    for (int64_t i = 0; i < r->image_count; i++) {
        const skg_view *view = &r->images[i].view;
        most = view->rows > most ? view->rows : most;
        most = view->columns > most ? view->columns : most;
        least = view->rows < least ? view->rows : least;
        least = view->columns < least ? view->columns : least;
    }
    while (least / (2 * factor) >= LEAST_SIDE && (factor < 4 || most / factor > COARSE_SIDE)) factor *= 2;
    return factor;
}

/* from: attenuations, which are averaged as transmissions; scratch: [rows][columns]. */
static void shrink_attenuation(const skg_view *view, int64_t factor, const double *from, double *scratch,
                               double *to) {
    const int64_t rows = view->rows / factor, columns = view->columns / factor;
    for (int64_t p = 0; p < view->rows * view->columns; p++) scratch[p] = exp(-from[p]);
    reg_shrink(view, factor, scratch, to);
    for (int64_t p = 0; p < rows * columns; p++) to[p] = -log(to[p]);
}

static skg_status shrink_image(const skg_registration *r, int64_t index, int64_t factor, reg_shrunk *shrunk) {
    const reg_image *image = &r->images[index];
    const skg_view *view = &image->view;
    double *scratch = NULL;
    shrunk->gains = r->options.free == SKG_REGISTRATION_FREE_POSE;
    shrunk->rows = view->rows / factor, shrunk->columns = view->columns / factor;
    const int64_t count = shrunk->rows * shrunk->columns;
    SKG_TRY(skg_alloc(count, sizeof *shrunk->fixed, "level of a pyramid", &shrunk->fixed));
    SKG_TRY(skg_alloc(count, sizeof *shrunk->rest, "level of a pyramid", &shrunk->rest));
    for (int k = 0; k < REG_SHARES; k++)
        SKG_TRY(skg_alloc(count, sizeof(double), "level of a pyramid", &shrunk->shares[k]));
    SKG_TRY(skg_alloc(count, sizeof *shrunk->mask, "level of a pyramid", &shrunk->mask));
    SKG_TRY(skg_alloc(view->rows * view->columns, sizeof *scratch, "level of a pyramid", &scratch));
    reg_shrink(view, factor, image->transmission, shrunk->fixed);
    shrink_attenuation(view, factor, image->rest, scratch, shrunk->rest);
    for (int k = 0; k < REG_SHARES; k++)
        shrink_attenuation(view, factor, image->shares[k], scratch, shrunk->shares[k]);
    reg_shrink(view, factor, image->mask, shrunk->mask);
    skg_free(&scratch);
    for (int64_t p = 0; p < count; p++) {
        shrunk->fixed[p] = -log(fmax(shrunk->fixed[p], 0) + REG_FLOOR);
        shrunk->mask[p] = shrunk->mask[p] >= 0.5;
    }
    return SKG_OK;
}

/* Radiographs of the same size, from sources of one kind, share a plan. */
static skg_status plan_image(skg_registration *r, reg_level *level, int64_t index) {
    reg_shrunk *shrunk = &level->images[index];
    const skg_view view = reg_view_shrunk(&r->images[index].view, level->factor);
    for (int64_t i = 0; i < index; i++)
        if (level->images[i].rows == shrunk->rows && level->images[i].columns == shrunk->columns &&
            r->images[i].view.projection == view.projection) {
            shrunk->plan = level->images[i].plan;
            return skg_plan_retain(shrunk->plan);
        }
    const int64_t coarse = level->factor * r->rays / 2, samples = level->factor < 2       ? r->rays
                                                                  : coarse > MOST_SAMPLES ? MOST_SAMPLES
                                                                                          : coarse;
    return reg_plan_create(r, r->body.scene, r->model, &view, samples, &shrunk->plan);
}

skg_status reg_levels_create(skg_registration *r) {
    for (int64_t factor = coarsest(r); factor >= 1; factor /= 2) {
        reg_level *level = &r->levels[r->level_count];
        level->factor = factor;
        SKG_TRY(skg_alloc(r->image_count, sizeof *level->images, "pyramid", &level->images));
        r->level_count++;
        for (int64_t i = 0; i < r->image_count; i++) {
            SKG_TRY(shrink_image(r, i, factor, &level->images[i]));
            /* More polynomials come nearer, and are misled from farther away (docs/register.md). */
            level->images[i].terms = factor == 1 && r->level_count > 1 ? REG_BASIS : REG_COARSE_BASIS;
            SKG_TRY(plan_image(r, level, i));
        }
    }
    return SKG_OK;
}

void reg_levels_free(skg_registration *r) {
    for (int64_t k = 0; k < r->level_count; k++) {
        for (int64_t i = 0; i < r->image_count && r->levels[k].images; i++) {
            reg_shrunk *shrunk = &r->levels[k].images[i];
            skg_free(&shrunk->fixed);
            skg_free(&shrunk->rest);
            for (int share = 0; share < REG_SHARES; share++) skg_free(&shrunk->shares[share]);
            skg_free(&shrunk->mask);
            skg_plan_release(&shrunk->plan);
        }
        skg_free(&r->levels[k].images);
    }
    r->level_count = 0;
}
