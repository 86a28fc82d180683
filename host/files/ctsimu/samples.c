/* samples and materials. */
#include "core/maths.h"
#include "ctsimu/parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ELEMENTS = 93 };

/* Adds the elements of a formula by mass. White space in it has no meaning. */
static skg_status add_formula(const skg_item *item, double share, double *fractions) {
    const char *text = NULL;
    char formula[256];
    size_t used = 0;
    skg_material *part = NULL;
    int64_t count = 0;
    SKG_TRY(skg_item_text(item, &text));
    if (!text) return skg_item_fail(item, SKG_ERR_FORMAT, "is missing");
    for (; *text && used + 1 < sizeof formula; text++)
        if (!strchr(" \t\r\n", *text)) formula[used++] = *text;
    formula[used] = '\0';
    skg_status status = skg_material_create_formula(formula, 1, &part);
    if (status != SKG_OK) return skg_item_fail(item, status, "%s", skg_last_error());
    status = skg_material_element_count(part, &count);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) {
        int32_t z = 0;
        double fraction = 0;
        status = skg_material_element_get(part, i, &z, &fraction);
        if (status == SKG_OK) fractions[z] += share * fraction;
    }
    skg_material_release(&part);
    return status;
}

/* composition: components by mass, or, in format 1.0, one formula. */
static skg_status read_composition(const skg_item *item, double *fractions) {
    const int64_t count = (int64_t)json_array_size(item->value);
    if (!json_is_array(item->value)) {
        const skg_item formula = skg_item_at(item, "formula");
        return add_formula(formula.value ? &formula : item, 1, fractions);
    }
    for (int64_t i = 0; i < count; i++) {
        const skg_item part = skg_item_element(item, i), formula = skg_item_at(&part, "formula");
        const skg_item share_item = skg_item_at(&part, "mass_fraction");
        double share = 1;
        SKG_TRY(skg_item_number(&share_item, SKG_UNIT_NONE, &share));
        if (!(share >= 0))
            return skg_item_fail(&share_item, SKG_ERR_MATERIAL, "is %g; give 0 or more", share);
        if (share > 0) SKG_TRY(add_formula(&formula, share, fractions));
    }
    return SKG_OK;
}

/* Fractions need not sum to 1. */
static skg_status make_mixture(const char *name, const double *fractions, double density,
                               skg_material **material) {
    int32_t z[ELEMENTS];
    double shares[ELEMENTS], sum = 0;
    int64_t count = 0;
    for (int32_t e = 1; e < ELEMENTS; e++) sum += fractions[e];
    for (int32_t e = 1; e < ELEMENTS; e++)
        if (fractions[e] > 0) z[count] = e, shares[count++] = fractions[e] / sum;
    return skg_material_create_mixture(name, count, z, shares, density, material);
}

static skg_status make_material(const skg_item *item, skg_material **material) {
    const skg_item density_item = skg_item_at(item, "density"),
                   composition = skg_item_at(item, "composition");
    const skg_item name_item = skg_item_at(item, "id");
    const char *name = NULL;
    double fractions[ELEMENTS] = {0}, density = 0;
    SKG_TRY(skg_item_text(&name_item, &name));
    SKG_TRY(skg_item_number(&density_item, SKG_UNIT_G_CM3, &density));
    if (density == 0) return SKG_OK; /* a vacuum */
    SKG_TRY(read_composition(&composition, fractions));
    const skg_status status = make_mixture(name, fractions, density, material);
    return status == SKG_OK ? SKG_OK : skg_item_fail(item, status, "%s", skg_last_error());
}

