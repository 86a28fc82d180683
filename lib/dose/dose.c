/* The dose of one exposure: beam, photons through the parts, detector. */
#include "dose/figures.h"

#include "beam/spectrum.h"
#include "core/clock.h"
#include "core/maths.h"
#include "core/text.h"
#include "material/material.h"
#include "scene/scene.h"
#include "scene/volume.h"

#include <inttypes.h>
#include <string.h>

#define HISTORIES_MAX ((int64_t)1 << 40)
enum { HISTORIES = 200000, POINTS_MAX = 4096 };

/* From keV and g. */
static const double UGY_PER_KEV_AND_GRAM = 1.602176634e-16 * 1e3 * 1e6;

void skg_dose_options_init_sized(void *options, int32_t size) {
    const skg_dose_options defaults = {.histories = HISTORIES};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_dose_report_init_sized(void *report, int32_t size) {
    const skg_dose_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

void skg_dose_point_init_sized(void *point, int32_t size) {
    const skg_dose_point defaults = {0};
    skg_struct_init(point, size, &defaults, sizeof defaults);
}

void skg_dose_part_init_sized(void *part, int32_t size) {
    const skg_dose_part defaults = {0};
    skg_struct_init(part, size, &defaults, sizeof defaults);
}

/* --- places */

/* Where a ray first meets matter of a part, in mm, within `reach`; HUGE_VAL: nowhere. The rules of overlaps are those of images;
 * a volume is matter in all of its box. */
static skg_status first_matter(const skg_dose_beam *beam, const skg_forest *tree, const double from[3],
                               const double way[3], double reach, double *at) {
    const skg_rules rules = skg_rules_of(beam->recipe);
    skg_way found = {0};
    *at = HUGE_VAL;
    const skg_status status = skg_way_find(tree, &rules, from, way, reach, &found);
    for (int64_t i = 0; status == SKG_OK && i < found.piece_count && *at == HUGE_VAL; i++)
        for (int64_t k = found.pieces[i].first; k < found.pieces[i].first + found.pieces[i].count; k++) {
            const int32_t part = found.presences[k].part;
            if (part < 0) continue;
            const skg_scene_part_data *its = &rules.scene->parts[part];
            if (its->volume || !skg_material_is_void(its->material)) *at = found.pieces[i].from;
        }
    skg_way_free(&found);
    return status;
}

/* Where the ray to the middle of the field enters the first part, or else that middle, which a warning says. */
static skg_status find_entrance(const skg_dose_beam *beam, const skg_forest *tree, double place[3]) {
    double from[3], way[3], mm, at = HUGE_VAL;
    skg_scale_vector(1, beam->middle, place);
    if (skg_dose_beam_way(beam, beam->middle, way, &mm)) {
        skg_dose_beam_begin(beam, tree, beam->middle, from);
        SKG_TRY(first_matter(beam, tree, from, way, HUGE_VAL, &at));
    }
    if (at < HUGE_VAL)
        skg_add_scaled(from, at, way, place);
    else
        skg_log(
            beam->recipe->scene->context, SKG_LOG_WARNING,
            "dose: the ray to the middle of the field meets no part, so that air kerma is that at the middle of the "
            "detector, (%g, %g, %g) mm; name the places that are meant",
            place[0], place[1], place[2]);
    return SKG_OK;
}

/* Whether nothing stands before a place; its own surface does not count. */
static skg_status is_bare(const skg_dose_beam *beam, const skg_forest *tree, const double place[3],
                          int *bare) {
    static const double on_surface = 1e-6; /* mm */
    double from[3], way[3], mm, at = HUGE_VAL;
    *bare = skg_dose_beam_way(beam, place, way, &mm);
    if (!*bare) return SKG_OK;
    const double distance = skg_dose_beam_begin(beam, tree, place, from);
    SKG_TRY(first_matter(beam, tree, from, way, distance, &at));
    *bare = !(at < distance - on_surface);
    return SKG_OK;
}

static skg_status find_points(const skg_dose_options *options, const skg_dose_beam *beam,
                              const skg_forest *tree, skg_dose *dose, skg_dose_spot *spots) {
    for (int64_t p = 0; p < dose->points; p++) {
        skg_dose_point *point = &dose->point[p];
        double way[3] = {0}, mm;
        int bare = 0;
        *point = (skg_dose_point){
            .size = sizeof *point, .backscatter = (double)NAN, .backscatter_sigma = (double)NAN};
        if (options->point_count > 0)
            memcpy(point->at, options->points + 3 * p, sizeof point->at);
        else
            SKG_TRY(find_entrance(beam, tree, point->at));
        point->in_field = skg_dose_beam_way(beam, point->at, way, &mm);
        SKG_TRY(skg_dose_beam_kerma(beam, point->at, &point->air_kerma_ugy));
        SKG_TRY(is_bare(beam, tree, point->at, &bare));
        spots[p].wanted = bare && point->air_kerma_ugy > 0;
        memcpy(spots[p].at, point->at, sizeof spots[p].at);
    }
    return SKG_OK;
}

/* --- photons */

static void take(const skg_dose_found *found, skg_dose *dose, const skg_dose_spot *spots) {
    skg_dose_report *report = &dose->report;
    for (int64_t i = 0; i < dose->parts; i++) {
        skg_dose_part *part = &dose->part[i];
        const double per_kev = part->mass_g > 0 ? UGY_PER_KEV_AND_GRAM / part->mass_g : (double)NAN;
        part->energy_kev = found->energy[i];
        part->dose_ugy = found->energy[i] * per_kev;
        part->sigma_ugy = found->energy[i] > 0 ? found->sigma[i] * per_kev : (double)NAN;
    }
    for (int64_t p = 0; p < dose->points; p++) {
        if (!spots[p].wanted) continue;
        dose->point[p].backscatter = 1 + found->kerma[p] / dose->point[p].air_kerma_ugy;
        dose->point[p].backscatter_sigma = found->kerma_sigma[p] / dose->point[p].air_kerma_ugy;
    }
    report->followed = 1;
    report->histories = found->histories;
    report->incident_kev = found->incident, report->escaped_kev = found->escaped;
    report->world_kev = found->around, report->balance_sigma_kev = found->absorbed_sigma;
}

static skg_status follow(skg_plan *plan, const skg_dose_options *options, const skg_dose_beam *beam,
                         const skg_forest *tree, const skg_dose_spot *spots, skg_dose *dose) {
    const skg_dose_walk walk = {.beam = beam,
                                .tree = tree,
                                .histories = options->histories,
                                .points = dose->points,
                                .seed = options->seed,
                                .spots = spots,
                                .progress = options->progress};
    skg_dose_found found;
    if (options->histories == 0) return SKG_OK;
    if (skg_dose_walk_check(plan->recipe) != SKG_OK) {
        skg_log(plan->context, SKG_LOG_WARNING,
                "dose: no photons are followed, so that doses of parts are not known: %s", skg_last_error());
        return SKG_OK;
    }
    const skg_status status = skg_dose_walk_run(&walk, &found);
    if (status == SKG_OK) take(&found, dose, spots);
    skg_dose_found_free(&found);
    return status;
}

/* By which the volume of a part becomes its mass, g/cm3; 0: not known. */
static double density_of(const skg_scene_part_data *part) {
    return !part->volume ? part->material->density : part->volume->values == SKG_VOLUME_MU ? 0 : 1;
}

/* Warns of parts whose volume lines have not found to a hundredth. */
static void doubt_masses(const skg_scene *scene, const double *volumes, const double *errors) {
    for (int64_t i = 0; i < scene->count; i++)
        if (volumes[i] > 0 && errors[i] > 0.01 * volumes[i])
            skg_log(
                scene->context, SKG_LOG_WARNING,
                "dose: the mass of %s, and with it its dose, is known to %.2g %% only, because other parts "
                "displace much of it",
                scene->parts[i].label, 100 * errors[i] / volumes[i]);
}

static skg_status find_masses(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                              skg_dose *dose) {
    double *volumes = NULL; /* then their errors */
    SKG_TRY(skg_alloc(2 * dose->parts, sizeof *volumes, "dose", &volumes));
    const skg_status status = skg_dose_volumes(recipe, tree, progress, volumes, volumes + dose->parts);
    if (status == SKG_OK) doubt_masses(recipe->scene, volumes, volumes + dose->parts);
    for (int64_t i = 0; i < dose->parts && status == SKG_OK; i++) {
        const double density = density_of(&recipe->scene->parts[i]), mm3_per_cm3 = 1e3;
        dose->part[i] =
            (skg_dose_part){.size = sizeof dose->part[i],
                            .dose_ugy = (double)NAN,
                            .sigma_ugy = (double)NAN,
                            .energy_kev = (double)NAN,
                            .mass_g = density > 0 ? density * volumes[i] / mm3_per_cm3 : (double)NAN};
    }
    skg_free(&volumes);
    return status;
}

/* --- the detector, by plans of its own; the caller was told of the scene */

static skg_status find_receptor(skg_plan *plan, const skg_dose_beam *beam, skg_progress *progress,
                                skg_dose_report *report) {
    skg_dose_receptor found;
    const skg_logger logger = plan->context->log;
    plan->context->log = (skg_logger){0};
    const skg_status status = skg_dose_receptor_find(plan, beam, progress, &found);
    plan->context->log = logger;
    if (status != SKG_OK) return status;
    report->detector_air_kerma_ugy = found.kerma;
    report->exposure_index = found.exposure_index;
    report->has_darkest = found.has_darkest;
    report->darkest_row = found.row, report->darkest_column = found.column;
    report->darkest_signal = found.signal;
    report->darkest_snr = found.has_darkest ? 1 / found.relative : 0;
    report->scattered = plan->recipe->options.scatter != NULL;
    return SKG_OK;
}

static skg_status fill(skg_plan *plan, const skg_dose_options *options, skg_dose *dose) {
    skg_dose_beam beam;
    skg_forest tree = {0};
    skg_dose_spot *spots = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_dose_beam_make(plan->recipe, &beam));
    SKG_TRY_CLEANUP(skg_forest_make(plan->recipe->scene, &tree));
    SKG_TRY_CLEANUP(skg_alloc(dose->points, sizeof *spots, "dose", &spots));
    SKG_TRY_CLEANUP(find_points(options, &beam, &tree, dose, spots));
    SKG_TRY_CLEANUP(find_masses(plan->recipe, &tree, options->progress, dose));
    SKG_TRY_CLEANUP(skg_dose_beam_layers(&beam, &dose->report.hvl1_mm_al, &dose->report.hvl2_mm_al));
    dose->report.kap_ugy_cm2 = skg_dose_beam_kap(&beam);
    SKG_TRY_CLEANUP(find_receptor(plan, &beam, options->progress, &dose->report));
    status = follow(plan, options, &beam, &tree, spots, dose);
cleanup:
    skg_free(&spots);
    skg_forest_free(&tree);
    skg_dose_beam_free(&beam);
    return status;
}

static skg_status check(const skg_dose_options *options) {
    if (options->histories < 0 || options->histories > HISTORIES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "dose: %" PRId64 " histories; 0 to %" PRId64, options->histories,
                        HISTORIES_MAX);
    if (options->point_count < 0 || options->point_count > POINTS_MAX ||
        (options->point_count > 0 && !options->points))
        return skg_fail(SKG_ERR_ARGUMENT, "dose: %" PRId64 " places; 0 to %d, with the places",
                        options->point_count, POINTS_MAX);
    for (int64_t k = 0; k < 3 * options->point_count; k++)
        if (!isfinite(options->points[k]))
            return skg_fail(SKG_ERR_ARGUMENT, "dose: place %" PRId64 " is not finite", k / 3);
    return SKG_OK;
}

skg_status skg_dose_make(int64_t points, int64_t parts, skg_dose **dose) {
    skg_dose *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *made, "dose", &made));
    skg_refs_init(&made->refs);
    made->points = points, made->parts = parts;
    made->report.size = sizeof made->report;
    SKG_TRY_CLEANUP(skg_alloc(points, sizeof *made->point, "dose", &made->point));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *made->part, "dose", &made->part));
    *dose = made;
    return SKG_OK;
