/* Divides the parts that do not move into shares that have a gain each: materials of a kind are wrong together, by density or energy. */
#include "registration/types.h"

#include <string.h>

/* Attenuation relative to water below which a material is light (lung, gas), and above which it is dense (bone, contrast medium,
 * metal). Assumptions: soft tissues are from 0.9 to 1.08. */
static const double light_below = 0.7, dense_above = 1.08;

static skg_status water_attenuation(const skg_registration *r, double *per_cm) {
    skg_material *water = NULL;
    SKG_TRY(skg_material_create_named("H2O", &water));
    const skg_status status = skg_material_attenuation_get(water, r->result.energy_kev, per_cm);
    skg_material_release(&water);
    return status;
}

/* share: [parts of the scene] of each. What the body lies inside, and volumes of cells, are the remainder. */
static skg_status sort_parts(const skg_registration *r, const reg_scene *rest, int64_t count,
                             reg_share *share) {
    double water = 1;
    skg_part part, body;
    SKG_TRY(water_attenuation(r, &water));
    skg_part_init(&part);
    skg_part_init(&body);
    for (int64_t p = 0; p < count; p++) {
        double own = 0;
        SKG_TRY(skg_scene_part_get(rest->scene, p, &part));
        share[p] = REG_HOLDING;
        if (part.volume) continue;
        SKG_TRY(skg_material_attenuation_get(part.material, r->result.energy_kev, &own));
        share[p] = own < light_below * water ? REG_LIGHT : own > dense_above * water ? REG_DENSE : REG_SOFT;
    }
    for (int64_t p = 0; p < r->part_count; p++) {
        SKG_TRY(skg_scene_part_get(r->scene, r->parts[p], &body));
        for (int64_t steps = 0; body.inside >= 0 && steps < count; steps++) {
            int64_t held = -1;
            SKG_TRY(skg_scene_part_get(r->scene, body.inside, &body));
            /* a part that moves is not in the scene of the rest */
            if (skg_scene_part_find(rest->scene, body.label, &held) == SKG_OK) share[held] = REG_HOLDING;
        }
    }
    return SKG_OK;
}

/* An image of what does not move, in which the parts of a share attenuate nothing. */
static skg_status render_without(skg_registration *r, const reg_scene *rest, int64_t parts,
                                 const reg_share *share, reg_share without, const skg_view *view,
                                 double *image) {
    skg_material *nothing = NULL, **own = NULL;
    skg_part part;
    int64_t changed = 0;
    skg_status status = SKG_OK;
    skg_part_init(&part);
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof(skg_material *), "materials of a registration", &own));
    SKG_TRY_CLEANUP(skg_material_create_mu("nothing", 0, &nothing));
    for (int64_t p = 0; p < parts; p++) {
        SKG_TRY_CLEANUP(skg_scene_part_get(rest->scene, p, &part));
        if (share[p] != without) continue;
        SKG_TRY_CLEANUP(skg_material_retain(part.material));
        own[p] = part.material;
        SKG_TRY_CLEANUP(skg_scene_part_material_set(rest->scene, p, nothing));
        changed++;
    }
    if (changed > 0) status = reg_render_once(r, rest, NULL, view, r->rays, NULL, image);
cleanup:
    for (int64_t p = 0; own && p < parts; p++) {
        if (own[p] && status == SKG_OK) status = skg_scene_part_material_set(rest->scene, p, own[p]);
        skg_material_release(&own[p]);
    }
    skg_free(&own);
    skg_material_release(&nothing);
    return status;
}

/* Images of the rest as it is, and without a share: their difference is the share. What the body lies inside is the remainder. */
static skg_status render_shares(skg_registration *r, const reg_scene *rest, int64_t parts,
                                const reg_share *share, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    double *whole = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *whole, "image of a registration", &whole));
    SKG_TRY_CLEANUP(reg_render_once(r, rest, NULL, &image->view, r->rays, NULL, whole));
    memcpy(image->shares[REG_HOLDING], whole, (size_t)count * sizeof *whole);
    for (int k = REG_HOLDING + 1; k < REG_SHARES; k++) {
        double *own = image->shares[k];
        memcpy(own, whole, (size_t)count * sizeof *whole);
        SKG_TRY_CLEANUP(render_without(r, rest, parts, share, (reg_share)k, &image->view, own));
        for (int64_t p = 0; p < count; p++) {
            own[p] = whole[p] - own[p];
            image->shares[REG_HOLDING][p] -= own[p];
        }
    }
cleanup:
    skg_free(&whole);
    return status;
}

skg_status reg_shares_find(skg_registration *r, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    int64_t parts = 0;
    reg_scene rest = {0}, around = {0};
    reg_share *share = NULL;
    skg_status status = SKG_OK;
    for (int k = 0; k < REG_SHARES; k++) memset(image->shares[k], 0, (size_t)count * sizeof(double));
    if (r->options.free != SKG_REGISTRATION_FREE_POSE) return SKG_OK;
    SKG_TRY_CLEANUP(reg_scene_make(r, REG_AROUND, &around));
    SKG_TRY_CLEANUP(
        reg_render_once(r, &around, NULL, &image->view, r->rays, NULL, image->shares[REG_BODY_OWN]));
    SKG_TRY_CLEANUP(reg_scene_make(r, REG_REST, &rest));
    SKG_TRY_CLEANUP(skg_scene_part_count(rest.scene, &parts));
    if (parts == 0) goto cleanup;
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *share, "parts of a registration", &share));
    SKG_TRY_CLEANUP(sort_parts(r, &rest, parts, share));
    status = render_shares(r, &rest, parts, share, image);
    /* Otherwise every image is one of the whole scene. */
    for (int64_t p = 0; p < count && !r->additive; p++) {
        image->shares[REG_BODY_OWN][p] = 0;
        for (int k = REG_HOLDING; k < REG_SHARES; k++) image->shares[REG_BODY_OWN][p] += image->shares[k][p];
    }
cleanup:
    reg_scene_free(&rest);
    reg_scene_free(&around);
    skg_free(&share);
    return status;
}