skg_status skg_ctsimu_material(const skg_item *id, skg_material **material) {
    const skg_item root = skg_item_root(id->scenario), list = skg_item_at(&root, "materials");
    const char *wanted = NULL;
    *material = NULL;
    SKG_TRY(skg_item_text(id, &wanted));
    for (int64_t i = 0; wanted && i < (int64_t)json_array_size(list.value); i++) {
        const skg_item one = skg_item_element(&list, i), its = skg_item_at(&one, "id");
        const char *name = json_string_value(its.value);
        if (name && strcmp(name, wanted) == 0) return make_material(&one, material);
    }
    if (!wanted || strcmp(wanted, "Vacuum") == 0) return SKG_OK;
    return skg_item_fail(id, SKG_ERR_MATERIAL, "\"%s\" is not among the materials of the scenario", wanted);
}

skg_status skg_ctsimu_put_material(const skg_material *material, json_t *object) {
    static const double nothing = 0;
    json_t *list = json_array(), *fractions = json_array();
    int64_t count = 0;
    double density = 0;
    skg_status status = SKG_OK;
    if (!list || !fractions) status = skg_fail(SKG_ERR_MEMORY, "scenario: no memory for a material");
    if (status == SKG_OK && material) status = skg_material_element_count(material, &count);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) {
        int32_t z = 0;
        double fraction = 0;
        status = skg_material_element_get(material, i, &z, &fraction);
        json_array_append_new(fractions, json_integer(z));
        json_array_append_new(fractions, json_real(fraction));
    }
    json_array_append_new(list, json_string(material ? "Mixture" : "mu"));
    if (material)
        json_array_append(list, fractions);
    else
        json_array_append_new(list, json_real(nothing));
    json_decref(fractions);
    if (status == SKG_OK && material) status = skg_material_density_get(material, &density);
    if (status == SKG_OK && material) status = skg_ctsimu_put(object, "Density", json_real(density));
    if (status == SKG_OK) return skg_ctsimu_put(object, "Material", list);
    json_decref(list);
    return status;
}

skg_status skg_ctsimu_put_world(skg_ctsimu *scenario, json_t *scene) {
    const skg_item root = skg_item_root(scenario), id = skg_item_at(&root, "environment.material_id");
    skg_material *material = NULL;
    SKG_TRY(skg_ctsimu_material(&id, &material));
    if (!material) return SKG_OK;
    json_t *world = json_object();
    skg_status status = skg_ctsimu_put_material(material, world);
    skg_material_release(&material);
    if (status == SKG_OK) return skg_ctsimu_put(scene, "World", world);
    json_decref(world);
    return status;
}

/* The pose of a sample in the axes of the stage, column by column. */
static void find_pose(const skg_ctsimu_geometry *g, const skg_placement *placement, int64_t frame,
                      const double *scale, double *columns) {
    skg_system own, placed;
    const skg_system *stage = &g->stages[frame];
    skg_placement_at(placement, frame, 0, placement->is_on_stage ? stage : NULL, 0, &own);
    placed = own;
    if (!placement->is_on_stage) skg_system_point(stage, own.centre, placed.centre);
    for (int k = 0; k < 3; k++) {
        double axis[3];
        for (int j = 0; j < 3; j++) axis[j] = own.axes[3 * j + k];
        if (!placement->is_on_stage) skg_system_direction(stage, axis, axis);
        for (int j = 0; j < 3; j++) columns[4 * k + j] = scale[k] * axis[j];
        columns[4 * k + 3] = 0;
    }
    memcpy(columns + 12, placed.centre, sizeof placed.centre);
    columns[15] = 1;
}

/* Moves that rounding alone makes do not count: 1e-9 mm, or of the axes. */
static int is_alike(const double *a, const double *b) {
    for (int i = 0; i < 16; i++)
        if (fabs(a[i] - b[i]) > 1e-9) return 0;
    return 1;
}

