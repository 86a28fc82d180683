/* The derivatives by the densities of parts: the sum over pixels and planes of the length through a part, times what a mm of its
 * material adds to the plane, times the derivative by the plane.
 *
 * Lengths are signed sums over hits, so that a gather of all faces gives them. With A(c, p) for the sum over the faces of part c of
 * depth times what a mm of part p's material is worth, part p has A(p, p) less the sum of A(c, p) over the parts c inside it. A part
 * contributes what its material differs from that around it, so that the gather of the gradient gives A(c, c) - A(c, p); and its
 * fourth moments give A(c, p). A part of the material around it contributes nothing; it is drawn for its fourth moments. Where
 * priorities, a world or a frame's own densities change what a hit is worth, an image of path lengths is rendered instead. */
#include "frame/gradient_density.h"

#include "frame/derivative_rates.h"
#include "frame/gradient_faces.h"
#include "frame/gradient_nodes.h"

#include <string.h>

int skg_gradient_needs_lengths(const struct skg_gradient_work *gradient, int64_t parts) {
    for (int64_t p = 0; p < parts; p++)
        if (gradient->needs_lengths[p]) return 1;
    return 0;
}

/* Which densities take path lengths in this pass. */
static void find_needs(const skg_job *job, const skg_frame_work *work, const skg_pass *pass, uint8_t *needs) {
    const int overridden = work->frame && work->frame->override_count != 0;
    const int all =
        overridden || job->recipe->model.world_plane >= 0 || job->gradient->wanted.attenuations != NULL;
    for (int64_t p = 0; p < pass->scene->count; p++) needs[p] = (uint8_t)all;
    for (int64_t s = 0; s < pass->priority.count; s++) {
        const int64_t part = pass->priority.parts[s], around = pass->scene->parts[part].inside;
        needs[part] = 1;
        if (around >= 0) needs[around] = 1;
    }
}

/* Adds up what all parts around a part contribute. Returns the number of planes. */
static int32_t list_around(const skg_pass *pass, int64_t part, double *own, skg_contribution *list) {
    int32_t count = 0;
    memset(own, 0, (size_t)pass->planes * sizeof *own);
    for (int64_t p = pass->scene->parts[part].inside; p >= 0; p = pass->scene->parts[p].inside)
        for (int64_t c = pass->first[p]; c < pass->first[p + 1]; c++)
            own[pass->contributions[c].plane] += pass->contributions[c].weight;
    for (int64_t k = 0; k < pass->planes; k++)
        if (own[k] != 0) list[count++] = (skg_contribution){.plane = (int32_t)k, .weight = own[k]};
    return count;
}

skg_status skg_gradient_find_surroundings(skg_job *job, const skg_pass *pass, skg_surroundings *around,
                                          skg_geometry_part **drawn) {
    const int64_t parts = pass->scene->count;
    int64_t nested = 0;
    int32_t *first = NULL;
    skg_contribution *list = NULL;
    skg_geometry_part *all = NULL;
    uint8_t *same = NULL;
    double *own = NULL;
    *drawn = pass->parts;
    for (int64_t p = 0; p < parts; p++) nested += pass->scene->parts[p].inside >= 0;
    SKG_TRY(skg_staging_take(&job->staging, parts + 1, sizeof *first, "gradient", &first));
    SKG_TRY(skg_staging_take(&job->staging, nested * pass->planes + 1, sizeof *list, "gradient", &list));
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *all, "gradient", &all));
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *same, "gradient", &same));
    SKG_TRY(skg_staging_take(&job->staging, pass->planes + 1, sizeof *own, "gradient", &own));
    for (int64_t s = 0; s < pass->priority.count; s++) same[pass->priority.parts[s]] = 1;
    for (int64_t p = 0; p < parts; p++) {
        all[p] = pass->parts[p];
        const int competes = same[p],
                  nests = pass->scene->parts[p].inside >= 0 && pass->scene->parts[p].mesh->closed;
        first[p + 1] = first[p] + (nests && !competes ? list_around(pass, p, own, list + first[p]) : 0);
        same[p] = (uint8_t)(all[p].contributions == 0 && first[p + 1] > first[p]);
        if (!same[p]) continue;
        all[p].contributions = 1;
        all[p].contribution = list + first[p];
        *drawn = all;
    }
    *around = (skg_surroundings){.first = first, .list = list, .same = same};
    return SKG_OK;
}

