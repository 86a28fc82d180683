/* The effect of volumes of cells. */
#include "core/text.h"
#include "plan/decisions.h"
#include "plan/rules.h"
#include "scene/volume.h"
#include "spectral/compression.h"

#include <inttypes.h>
#include <math.h>

/* Multiply-adds of a slice of a ray: two crossings and two cells or so. */
static const double COST_OF_SLICE = 30;

static int has_volume(const skg_recipe *recipe) {
    return recipe->volume_count > 0;
}

/* The label of the first volume. */
static const char *first_volume(const skg_scene *scene) {
    int64_t p = 0;
    while (!scene->parts[p].volume) p++;
    return scene->parts[p].label;
}

/* Fails unless scatter can be computed: the cells have elements, and there are at most SKG_SCATTER_VOLUMES_MAX volumes. */
static skg_status check_scatter(const skg_recipe *recipe, int64_t part) {
    const skg_scene *scene = recipe->scene;
    if (!recipe->options.scatter) return SKG_OK;
    if (scene->parts[part].volume->values == SKG_VOLUME_MU)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "scatter: the values of %s are attenuation coefficients, which do not say how it scatters; give "
            "densities or Hounsfield numbers, or leave out the scatter",
            scene->parts[part].label);
    if (recipe->volume_count <= SKG_SCATTER_VOLUMES_MAX) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "scatter: %s is one of %" PRId64
        " volumes of cells, and photons are followed through %d at most; join some of them, or leave "
        "out the scatter",
        scene->parts[part].label, recipe->volume_count, (int)SKG_SCATTER_VOLUMES_MAX);
}

skg_status skg_volumes_check(const skg_recipe *recipe) {
    const skg_scene *scene = recipe->scene;
    for (int64_t p = 0; p < scene->count; p++) {
        const int64_t parent = scene->parts[p].inside;
        if (scene->parts[p].volume) SKG_TRY(check_scatter(recipe, p));
        if (scene->parts[p].volume && recipe->options.unite)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s is a volume of cells, beside which components of meshes are not united; take another "
                "Repair",
                scene->parts[p].label);
        if (parent < 0 || !scene->parts[parent].volume || scene->parts[p].mesh->closed) continue;
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "%s lies inside the volume %s, but its mesh is not closed, so it cannot displace cells; close it",
            scene->parts[p].label, scene->parts[parent].label);
    }
    return SKG_OK;
}

static void find_volumes(const skg_effect_facts *f, skg_effect_state *state) {
    const skg_scene *scene = f->recipe->scene;
    const int64_t count = f->recipe->volume_count;
    int64_t bytes = 0;
    if (!count) {
        skg_effect_set(state, 0, "no part is a volume of cells");
        return;
    }
    for (int64_t p = 0; p < scene->count; p++)
        if (scene->parts[p].volume) bytes += skg_volume_bytes(scene->parts[p].volume);
    const char *label = first_volume(scene);
    int64_t first = 0;
    while (!scene->parts[first].volume) first++;
    const skg_volume *volume = scene->parts[first].volume;
    skg_effect_set(state, 1,
                   "%s%s: %" PRId64 " x %" PRId64 " x %" PRId64 " cells of %d bits; %.3g MB; %" PRId64
                   " %s in %d %s",
                   label, count > 1 ? " and others" : "", volume->size[0], volume->size[1], volume->size[2],
                   volume->wide ? 32 : 16, (double)bytes * 1e-6, f->recipe->model.curves,
                   skg_plural(f->recipe->model.curves, "composition", "compositions"),
                   (int)f->recipe->model.planes, skg_plural(f->recipe->model.planes, "plane", "planes"));
}

static double cost_volumes(const skg_effect_facts *f) {
    const skg_scene *scene = f->recipe->scene;
    double slices = 0;
    for (int64_t p = 0; p < scene->count; p++)
        if (scene->parts[p].volume)
            slices += cbrt((double)scene->parts[p].volume->size[0] * (double)scene->parts[p].volume->size[1] *
                           (double)scene->parts[p].volume->size[2]);
    return f->counts.passes * slices * (COST_OF_SLICE + 2 * (double)f->recipe->model.planes);
}

static skg_status refuse_gradient(const char *call, const skg_recipe *recipe, int by_view) {
    for (int64_t p = 0; has_volume(recipe) && p < recipe->scene->count; p++)
        if (recipe->scene->parts[p].volume && recipe->scene->parts[p].volume->linear)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "%s: the values of %s are linear between its cells, where there are no derivatives; take "
                "Interpolation cells",
                call, recipe->scene->parts[p].label);
    if (!has_volume(recipe) || !by_view) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "%s: an image with a volume of cells (%s) has no derivative by source or detector; leave them out, "
        "or give the part as a mesh",
        call, first_volume(recipe->scene));
}

const skg_effect_row skg_effect_volumes = {
    .name = "volumes",
    .key = "Volume",
    .self_test = SKG_SELF_TEST_VOLUME,
    .refuses_half = has_volume,
    .refuses_gradient = refuse_gradient,
    .adjoint = "volume_slopes.cl",
    .find = find_volumes,
    .cost = cost_volumes,
};
