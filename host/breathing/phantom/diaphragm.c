/* The diaphragm: a closed sheet about its middle surface. */
#include "core/maths.h"
#include "phantom/contacts.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

typedef struct {
    const skg_thorax_plan *plan;
    int64_t rings; /* from the centre to the rim */
} sheet;

/* Rings run below from the centre to the rim, then above back to the centre. */
static void sheet_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const sheet *s = shape;
    double angle = 2 * SKG_PI * azimuth, h = 0.5 /* mm */, normal[3];
    int64_t out = ring <= s->rings ? ring : 2 * s->rings - ring;
    double t = (double)out / (double)s->rings,
           r = skg_shape_towards_rim(t) * skg_dome_rim_radius(&s->plan->diaphragm, angle);
    double x = skg_dome_centre[0] + r * cos(angle), y = skg_dome_centre[1] + r * sin(angle);
    normal[0] =
        skg_dome_height(&s->plan->diaphragm, x - h, y) - skg_dome_height(&s->plan->diaphragm, x + h, y);
    normal[1] =
        skg_dome_height(&s->plan->diaphragm, x, y - h) - skg_dome_height(&s->plan->diaphragm, x, y + h);
    normal[2] = 1;
    double side = ring == s->rings ? 0 : ring < s->rings ? -skg_dome_half_thickness : skg_dome_half_thickness;
    p[0] = x, p[1] = y, p[2] = skg_dome_height(&s->plan->diaphragm, x, y);
    skg_add_scaled(p, side / skg_length(normal), normal, p);
}

skg_status skg_thorax_diaphragm(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    sheet s = {plan, skg_shape_count(plan->resolution, 20, 6)};
    int64_t *counts, rings = 2 * s.rings + 1, around = skg_shape_count(plan->resolution, 78, 24);
    SKG_TRY(skg_alloc(rings, sizeof *counts, "diaphragm", &counts));
    for (int64_t r = 0; r < rings; r++) {
        int64_t out = r <= s.rings ? r : 2 * s.rings - r, part = around * 3 * out / (2 * s.rings);
        counts[r] = out == 0 ? 1 : part < 6 ? 6 : part < around ? part : around;
    }
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_rings("diaphragm", rings, counts, sheet_place, &s, &arrays);
    if (status == SKG_OK) status = skg_shape_unfold("diaphragm", &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "diaphragm", 50, skin, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}
