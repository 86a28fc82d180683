/* The derivatives by the densities of parts: the sum over pixels and planes of the length through a part, times what a mm of its
 * material adds to the plane, times the derivative by the plane.
 *
 * Lengths are signed sums over hits, so that a gather of all faces gives them. With A(c, p) for the sum over the faces of part c of
 * depth times what a mm of part p's material is worth, part p has A(p, p) less the sum of A(c, p) over the parts c inside it. A part
 * contributes what its material differs from that around it, so that the gather of the gradient gives A(c, c) - A(c, p); and its
 * fourth moments give the smaller one of the two, so that air in tissue is not the difference of sums a thousand times as large. A part of the material around it contributes nothing; it is drawn for its fourth moments. Where
 * priorities, a world or a frame's own densities change what a hit is worth, an image of path lengths is rendered instead. So is an image
 * of what the cells of a volume add to each plane, which goes with its density. */
#include "gradient/density.h"

#include "gradient/direction_rates.h"
#include "gradient/faces.h"
#include "gradient/nodes.h"

#include <math.h>
#include <string.h>

int skg_gradient_needs_lengths(const skg_gradient_work *gradient, int64_t parts) {
    for (int64_t p = 0; p < parts; p++)
        if (gradient->needs_lengths[p]) return 1;
    return 0;
}

/* Which densities take path lengths in this pass. */
static void find_needs(const skg_job *job, const skg_frame_work *work, const skg_pass *pass, uint8_t *needs) {
    const int overridden = work->frame && work->frame->override_count != 0;
    const int all = overridden || job->recipe->model.world_plane >= 0 ||
                    skg_gradient_of(job)->wanted.attenuations != NULL;
    for (int64_t p = 0; p < pass->scene->count; p++)
        needs[p] = (uint8_t)(all || pass->scene->parts[p].volume != NULL);
    for (int64_t s = 0; s < pass->priority.count; s++) {
        const int64_t part = pass->priority.parts[s], around = pass->scene->parts[part].inside;
        needs[part] = 1;
        if (around >= 0) needs[around] = 1;
    }
}

/* Adds what parts contribute, from this one outwards. */
static void add_outwards(const skg_pass *pass, int64_t part, double *sums) {
    for (int64_t p = part; p >= 0; p = pass->scene->parts[p].inside)
        for (int64_t c = pass->first[p]; c < pass->first[p + 1]; c++)
            sums[pass->contributions[c].plane] += pass->contributions[c].weight;
}

/* Lists what a mm of matter adds to the planes: that around a part, or that of the part itself if this is less. sums: [2][planes] memory.
 * Returns the number of planes. */
static int32_t list_less(const skg_pass *pass, int64_t part, double *sums, skg_contribution *list,
                         uint8_t *is_own) {
    const int64_t planes = pass->planes;
    int32_t count = 0;
    double around = 0, own = 0;
    memset(sums, 0, 2 * (size_t)planes * sizeof *sums);
    add_outwards(pass, pass->scene->parts[part].inside, sums);
    add_outwards(pass, part, sums + planes);
    for (int64_t k = 0; k < planes; k++) around += fabs(sums[k]), own += fabs(sums[planes + k]);
    *is_own = own < around;
    for (int64_t k = 0; k < planes; k++) {
        const double weight = sums[*is_own ? planes + k : k];
        if (weight != 0) list[count++] = (skg_contribution){.plane = (int32_t)k, .weight = weight};
    }
    return count;
}