/* The sum over the hits of a part of length times the weight by what stands around it. */
static double sum_around(const skg_job *job, const skg_gathered *gathered, int64_t part, int64_t first) {
    const skg_geometry *geometry = &job->machine->geometry;
    const int64_t end = first + geometry->layouts[geometry->mesh_of_part[part]].triangles;
    uint64_t sum = 0; /* wraps around */
    for (int64_t t = first; t < end; t++) sum += (uint64_t)gathered->moments[4 * t + 3];
    return (double)(int64_t)sum * gathered->around_units[part];
}

void skg_gradient_add_densities(skg_job *job, const skg_frame_work *work, const skg_pass *pass,
                                const skg_gathered *gathered, const skg_force_sums *sums) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_geometry *geometry = &job->machine->geometry;
    find_needs(job, work, pass, gradient->needs_lengths);
    for (int64_t p = 0, first = 0; p < pass->scene->count; p++) {
        const int64_t around = pass->scene->parts[p].inside;
        const double of_around = around < 0 ? 0 : sum_around(job, gathered, p, first);
        first += geometry->layouts[geometry->mesh_of_part[p]].triangles;
        if (!gradient->needs_lengths[p]) gradient->densities[p] += sums[p].length + of_around;
        if (around >= 0 && !gradient->needs_lengths[around]) gradient->densities[around] -= of_around;
    }
}

skg_status skg_gradient_keep_planes(skg_job *job, const skg_pass *pass) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int64_t count = job->recipe->model.planes * layout.plane;
    if (!gradient->planes) SKG_TRY(skg_alloc(count, sizeof *gradient->planes, "gradient", &gradient->planes));
    return skg_gradient_read(pass, job->machine->gradient.weights.memory, 0, count, gradient->planes);
}

skg_status skg_gradient_place_lengths(skg_job *job, const skg_pass *pass, skg_image_place *place) {
    skg_machine *machine = job->machine;
    const int is_double = pass->kernels.precision == SKG_PRECISION_DOUBLE;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows;
    SKG_TRY(skg_buffer_reserve(machine->context, &machine->gradient.lengths,
                               columns * rows * (int64_t)(is_double ? sizeof(double) : sizeof(float)),
                               CL_MEM_READ_WRITE, "gradient"));
    *place = (skg_image_place){.memory = machine->gradient.lengths.memory,
                               .output_double = is_double,
                               .row_stride = columns,
                               .channel_stride = rows * columns};
    return SKG_OK;
}

/* What a mm of a part's own material adds to the planes: the sum of what the part and all parts around it contribute. */
static void find_own(const skg_recipe *recipe, int64_t part, double *own) {
    const skg_model *model = &recipe->model;
    memset(own, 0, (size_t)model->planes * sizeof *own);
    if (model->world_plane >= 0) own[model->world_plane] = model->world_weight;
    for (int64_t p = part; p >= 0; p = recipe->scene->parts[p].inside)
        for (int64_t c = model->first_contribution[p]; c < model->first_contribution[p + 1]; c++)
            own[model->contributions[c].plane] += model->contributions[c].weight;
}

skg_status skg_gradient_add_density(skg_job *job, const skg_pass *pass, int64_t part) {
    struct skg_gradient_work *gradient = job->gradient;
    const skg_recipe *recipe = job->recipe;
    const int64_t columns = pass->camera.columns, rows = pass->camera.rows, planes = recipe->model.planes;
    /* The raster of images has rows of the same length. */
    const skg_weight_layout layout =
        skg_attenuate_weight_layout(pass->main.raster, (int32_t)recipe->samples.fine);
    double *lengths = NULL, *own = NULL, sum = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(columns * rows, sizeof *lengths, "gradient", &lengths));
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *own, "gradient", &own));
    SKG_TRY_CLEANUP(
        skg_gradient_read(pass, job->machine->gradient.lengths.memory, 0, columns * rows, lengths));
    find_own(recipe, part, own);
    if (gradient->direction_count) {
        status = skg_derivative_add_lengths(job, pass, part, own, lengths);
        goto cleanup;
    }
    if (gradient->wanted.attenuations) SKG_TRY_CLEANUP(skg_gradient_add_nodes(job, pass, part, lengths));
    for (int64_t k = 0; k < planes && gradient->wanted.densities; k++) {
        const double *slopes = gradient->planes + k * layout.plane;
        for (int64_t r = 0; r < rows && own[k] != 0; r++)
            for (int64_t c = 0; c < columns; c++)
                sum += own[k] * slopes[r * layout.stride + c] * lengths[r * columns + c];
    }
    gradient->densities[part] += sum;
cleanup:
    skg_free(&lengths);
    skg_free(&own);
    return status;
}
