/* The skin: rounded rectangles over z. */
#include "core/maths.h"
#include "phantom/curve.h"
#include "phantom/makers.h"
#include "phantom/rings.h"

#include <math.h>

/* Skin by z: half width, y of the front, y of the back. */
static const double outline[][4] = {{-300, 158, -150, 62}, {-200, 158, -156, 64}, {-100, 160, -166, 70},
                                    {0, 164, -168, 76},    {60, 168, -156, 78},   {110, 178, -140, 74},
                                    {145, 186, -126, 64},  {168, 178, -112, 50},  {184, 140, -104, 36},
                                    {198, 84, -98, 26},    {212, 64, -94, 20},    {240, 60, -92, 18}};
enum { OUTLINE = sizeof outline / sizeof *outline };

typedef struct {
    int64_t caps, sides;
} skin_rings;

static void skin_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const skin_rings *s = shape;
    int64_t last = 2 * s->caps + s->sides - 1, from_end = ring < last - ring ? ring : last - ring;
    double level = (double)(ring - s->caps) / (double)(s->sides - 1), edge = 1;
    if (from_end < s->caps) level = ring < s->caps ? 0 : 1, edge = (double)from_end / (double)s->caps;
    double z = -300 + 540 * level, column[OUTLINE][2], value[3];
    for (int c = 1; c < 4; c++) {
        for (int i = 0; i < OUTLINE; i++) column[i][0] = outline[i][0], column[i][1] = outline[i][c];
        value[c - 1] = skg_shape_curve((const double(*)[2])column, OUTLINE, z);
    }
    double c = cos(2 * SKG_PI * azimuth), d = sin(2 * SKG_PI * azimuth);
    double r = edge / pow(pow(fabs(c), 2.4) + pow(fabs(d), 2.4), 1 / 2.4); /* a rounded rectangle */
    p[0] = r * value[0] * c;
    p[1] = 0.5 * (value[1] + value[2]) + r * 0.5 * (value[2] - value[1]) * d;
    p[2] = z;
}

skg_status skg_thorax_skin(const skg_thorax_plan *plan, skg_thorax *thorax) {
    skin_rings s = {skg_shape_count(plan->resolution, 6, 2), skg_shape_count(plan->resolution, 36, 16)};
    int64_t rings = 2 * s.caps + s.sides, around = skg_shape_count(plan->resolution, 52, 24), *counts;
    SKG_TRY(skg_alloc(rings, sizeof *counts, "skin", &counts));
    for (int64_t r = 0; r < rings; r++) {
        int64_t from_end = r < rings - 1 - r ? r : rings - 1 - r, part = around * from_end / s.caps;
        counts[r] = from_end == 0 ? 1 : from_end >= s.caps ? around : part > 6 ? part : 6;
    }
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_rings("skin", rings, counts, skin_place, &s, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "skin", -60, -1, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}
