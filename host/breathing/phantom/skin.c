/* The skin and the muscle under it: rounded rectangles over z. */
#include "core/maths.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

#include <math.h>

/* By z: half width, y of the front, y of the back. */
typedef double outline_row[4];

static const outline_row simple_outline[] = {
    {-300, 158, -150, 62}, {-200, 158, -156, 64}, {-100, 160, -166, 70}, {0, 164, -168, 76},
    {60, 168, -156, 78},   {110, 178, -140, 74},  {145, 186, -126, 64},  {168, 178, -112, 50},
    {184, 140, -104, 36},  {198, 84, -98, 26},    {212, 64, -94, 20},    {240, 60, -92, 18}};

/* Outline of the full thorax, with the shoulders' slope, and deep enough for the shoulder blades. */
static const outline_row full_outline[] = {
    {-300, 158, -150, 62}, {-200, 158, -157, 66}, {-100, 159, -163, 70}, {-50, 161, -163, 73},
    {0, 165, -160, 77},    {60, 174, -143, 81},   {110, 191, -133, 81},  {145, 201, -131, 73},
    {168, 192, -122, 61},  {184, 160, -106, 48},  {197, 112, -101, 38},  {209, 80, -98, 32},
    {222, 68, -95, 29},    {240, 62, -93, 27}};
enum { ROWS_MAX = 16 };

/* Thickness of the fat under the skin by z: at the sides, in front, behind, mm (assumptions for an adult of normal
 * weight). */
static const outline_row fat[] = {{-300, 20, 24, 16},    {-150, 15, 16, 13.5}, {-60, 13, 11.2, 11.5},
                                  {100, 14.5, 11.5, 12}, {160, 14, 11.5, 12},  {240, 11, 11, 11}};

typedef struct {
    int64_t caps, sides;
    const outline_row *outline;
    int rows;
    double low, high; /* z of the ends */
    int under;        /* 1: the surface under the fat */
} skin_rings;

static double column_at(const outline_row *row, int rows, int column, double z) {
    double knots[ROWS_MAX][2];
    for (int i = 0; i < rows; i++) knots[i][0] = row[i][0], knots[i][1] = row[i][column];
    return skg_shape_curve((const double(*)[2])knots, rows, z);
}

static void skin_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const skin_rings *s = shape;
    int64_t last = 2 * s->caps + s->sides - 1, from_end = ring < last - ring ? ring : last - ring;
    double level = (double)(ring - s->caps) / (double)(s->sides - 1), edge = 1;
    if (from_end < s->caps) level = ring < s->caps ? 0 : 1, edge = (double)from_end / (double)s->caps;
    double z = s->low + (s->high - s->low) * level, at = z, value[3];
    /* Under the slope of the shoulders, fat as thick as at the sides means a lower outline. */
    if (s->under) at += 11 / (1 + exp((110 - z) / 12)) / (1 + exp((z - 225) / 5));
    for (int c = 1; c < 4; c++) {
        value[c - 1] = column_at(s->outline, s->rows, c, at);
        if (s->under)
            value[c - 1] += (c == 2 ? 1 : -1) * column_at(fat, (int)(sizeof fat / sizeof *fat), c, z);
    }
    double c = cos(2 * SKG_PI * azimuth), d = sin(2 * SKG_PI * azimuth);
    double r = edge / pow(pow(fabs(c), 2.4) + pow(fabs(d), 2.4), 1 / 2.4); /* a rounded rectangle */
    p[0] = r * value[0] * c;
    p[1] = 0.5 * (value[1] + value[2]) + r * 0.5 * (value[2] - value[1]) * d;
    p[2] = z;
}

static skg_status add_envelope(const skg_thorax_plan *plan, const char *label, double hounsfield,
                               int64_t outer, skin_rings *s, skg_thorax *thorax) {
    s->caps = skg_shape_count(plan->resolution, 6, 2), s->sides = skg_shape_count(plan->resolution, 36, 16);
    int64_t rings = 2 * s->caps + s->sides, around = skg_shape_count(plan->resolution, 52, 24), *counts;
    SKG_TRY(skg_alloc(rings, sizeof *counts, label, &counts));
    for (int64_t r = 0; r < rings; r++) {
        int64_t from_end = r < rings - 1 - r ? r : rings - 1 - r, part = around * from_end / s->caps;
        counts[r] = from_end == 0 ? 1 : from_end >= s->caps ? around : part > 6 ? part : 6;
    }
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_rings(label, rings, counts, skin_place, s, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, label, hounsfield, outer, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_skin(const skg_thorax_plan *plan, skg_thorax *thorax) {
    skin_rings s = {.outline = full_outline, .rows = sizeof full_outline / sizeof *full_outline};
    if (plan->simple) s.outline = simple_outline, s.rows = sizeof simple_outline / sizeof *simple_outline;
    s.low = -300, s.high = 240;
    return add_envelope(plan, "skin", -60, -1, &s, thorax);
}

/* Muscle fills what the fat encloses and no organ takes. It ends 2 mm inside the cut ends of the body. */
skg_status skg_thorax_muscle(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    skin_rings s = {.outline = full_outline, .rows = sizeof full_outline / sizeof *full_outline};
    s.low = -298, s.high = 238, s.under = 1;
    return add_envelope(plan, "muscle", 55, skin, &s, thorax);
}