cleanup:
    skg_dose_release(&made);
    return status;
}

static skg_status create(skg_plan *plan, const skg_dose_options *given, skg_dose **dose) {
    SKG_PLAIN;
    skg_dose_options options;
    skg_dose *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS_OF("skg_dose_create", plan);
    SKG_NEEDS_OF("skg_dose_create", dose);
    *dose = NULL;
    skg_dose_options_init(&options);
    if (given) SKG_TRY(skg_struct_read(given, "skg_dose_options", &options, sizeof options));
    SKG_TRY(check(&options));
    SKG_TRY(skg_context_enter(plan->context));
    SKG_TRY(skg_plan_renew(plan));
    if (plan->recipe->view.radius > 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "dose: the field of a curved detector is not computed; take a flat one");
    const double begun = skg_seconds();
    SKG_TRY_CLEANUP(
        skg_dose_make(options.point_count > 0 ? options.point_count : 1, plan->recipe->scene->count, &made));
    status = fill(plan, &options, made);
    made->report.seconds = skg_seconds() - begun;
cleanup:
    if (status != SKG_OK) skg_dose_release(&made);
    *dose = made;
    return status;
}

skg_status skg_dose_create(skg_plan *plan, const skg_dose_options *options, skg_dose **dose) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, create(plan, options, dose));
}

