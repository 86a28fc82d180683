/* The beam in the room: air kerma at places and over the field, half-value layers. */
#include "dose/figures.h"

#include "beam/spectrum.h"
#include "core/maths.h"
#include "material/material.h"

/* Strips of the field along each side, at whose middles kerma is taken: the sum of a smooth function is right to 1e-5. */
enum { STRIPS = 96 };

/* --- air kerma by energy */

void skg_kerma_table_fill(double high_kev, skg_kerma_table *table) {
    table->high_kev = fmax(high_kev, 1.01 * SKG_DOSE_LOWEST_KEV);
    for (int i = 0; i < SKG_KERMA_ROWS; i++) {
        const double share = (double)i / (SKG_KERMA_ROWS - 1);
        table->of[i] =
            skg_air_kerma(SKG_DOSE_LOWEST_KEV * exp(share * log(table->high_kev / SKG_DOSE_LOWEST_KEV)));
    }
}

double skg_kerma_at(const skg_kerma_table *table, double kev) {
    const double at =
        fmin(fmax(log(kev / SKG_DOSE_LOWEST_KEV) / log(table->high_kev / SKG_DOSE_LOWEST_KEV), 0), 1) *
        (SKG_KERMA_ROWS - 1);
    const int row = at < SKG_KERMA_ROWS - 2 ? (int)at : SKG_KERMA_ROWS - 2;
    return table->of[row] + (at - row) * (table->of[row + 1] - table->of[row]);
}

/* --- the beam */

/* The number of photons is known if the scene says it: mAs, or photons of a pixel. */
static skg_status check_photons(const skg_recipe *recipe) {
    if (recipe->spectrum->unloaded)
        return skg_fail(SKG_ERR_BEAM,
                        "dose: the load of the tube is not known, and so neither is its number of photons; "
                        "give mAs (skg_tube.mas)");
    if (recipe->absolute && recipe->view.projection != SKG_PROJECTION_POINT)
        return skg_fail(SKG_ERR_BEAM,
                        "dose: a parallel beam has no distance, so that photons per mm2 at 1 m (mAs) say "
                        "nothing of it; give photons per pixel (PhotonCount)");
    return SKG_OK;
}

static void find_direction(const skg_view *view, double way[3]) {
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY)
        skg_scale_vector(1, view->source, way);
    else
        skg_add_scaled(view->centre, -1, view->source, way);
    skg_scale_vector(1 / skg_length(way), way, way);
}

/* At every place of the field's plane, from its shares of the sides. */
static void place_on(const skg_dose_beam *b, double u, double v, double place[3]) {
    const skg_field *f = &b->field;
    skg_add_scaled(f->centre, f->low[0] + u * (f->high[0] - f->low[0]), f->column, place);
    skg_add_scaled(place, f->low[1] + v * (f->high[1] - f->low[1]), f->row, place);
}

/* Photons of the spectrum per sr, or per mm2: the recipe's are those of a pixel at the foot of the perpendicular. */
static void find_photons(skg_dose_beam *b) {
    const skg_spectrum *spectrum = b->recipe->spectrum;
    const skg_view *view = &b->recipe->view;
    double across[3], photons = 0;
    skg_cross(view->column_step, view->row_step, across);
    for (int64_t i = 0; i < spectrum->count; i++) photons += spectrum->photons[i];
    photons *= skg_recipe_exposure(b->recipe, view);
    b->photons = photons / (b->parallel ? skg_length(across) : skg_view_exposure(view) * 1e-6);
}

