/* The generated thorax as a handle. */
#include "core/text.h"
#include "core/threads.h"
#include "phantom/makers.h"

#include <inttypes.h>
#include <math.h>

/* STANDARD: triangles by default, about those of the paper's scene. FULL: triangles at resolution 1, as the counts of
 * the makers give them; the simple thorax has STANDARD there. */
enum { STANDARD_TRIANGLES = 42000, FULL_TRIANGLES = 84000 };

void skg_thorax_options_init_sized(void *options, int32_t size) {
    const skg_thorax_options defaults = {.triangles = STANDARD_TRIANGLES};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_thorax_part_init_sized(void *part, int32_t size) {
    const skg_thorax_part defaults = {.inside = -1};
    skg_struct_init(part, size, &defaults, sizeof defaults);
}

static skg_status fill(int simple, double triangles, skg_thorax *thorax) {
    skg_thorax_plan *plan;
    const double resolution = sqrt(triangles / (simple ? STANDARD_TRIANGLES : FULL_TRIANGLES));
    const int64_t outer = simple ? 0 : 1; /* skin or muscle */
    SKG_TRY(skg_alloc(1, sizeof *plan, "thorax", &plan));
    skg_status status = skg_thorax_plan_fill(simple, resolution, plan);
    if (status == SKG_OK) status = skg_thorax_skin(plan, thorax);
    if (status == SKG_OK && !simple) status = skg_thorax_muscle(plan, 0, thorax);
    /* A part draws back from those before it, so bones come first and lungs last. */
    if (status == SKG_OK) status = skg_thorax_bones(plan, outer, thorax);
    if (status == SKG_OK) status = skg_thorax_airways(plan, outer, thorax);
    if (status == SKG_OK && !simple) status = skg_thorax_vessels(plan, outer, thorax);
    if (status == SKG_OK) status = skg_thorax_diaphragm(plan, outer, thorax);
    if (status == SKG_OK) status = skg_thorax_organs(plan, outer, thorax);
    if (status == SKG_OK && !simple) status = skg_thorax_belly(plan, outer, thorax);
    if (status == SKG_OK) status = skg_thorax_lungs(plan, outer, thorax);
    if (status == SKG_OK) status = skg_thorax_needle(thorax);
    skg_free(&plan);
    return status;
}

skg_status skg_thorax_create(const skg_thorax_options *options, skg_thorax **result) {
    SKG_PLAIN;
    skg_thorax_options ours;
    skg_thorax_options_init(&ours);
    SKG_NEEDS(result);
    *result = NULL;
    if (options) SKG_TRY(skg_struct_read(options, "skg_thorax_options", &ours, sizeof ours));
    if (ours.simple < 0 || ours.simple > 1)
        return skg_fail(SKG_ERR_ARGUMENT, "thorax: simple is %" PRId32 "; 0 or 1", ours.simple);
    if (ours.triangles < 10000 || ours.triangles > 20000000)
        return skg_fail(SKG_ERR_ARGUMENT, "thorax: %" PRId64 " triangles; 10000 to 20000000", ours.triangles);
    skg_thorax *thorax;
    SKG_TRY(skg_openmp_enter());
    SKG_TRY(skg_alloc(1, sizeof *thorax, "thorax", &thorax));
    skg_status status = fill(ours.simple, (double)ours.triangles, thorax);
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

skg_status skg_thorax_part_count(const skg_thorax *thorax, int64_t *parts) {
    SKG_NEEDS(thorax);
    SKG_NEEDS(parts);
    *parts = thorax->parts;
    return SKG_OK;
}

skg_status skg_thorax_part_get(const skg_thorax *thorax, int64_t number, skg_thorax_part *part) {
    SKG_NEEDS(thorax);
    if (number < 0 || number >= thorax->parts)
        return skg_fail(SKG_ERR_ARGUMENT, "thorax: no part %" PRId64 "; 0 to %" PRId64, number,
                        thorax->parts - 1);
    skg_thorax_part ours;
    skg_thorax_part_init(&ours);
    ours.through = thorax->part[number].through;
    ours.inside = thorax->part[number].inside;
    ours.mesh = thorax->part[number].mesh;
    ours.label = thorax->part[number].label;
    ours.material = thorax->part[number].material;
    ours.hounsfield = thorax->part[number].hounsfield;
    ours.density_g_cm3 = thorax->part[number].density;
    return skg_struct_write(&ours, sizeof ours, "skg_thorax_part", part);
}