skg_status skg_dose_retain(skg_dose *dose) {
    SKG_NEEDS(dose);
    skg_ref(&dose->refs);
    return SKG_OK;
}

void skg_dose_release(skg_dose **dose) {
    if (!dose || !*dose) return;
    if (skg_unref(&(*dose)->refs)) {
        skg_free(&(*dose)->point);
        skg_free(&(*dose)->part);
        skg_free(dose);
    }
    *dose = NULL;
}

skg_status skg_dose_report_get(const skg_dose *dose, skg_dose_report *report) {
    SKG_NEEDS(dose);
    SKG_NEEDS(report);
    return skg_struct_write(&dose->report, sizeof dose->report, "skg_dose_report", report);
}

skg_status skg_dose_point_count(const skg_dose *dose, int64_t *count) {
    SKG_NEEDS(dose);
    SKG_NEEDS(count);
    *count = dose->points;
    return SKG_OK;
}

skg_status skg_dose_point_get(const skg_dose *dose, int64_t index, skg_dose_point *point) {
    SKG_NEEDS(dose);
    SKG_NEEDS(point);
    if (index < 0 || index >= dose->points)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_dose_point_get: place %" PRId64 " of %" PRId64, index,
                        dose->points);
    return skg_struct_write(&dose->point[index], sizeof dose->point[index], "skg_dose_point", point);
}

skg_status skg_dose_part_get(const skg_dose *dose, int64_t part, skg_dose_part *result) {
    SKG_NEEDS(dose);
    SKG_NEEDS(result);
    if (part < 0 || part >= dose->parts)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_dose_part_get: part %" PRId64 " of %" PRId64, part,
                        dose->parts);
    return skg_struct_write(&dose->part[part], sizeof dose->part[part], "skg_dose_part", result);
}