skg_status skg_dose_beam_make(const skg_recipe *recipe, skg_dose_beam *b) {
    const skg_view *view = &recipe->view;
    double way[3];
    *b = (skg_dose_beam){
        .recipe = recipe, .work = {.recipe = recipe, .view = view}, .world = recipe->options.world};
    SKG_TRY(check_photons(recipe));
    SKG_TRY(skg_field_make(recipe->options.collimation, view, &b->field));
    SKG_TRY(skg_beam_profile_make(&b->work, &b->profile));
    SKG_TRY(skg_alloc(recipe->spectrum->count, sizeof *b->kerma, "dose", &b->kerma));
    for (int64_t i = 0; i < recipe->spectrum->count; i++) {
        b->kerma[i] = skg_air_kerma(recipe->spectrum->energy_kev[i]);
        b->high_kev = recipe->spectrum->energy_kev[i];
    }
    b->parallel = view->projection != SKG_PROJECTION_POINT;
    find_direction(view, b->direction);
    place_on(b, 0.5, 0.5, b->middle);
    skg_cross(b->field.column, b->field.row, b->normal);
    skg_scale_vector(1 / skg_length(b->normal), b->normal, b->normal);
    if (b->parallel)
        skg_scale_vector(1, b->direction, way);
    else
        skg_add_scaled(b->field.centre, -1, view->source, way);
    if (skg_dot(b->normal, way) < 0) skg_scale_vector(-1, b->normal, b->normal);
    b->depth = b->parallel ? 0 : skg_dot(b->normal, way);
    b->area = (b->field.high[0] - b->field.low[0]) * (b->field.high[1] - b->field.low[1]);
    find_photons(b);
    return SKG_OK;
}

void skg_dose_beam_free(skg_dose_beam *b) {
    skg_beam_profile_free(&b->profile);
    skg_free(&b->kerma);
}

int skg_dose_beam_way(const skg_dose_beam *b, const double place[3], double way[3], double *mm) {
    double on[3], from_middle[3];
    *mm = 0;
    if (b->parallel) {
        skg_scale_vector(1, b->direction, way);
        skg_add_scaled(place, -1, b->recipe->view.source, from_middle);
        if (b->recipe->view.projection == SKG_PROJECTION_PARALLEL && skg_dot(from_middle, way) < 0) return 0;
        skg_add_scaled(place, -1, b->field.centre, from_middle);
        skg_add_scaled(place, -skg_dot(from_middle, b->normal) / skg_dot(way, b->normal), way, on);
    } else {
        skg_add_scaled(place, -1, b->recipe->view.source, way);
        *mm = skg_length(way);
        const double depth = skg_dot(way, b->normal);
        if (!(depth > 0)) return 0;
        skg_add_scaled(b->recipe->view.source, b->depth / depth, way, on);
        skg_scale_vector(1 / *mm, way, way);
    }
    skg_add_scaled(on, -1, b->field.centre, from_middle);
    const double u = skg_dot(from_middle, b->field.column), v = skg_dot(from_middle, b->field.row);
    return u >= b->field.low[0] && u <= b->field.high[0] && v >= b->field.low[1] && v <= b->field.high[1];
}

double skg_dose_beam_begin(const skg_dose_beam *b, const skg_forest *tree, const double place[3],
                           double from[3]) {
    double way[3], far = 0;
    skg_add_scaled(place, -1, b->recipe->view.source, way);
    if (!b->parallel) {
        skg_scale_vector(1, b->recipe->view.source, from);
        return skg_length(way);
    }
    const int has_plane = b->recipe->view.projection == SKG_PROJECTION_PARALLEL;
    if (has_plane) far = skg_dot(way, b->direction);
    for (int k = 0; k < 3 && !has_plane && tree->node_count > 0; k++)
        far += fmax(fabs(place[k] - tree->nodes[0].low[k]), fabs(place[k] - tree->nodes[0].high[k]));
    skg_add_scaled(place, -far, b->direction, from);
    return far;
}

/* Sums a quantity over the spectrum along a direction, per photon of the spectrum, with the profile of the beam. of: [bins] the quantity of
 * a photon of each energy, such as the kerma of one per mm2; depth: [bins] optical depth before the point; NULL: none */
static double along(const skg_dose_beam *b, const double *of, const double way[3], const double *depth) {
    const skg_spectrum *spectrum = b->recipe->spectrum;
    const skg_beam_place place = skg_beam_profile_find(&b->profile, way);
    double photons = 0, sum = 0;
    for (int64_t i = 0; i < spectrum->count; i++) {
        photons += spectrum->photons[i];
        sum += spectrum->photons[i] * of[i] * skg_beam_profile_at(&b->profile, &place, i) *
               (depth ? exp(-depth[i]) : 1);
    }
    return sum / photons;
}

