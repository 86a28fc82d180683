/* How large the sums of a gradient can become, and by what they are multiplied to be integers of 64 bits. */
#include "gradient/scales.h"

#include "gradient/volumes.h"

#include "core/maths.h"

#include <math.h>

double skg_gradient_depth_unit(const skg_gather_run *run, int64_t part) {
    const skg_geometry_part *p = &run->pass->parts[part];
    if (!(p->depth > 0)) return 0;
    const double reference = p->reference > 0 ? p->reference : 1;
    return run->pass->camera.parallel ? run->pass->scale.scale : run->pass->scale.scale * reference;
}

/* No |d loss / d q| of a part's hits is larger, but for priorities. */
static double bound_of(const skg_gather_run *run, int64_t part, const double *most) {
    const skg_geometry_part *p = &run->pass->parts[part];
    double bound = 0;
    for (int32_t c = 0; c < p->contributions; c++)
        bound += fabs(p->contribution[c].weight) * most[p->contribution[c].plane];
    return bound * skg_gradient_depth_unit(run, part);
}

static double reference_of(const skg_gather_run *run, int64_t part) {
    const double reference = run->pass->parts[part].reference;
    return run->pass->camera.parallel || !(reference > 0) ? 1 : reference;
}

/* The pixels that a part can cover. */
static double pixels_of(const skg_gather_run *run, int64_t part) {
    const skg_geometry_part *p = &run->pass->parts[part];
    const double columns = fmin(p->columns[1] - p->columns[0] + 4, (double)run->raster->layout.columns);
    const double rows = fmin(p->rows[1] - p->rows[0] + 4, (double)run->raster->layout.rows);
    return columns > 1 && rows > 1 ? columns * rows : 1;
}

/* No weight of a hit, times t^2 over the square of the reference, is larger. */
static double hit_bound(const skg_gather_run *run, int64_t part, const double *most, double competing) {
    const double reference = reference_of(run, part);
    const double deep =
        run->pass->camera.parallel ? 1 : (reference + run->pass->parts[part].depth) / reference;
    return (bound_of(run, part, most) + competing * reference) * deep * deep;
}

/* The addition of priorities to the bound of every part that competes. */
static double competing_of(const skg_gather_run *run, const double *most) {
    double competing = run->pass->priority.count ? skg_gather_volumes_bound(run, most) : 0;
    for (int64_t s = 0; s < run->pass->priority.count; s++) {
        const int64_t p = run->pass->priority.parts[s];
        const double layers = (double)run->pass->scene->parts[p].mesh->layers;
        competing += 2 * bound_of(run, p, most) / reference_of(run, p) * (layers > 1 ? layers : 1);
    }
    return competing;
}

/* A power of two that brings numbers of this size to 2^62. */
static double scale_for(double bound) {
    int exponent = 0;
    frexp(bound, &exponent);
    return ldexp(1, exponent > 62 + 120 ? -120 : exponent < 62 - 120 ? 120 : 62 - exponent);
}

/* No depth of a hit, times its weight by what stands around the part, is larger. */
static double around_bound(const skg_gather_run *run, int64_t part, const double *most,
                           const skg_surroundings *around) {
    double bound = 0;
    for (int32_t c = around->first[part]; c < around->first[part + 1]; c++)
        bound += fabs(around->list[c].weight) * most[around->list[c].plane];
    return bound * skg_gradient_depth_unit(run, part) * run->pass->parts[part].depth /
           reference_of(run, part);
}

/* The sum over a face, times columns or rows, stays below 2^62, and a hit below 2^50. That of lengths over all faces of a part stays below as
 * long as the lengths through it do. */
void skg_gradient_find_scales(const skg_gather_run *run, const double *most, const skg_surroundings *around,
                              double *scales, double *units) {
    const double competing = competing_of(run, most);
    const skg_raster_layout *layout = &run->raster->layout;
    const double far = layout->columns > layout->rows ? layout->columns : layout->rows;
    const int64_t parts = run->pass->scene->count;
    for (int64_t p = 0; p < parts; p++) {
        if (run->pass->parts[p].contributions == 0) continue;
        const double bound = hit_bound(run, p, most, competing) * fmax(pixels_of(run, p) * far, 4096);
        if (bound > 0 && !(around && around->same[p]))
            scales[p] = scale_for(bound), units[p] = reference_of(run, p) / scales[p];
        const double layers = (double)run->pass->scene->parts[p].mesh->layers;
        const double of_around = around ? around_bound(run, p, most, around) * (layers > 1 ? layers : 1) : 0;
        if (of_around > 0) {
            scales[parts + p] = scale_for(of_around * fmax(2 * pixels_of(run, p), 4096));
            units[parts + p] = 1 / scales[parts + p];
        }
    }
}

/* At most 2^12 of the largest hits meet in a pixel: a hit stays below 2^50. */
double skg_gradient_find_scale(const skg_gather_run *run, const double *most, const uint8_t *moves,
                               double slope, double *scales) {
    const double competing = competing_of(run, most);
    const int64_t parts = run->pass->scene->count;
    double bound = 0;
    for (int64_t p = 0; p < parts; p++)
        if (moves[p] && run->pass->parts[p].contributions > 0)
            bound = fmax(bound, hit_bound(run, p, most, competing));
    if (!(bound * slope > 0)) return 0;
    const double scale = scale_for(ldexp(bound * slope, 12));
    for (int64_t p = 0; p < parts; p++) scales[p] = moves[p] ? scale : 0;
    return scale;
}
