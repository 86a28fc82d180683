/* Densities and fill fractions of parts in single frames. */
#include "frame/frames.h"

#include <inttypes.h>
#include <string.h>

typedef struct {
    const skg_recipe *recipe;
    double *density, *fill; /* [parts] */
    double *own; /* [parts + 1][planes] what a mm of each part's material, and of the world's, adds */
    char *known, *overridden; /* [parts] whether own is known; whether the frame overrides the part */
} overrides;

/* Greatest ratio to the planned density. */
static const double DENSITY_MAX = 1000;

static skg_status read_one(const skg_frame *given, int64_t k, overrides *o) {
    const skg_scene *scene = o->recipe->scene;
    const int64_t part = given->override_parts[k];
    const double density = given->density_ratios ? given->density_ratios[k] : 1;
    const double fill = given->fill_fractions ? given->fill_fractions[k] : 1;
    if (part < 0 || part >= scene->count)
        return skg_fail(SKG_ERR_ARGUMENT, "a frame overrides part %" PRId64 " of %" PRId64, part,
                        scene->count);
    const char *label = scene->parts[part].label;
    if (!(density >= 0 && density <= DENSITY_MAX))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a density ratio of %g; 0 to %g", label, density, DENSITY_MAX);
    if (!(fill >= 0 && fill <= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a fill fraction of %g; 0 to 1", label, fill);
    for (int64_t p = 0; p < scene->count && fill < 1; p++)
        if (scene->parts[p].inside == part)
            return skg_fail(SKG_ERR_UNSUPPORTED, "%s: a fill fraction of %g, but %s lies inside it", label,
                            fill, scene->parts[p].label);
    o->density[part] = density;
    o->fill[part] = fill;
    if (o->overridden) o->overridden[part] = 1;
    return SKG_OK;
}

static skg_status read_all(const skg_frame *given, overrides *o) {
    for (int64_t p = 0; p < o->recipe->scene->count; p++) o->density[p] = o->fill[p] = 1;
    for (int64_t k = 0; k < given->override_count; k++) SKG_TRY(read_one(given, k, o));
    return SKG_OK;
}

static int64_t parent_of(const overrides *o, int64_t part) {
    const int64_t inside = o->recipe->scene->parts[part].inside;
    return inside >= 0 ? inside : o->recipe->scene->count;
}

/* A part contributes the difference of its own material and its parent's. So its own is the sum of the contributions of
 * the part and of all parts around it. */
static void find_own(overrides *o, int64_t part) {
    const skg_model *model = &o->recipe->model;
    if (part == o->recipe->scene->count || o->known[part]) return;
    const int64_t parent = parent_of(o, part);
    find_own(o, parent);
    double *own = o->own + part * model->planes;
    memcpy(own, o->own + parent * model->planes, (size_t)model->planes * sizeof *own);
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++)
        own[model->contributions[w].plane] += model->contributions[w].weight;
    o->known[part] = 1;
}

/* Lists what a part contributes; returns how many contributions. */
static int64_t list_part(const overrides *o, int64_t part, skg_contribution *contributions) {
    const skg_model *model = &o->recipe->model;
    const int64_t parts = o->recipe->scene->count, parent = parent_of(o, part);
    int64_t count = model->first_contribution[part + 1] - model->first_contribution[part];
    if (!o->overridden[part] && (parent == parts || !o->overridden[parent])) {
        memcpy(contributions, model->contributions + model->first_contribution[part],
               (size_t)count * sizeof *contributions);
        return count;
    }
    const double around = parent == parts ? 1 : o->density[parent];
    count = 0;
    for (int32_t k = 0; k < model->planes; k++) {
        const double weight = o->fill[part] * (o->density[part] * o->own[part * model->planes + k] -
                                               around * o->own[parent * model->planes + k]);
        if (weight != 0) contributions[count++] = (skg_contribution){.plane = k, .weight = weight};
    }
    return count;
}

static skg_status list_all(overrides *o, const skg_frame *given, skg_contribution *contributions,
                           int64_t *first) {
    const skg_model *model = &o->recipe->model;
    const int64_t parts = o->recipe->scene->count;
    SKG_TRY(read_all(given, o));
    if (model->world_plane >= 0) o->own[parts * model->planes + model->world_plane] = model->world_weight;
    for (int64_t p = 0; p < parts; p++) find_own(o, p);
    for (int64_t p = 0; p < parts; p++) first[p + 1] = first[p] + list_part(o, p, contributions + first[p]);
    return SKG_OK;
}

skg_status skg_overrides_apply(const skg_recipe *recipe, const skg_frame *given,
                               skg_contribution **contributions, int64_t **first) {
    const int64_t parts = recipe->scene->count, planes = recipe->model.planes;
    overrides o = {.recipe = recipe};
    skg_status status = SKG_OK;
    if (skg_scene_volumes(recipe->scene) > 0)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "densities and fill fractions of single frames are not computed beside a volume; give each frame "
            "a scene of its own, or leave out the volume");
    if (given->override_count < 0 || !given->override_parts)
        return skg_fail(SKG_ERR_ARGUMENT, "a frame has %" PRId64 " overrides, but no ids of parts",
                        given->override_count);
    SKG_TRY_CLEANUP(skg_alloc(2 * parts, sizeof *o.density, "overrides of a frame", &o.density));
    SKG_TRY_CLEANUP(skg_alloc(2 * parts, 1, "overrides of a frame", &o.known));
    SKG_TRY_CLEANUP(skg_alloc((parts + 1) * planes, sizeof *o.own, "overrides of a frame", &o.own));
    SKG_TRY_CLEANUP(skg_alloc(parts * planes, sizeof **contributions, "parts of a frame", contributions));
    SKG_TRY_CLEANUP(skg_alloc(parts + 1, sizeof **first, "parts of a frame", first));
    o.fill = o.density + parts;
    o.overridden = o.known + parts;
    status = list_all(&o, given, *contributions, *first);
cleanup:
    skg_free(&o.density);
    skg_free(&o.known);
    skg_free(&o.own);
    return status;
}

skg_status skg_overrides_matter(const skg_recipe *recipe, const skg_frame *given, double *density,
                                double *fill) {
    overrides o = {.recipe = recipe, .density = density, .fill = fill};
    return read_all(given, &o);
}