skg_status skg_gradient_find_surroundings(skg_job *job, const skg_pass *pass, skg_surroundings *around,
                                          skg_geometry_part **drawn) {
    const int64_t parts = pass->scene->count;
    int64_t nested = 0;
    int32_t *first = NULL;
    skg_contribution *list = NULL;
    skg_geometry_part *all = NULL;
    uint8_t *same = NULL, *of_own = NULL;
    double *sums = NULL;
    *drawn = pass->parts;
    for (int64_t p = 0; p < parts; p++) nested += pass->scene->parts[p].inside >= 0;
    SKG_TRY(skg_staging_take(&job->staging, parts + 1, sizeof *first, "gradient", &first));
    SKG_TRY(skg_staging_take(&job->staging, nested * pass->planes + 1, sizeof *list, "gradient", &list));
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *all, "gradient", &all));
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *same, "gradient", &same));
    SKG_TRY(skg_staging_take(&job->staging, parts, sizeof *of_own, "gradient", &of_own));
    SKG_TRY(skg_staging_take(&job->staging, 2 * pass->planes + 1, sizeof *sums, "gradient", &sums));
    for (int64_t s = 0; s < pass->priority.count; s++) same[pass->priority.parts[s]] = 1;
    for (int64_t p = 0; p < parts; p++) {
        all[p] = pass->parts[p];
        const int competes = same[p],
                  nests = pass->scene->parts[p].inside >= 0 && pass->scene->parts[p].mesh->closed;
        first[p + 1] = first[p];
        if (nests && !competes) first[p + 1] += list_less(pass, p, sums, list + first[p], &of_own[p]);
        same[p] = (uint8_t)(all[p].contributions == 0 && first[p + 1] > first[p]);
        if (!same[p]) continue;
        all[p].contributions = 1;
        all[p].contribution = list + first[p];
        *drawn = all;
    }
    *around = (skg_surroundings){.first = first, .list = list, .same = same, .of_own = of_own};
    return SKG_OK;
}

/* The sum over the hits of a part of length times the weight by what is listed of it. */
static double sum_listed(const skg_job *job, const skg_gathered *gathered, int64_t part, int64_t first) {
    const skg_geometry *geometry = &job->machine->geometry;
    const int64_t end = first + geometry->layouts[geometry->mesh_of_part[part]].triangles;
    uint64_t sum = 0; /* wraps around */
    for (int64_t t = first; t < end; t++) sum += (uint64_t)gathered->moments[4 * t + 3];
    return (double)(int64_t)sum * gathered->around_units[part];
}

void skg_gradient_add_densities(skg_job *job, const skg_frame_work *work, const skg_pass *pass,
                                const skg_surroundings *surroundings, const skg_gathered *gathered,
                                const skg_force_sums *sums) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_geometry *geometry = &job->machine->geometry;
    find_needs(job, work, pass, gradient->needs_lengths);
    for (int64_t p = 0, first = 0; p < pass->scene->count; p++) {
        const int64_t around = pass->scene->parts[p].inside;
        const double listed = around < 0 ? 0 : sum_listed(job, gathered, p, first);
        const double of_around = listed - (surroundings->of_own[p] ? sums[p].length : 0);
        const double of_own = listed + (surroundings->of_own[p] ? 0 : sums[p].length);
        first += geometry->layouts[geometry->mesh_of_part[p]].triangles;
        if (!gradient->needs_lengths[p]) gradient->densities[p] += of_own;
        if (around >= 0 && !gradient->needs_lengths[around]) gradient->densities[around] -= of_around;
    }
}

skg_status skg_gradient_keep_planes(skg_job *job, const skg_pass *pass) {
    skg_gradient_work *gradient = skg_gradient_of(job);
    const skg_weight_layout layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine);
    const int64_t count = job->recipe->model.planes * layout.plane;
    if (!gradient->planes) SKG_TRY(skg_alloc(count, sizeof *gradient->planes, "gradient", &gradient->planes));
    return skg_gradient_read(pass, skg_gradient_of(job)->memory->weights.memory, 0, count, gradient->planes);
}

/* Contribution of a mm of a part's own material to the planes: the sum of the contributions of the part and of all parts around it. Of a
 * volume the lengths are those of a plane themselves. */
static void find_own(const skg_recipe *recipe, int64_t part, int32_t plane, double *own) {
    const skg_model *model = &recipe->model;
    memset(own, 0, (size_t)model->planes * sizeof *own);
    if (recipe->scene->parts[part].volume) {
        own[plane] = 1;
        return;
    }
    if (model->world_plane >= 0) own[model->world_plane] = model->world_weight;
    for (int64_t p = part; p >= 0; p = recipe->scene->parts[p].inside)
        for (int64_t c = model->first_contribution[p]; c < model->first_contribution[p + 1]; c++)
            own[model->contributions[c].plane] += model->contributions[c].weight;
}

skg_status skg_gradient_add_density(skg_job *job, const skg_pass *pass, int64_t part, int32_t plane) {
    skg_gradient_work *gradient = skg_gradient_of(job);
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
        skg_gradient_read(pass, skg_gradient_of(job)->memory->lengths.memory, 0, columns * rows, lengths));
    find_own(recipe, part, plane, own);
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
