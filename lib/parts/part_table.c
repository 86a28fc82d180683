/* Measures the parts of a scene: density, volume, mass, mean path, share of the attenuation. */
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"
#include "frame/plans.h"

#include <skiagraph/frame.h>
#include <skiagraph/mesh.h>
#include <skiagraph/part_table.h>
#include <skiagraph/volume.h>

#include <inttypes.h>
#include <math.h>

struct skg_part_table {
    int64_t count;
    double kev;
    skg_part_row *rows;  /* [count] */
    double *surface_mm3; /* [count] of the mesh, with what lies inside */
    double *exponent;    /* [count] 1/cm times mm, summed over all rays; NAN: not known */
    int64_t *inside;     /* [count] the part that it lies inside; -1: none */
};

void skg_part_row_init_sized(void *row, int32_t size) {
    const skg_part_row defaults = {0};
    skg_struct_init(row, size, &defaults, sizeof defaults);
}

/* The mean density of the cells of a volume. */
static skg_status read_volume(const skg_part *part, double surface_mm3, double *density) {
    skg_volume_contents contents;
    skg_volume_contents_init(&contents);
    SKG_TRY(skg_volume_contents_get(part->volume, &contents));
    if (contents.mass > 0)
        *density = contents.mass * fabs(skg_pose_determinant(part->pose)) / (surface_mm3 * 1e-3);
    return SKG_OK;
}

/* Reads the row of a part from its scene and its mesh. The share of a volume of cells is not known, and so no other part's is. */
static skg_status read_part(const skg_scene *scene, int64_t i, skg_part_table *t) {
    skg_part part;
    skg_mesh_health health;
    double *density = &t->rows[i].density_g_cm3;
    skg_part_init(&part);
    skg_mesh_health_init(&health);
    SKG_TRY(skg_scene_part_get(scene, i, &part));
    SKG_TRY(skg_mesh_health_get(part.mesh, &health));
    SKG_TRY(skg_material_density_get(part.material, density));
    SKG_TRY(skg_material_attenuation_get(part.material, t->kev, &t->exponent[i]));
    t->inside[i] = part.inside;
    if (!(*density > 0)) *density = (double)NAN;
    t->surface_mm3[i] = health.closed ? health.volume * fabs(skg_pose_determinant(part.pose)) : (double)NAN;
    if (!part.volume) return SKG_OK;
    t->exponent[i] = (double)NAN;
    return read_volume(&part, t->surface_mm3[i], density);
}

/* The lengths of a part for all rays. */
static skg_status measure_paths(skg_plan *plan, int64_t i, float *lengths, skg_part_table *t) {
    const int64_t pixels = plan->recipe->view.columns * plan->recipe->view.rows;
    skg_output output;
    skg_frame frame;
    skg_job *job = NULL;
    double sum = 0;
    int64_t met = 0;
    skg_output_init(&output);
    skg_frame_init(&frame);
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = i;
    output.data = lengths;
    SKG_TRY(skg_plan_submit(plan, 1, &frame, 1, &output, &job));
    const skg_status status = skg_job_wait(&job);
    if (status != SKG_OK && status != SKG_RANGE) return status;
    for (int64_t k = 0; k < pixels; k++) {
        met += lengths[k] > 0;
        sum += lengths[k] > 0 ? (double)lengths[k] : 0;
    }
    t->rows[i].mean_path_mm = met > 0 ? sum / (double)met : 0;
    t->exponent[i] *= sum;
    return SKG_OK;
}

/* Volumes without the parts inside, masses and shares. */
static void finish(skg_part_table *t) {
    double all = 0;
    for (int64_t i = 0; i < t->count; i++) t->rows[i].volume_mm3 = t->surface_mm3[i];
    for (int64_t i = 0; i < t->count; i++) {
        if (t->inside[i] >= 0) t->rows[t->inside[i]].volume_mm3 -= t->surface_mm3[i];
        all += t->exponent[i];
    }
    for (int64_t i = 0; i < t->count; i++) {
        skg_part_row *row = &t->rows[i];
        row->mass_g = row->density_g_cm3 * row->volume_mm3 * 1e-3;
        row->share = all > 0 ? t->exponent[i] / all : (double)NAN;
    }
}

static skg_status fill(skg_plan *plan, skg_part_table *t) {
    const skg_recipe *recipe = plan->recipe;
    skg_quality quality;
    float *lengths = NULL;
    skg_status status = SKG_OK;
    skg_quality_init(&quality);
    SKG_TRY(skg_scene_part_count(recipe->scene, &t->count));
    SKG_TRY(skg_alloc(t->count, sizeof *t->rows, "table of parts", &t->rows));
    SKG_TRY(skg_alloc(t->count, sizeof *t->surface_mm3, "table of parts", &t->surface_mm3));
    SKG_TRY(skg_alloc(t->count, sizeof *t->exponent, "table of parts", &t->exponent));
    SKG_TRY(skg_alloc(t->count, sizeof *t->inside, "table of parts", &t->inside));
    SKG_TRY(skg_spectrum_quality_get(recipe->spectrum, &quality));
    t->kev = quality.mean_kev;
    for (int64_t i = 0; i < t->count; i++) SKG_TRY(read_part(recipe->scene, i, t));
    SKG_TRY(skg_alloc(recipe->view.columns * recipe->view.rows, sizeof *lengths, "path lengths", &lengths));
    for (int64_t i = 0; i < t->count && status == SKG_OK; i++) status = measure_paths(plan, i, lengths, t);
    skg_free(&lengths);
    if (status == SKG_OK) finish(t);
    return status;
}

static skg_status create(skg_plan *plan, skg_part_table **table) {
    SKG_PLAIN;
    skg_part_table *t = NULL;
    SKG_NEEDS_OF("skg_part_table_create", table);
    *table = NULL;
    SKG_NEEDS_OF("skg_part_table_create", plan);
    SKG_TRY(skg_alloc(1, sizeof *t, "table of parts", &t));
    const skg_status status = fill(plan, t);
    if (status == SKG_OK)
        *table = t;
    else
        skg_part_table_release(&t);
    return status;
}

skg_status skg_part_table_create(skg_plan *plan, skg_part_table **table) {
    const skg_call begun = skg_call_begin(plan ? plan->context : NULL);
    return skg_call_end(begun, create(plan, table));
}

void skg_part_table_release(skg_part_table **table) {
    if (!table || !*table) return;
    skg_free(&(*table)->rows);
    skg_free(&(*table)->surface_mm3);
    skg_free(&(*table)->exponent);
    skg_free(&(*table)->inside);
    skg_free(table);
}

skg_status skg_part_table_energy_get(const skg_part_table *table, double *kev) {
    SKG_NEEDS(table);
    SKG_NEEDS(kev);
    *kev = table->kev;
    return SKG_OK;
}

skg_status skg_part_row_count(const skg_part_table *table, int64_t *count) {
    SKG_NEEDS(table);
    SKG_NEEDS(count);
    *count = table->count;
    return SKG_OK;
}

skg_status skg_part_row_get(const skg_part_table *table, int64_t index, skg_part_row *row) {
    SKG_NEEDS(table);
    SKG_NEEDS(row);
    if (index < 0 || index >= table->count)
        return skg_fail(SKG_ERR_ARGUMENT, "part %" PRId64 "; the table has %" PRId64, index, table->count);
    return skg_struct_write(&table->rows[index], sizeof table->rows[index], "skg_part_row", row);
}
