/* The body's contrast as another than the model's: freed where the radiographs ask for it, since it makes weak directions weaker. */
#include "registration/types.h"

/* Squares that a gain has to explain in each radiograph, as multiples of what is left in a pixel: five standard deviations. An
 * assumption. */
static const double least_explained = 25;

static double count_pixels(const skg_registration *r, const reg_level *level) {
    double count = 0;
    for (int64_t i = 0; i < r->image_count; i++)
        for (int64_t p = 0; p < level->images[i].rows * level->images[i].columns; p++)
            count += level->images[i].mask[p] > 0;
    return count;
}

/* Whether a gain explains enough, and shows the body everywhere. */
static int is_asked_for(const skg_registration *r, const reg_level *level, const reg_state *state,
                        double before, double after) {
    for (int64_t i = 0; i < r->image_count; i++)
        if (!(state->nuisances[i * REG_NUISANCES + REG_BASIS + REG_BODY_OWN] > -1)) return 0;
    return before - after > least_explained * (double)r->image_count / count_pixels(r, level) * after;
}

skg_status reg_gain_search(skg_registration *r, const reg_level *level, reg_state *state, double *loss) {
    float **images = NULL;
    reg_state gained = {0};
    skg_status status = SKG_OK;
    SKG_TRY(reg_search(r, level, state, loss));
    if (r->loss != SKG_REGISTRATION_LOSS_LSQ || !level->images[0].gains || state->body_gain) return SKG_OK;
    SKG_TRY_CLEANUP(reg_images_create(r, level, &images));
    SKG_TRY_CLEANUP(reg_state_create(r, &gained));
    reg_state_copy(r, state, &gained);
    gained.body_gain = 1;
    SKG_TRY_CLEANUP(reg_render(r, level, &gained, images));
    SKG_TRY_CLEANUP(reg_nuisances_find(r, level, &gained, images));
    if (is_asked_for(r, level, &gained, *loss, reg_loss(r, level, &gained, images))) {
        reg_state_copy(r, &gained, state);
        status = reg_search(r, level, state, loss);
    }
cleanup:
    reg_images_free(r, &images);
    reg_state_free(&gained);
    return status;
}
