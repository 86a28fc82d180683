/* The generated thorax as a handle. */
#include "phantom/thorax.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void skg_thorax_options_init_sized(void *options, int32_t size) {
    const skg_thorax_options defaults = {.triangles = 42000};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_thorax_part_init_sized(void *part, int32_t size) {
    const skg_thorax_part defaults = {.inside = -1};
    skg_struct_init(part, size, &defaults, sizeof defaults);
}

/* What parts are of, by how their labels begin: a name of the material tables, and a density in g/cm3 where
 * it is not theirs. Bones are by Hounsfield number: a bone as a whole has marrow in it. */
static const struct {
    const char *label, *material;
    double density;
} tissue[] = {{"skin", "Adipose", 0},
              {"lung", "Lung tissue", 0.24}, /* end-expiration; about 720 g in 3 l */
              {"trachea", "Air", 0},
              {"bronchus", "Air", 0},
              {"heart", "Blood", 0},
              {"diaphragm", "Muscle", 0},
              {"liver", "Liver", 0},
              {"gallbladder", "Water", 0},
              {"bile ducts", "Iopamidol 150", 0},
              {"common bile duct", "Iopamidol 150", 0},
              {"stomach", "Soft tissue", 0},
              {"spleen", "Spleen", 0},
              {"kidney", "Kidney", 0},
              {"needle", "Needle steel", 0}};

static void set_tissue(skg_thorax *thorax, int64_t i) {
    for (size_t t = 0; t < sizeof tissue / sizeof *tissue; t++)
        if (strncmp(thorax->part[i].label, tissue[t].label, strlen(tissue[t].label)) == 0) {
            thorax->part[i].material = tissue[t].material;
            thorax->part[i].density = tissue[t].density;
            return;
        }
}

skg_status skg_thorax_fit(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays) {
    skg_mesh **others = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(thorax->parts, sizeof *others, label, &others));
    for (int64_t i = 0; i < thorax->parts; i++)
        if (thorax->part[i].inside == inside) others[count++] = thorax->part[i].mesh;
    SKG_TRY_CLEANUP(skg_shape_retreat(label, count, others, arrays));
    SKG_TRY_CLEANUP(skg_thorax_add(thorax, label, hounsfield, inside, arrays));
cleanup:
    skg_free(&others);
    return status;
}

skg_status skg_thorax_add(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                          skg_mesh_arrays *arrays) {
    if (thorax->parts == thorax->room) {
        int64_t room = 2 * thorax->room + 16;
        SKG_TRY(skg_realloc(room, sizeof *thorax->part, "thorax", &thorax->part));
        thorax->room = room;
    }
    skg_mesh *mesh;
    SKG_TRY(skg_mesh_adopt(NULL, label, arrays, &mesh));
    memset(thorax->part + thorax->parts, 0, sizeof *thorax->part);
    strncpy(thorax->part[thorax->parts].label, label, sizeof thorax->part->label - 1);
    thorax->part[thorax->parts].hounsfield = hounsfield;
    thorax->part[thorax->parts].inside = inside;
    set_tissue(thorax, thorax->parts);
    thorax->part[thorax->parts++].mesh = mesh;
    return SKG_OK;
}

static skg_status fill(double resolution, skg_thorax *thorax) {
    skg_thorax_plan *plan;
    SKG_TRY(skg_alloc(1, sizeof *plan, "thorax", &plan));
    skg_status status = skg_cage_plan(resolution, plan);
    if (status == SKG_OK) status = skg_thorax_skin(plan, thorax);
    if (status == SKG_OK) status = skg_thorax_bones(plan, 0, thorax); /* what gives way least comes first */
    if (status == SKG_OK) status = skg_thorax_airways(plan, 0, thorax);
    if (status == SKG_OK) status = skg_thorax_organs(plan, 0, thorax);
    if (status == SKG_OK) status = skg_thorax_lungs(plan, 0, thorax);
    if (status == SKG_OK) status = skg_thorax_needle(plan, thorax);
    skg_free(&plan);
    return status;
}

skg_status skg_thorax_create(const skg_thorax_options *options, skg_thorax **result) {
    skg_thorax_options ours;
    skg_thorax_options_init(&ours);
    if (!result) return skg_fail(SKG_ERR_ARGUMENT, "thorax: no place for the result");
    *result = NULL;
    if (options) SKG_TRY(skg_struct_read(options, "skg_thorax_options", &ours, sizeof ours));
    if (ours.triangles < 10000 || ours.triangles > 20000000)
        return skg_fail(SKG_ERR_ARGUMENT, "thorax: %" PRId64 " triangles; 10000 to 20000000", ours.triangles);
    skg_thorax *thorax;
    SKG_TRY(skg_alloc(1, sizeof *thorax, "thorax", &thorax));
    skg_status status = fill(sqrt((double)ours.triangles / 42000), thorax);
    if (status != SKG_OK) {
        skg_thorax_release(&thorax);
        return status;
    }
    *result = thorax;
    return SKG_OK;
}

void skg_thorax_release(skg_thorax **thorax) {
    if (!thorax || !*thorax) return;
    for (int64_t i = 0; i < (*thorax)->parts; i++) skg_mesh_release(&(*thorax)->part[i].mesh);
    skg_free(&(*thorax)->part);
    skg_free(thorax);
}

skg_status skg_thorax_part_count(const skg_thorax *thorax, int64_t *count) {
    if (!thorax || !count) return skg_fail(SKG_ERR_ARGUMENT, "thorax: NULL");
    *count = thorax->parts;
    return SKG_OK;
}

skg_status skg_thorax_part_get(const skg_thorax *thorax, int64_t index, skg_thorax_part *part) {
    if (!thorax) return skg_fail(SKG_ERR_ARGUMENT, "thorax: NULL");
    if (index < 0 || index >= thorax->parts)
        return skg_fail(SKG_ERR_ARGUMENT, "thorax: no part %" PRId64 "; 0 to %" PRId64, index,
                        thorax->parts - 1);
    skg_thorax_part ours;
    skg_thorax_part_init(&ours);
    ours.inside = thorax->part[index].inside;
    ours.mesh = thorax->part[index].mesh;
    ours.label = thorax->part[index].label;
    ours.material = thorax->part[index].material;
    ours.hounsfield = thorax->part[index].hounsfield;
    ours.density_g_cm3 = thorax->part[index].density;
    return skg_struct_write(&ours, sizeof ours, "skg_thorax_part", part);
}
