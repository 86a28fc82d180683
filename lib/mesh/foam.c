/* Spheres: given ones, and those of a foam. */
#include "core/maths.h"
#include "core/text.h"
#include "mesh/mesh.h"
#include "mesh/pieces.h"

#include <skiagraph/bodies.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const char *const shape = "foam";

skg_status skg_mesh_create_spheres(int64_t count, const double *centres, const double *radii,
                                   int64_t segments, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays;
    SKG_NEEDS(centres);
    SKG_NEEDS(radii);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_check_count("spheres", "segments", segments, 3, 26000));
    const int64_t ring = skg_sphere_rings(segments) * segments;
    SKG_TRY(skg_check_count("spheres", "spheres", count, 1, SKG_MESH_LIMIT / (2 * ring)));
    for (int64_t i = 0; i < count; i++) {
        SKG_TRY(skg_check_length("spheres", "radius", radii[i]));
        for (int k = 0; k < 3; k++)
            if (!isfinite(centres[3 * i + k]))
                return skg_fail(SKG_ERR_ARGUMENT, "spheres: the centre of sphere %" PRId64 " is not finite",
                                i);
    }
    SKG_TRY(skg_pieces_start("spheres", count * (2 + ring), count * 2 * ring, &arrays));
    for (int64_t i = 0; i < count; i++) skg_add_sphere(&arrays, centres + 3 * i, radii[i], segments);
    return skg_mesh_adopt(NULL, "spheres", &arrays, mesh);
}

void skg_foam_init_sized(void *foam, int32_t size) {
    const skg_foam defaults = {.box = {20, 20, 20}, .radius_mm = 1, .fraction = 0.1, .segments = 12};
    skg_struct_init(foam, size, &defaults, sizeof defaults);
}

/* Spheres that were placed, in cells at least as wide as two spheres that touch. */
typedef struct {
    const skg_foam *foam;
    double *centres, *radii;
    int64_t count, placed;
    double cell;
    int64_t cells[3];
    int64_t *heads, *next; /* -1: none */
    uint64_t state;
} packing;

enum { TRIES = 20000 };

static double normal(uint64_t *state) {
    const double u = skg_draw(state), v = skg_draw(state);
    return sqrt(-2 * log(1 - u)) * cos(2 * SKG_PI * v);
}

static double draw_radius(const skg_foam *foam, uint64_t *state) {
    if (foam->spread == 0) return foam->radius_mm;
    return foam->radius_mm * fmin(fmax(1 + foam->spread * normal(state), 0.2), 2);
}

static int falling(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* The radii, the largest first. With most 0 it counts them only. */
static int64_t draw_radii(const skg_foam *foam, int64_t most, double *radii) {
    const double box = foam->box[0] * foam->box[1] * foam->box[2];
    uint64_t state = (uint64_t)foam->seed;
    double volume = 0;
    int64_t count = 0;
    while (foam->count > 0 ? count < foam->count : volume < foam->fraction * box) {
        const double r = draw_radius(foam, &state);
        if (count < most) radii[count] = r;
        volume += 4.0 / 3 * SKG_PI * r * r * r;
        if (++count > SKG_MESH_LIMIT) break;
    }
    if (most > 0) qsort(radii, (size_t)count, sizeof *radii, falling);
    return count;
}

static int64_t cell_of(const packing *p, const double *centre, int k) {
    const int64_t cell = (int64_t)((centre[k] + 0.5 * p->foam->box[k]) / p->cell);
    return cell < 0 ? 0 : cell < p->cells[k] ? cell : p->cells[k] - 1;
}

static int fits(const packing *p, const double *centre, double radius) {
    int64_t low[3], high[3];
    for (int k = 0; k < 3; k++) {
        const int64_t own = cell_of(p, centre, k);
        low[k] = own > 0 ? own - 1 : 0, high[k] = own + 1 < p->cells[k] ? own + 1 : own;
    }
    for (int64_t z = low[2]; z <= high[2]; z++)
        for (int64_t y = low[1]; y <= high[1]; y++)
            for (int64_t x = low[0]; x <= high[0]; x++)
                for (int64_t i = p->heads[(z * p->cells[1] + y) * p->cells[0] + x]; i >= 0; i = p->next[i]) {
                    double square = 0;
                    for (int k = 0; k < 3; k++) {
                        const double d = centre[k] - p->centres[3 * i + k];
                        square += d * d;
                    }
                    const double least = radius + p->radii[i] + p->foam->gap_mm;
                    if (square < least * least) return 0;
                }
    return 1;
}

static int place_one(packing *p, double radius) {
    double *centre = p->centres + 3 * p->placed;
    for (int attempt = 0; attempt < TRIES; attempt++) {
        for (int k = 0; k < 3; k++)
            centre[k] = (skg_draw(&p->state) - 0.5) * (p->foam->box[k] - 2 * (radius + p->foam->gap_mm));
        if (!fits(p, centre, radius)) continue;
        const int64_t cell = (cell_of(p, centre, 2) * p->cells[1] + cell_of(p, centre, 1)) * p->cells[0] +
                             cell_of(p, centre, 0);
        p->next[p->placed] = p->heads[cell];
        p->heads[cell] = p->placed++;
        return 1;
    }
    return 0;
}

static skg_status place_all(packing *p) {
    const double *box = p->foam->box;
    double volume = 0;
    for (int64_t i = 0; i < p->count; i++) {
        const double r = p->radii[i], least = fmin(box[0], fmin(box[1], box[2]));
        if (!(2 * (r + p->foam->gap_mm) < least))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "foam: a sphere of radius %g mm does not fit into a box of %g x %g x %g mm", r,
                            box[0], box[1], box[2]);
        if (!place_one(p, r))
            return skg_fail(SKG_ERR_MESH,
                            "foam: no place is left for sphere %" PRId64 " of %" PRId64
                            ", when %.3g of the box is filled; "
                            "give a smaller fraction or gap, or smaller spheres",
                            i + 1, p->count, volume / (box[0] * box[1] * box[2]));
        volume += 4.0 / 3 * SKG_PI * r * r * r;
    }
    return SKG_OK;
}

