/* Prepares the search of a registration: checks, the energy of the model, masks, and the constant image of the parts that do not move. */
#include "registration/types.h"

#include <inttypes.h>
#include <string.h>

/* How far along the beam of a view the body's middle is: 0 at the source, 1 at the detector. */
static double depth_of(const skg_registration *r, const reg_image *image, const double *motion) {
    double normal[3], middle[3], from_middle[3], from_source[3];
    const skg_view *view = &image->view;
    skg_pose_point(motion, r->middle, middle);
    skg_cross(view->column_step, view->row_step, normal);
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
        /* No source: the depth only says on which side of the detector the body is. */
        skg_add_scaled(view->centre, -1, middle, from_middle);
        return skg_dot(normal, from_middle) * skg_dot(normal, view->source) > 0 ? 0.5 : 2;
    }
    skg_add_scaled(middle, -1, view->source, from_middle);
    skg_add_scaled(view->centre, -1, view->source, from_source);
    return skg_dot(normal, from_middle) / skg_dot(normal, from_source);
}

/* Millimetres at the body per pixel. */
static double pixel_at_body(const skg_view *view, double depth) {
    const double pixel = sqrt(skg_length(view->column_step) * skg_length(view->row_step));
    return view->projection == SKG_PROJECTION_POINT ? pixel * depth : pixel;
}

static const char *body_name(const skg_registration *r) {
    const char *label = "the body";
    if (r->part_count == 1) skg_scene_part_label_get(r->scene, r->parts[0], &label);
    return label;
}

/* Where the parts are seen at the start, and which pixels count. */
static skg_status find_mask(skg_registration *r, const reg_scene *shadow, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    const double depth = depth_of(r, image, r->state.motion);
    double most = 0, counted = 0;
    if (!(depth > 0))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: %s lies behind the source of this view; move it, or give another "
                        "view or start",
                        image->name, body_name(r));
    if (!(depth < 1))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "%s: %s lies behind the detector of this view; move it, or give another view or start",
            image->name, body_name(r));
    SKG_TRY(reg_render_once(r, shadow, NULL, &image->view, 1, r->state.motion, image->shadow));
    for (int64_t p = 0; p < count; p++) most = fmax(most, image->shadow[p]);
    if (!(most > 0))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: %s is not seen in this view; give the view that the image was taken from, or "
                        "another start",
                        image->name, body_name(r));
    SKG_TRY(reg_mask_near(image->view.rows, image->view.columns, image->shadow,
                          r->options.margin_mm / pixel_at_body(&image->view, depth), image->mask));
    for (int64_t p = 0; p < count; p++) counted += image->mask[p];
    if (counted >= 64) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the mask leaves %.0f pixels near %s, and 64 are needed; give another mask",
                    image->name, counted, body_name(r));
}

/* Mean length of the chords of the thinnest part: four volumes over the surface (Cauchy). */
static skg_status mean_chord(const skg_registration *r, double *chord) {
    *chord = HUGE_VAL;
    for (int64_t p = 0; p < r->part_count; p++) {
        skg_part part;
        skg_mesh_health health;
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        SKG_TRY(skg_scene_part_get(r->scene, r->parts[p], &part));
        SKG_TRY(skg_mesh_health_get(part.mesh, &health));
        const double scale = cbrt(fabs(skg_pose_determinant(part.pose)));
        if (health.closed && health.volume > 0)
            *chord = fmin(*chord, scale * 4 * health.volume / health.area);
    }
    return SKG_OK;
}

/* Rays along a side of a pixel: those of the scene; two at least, because slopes of single rays have no bound at silhouettes; and four
 * across the body where it is thin, because pixels do not see otherwise how much of them it covers. */
static skg_status find_rays(skg_registration *r) {
    enum { LEAST = 2, MOST = 8, ACROSS = 4 };
    double chord = 0, pixel = 0;
    SKG_TRY(mean_chord(r, &chord));
    for (int64_t i = 0; i < r->image_count; i++)
        pixel = fmax(pixel, pixel_at_body(&r->images[i].view, depth_of(r, &r->images[i], r->state.motion)));
    r->rays = r->plan.supersampling > LEAST ? r->plan.supersampling : LEAST;
    const double asked = ceil(fmin(ACROSS * pixel / chord, MOST));
    if (asked > (double)r->rays) r->rays = (int64_t)asked;
    return SKG_OK;
}

static double mean_of(int64_t count, const double *values) {
    double sum = 0;
    for (int64_t p = 0; p < count; p++) sum += values[p];
    return sum / (double)count;
}

