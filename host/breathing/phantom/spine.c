/* The spine of the full thorax: vertebrae with their arches, discs, and the canal. */
#include "core/maths.h"
#include "phantom/anatomy.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

/* Measures of a vertebra, mm. */
typedef struct {
    double z, height, y, width, depth; /* of the body: middle, and half axes of its section */
    double size;                       /* of the arch, relative to that of T10 */
    double pedicle;                    /* x of the pedicles' middle */
    double canal;                      /* y of the canal's middle */
} vertebra;

static const double canal_radius = 7.5; /* mm */

static vertebra vertebra_at(int k) {
    const double w = k / (SPINE_BODIES - 1.0), z = skg_spine_body[k][0];
    vertebra v = {z, skg_spine_body[k][1], skg_spine_depth(z), 13 + 8 * w, 9 + 7 * w, 0.85 + 0.2 * w, 0, 0};
    v.pedicle = fmax(canal_radius + 4, 0.68 * v.width);
    v.canal = v.y + v.depth + canal_radius + 1.5;
    return v;
}

static skg_status add_body(const skg_thorax_plan *plan, const vertebra *v, skg_mesh_arrays *arrays) {
    static const double level[6][2] = {{-0.5, 0.93}, {-0.4, 0.97}, {-0.12, 0.86}, {0.12, 0.86},
                                       {0.4, 0.97},  {0.5, 0.93}}; /* a waist between end plates */
    skg_tube_ring ring[6];
    for (int i = 0; i < 6; i++)
        ring[i] = (skg_tube_ring){
            {0, v->y, v->z + level[i][0] * (v->height - 3)}, level[i][1] * v->depth, level[i][1] * v->width};
    return skg_shape_tube("spine", 6, ring, 0.3, skg_shape_count(plan->resolution, 17, 8), arrays);
}

/* A short limb of a vertebra's arch through 3 points. */
static skg_status add_limb(const skg_thorax_plan *plan, const double p[3][3], double height, double width,
                           double side, skg_mesh_arrays *arrays) {
    double curve[9][3];
    SKG_TRY(skg_shape_spline(p, 3, 9, curve));
    return skg_shape_cord("spine", (const double(*)[3])curve, 9, height, width, side,
                          skg_shape_count(plan->resolution, 4, 3), skg_shape_count(plan->resolution, 7, 5),
                          arrays);
}

/* Pedicles, laminae, transverse processes and spinous process, apart from each other by a gap. */
static skg_status add_arch(const skg_thorax_plan *plan, const vertebra *v, skg_mesh_arrays *arrays) {
    const double s = v->size, x = v->pedicle, c = v->canal, behind = c + canal_radius + 3.5;
    const double wall = v->y + v->depth * sqrt(1 - x * x / (v->width * v->width));
    const double up = v->z + 0.16 * v->height, low = v->z - 0.1 * v->height;
    const double steep =
        1 - fabs(v->z - 40) / 260; /* spinous processes of the middle vertebrae hang lowest */
    const double pedicle[3][3] = {{x, wall + 2, up}, {x, 0.5 * (wall + c) + 1, up}, {x, c + 3, up}};
    const double lamina[3][3] = {
        {-x - 1, behind - 1, low + 2}, {0, behind + 4, low - 2}, {x + 1, behind - 1, low + 2}};
    const double across[3][3] = {
        {x + 6, behind - 1, up}, {x + 12, behind + 2, up + 1}, {x + 18 * s, behind + 5, up + 2}};
    const double spinous[3][3] = {{0, behind + 9.5, low - 5},
                                  {0, behind + 15, low - 8 - 10 * steep},
                                  {0, behind + 20, low - 11 - 18 * steep}};
    for (double side = 1; side >= -1; side -= 2) {
        SKG_TRY(add_limb(plan, pedicle, 5.5 * s, 3.2 * s, side, arrays));
        SKG_TRY(add_limb(plan, across, 4.5 * s, 3.5 * s, side, arrays));
    }
    SKG_TRY(add_limb(plan, lamina, 6 * s, 2.6, 1, arrays));
    return add_limb(plan, spinous, 3.4, 2.6, 1, arrays);
}

static skg_status discs(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    for (int k = 0; k + 1 < SPINE_BODIES && status == SKG_OK; k++) {
        const vertebra above = vertebra_at(k), below = vertebra_at(k + 1);
        const double top = above.z - 0.5 * (above.height - 3) - 0.9,
                     bottom = below.z + 0.5 * (below.height - 3) + 0.9;
        skg_tube_ring ring[2];
        for (int i = 0; i < 2; i++) {
            const double z = i == 0 ? bottom : top;
            ring[i] = (skg_tube_ring){{0, skg_spine_depth(z), z}, 0.9 * above.depth, 0.93 * above.width};
        }
        status = skg_shape_tube("discs", 2, ring, 0.1, skg_shape_count(plan->resolution, 14, 8), &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_fit(thorax, "discs", 90, outer, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

static skg_status canal(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    double line[SPINE_BODIES][3], curve[65][3];
    skg_mesh_arrays arrays = {0};
    for (int k = 0; k < SPINE_BODIES; k++) {
        const vertebra v = vertebra_at(SPINE_BODIES - 1 - k);
        line[k][0] = 0, line[k][1] = v.canal, line[k][2] = v.z;
    }
    SKG_TRY(skg_shape_spline((const double(*)[3])line, SPINE_BODIES, 65, curve));
    skg_status status = skg_shape_hose("spinal canal", (const double(*)[3])curve, 65, canal_radius,
                                       canal_radius, 1, skg_shape_count(plan->resolution, 28, 12),
                                       skg_shape_count(plan->resolution, 10, 6), &arrays);
    if (status == SKG_OK) status = skg_thorax_fit(thorax, "spinal canal", 20, outer, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_spine(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    for (int k = 0; k < SPINE_BODIES && status == SKG_OK; k++) {
        const vertebra v = vertebra_at(k);
        status = add_body(plan, &v, &arrays);
        if (status == SKG_OK) status = add_arch(plan, &v, &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_fit(thorax, "spine", 380, outer, &arrays);
    skg_mesh_arrays_free(&arrays);
    if (status == SKG_OK) status = discs(plan, outer, thorax);
    return status == SKG_OK ? canal(plan, outer, thorax) : status;
}