/* Transform, and Poses if the sample moves on the stage. */
static skg_status put_poses(const skg_item *item, const skg_ctsimu_geometry *g,
                            const skg_placement *placement, json_t *sample) {
    static const char *const names[] = {"scaling_factor.r", "scaling_factor.s", "scaling_factor.t"};
    double scale[3] = {1, 1, 1}, first[16], pose[16];
    int moves = 0;
    for (int k = 0; k < 3; k++) {
        const skg_item factor = skg_item_at(item, names[k]);
        SKG_TRY(skg_item_number(&factor, SKG_UNIT_NONE, &scale[k]));
    }
    find_pose(g, placement, 0, scale, first);
    json_t *poses = json_array(), *transform = json_array(), *matrix = json_array();
    json_array_append_new(matrix, json_string("Matrix"));
    json_array_append_new(matrix, skg_ctsimu_numbers(16, first));
    json_array_append_new(transform, matrix);
    for (int64_t k = 0; k < item->scenario->frames; k++) {
        find_pose(g, placement, k, scale, pose);
        moves |= !is_alike(pose, first);
        json_array_append_new(poses, skg_ctsimu_numbers(16, pose));
    }
    if (moves) json_object_set(sample, "Poses", poses);
    json_decref(poses);
    return skg_ctsimu_put(sample, "Transform", transform);
}

static skg_status put_sample(const skg_item *item, const skg_ctsimu_geometry *g, json_t *sample) {
    const skg_item file = skg_item_at(item, "file"), unit = skg_item_at(item, "unit");
    const skg_item position = skg_item_at(item, "position"), id = skg_item_at(item, "material_id");
    const skg_item label = skg_item_at(item, "name");
    const char *name = NULL, *path = NULL, *length = NULL, *title = NULL;
    skg_placement placement = {0};
    skg_material *material = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_item_text(&file, &name));
    if (!name) return skg_item_fail(&file, SKG_ERR_FORMAT, "is missing; a sample needs a mesh");
    SKG_TRY(skg_item_file(&file, &path));
    SKG_TRY(skg_item_text(&unit, &length));
    SKG_TRY(skg_item_text(&label, &title));
    if (title) SKG_TRY(skg_ctsimu_put(sample, "Label", json_string(title)));
    SKG_TRY(skg_ctsimu_put(sample, "Path", json_string(name)));
    SKG_TRY(skg_ctsimu_put(sample, "Unit", json_string(length ? length : "mm")));
    SKG_TRY(skg_ctsimu_put(sample, "MoveToCentre", json_true()));
    SKG_TRY(skg_ctsimu_put(sample, "Parent", json_null()));
    SKG_TRY_CLEANUP(skg_ctsimu_material(&id, &material));
    SKG_TRY_CLEANUP(skg_ctsimu_put_material(material, sample));
    SKG_TRY_CLEANUP(skg_placement_read(&position, &placement));
    SKG_TRY_CLEANUP(put_poses(item, g, &placement, sample));
cleanup:
    skg_placement_free(&placement);
    skg_material_release(&material);
    return status;
}

/* A scenario of the free beam gets a cube of what is around it, because a scene needs a part. */
static skg_status put_nothing(skg_ctsimu *scenario, json_t *samples) {
    const skg_item root = skg_item_root(scenario), id = skg_item_at(&root, "environment.material_id");
    skg_material *material = NULL;
    json_t *cube = json_pack("{s:s, s:[i, s], s:n}", "Label", "nothing", "Cube", 1, "mm", "Parent");
    SKG_TRY(skg_ctsimu_put(samples, NULL, cube));
    SKG_TRY(skg_ctsimu_material(&id, &material));
    const skg_status status = skg_ctsimu_put_material(material, cube);
    skg_material_release(&material);
    return status;
}

skg_status skg_ctsimu_put_samples(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, json_t *scene) {
    const skg_item root = skg_item_root(scenario), list = skg_item_at(&root, "samples");
    json_t *samples = json_object_get(scene, "Samples");
    for (int64_t i = 0; i < (int64_t)json_array_size(list.value); i++) {
        const skg_item item = skg_item_element(&list, i);
        json_t *sample = json_object();
        if (!item.value) {
            json_decref(sample);
            continue;
        }
        SKG_TRY(skg_ctsimu_put(samples, NULL, sample));
        SKG_TRY(put_sample(&item, g, sample));
    }
    return json_array_size(samples) > 0 ? SKG_OK : put_nothing(scenario, samples);
}