/* Optical depths of mm of the world; of a parallel beam from where it begins. */
static skg_status cross_world(const skg_dose_beam *b, const double place[3], double mm, double *depth) {
    const skg_spectrum *spectrum = b->recipe->spectrum;
    if (b->parallel) {
        double way[3];
        skg_add_scaled(place, -1, b->recipe->view.source, way);
        mm = fmax(skg_dot(way, b->direction), 0);
    }
    for (int64_t i = 0; i < spectrum->count; i++) {
        SKG_TRY(skg_material_attenuation_get(b->world, spectrum->energy_kev[i], &depth[i]));
        depth[i] *= mm / 10;
    }
    return SKG_OK;
}

skg_status skg_dose_beam_kerma(const skg_dose_beam *b, const double place[3], double *kerma) {
    double way[3], mm = 0, *depth = NULL;
    skg_status status = SKG_OK;
    *kerma = 0;
    if (!skg_dose_beam_way(b, place, way, &mm)) return SKG_OK;
    if (b->world && b->recipe->view.projection != SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
        SKG_TRY(skg_alloc(b->recipe->spectrum->count, sizeof *depth, "dose", &depth));
        status = cross_world(b, place, mm, depth);
    }
    /* Photons per mm2 across the beam. */
    const double per_mm2 =
        b->parallel ? b->photons / skg_dot(b->direction, b->normal) : b->photons / (mm * mm);
    if (status == SKG_OK) *kerma = per_mm2 * along(b, b->kerma, way, depth);
    skg_free(&depth);
    return status;
}

/* The integral of what photons give over the field. on_area: 1: over an area across the middle ray; 0: over the solid angle. Of a parallel
 * beam over the area of the field. */
static double over_field(const skg_dose_beam *b, const double *of, int on_area) {
    double central[3], sum = 0;
    if (b->parallel) return b->area * b->photons * along(b, of, b->direction, NULL);
    skg_add_scaled(b->middle, -1, b->recipe->view.source, central);
    skg_scale_vector(1 / skg_length(central), central, central);
    const int is_even = !b->profile.heel && !b->profile.bowtie;
    const double even = along(b, of, central, NULL);
    for (int i = 0; i < STRIPS * STRIPS; i++) {
        double place[3], way[3];
        place_on(b, (i % STRIPS + 0.5) / STRIPS, ((double)(i / STRIPS) + 0.5) / STRIPS, place);
        skg_add_scaled(place, -1, b->recipe->view.source, way);
        const double mm = skg_length(way);
        skg_scale_vector(1 / mm, way, way);
        const double sr = b->area / (STRIPS * STRIPS) * skg_dot(way, b->normal) / (mm * mm);
        sum += (on_area ? sr / skg_dot(way, central) : sr) * (is_even ? even : along(b, of, way, NULL));
    }
    return b->photons * sum;
}

double skg_dose_beam_kap(const skg_dose_beam *b) {
    const double cm2 = 1e-2;
    return cm2 * over_field(b, b->kerma, 1);
}

double skg_dose_beam_energy(const skg_dose_beam *b) {
    return over_field(b, b->recipe->spectrum->energy_kev, 0);
}

skg_status skg_dose_beam_layers(const skg_dose_beam *b, double *first, double *second) {
    enum { ALUMINIUM = 13 };
    const skg_spectrum *spectrum = b->recipe->spectrum;
    skg_spectrum *behind = NULL;
    skg_material *metal = NULL;
    double way[3];
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_material_create_element(ALUMINIUM, &metal));
    SKG_TRY_CLEANUP(skg_spectrum_create_counts(spectrum, 1, &behind));
    if (!b->parallel) {
        skg_add_scaled(b->middle, -1, b->recipe->view.source, way);
        const skg_beam_place place = skg_beam_profile_find(&b->profile, way);
        for (int64_t i = 0; i < spectrum->count; i++)
            behind->photons[i] *= skg_beam_profile_at(&b->profile, &place, i);
    }
    status = skg_half_value_layers(behind, metal, first, second);
cleanup:
    skg_spectrum_release(&behind);
    skg_material_release(&metal);
    return status;
}