/* The mean energy of the photons, and the range. */
static skg_status spectrum_range(const skg_spectrum *spectrum, double *mean, double range[2]) {
    int64_t bins = 0;
    double photons = 0, energy = 0;
    SKG_TRY(skg_spectrum_bin_count(spectrum, &bins));
    for (int64_t b = 0; b < bins; b++) {
        double kev, count;
        SKG_TRY(skg_spectrum_bin_get(spectrum, b, &kev, &count));
        photons += count, energy += kev * count;
        range[0] = b == 0 ? kev : fmin(range[0], kev);
        range[1] = b == 0 ? kev : fmax(range[1], kev);
    }
    *mean = photons > 0 ? energy / photons : range[0];
    return SKG_OK;
}

/* The mean attenuation of the whole scene in a small image of the first view. */
static skg_status attenuation_at(skg_registration *r, const reg_scene *all, skg_spectrum *spectrum,
                                 const skg_view *view, double *image, double *mean) {
    SKG_TRY(reg_render_once(r, all, spectrum, view, 1, NULL, image));
    *mean = mean_of(view->rows * view->columns, image);
    return SKG_OK;
}

/* The energy at which the scene attenuates as much, on average, as with its spectrum: secants of the logarithms. */
static skg_status find_energy(skg_registration *r, const reg_scene *all) {
    enum { TURNS = 5, SIDE = 64 };
    const skg_view *whole = &r->images[0].view;
    const int64_t side = whole->rows > whole->columns ? whole->rows : whole->columns;
    const skg_view view = reg_view_shrunk(whole, side > SIDE ? side / SIDE : 1);
    double range[2] = {0, 0}, energy = 0, aim, found, power = 1, before[2] = {0, 0}, *image = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(spectrum_range(r->spectrum, &energy, range));
    if (range[0] < range[1]) {
        SKG_TRY(skg_alloc(view.rows * view.columns, sizeof *image, "image of a registration", &image));
        SKG_TRY_CLEANUP(attenuation_at(r, all, r->spectrum, &view, image, &aim));
        for (int turn = 0; turn < TURNS && aim > 0; turn++) {
            SKG_TRY_CLEANUP(skg_spectrum_create_mono(energy, 1, &r->model));
            SKG_TRY_CLEANUP(attenuation_at(r, all, NULL, &view, image, &found));
            skg_spectrum_release(&r->model);
            if (!(found > 0) || fabs(found / aim - 1) < 2e-3) break;
            if (turn > 0 && before[0] != energy && found != before[1])
                power = -log(found / before[1]) / log(energy / before[0]);
            if (!(power > 0.05)) power = 1; /* an edge lies between: a step as if there were none */
            before[0] = energy, before[1] = found;
            energy = fmin(fmax(energy * pow(found / aim, 1 / power), range[0]), range[1]);
        }
    }
    status = skg_spectrum_create_mono(energy, 1, &r->model);
    r->result.energy_kev = energy;
cleanup:
    skg_free(&image);
    return status;
}

/* Attenuation of the parts that are missing in the scene of the body. */
static skg_status find_rest(skg_registration *r, const reg_scene *all, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    double *body = NULL;
    if (!r->additive) return SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof *body, "image of a registration", &body));
    skg_status status = reg_render_once(r, all, NULL, &image->view, r->rays, NULL, image->rest);
    if (status == SKG_OK) status = reg_render_once(r, &r->body, NULL, &image->view, r->rays, NULL, body);
    for (int64_t p = 0; p < count; p++) image->rest[p] -= body[p];
    skg_free(&body);
    return status;
}

skg_status reg_prepare(skg_registration *r) {
    reg_scene all = {0}, shadow = {0};
    skg_status status = SKG_OK;
    if (r->image_count == 0)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: there is no radiograph; add one");
    if (r->part_count == 0)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: no part was chosen; add the parts that move");
    SKG_TRY(reg_state_create(r, &r->state));
    SKG_TRY(reg_body_measure(r));
    SKG_TRY(find_rays(r));
    SKG_TRY_CLEANUP(reg_scene_make(r, REG_ALL, &all));
    SKG_TRY_CLEANUP(reg_scene_make(r, REG_SHADOW, &shadow));
    SKG_TRY_CLEANUP(reg_scene_make(r, r->additive ? REG_BODY : REG_ALL, &r->body));
    SKG_TRY_CLEANUP(find_energy(r, &all));
    for (int64_t i = 0; i < r->image_count; i++) {
        SKG_TRY_CLEANUP(reg_progress(r));
        SKG_TRY_CLEANUP(find_mask(r, &shadow, &r->images[i]));
        SKG_TRY_CLEANUP(find_rest(r, &all, &r->images[i]));
        SKG_TRY_CLEANUP(reg_shares_find(r, &r->images[i]));
    }
    SKG_TRY_CLEANUP(reg_levels_create(r));
cleanup:
    reg_scene_free(&all);
    reg_scene_free(&shadow);
    return status;
}