static skg_status check_foam(const skg_foam *foam) {
    for (int k = 0; k < 3; k++) SKG_TRY(skg_check_length(shape, "edge of the box", foam->box[k]));
    SKG_TRY(skg_check_length(shape, "radius", foam->radius_mm));
    if (!(foam->spread >= 0 && foam->spread <= 0.5))
        return skg_fail(SKG_ERR_ARGUMENT, "foam: spread %g: 0 to 0.5", foam->spread);
    if (!(foam->gap_mm >= 0 && isfinite(foam->gap_mm)))
        return skg_fail(SKG_ERR_ARGUMENT, "foam: gap %g mm: 0 or more", foam->gap_mm);
    if (foam->count <= 0 && !(foam->fraction > 0 && foam->fraction <= 0.6))
        return skg_fail(SKG_ERR_ARGUMENT, "foam: fraction %g: above 0 to 0.6", foam->fraction);
    return skg_check_count(shape, "spheres", foam->count, 0, SKG_MESH_LIMIT / 12);
}

skg_status skg_mesh_create_foam(const skg_foam *foam, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_foam ours;
    skg_foam_init(&ours);
    SKG_NEEDS(foam);
    SKG_NEEDS(mesh);
    *mesh = NULL;
    SKG_TRY(skg_struct_read(foam, "skg_foam", &ours, sizeof ours));
    SKG_TRY(check_foam(&ours));
    packing p = {.foam = &ours, .count = draw_radii(&ours, 0, NULL), .state = ~(uint64_t)ours.seed};
    int64_t cells = 1;
    skg_status status = skg_alloc(p.count, sizeof *p.radii, shape, &p.radii);
    SKG_TRY_CLEANUP(status);
    SKG_TRY_CLEANUP(skg_alloc(p.count, 3 * sizeof *p.centres, shape, &p.centres));
    SKG_TRY_CLEANUP(skg_alloc(p.count, sizeof *p.next, shape, &p.next));
    draw_radii(&ours, p.count, p.radii);
    p.cell = 2 * p.radii[0] + ours.gap_mm;
    for (int k = 0; k < 3; k++) {
        p.cells[k] = (int64_t)fmin(fmax(ours.box[k] / p.cell, 1), 512);
        p.cell = fmax(p.cell, ours.box[k] / 512);
        cells *= p.cells[k];
    }
    SKG_TRY_CLEANUP(skg_alloc(cells, sizeof *p.heads, shape, &p.heads));
    for (int64_t i = 0; i < cells; i++) p.heads[i] = -1;
    SKG_TRY_CLEANUP(place_all(&p));
    SKG_TRY_CLEANUP(skg_mesh_create_spheres(p.count, p.centres, p.radii, ours.segments, mesh));
cleanup:
    skg_free(&p.radii);
    skg_free(&p.centres);
    skg_free(&p.next);
    skg_free(&p.heads);
    return status;
}
